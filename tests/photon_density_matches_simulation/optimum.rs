//! The best radius and number of neighbours against searches over errors that are integrated.

use crate::common::{KERNELS, close, integrate, over_disc, weight};
use furnace::truth::density::Kernel;
use furnace::truth::density::optimum::Spot;
use std::f64::consts::PI;

/// So weak photons that radii are small and leading orders suffice.
const SPOT: Spot = Spot { irradiance: 2.0, laplacian: -3.0, photon: 1e-12 };

/// Mean squared error of photons with Poisson-distributed numbers for irradiance 2 - x² - y²/2, as a function of the radius.
fn error_by_radius(kernel: Kernel) -> impl Fn(f64) -> f64 {
    let field = |x: f64, y: f64| -x * x - 0.5 * y * y;
    let curved = over_disc(1.0, |x, y| weight(kernel, x.hypot(y)) * field(x, y));
    let square = over_disc(1.0, |x, y| weight(kernel, x.hypot(y)).powi(2));
    let curved_square = over_disc(1.0, |x, y| weight(kernel, x.hypot(y)).powi(2) * field(x, y));
    move |radius: f64| {
        let r2 = radius * radius;
        (r2 * curved).powi(2) + SPOT.photon * (2.0 * square / r2 + curved_square)
    }
}

#[test]
fn the_best_radius_is_found_by_search() {
    for kernel in KERNELS {
        let error = error_by_radius(kernel);
        let (mut low, mut high) = (1e-3f64, 1e-1f64);
        for _ in 0..40 {
            let third = (high / low).powf(1.0 / 3.0);
            let (a, b) = (low * third, high / third);
            if error(a) < error(b) { high = b } else { low = a }
        }
        close(SPOT.best_radius(kernel), low, 1e-4);
        close(SPOT.least_error(kernel), error(low), 1e-4);
        for radius in [0.3 * low, 3.0 * low] {
            close(SPOT.error(kernel, radius), error(radius), 2e-4);
        }
        let (bias, variance) = (SPOT.bias(kernel, low), SPOT.variance(kernel, low));
        close(bias * bias + variance, error(low), 1e-4);
        // more photons
        let more = Spot { photon: 1e-15, ..SPOT };
        close(SPOT.least_error(kernel) / more.least_error(kernel), 100.0, 1e-9);
    }
    let sixth = 32.0 * SPOT.irradiance * SPOT.photon / (PI * SPOT.laplacian.powi(2));
    close(SPOT.best_radius(Kernel::Box).powi(6), sixth, 1e-12);
}

/// Mean and mean square of (k - 1) photon / (π r_k²) for an irradiance of 1 and photons of power 1 in the centre, `curve` being
/// the Laplacian. The photons within r are Poisson-distributed with mean g = π r² (1 + curve · r²/8), so up to the k-th it
/// is Γ(k)-distributed.
fn nearest(k: u64, curve: f64) -> (f64, f64) {
    let count = k as f64;
    // π r²
    let area =
        |g: f64| if curve == 0.0 { g } else { 2.0 * g / (1.0 + (1.0 + curve * g / (2.0 * PI)).sqrt()) };
    let density = |g: f64| ((count - 1.0) * (g / count).ln() - g + count).exp();
    // from where nothing overflows, in pieces that the rule resolves
    let piece = (count + 14.0 * count.sqrt() + 40.0) / 4.0;
    let mean = |order: i32| {
        let integrand = |g: f64| density(g) * ((count - 1.0) / area(g)).powi(order);
        (0..4)
            .map(|i| integrate(1e-9 + f64::from(i) * piece, f64::from(i + 1) * piece, integrand))
            .sum::<f64>()
    };
    let whole = mean(0);
    (mean(1) / whole, mean(2) / whole)
}

#[test]
fn neighbours_have_that_error() {
    for k in [3, 5, 20, 90] {
        let curve = 1e-6;
        let bias = (nearest(k, curve).0 - nearest(k, 0.0).0) / curve;
        // in units of the irradiance 2 and with curve = laplacian photon / irradiance²
        let spot = Spot { irradiance: 2.0, laplacian: 5.0, photon: 0.01 };
        close(spot.nearest_bias(k), 2.0 * bias * 0.0125, 1e-5);
        let (mean, square) = nearest(k, 0.0);
        let error = (2.0 * bias * 0.0125).powi(2) + 4.0 * (square - mean * mean);
        close(spot.nearest_error(k), error, 1e-5);
    }
    assert_eq!(SPOT.nearest_error(2), f64::INFINITY);
}

#[test]
fn the_best_count_is_found_by_search() {
    for (laplacian, photon) in [(1.0, 100.0), (-1.0, 20.0), (1.0, 1.0), (0.2, 1.0), (0.3, 0.11)] {
        let spot = Spot { irradiance: 1.0, laplacian, photon };
        let error = |k: u64| {
            let slope = (nearest(k, 1e-6).0 - nearest(k, 0.0).0) / 1e-6;
            let (mean, square) = nearest(k, 0.0);
            (slope * laplacian * photon).powi(2) + square - mean * mean
        };
        let best = (3..120).min_by(|&a, &b| error(a).total_cmp(&error(b))).unwrap();
        assert_eq!(spot.best_count(), best, "{spot:?}");
    }
    // more photons
    let (many, few) = (SPOT.best_count() as f64, Spot { photon: 1e-9, ..SPOT }.best_count() as f64);
    close(many / few, 100.0, 1e-3);
    let cube = 32.0 * PI * PI * 16.0 / (3e-12f64).powi(2);
    close(many, cube.cbrt(), 1e-6);
}
