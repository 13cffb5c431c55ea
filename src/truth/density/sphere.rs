//! Fixed radius on the inside of a sphere. Wherever a cosine-distributed photon starts, it hits the sphere uniformly, and
//! the cap within a chord r has exactly the area π r² (Archimedes): the disc's formulas hold without any curvature.
//!
//! A photon arrives with weight w_0 = 1. Each hit reflects it with probability q and multiplies its weight by albedo / q,
//! so that hit j exists with probability q^j and E w_j is albedo^j. The estimate is the sum over all hits of
//! Φ/N · w_j · K(distance). Hit j has been reflected j times: the light that it makes the surface send on is of bounce
//! j + 1. [`Counted`] counts hits here.

use super::Kernel;
use crate::truth::Counted;
use crate::truth::moments::power;
use std::f64::consts::PI;

/// A part of the sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coated {
    /// Share of the sphere's area, in (0, 1].
    pub fraction: f64,
    /// Albedo, in [0, 1].
    pub albedo: f64,
    /// Probability that a photon survives a hit, in (0, 1].
    pub q: f64,
}

/// Photons on the way through a sphere, as one channel sees them; q may be common to all channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photons {
    /// Mean albedo, in [0, 1).
    mean: f64,
    /// Mean of albedo² / q: E w_j² is its j-th power. From 1 on, the variance over all hits is infinite.
    square: f64,
    /// Albedo within the kernel.
    here: f64,
    /// Hits after which a photon ends, without compensation.
    most: Option<u32>,
}

impl Photons {
    /// A sphere of one albedo in [0, 1), where photons survive with probability `q` in (0, 1]. With q = albedo all weights
    /// are 1; q = 1 needs [`Photons::with_at_most`] to ever end.
    pub fn uniform(albedo: f64, q: f64) -> Self {
        Photons::patches(&[Coated { fraction: 1.0, albedo, q }], 0)
    }

    /// A sphere of several parts whose fractions add up to 1, the kernel lying wholly in part number `here`.
    pub fn patches(parts: &[Coated], here: usize) -> Self {
        let sum = |f: fn(&Coated) -> f64| parts.iter().map(|part| part.fraction * f(part)).sum::<f64>();
        assert!((sum(|_| 1.0) - 1.0).abs() < 1e-9, "parts of a sphere: {parts:?}");
        assert!(parts.iter().all(|p| p.q > 0.0 && p.q <= 1.0), "not probabilities: {parts:?}");
        let (mean, square) = (sum(|p| p.albedo), sum(|p| p.albedo * p.albedo / p.q));
        assert!((0.0..1.0).contains(&mean), "a mean albedo of {mean}");
        Photons { mean, square, here: parts[here].albedo, most: None }
    }

    /// The same where a photon's hits end after `most`, whatever light is lost by that: the mean changes too.
    pub fn with_at_most(self, most: u32) -> Self {
        Photons { most: Some(most), ..self }
    }

    /// Expected irradiance in units of Φ / sphere's area, the same everywhere: albedo^j of hit j, 1 / (1 - albedo) of all.
    /// This is the truth unless hits are cut off by [`Photons::with_at_most`]: the estimate is unbiased for every radius,
    /// hit by hit.
    pub fn mean(&self, counted: Counted) -> f64 {
        let (first, end) = self.range(counted);
        match end {
            Some(end) => (first..end).map(|j| power(self.mean, j)).sum(),
            None => power(self.mean, first) / (1.0 - self.mean),
        }
    }

    /// Expected irradiance [W m^-2] of lights with that power \[W\] in a sphere of that radius \[m\].
    pub fn irradiance(&self, light_power: f64, sphere_radius: f64, counted: Counted) -> f64 {
        light_power * self.mean(counted) / (4.0 * PI * sphere_radius * sphere_radius)
    }

    /// Variance of the estimate from `photons` independent photons, in units of (Φ / sphere's area)²; infinite where it is.
    /// `radius` is that of the kernel as a chord, in units of the sphere's radius: in (0, 2].
    ///
    /// Photons are independent, so the variance is that of one over their number; of one, the squares of its hits have
    /// E Y² = 4 `kernel.variance()` / `radius`², where Y has mean 1, and a hit and a later one are as independent as their
    /// weights.
    pub fn variance(&self, kernel: Kernel, radius: f64, photons: u64, counted: Counted) -> f64 {
        assert!(radius > 0.0 && radius <= 2.0, "a chord of {radius} radii");
        assert!(photons >= 1);
        let mean = self.mean(counted);
        (self.second(4.0 * kernel.variance() / (radius * radius), counted) - mean * mean) / photons as f64
    }

    /// The same over the squared mean; not a number where nothing is counted. For all hits of a uniform sphere and the box
    /// kernel with q = albedo it is [(1 - a)(1 - albedo)/a + albedo] / `photons` with a = `radius`²/4; for hit j alone and
    /// any q it is [1/(a q^j) - 1] / `photons`, whatever the albedo.
    pub fn relative_variance(&self, kernel: Kernel, radius: f64, photons: u64, counted: Counted) -> f64 {
        let mean = self.mean(counted);
        self.variance(kernel, radius, photons, counted) / (mean * mean)
    }

    /// E X² of one photon's sum X of w_j Y_j, where the Y_j are independent with mean 1 and mean square `y2`.
    pub(super) fn second(&self, y2: f64, counted: Counted) -> f64 {
        let (first, end) = self.range(counted);
        let Some(end) = end else {
            if self.square >= 1.0 {
                return f64::INFINITY;
            }
            // the hits that follow one have the weight here / (1 - mean), relative to it
            let following = self.here / (1.0 - self.mean);
            return power(self.square, first) / (1.0 - self.square) * (y2 + 2.0 * following);
        };
        let following = |j: u32| self.here * (0..end - 1 - j).map(|gap| power(self.mean, gap)).sum::<f64>();
        (first..end).map(|j| power(self.square, j) * (y2 + 2.0 * following(j))).sum()
    }

    /// The first hit that counts, and the one before which counting ends if it does.
    fn range(&self, counted: Counted) -> (u32, Option<u32>) {
        let most = self.most.unwrap_or(u32::MAX);
        match counted {
            Counted::All => (0, self.most),
            Counted::Only(j) => (j, Some(most.min(j + 1))),
            Counted::From(j) => (j, self.most),
        }
    }
}
