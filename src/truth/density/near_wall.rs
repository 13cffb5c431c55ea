//! Photons of a point light inside a matte sphere, gathered around the point of the wall nearest to it: direct light is
//! blurred by a known factor, and all other light is uniform, as in [`super::Photons`].
//!
//! Of one photon with weight w_0 = 1, hit 0 lies within the kernel's cap with the probability p of [`Nearest::share`];
//! from a hit on, wherever it was, hits are uniform over the sphere and lie within the cap with a = r²/4, independently.

use super::gradient::Nearest;
use super::{Kernel, Photons};
use crate::truth::Counted;

/// Photons as one channel sees them, and the box kernel's cap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearWall {
    /// Albedo of the sphere, in [0, 1).
    pub albedo: f64,
    /// Probability that a photon survives a hit, in (0, 1].
    pub q: f64,
    /// Light and cap, in units of the sphere's radius.
    pub nearest: Nearest,
}

impl NearWall {
    /// Share of the sphere's area within the cap (Archimedes), in (0, 1].
    fn cap(&self) -> f64 {
        0.25 * self.nearest.radius * self.nearest.radius
    }

    /// Expected weight of a photon's hits within the cap. [`Counted`] counts hits: 0 is direct light.
    pub fn mean(&self, hits: Counted) -> f64 {
        let direct = if first_counts(hits) { self.nearest.share() } else { 0.0 };
        direct + self.later(hits).map_or(0.0, |later| self.cap() * self.photons().mean(later))
    }

    /// Variance of that weight; infinite from albedo² = q on, if later hits count.
    ///
    /// E Y² = p + 2 p a Σ albedo^j + a² E (Σ w_j Y_j)², where the last is that of uniform hits.
    pub fn variance(&self, hits: Counted) -> f64 {
        let direct = if first_counts(hits) { self.nearest.share() } else { 0.0 };
        let cap = self.cap();
        let later = self.later(hits).map_or(0.0, |later| {
            let photons = self.photons();
            let uniform = photons.second(Kernel::Box.variance() / cap, later);
            2.0 * direct * cap * photons.mean(later) + cap * cap * uniform
        });
        let mean = self.mean(hits);
        direct + later - mean * mean
    }

    fn photons(&self) -> Photons {
        Photons::uniform(self.albedo, self.q)
    }

    /// Those of the hits that are not the first.
    fn later(&self, hits: Counted) -> Option<Counted> {
        match hits {
            Counted::Only(0) => None,
            Counted::Only(j) => Some(Counted::Only(j)),
            Counted::All => Some(Counted::From(1)),
            Counted::From(j) => Some(Counted::From(j.max(1))),
        }
    }
}

/// Whether hit 0 counts.
fn first_counts(hits: Counted) -> bool {
    matches!(hits, Counted::All | Counted::Only(0) | Counted::From(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(height: f64) -> NearWall {
        NearWall { albedo: 0.6, q: 0.7, nearest: Nearest { height, radius: 0.3 } }
    }

    /// A light in the centre is a uniform one.
    #[test]
    fn a_light_in_the_centre_is_uniform() {
        let (near, uniform) = (near(1.0), Photons::uniform(0.6, 0.7));
        let cap = near.cap();
        let all = [Counted::All, Counted::Only(0), Counted::Only(2), Counted::From(0), Counted::From(1)];
        for hits in all {
            let mean = cap * uniform.mean(hits);
            assert!((near.mean(hits) - mean).abs() < 1e-12, "{hits:?}");
            let variance = cap * cap * uniform.variance(Kernel::Box, 0.3, 1, hits);
            assert!((near.variance(hits) - variance).abs() < 1e-12, "{hits:?}");
        }
    }

    #[test]
    fn without_reflection_a_photon_is_a_coin() {
        let black = NearWall { albedo: 0.0, ..near(0.4) };
        let p = black.nearest.share();
        assert!((black.variance(Counted::All) - p * (1.0 - p)).abs() < 1e-15);
        assert!((near(0.4).variance(Counted::Only(0)) - p * (1.0 - p)).abs() < 1e-15);
        let heavy = NearWall { albedo: 0.9, q: 0.8, ..near(0.4) };
        assert_eq!(heavy.variance(Counted::All), f64::INFINITY);
        assert!((0.0225 * 0.6 - near(0.4).mean(Counted::Only(1))).abs() < 1e-15);
    }
}
