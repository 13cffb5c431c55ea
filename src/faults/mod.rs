//! Estimators with a known mistake, by which a test bench shows that it would notice one.
//!
//! Each was made before by somebody: in the lecture that this program follows, or in a renderer. Nothing that is sampled
//! in earnest knows of them: they are path tracers of their own, which only claim to be a sound estimator.

mod averaging;
mod catalogue;
mod direct;
mod mis;
mod photon;
mod scatter;
pub mod slip;
mod survival;
mod walk;
mod wrong;

pub use slip::Slip;

use crate::estimator::{Ctx, Estimate, Estimator, Property};
use crate::scene::Ray;
use slip::Scattering;
use walk::{Record, Walk};

/// A mistake and where it was seen.
#[derive(Debug)]
pub struct Fault {
    /// What files call it.
    pub name: &'static str,
    /// What is wrong, in a sentence.
    pub about: &'static str,
    /// Who made it, and where that is told.
    pub seen: &'static str,
    /// Its number in the catalogues of real mistakes.
    pub number: &'static str,
    /// The mistake.
    pub slip: Slip,
    /// What is to be noticed.
    pub effect: Effect,
    /// Whether it is the lecture's pseudo-code taken at its word.
    pub printed: bool,
}

/// What a mistake does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// The mean is wrong.
    Mean,
    /// The mean is right: variance, cost or the length of paths is not what was claimed.
    Spread,
    /// Realizations are not independent.
    Streams,
    /// Contributions are not numbers, or negative, or walks do not end.
    Invalid,
    /// Nothing can be noticed in the scenes that there are: it is to be shown that nothing changes.
    Equivalent,
}

/// No mistake, for comparison: the same code, which must do what the sound estimator does.
pub static SOUND: Fault = Fault {
    name: "sound",
    about: "no mistake: the same random numbers and contributions as the sound estimator",
    seen: "nowhere",
    number: "",
    slip: Slip::Sound,
    effect: Effect::Equivalent,
    printed: false,
};

/// Every fault.
pub fn all() -> impl Iterator<Item = &'static Fault> {
    catalogue::CATALOGUE.iter().flat_map(|part| part.iter())
}

/// The fault of this name.
pub fn find(name: &str) -> Option<&'static Fault> {
    all().find(|fault| fault.name == name)
}

/// What to say where there is none of this name.
pub fn unknown(name: &str) -> String {
    let distance = |known: &&str| strsim::damerau_levenshtein(name, known);
    let known: Vec<&str> = all().map(|fault| fault.name).collect();
    let near =
        known.iter().copied().min_by_key(distance).filter(|known| distance(known) <= 1 + name.len() / 4);
    match near {
        Some(near) => format!("there is no fault `{name}`; did you mean `{near}`?"),
        None => format!("there is no fault `{name}`; there are: {}", known.join(", ")),
    }
}

/// An estimator with a mistake.
#[derive(Clone, Copy, Debug)]
pub struct Faulty {
    /// The mistake.
    pub fault: &'static Fault,
    /// What it claims to be, whose settings it honours.
    pub estimator: Estimator,
}

impl Faulty {
    /// The realization whose random numbers it uses for number `r`: `r`, unless that is its mistake.
    pub fn realization(&self, r: u64) -> u64 {
        self.fault.slip.realization(r)
    }
}

impl Estimate for Faulty {
    type Pass = ();

    fn begin(&self, _: u64, _: &mut Ctx<'_>) {}

    fn estimate(&self, (): &(), ray: Ray, cx: &mut Ctx<'_>) {
        let walk = Walk::of(&self.estimator, self.fault.slip);
        match self.fault.slip {
            Slip::Density(density) => photon::estimate(density, &walk.roulette, &ray, cx),
            Slip::Averaging(averaging) => averaging::estimate(averaging, &walk, ray, cx),
            Slip::Scattering(Scattering::CoarseDropped) => walk.trace(ray, cx, &mut Record::Numbers),
            _ => walk.trace(ray, cx, &mut Record::Tally),
        }
    }

    fn property(&self) -> Property {
        self.estimator.property()
    }
}
