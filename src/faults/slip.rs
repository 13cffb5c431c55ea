//! Every mistake, sorted by the place of the path tracer where it is made.

pub use super::direct::{Facing, Light, Shadow};
pub use super::mis::Weighting;
pub use super::photon::Density;
pub use super::scatter::Scattering;
pub use super::survival::Surviving;
use crate::estimator::{Roulette, Rule};
use crate::scene::Directions;

/// A mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slip {
    /// None: the walk is sound.
    Sound,
    /// In what a hit emitter adds.
    Emission(Emission),
    /// In roulette.
    Surviving(Surviving),
    /// In where the walk ends.
    Ending(Ending),
    /// In continued directions.
    Scattering(Scattering),
    /// In the sampled light.
    Light(Light),
    /// In which side of a surface counts.
    Facing(Facing),
    /// In the shadow ray.
    Shadow(Shadow),
    /// In how two techniques are combined.
    Weighting(Weighting),
    /// In where rays start.
    Offset(Offset),
    /// In how paths become one value.
    Averaging(Averaging),
    /// In the random numbers.
    Streams(Streams),
    /// A photon density estimate, with or without a mistake.
    Density(Density),
    /// The lecture's last algorithm to the letter: `Surviving::Printed` and `Emission::Never`.
    Printed,
}

/// Mistakes in what a hit emitter adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Emission {
    /// Hits count in full although lights are sampled too.
    Twice,
    /// What the camera sees directly is left out.
    NotAtCamera,
    /// What a Dirac lobe shows is left out where lights are sampled.
    NotAfterMirror,
    /// What a Dirac lobe shows counts only if it is in front of the first vertex.
    SeenFromFirst,
    /// Left out everywhere.
    Never,
    /// Throughput is forgotten.
    WithoutThroughput,
    /// An emitter reflects nothing: the walk ends there.
    Ends,
}

/// Mistakes in where the walk ends, which are made before it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Roulette is off, unnoticed; a limit that is meant for emergencies ends the walk.
    RouletteOff,
    /// Roulette begins one bounce late.
    Late,
    /// A limit cuts what counts.
    Hidden,
}

/// Mistakes in where rays start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offset {
    /// Nothing keeps a ray from meeting the surface that it leaves.
    None,
    /// A distance along the normal that is far from small.
    Large,
}

/// Mistakes in how paths become one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Averaging {
    /// What is brighter than a limit is set to it.
    Clamped,
    /// Paths are drawn until they look alike.
    Adaptive,
}

/// Mistakes in the random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Streams {
    /// All blocks of 4096 realizations share one seed.
    Shared,
    /// The counter of realizations has 16 bits.
    Wraps,
}

/// Bounces after which [`Ending::RouletteOff`] ends.
pub const EMERGENCY: u32 = 64;
/// Bounces after which [`Ending::Hidden`] ends.
pub const HIDDEN: u32 = 8;

impl Slip {
    /// The mistake in emission, if there is one.
    pub fn emission(self) -> Option<Emission> {
        match self {
            Slip::Emission(emission) => Some(emission),
            Slip::Printed => Some(Emission::Never),
            _ => None,
        }
    }

    /// The mistake in roulette, if there is one.
    pub fn surviving(self) -> Option<Surviving> {
        match self {
            Slip::Surviving(surviving) => Some(surviving),
            Slip::Printed => Some(Surviving::Printed),
            _ => None,
        }
    }

    /// The termination rule that really holds.
    pub fn roulette(self, claimed: Roulette) -> Roulette {
        let within = |limit: u32| Some(claimed.clamp.map_or(limit, |clamp| clamp.min(limit)));
        match self {
            Slip::Ending(Ending::RouletteOff) => {
                Roulette { rule: Rule::None, clamp: within(EMERGENCY), ..claimed }
            }
            Slip::Ending(Ending::Late) => Roulette { from: claimed.from + 1, ..claimed },
            Slip::Ending(Ending::Hidden) => Roulette { clamp: within(HIDDEN), ..claimed },
            _ => claimed,
        }
    }

    /// The density that continued directions are believed to have.
    pub fn believed(self, claimed: Directions) -> Directions {
        match self {
            Slip::Scattering(Scattering::CosineAsUniform | Scattering::AngleAsUniform) => Directions::Uniform,
            Slip::Scattering(Scattering::UniformAsCosine | Scattering::AngleAsCosine) => Directions::Cosine,
            _ => claimed,
        }
    }

    /// The realization whose random numbers are used for number `r`.
    pub fn realization(self, r: u64) -> u64 {
        match self {
            Slip::Streams(Streams::Shared) => r % 4096,
            Slip::Streams(Streams::Wraps) => r % 65_536,
            _ => r,
        }
    }
}
