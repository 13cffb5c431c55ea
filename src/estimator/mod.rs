//! Estimators of radiance. A new one is one file and a few lines here: `mod`, a variant, its arms.

pub mod ctx;
pub mod explicit;
pub mod implicit;
pub mod recursive;
pub mod roulette;

pub use ctx::{BINS, Ctx, MAX_RAYS, Tally};
pub use explicit::{Explicit, Heuristic, Pick, Technique};
pub use implicit::Implicit;
pub use recursive::Recursive;
pub use roulette::{Roulette, Rule};

use crate::scene::{Directions, LightSampling, Ray};
use serde::{Deserialize, Serialize};

/// Something that estimates the radiance arriving along a ray.
pub trait Estimate: Sync {
    /// Draws one sample: writes contributions by bounce into `cx`, which also counts its rays.
    fn estimate(&self, ray: Ray, cx: &mut Ctx<'_>);

    /// What it promises; decides which claims are legal.
    fn property(&self) -> Property;
}

/// What an estimator promises about its mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// The mean is the radiance.
    Unbiased,
    /// The mean is the radiance scattered at most so many times.
    Clamped {
        /// The largest number of scattering events that is counted.
        bounces: u32,
    },
}

impl Property {
    /// What follows from the termination rule of an otherwise unbiased estimator.
    pub fn of(roulette: &Roulette) -> Self {
        match roulette.clamp {
            None => Property::Unbiased,
            Some(bounces) => Property::Clamped { bounces },
        }
    }
}

/// Every estimator of the bench.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// N samples at each vertex.
    Recursive(Recursive),
    /// One sample at each vertex, light found by chance.
    Implicit(Implicit),
    /// Direct light sampled on the emitters.
    Explicit(Explicit),
}

impl Estimator {
    /// One instance of each, with the given termination rule: what the tests run over.
    pub fn catalogue(roulette: Roulette) -> Vec<Estimator> {
        let directions = [Directions::Cosine, Directions::Uniform];
        let mut all = Vec::new();
        for directions in directions {
            all.push(Estimator::Implicit(Implicit { directions, roulette }));
            all.push(Estimator::Recursive(Recursive { samples: 2, directions, roulette }));
            for lights in [LightSampling::Area, LightSampling::SolidAngle] {
                all.push(Estimator::Explicit(Explicit {
                    lights,
                    directions,
                    roulette,
                    technique: Technique::Light,
                    pick: Pick::Power,
                }));
            }
        }
        all
    }

    /// The same estimator with another termination rule.
    pub fn with_roulette(&self, roulette: Roulette) -> Self {
        match *self {
            Estimator::Recursive(e) => Estimator::Recursive(Recursive { roulette, ..e }),
            Estimator::Implicit(e) => Estimator::Implicit(Implicit { roulette, ..e }),
            Estimator::Explicit(e) => Estimator::Explicit(Explicit { roulette, ..e }),
        }
    }

    /// When its walks end.
    pub fn roulette(&self) -> &Roulette {
        match self {
            Estimator::Recursive(e) => &e.roulette,
            Estimator::Implicit(e) => &e.roulette,
            Estimator::Explicit(e) => &e.roulette,
        }
    }
}

impl Estimate for Estimator {
    #[inline]
    fn estimate(&self, ray: Ray, cx: &mut Ctx<'_>) {
        match self {
            Estimator::Recursive(e) => e.estimate(ray, cx),
            Estimator::Implicit(e) => e.estimate(ray, cx),
            Estimator::Explicit(e) => e.estimate(ray, cx),
        }
    }

    fn property(&self) -> Property {
        Property::of(self.roulette())
    }
}
