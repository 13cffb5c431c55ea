//! Estimators of radiance. A new one is one file and a few lines here: `mod`, a variant, its arms.

pub mod ctx;
pub mod explicit;
pub mod film;
pub mod implicit;
pub mod kernel;
pub mod light_tracing;
pub mod mis;
pub mod particles;
pub mod photon_map;
pub mod photons;
pub mod pulse;
pub mod recursive;
pub mod roulette;

pub use ctx::{BINS, Ctx, Direct, MAX_RAYS, Step, Tally};
pub use explicit::Explicit;
pub use film::Film;
pub use implicit::Implicit;
pub use kernel::{Gather, Kernel, Last, Rates};
pub use light_tracing::LightTracing;
pub use mis::{Heuristic, Technique};
pub use photon_map::{DirectLight, PhotonMap};
pub use photons::Photons;
pub use recursive::Recursive;
pub use roulette::{Number, Roulette, Rule};

use crate::scene::{Directions, LightSampling, Pick, Ray};
use serde::{Deserialize, Serialize};

/// Something that estimates the radiance arriving along a ray.
pub trait Estimate: Sync {
    /// What all pixels of one realization share: photons, or what particles have left on the image. `()` for a path
    /// tracer.
    type Pass: Sync;

    /// Makes it, for the realization of this number, before the first pixel.
    fn begin(&self, realization: u64, cx: &mut Ctx<'_>) -> Self::Pass;

    /// Draws one sample of a pixel: writes contributions by bounce into `cx`, which also counts its rays.
    fn estimate(&self, pass: &Self::Pass, ray: Ray, cx: &mut Ctx<'_>);

    /// What it promises; decides which claims are legal.
    fn property(&self) -> Property;
}

/// What an estimator promises about its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Property {
    /// The mean is the radiance.
    Unbiased,
    /// The mean is the radiance scattered at most so many times.
    Clamped {
        /// The largest number of scattering events that is counted.
        bounces: u32,
    },
    /// The mean is not the radiance, but comes ever nearer to it.
    Consistent {
        /// How fast.
        rates: Rates,
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
    /// Particles connected to the sensor.
    LightTracing(LightTracing),
    /// The density of photons.
    PhotonMap(PhotonMap),
}

/// What the pixels of one realization share.
pub enum Pass {
    /// Nothing.
    Nothing,
    /// What particles have left on the image.
    Film(Film),
    /// Photons.
    Photons(Box<Photons>),
}

impl Estimator {
    /// One instance of each, with the given termination rule: what the tests run over.
    pub fn catalogue(roulette: Roulette) -> Vec<Estimator> {
        let (area, solid_angle) = (LightSampling::AREA, LightSampling::SOLID_ANGLE);
        let mut all = Vec::new();
        for directions in [Directions::Cosine, Directions::Uniform] {
            all.push(Estimator::Implicit(Implicit { directions, roulette }));
            all.push(Estimator::Recursive(Recursive { samples: 2, directions, roulette }));
            for (technique, lights) in [
                (Technique::Light, area),
                (Technique::Light, solid_angle),
                (Technique::Light, LightSampling { pick: Pick::Uniform, ..area }),
                (Technique::Direction, area),
                (Technique::Both(Heuristic::Balance), area),
                (Technique::Both(Heuristic::Power), solid_angle),
            ] {
                all.push(Estimator::Explicit(Explicit { technique, lights, directions, roulette }));
            }
        }
        all
    }

    /// Whether its paths follow from the eye, one realization each for a sensor of one pixel.
    pub fn is_path_tracer(&self) -> bool {
        !matches!(self, Estimator::LightTracing(_) | Estimator::PhotonMap(_))
    }

    /// Whether its paths from the eye sample points on emitters.
    pub fn samples_lights(&self) -> bool {
        match self {
            Estimator::Explicit(e) => e.technique.samples_lights(),
            Estimator::PhotonMap(e) => e.direct == DirectLight::Sampled,
            Estimator::Recursive(_) | Estimator::Implicit(_) | Estimator::LightTracing(_) => false,
        }
    }

    /// The same estimator with another termination rule.
    pub fn with_roulette(&self, roulette: Roulette) -> Self {
        match *self {
            Estimator::Recursive(e) => Estimator::Recursive(Recursive { roulette, ..e }),
            Estimator::Implicit(e) => Estimator::Implicit(Implicit { roulette, ..e }),
            Estimator::Explicit(e) => Estimator::Explicit(Explicit { roulette, ..e }),
            Estimator::LightTracing(e) => Estimator::LightTracing(LightTracing { roulette, ..e }),
            Estimator::PhotonMap(e) => Estimator::PhotonMap(PhotonMap { roulette, ..e }),
        }
    }

    /// When its walks end.
    pub fn roulette(&self) -> &Roulette {
        match self {
            Estimator::Recursive(e) => &e.roulette,
            Estimator::Implicit(e) => &e.roulette,
            Estimator::Explicit(e) => &e.roulette,
            Estimator::LightTracing(e) => &e.roulette,
            Estimator::PhotonMap(e) => &e.roulette,
        }
    }
}

impl Estimate for Estimator {
    type Pass = Pass;

    fn begin(&self, realization: u64, cx: &mut Ctx<'_>) -> Pass {
        match self {
            Estimator::Recursive(_) | Estimator::Implicit(_) | Estimator::Explicit(_) => Pass::Nothing,
            Estimator::LightTracing(e) => Pass::Film(e.begin(realization, cx)),
            Estimator::PhotonMap(e) => Pass::Photons(Box::new(e.begin(realization, cx))),
        }
    }

    #[inline]
    fn estimate(&self, pass: &Pass, ray: Ray, cx: &mut Ctx<'_>) {
        match (self, pass) {
            (Estimator::Recursive(e), _) => e.estimate(&(), ray, cx),
            (Estimator::Implicit(e), _) => e.estimate(&(), ray, cx),
            (Estimator::Explicit(e), _) => e.estimate(&(), ray, cx),
            (Estimator::LightTracing(e), Pass::Film(film)) => e.estimate(film, ray, cx),
            (Estimator::PhotonMap(e), Pass::Photons(photons)) => e.estimate(photons, ray, cx),
            (Estimator::LightTracing(_) | Estimator::PhotonMap(_), _) => {
                unreachable!("a pass of another estimator")
            }
        }
    }

    fn property(&self) -> Property {
        match self {
            Estimator::PhotonMap(e) => e.property(),
            _ => Property::of(self.roulette()),
        }
    }
}
