//! Progressive passes against the recursion of their radii, summed pass by pass, and against simulated photons.

use crate::common::{Random, close, has_mean, has_variance};
use furnace::truth::density::Kernel;
use furnace::truth::density::progressive::{
    BEST_ALPHA, Shrinking, bias_exponent, error_exponent, variance_exponent,
};
use std::f64::consts::PI;

/// Squared radii of the first passes, each from the one before.
fn radii(shrinking: Shrinking, passes: u64) -> Vec<f64> {
    let mut square = shrinking.first.powi(2);
    let mut squares = Vec::new();
    for i in 1..=passes {
        squares.push(square);
        square *= (i as f64 + shrinking.alpha) / (i as f64 + 1.0);
    }
    squares
}

#[test]
fn sums_over_passes_are_exact() {
    for alpha in [0.1, 0.5, 2.0 / 3.0, 0.9, 1.0] {
        let shrinking = Shrinking { first: 0.3, alpha };
        let squares = radii(shrinking, 100_000);
        for n in [1, 2, 3, 10, 1000, 9_999, 10_000, 10_001, 100_000] {
            let n64 = n as u64;
            let mean = |f: &dyn Fn(f64) -> f64| squares[..n].iter().map(|&s| f(s)).sum::<f64>() / n as f64;
            let (a, b) = (0.7, -0.2);
            close(shrinking.square_radius(n64), squares[n - 1], 1e-10);
            close(shrinking.mean_square_radius(n64), mean(&|s| s), 1e-10);
            close(shrinking.variance_ratio(n64), mean(&|s| 0.09 / s) / n as f64, 1e-10);
            close(shrinking.variance(n64, a, b), mean(&|s| a / s + b) / n as f64, 1e-10);
            close(shrinking.bias(n64, -0.4), -0.4 * mean(&|s| s), 1e-10);
        }
    }
}

#[test]
fn limits_are_approached() {
    for alpha in [0.5, 2.0 / 3.0, 0.8] {
        let shrinking = Shrinking { first: 0.3, alpha };
        let squares = radii(shrinking, 1_000_000);
        // what is left falls as n^-alpha of the radii and faster of the variances
        for (n, left) in [(10_000, 1.2e-2), (1_000_000, 1.2e-3)] {
            let mean = |f: &dyn Fn(f64) -> f64| squares[..n].iter().map(|&s| f(s)).sum::<f64>() / n as f64;
            close(shrinking.late_mean_square_radius(n as u64), mean(&|s| s), left);
            close(shrinking.late_variance_ratio(n as u64), mean(&|s| 0.09 / s) / n as f64, 0.1 * left);
        }
        let slope = |f: &dyn Fn(u64) -> f64| (f(1 << 40) / f(1 << 30)).ln() / 1024f64.ln();
        close(bias_exponent(alpha), slope(&|n| shrinking.mean_square_radius(n)), 3e-4);
        close(variance_exponent(alpha), slope(&|n| shrinking.variance_ratio(n)), 3e-4);
        let error = |n: u64| shrinking.mean_square_radius(n).powi(2) + shrinking.variance_ratio(n);
        close(error_exponent(alpha), slope(&error), 1e-2);
    }
    assert!(error_exponent(BEST_ALPHA) < error_exponent(BEST_ALPHA + 0.01));
    assert!(error_exponent(BEST_ALPHA) < error_exponent(BEST_ALPHA - 0.01));
    close(error_exponent(BEST_ALPHA), -2.0 / 3.0, 1e-12);
}

/// A Poisson-distributed number of photons of that density, 1 + 1.5 x² over the plane, in the square around the disc:
/// their estimate of the irradiance in the centre, which is 1 and has the Laplacian 3.
fn pass(random: &mut Random, density: f64, square_radius: f64) -> f64 {
    let side = 2.0 * square_radius.sqrt();
    let most = 1.0 + 1.5 * square_radius;
    let (mut x, mut count) = (-0.5 * side, 0);
    loop {
        // photons in order of x, with the largest density, some of which are then left out
        x += random.exponential() / (density * most * side);
        if x > 0.5 * side {
            return f64::from(count) / (density * PI * square_radius);
        }
        let y = side * (random.uniform() - 0.5);
        let stays = random.uniform() * most < 1.0 + 1.5 * x * x;
        count += i32::from(stays && x * x + y * y < square_radius);
    }
}

/// Deviations of 3 % of the variance (to which curvature adds 20 %) and 4 % of the bias (21 % of the truth) are noticed.
#[test]
fn passes_have_that_mean_and_variance() {
    let (shrinking, density) = (Shrinking { first: 0.9, alpha: 0.6 }, 8.0);
    let squares = radii(shrinking, 6);
    let mut random = Random::new(41);
    let mut average = || squares.iter().map(|&s| pass(&mut random, density, s)).sum::<f64>() / 6.0;
    let errors: Vec<f64> = (0..100_000).map(|_| average() - 1.0).collect();
    let slope = 3.0 * Kernel::Box.bias();
    has_mean(&errors, shrinking.bias(6, slope), 0.04);
    let variance = shrinking.variance(6, 1.0 / (density * PI), slope / (density * PI));
    has_variance(&errors, variance, 0.03);
}
