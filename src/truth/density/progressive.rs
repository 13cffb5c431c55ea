//! Passes with ever smaller radii, whose estimates are averaged: bias and variance both vanish.
//!
//! r²_{i+1} = r²_i (i + α)/(i + 1) with passes counted from 1 [Knaus & Zwicker 2011, Progressive Photon Mapping: A
//! Probabilistic Approach, ACM TOG 30(3)]. All sums are exact for any number of passes, with relative rounding errors of up
//! to 1e-10 for α from 0.1; they grow where α is smaller, as 1/α.

use libm::{exp, lgamma, tgamma};

/// Radii that shrink from pass to pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shrinking {
    /// Radius of the first pass \[m\], above 0.
    pub first: f64,
    /// α in (0, 1]: by how little radii shrink; 1 keeps them. The error is least in the long run at [`BEST_ALPHA`].
    pub alpha: f64,
}

/// The α for which squared bias and variance vanish equally fast, both as n^(-2/3).
pub const BEST_ALPHA: f64 = 2.0 / 3.0;

impl Shrinking {
    /// Squared radius \[m²\] of a pass, counted from 1.
    pub fn square_radius(&self, pass: u64) -> f64 {
        self.first * self.first * ratio(self.counted(pass), self.alpha, 1.0) / tgamma(1.0 + self.alpha)
    }

    /// Mean squared radius \[m²\] of the first `passes`.
    pub fn mean_square_radius(&self, passes: u64) -> f64 {
        let (n, alpha) = (self.counted(passes), self.alpha);
        let sum = ratio(n, 1.0 + alpha, 1.0) / alpha - tgamma(alpha);
        self.first * self.first * sum / (n * tgamma(1.0 + alpha))
    }

    /// Variance of the mean of the first `passes`, over that of the first pass alone, if that of each pass is inversely
    /// proportional to its squared radius; in (0, 1].
    pub fn variance_ratio(&self, passes: u64) -> f64 {
        let (n, alpha) = (self.counted(passes), self.alpha);
        let sum = (ratio(n, 2.0, alpha) - 1.0 / tgamma(alpha)) / (2.0 - alpha);
        tgamma(1.0 + alpha) * sum / (n * n)
    }

    /// Variance of the mean of the first `passes` if pass i, independently, has the variance a/r_i² + b. Uniform spheres
    /// and, with Poisson-distributed photons, irradiance with a constant Laplacian are exactly so.
    pub fn variance(&self, passes: u64, a: f64, b: f64) -> f64 {
        a / (self.first * self.first) * self.variance_ratio(passes) + b / passes as f64
    }

    /// Bias of the mean of the first `passes` if pass i has the bias `per_square` · r_i²: [`super::Kernel::bias`] times the
    /// Laplacian.
    pub fn bias(&self, passes: u64, per_square: f64) -> f64 {
        per_square * self.mean_square_radius(passes)
    }

    /// What [`Shrinking::mean_square_radius`] tends to for many passes: r_1² n^(α-1) / (α Γ(1 + α)).
    pub fn late_mean_square_radius(&self, passes: u64) -> f64 {
        let power = libm::pow(self.counted(passes), bias_exponent(self.alpha));
        self.first * self.first * power / (self.alpha * tgamma(1.0 + self.alpha))
    }

    /// What [`Shrinking::variance_ratio`] tends to for many passes: n^-α Γ(1 + α)/(2 - α).
    pub fn late_variance_ratio(&self, passes: u64) -> f64 {
        let power = libm::pow(self.counted(passes), variance_exponent(self.alpha));
        power * tgamma(1.0 + self.alpha) / (2.0 - self.alpha)
    }

    fn counted(&self, passes: u64) -> f64 {
        assert!(passes >= 1, "passes count from 1");
        assert!(self.alpha > 0.0 && self.alpha <= 1.0, "α of {}", self.alpha);
        passes as f64
    }
}

/// The power of the number of passes with which bias vanishes: α - 1.
pub fn bias_exponent(alpha: f64) -> f64 {
    alpha - 1.0
}

/// The power of the number of passes with which variance vanishes: -α.
pub fn variance_exponent(alpha: f64) -> f64 {
    -alpha
}

/// The power of the number of passes with which the mean squared error vanishes, -2/3 at best: the slower one of squared
/// bias and variance.
pub fn error_exponent(alpha: f64) -> f64 {
    (2.0 * bias_exponent(alpha)).max(variance_exponent(alpha))
}

/// Γ(x + a) / Γ(x + b) for x from 1 and small, not negative a and b. Where lnΓ would lose digits, its expansion for large x,
/// whose next term is of order x^-3 [DLMF 5.11.13].
fn ratio(x: f64, a: f64, b: f64) -> f64 {
    if x < 1e4 {
        return exp(lgamma(x + a) - lgamma(x + b));
    }
    let (power, sum) = (a - b, a + b - 1.0);
    let second = power * (power - 1.0) / 24.0 * (3.0 * sum * sum - power - 1.0);
    libm::pow(x, power) * (1.0 + (0.5 * power * sum + second / x) / x)
}
