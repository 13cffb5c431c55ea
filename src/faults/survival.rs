//! Mistakes in Russian roulette.

use super::walk::{Path, Walk};
use crate::estimator::{Ctx, Rule};
use crate::scene::{Hit, Rgb};

/// Mistakes in Russian roulette. They leave alone what is certain (q = 0 or 1) and what splits (q > 1), unless they
/// choose q themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surviving {
    /// Survivors are not weighted.
    NotWeighted,
    /// Survivors are weighted by the probability of the other outcome.
    Complement,
    /// The comparison is the wrong way round.
    Flipped,
    /// As the lecture prints it: with chi = 1 - q, on if u < chi, and then divided by 1 - chi.
    Printed,
    /// As it prints it, with the chi that it calls typical: the albedo.
    PrintedByAlbedo,
    /// The albedo is the probability of the end, and all else is right.
    EndsByAlbedo,
    /// Dark paths end for certain, and nobody is weighted for it.
    DarkEnds,
    /// `<=` where the generator has 256 levels, the lowest of them 0.
    Inclusive,
    /// Survival max(1/2, luminance of the throughput), which may exceed 1 and is divided by all the same.
    NotCapped,
    /// The largest channel of a throughput by its signed value.
    Signed,
}

/// What roulette decides.
pub struct Survival {
    /// How many paths go on.
    pub copies: u32,
    /// The probability that the walk believes in.
    pub q: f64,
    /// What those who go on are weighted with.
    pub weight: f64,
}

/// Throughput below which [`Surviving::DarkEnds`] ends.
pub const DARK: f64 = 0.1;
/// Levels of a coarse generator.
pub const LEVELS: f64 = 256.0;

impl Walk {
    /// Roulette at `x`, which was reached after `path.bounce - 1` scattering events.
    pub fn survival(&self, path: &Path<'_>, x: &Hit<'_>, cx: &mut Ctx<'_>) -> Survival {
        let (bounce, albedo) = (path.bounce - 1, x.albedo());
        let q = self.roulette.q(bounce, path.beta, albedo);
        let open = q > 0.0 && q < 1.0;
        let chooses = albedo != Rgb::ZERO && bounce >= self.roulette.from;
        let matte = chooses && !x.material.bsdf.is_dirac(); // the lecture speaks of those
        let on = |survives: bool, q: f64, weight: f64| Survival { copies: u32::from(survives), q, weight };
        match self.slip.surviving() {
            Some(Surviving::NotWeighted) => Survival { copies: cx.copies(q), q, weight: 1.0 },
            Some(Surviving::Complement) if open => on(cx.u1() < q, q, 1.0 / (1.0 - q)),
            Some(Surviving::Flipped) if open => on(cx.u1() >= q, q, 1.0 / q),
            Some(Surviving::Printed) if open => {
                let chi = 1.0 - q;
                on(cx.u1() < chi, q, 1.0 / (1.0 - chi))
            }
            Some(Surviving::PrintedByAlbedo) if matte => {
                let chi = albedo.max_element();
                on(cx.u1() < chi, 1.0 - chi, 1.0 / (1.0 - chi))
            }
            Some(Surviving::EndsByAlbedo) if matte => {
                let q = 1.0 - albedo.max_element();
                Survival { copies: cx.copies(q), q, weight: 1.0 / q }
            }
            Some(Surviving::DarkEnds) if chooses && (path.beta * albedo).max_element() < DARK => {
                on(false, q, 1.0)
            }
            Some(Surviving::Inclusive) if open => on((cx.u1() * LEVELS).floor() / LEVELS <= q, q, 1.0 / q),
            Some(Surviving::NotCapped) if chooses => {
                let q = luminance(path.beta).max(0.5);
                on(cx.u1() < q, q, 1.0 / q)
            }
            Some(Surviving::Signed) if chooses => {
                let q = self.signed(path.beta * albedo).unwrap_or(q);
                Survival { copies: cx.copies(q), q, weight: 1.0 / q }
            }
            _ => Survival { copies: cx.copies(q), q, weight: 1.0 / q },
        }
    }

    /// q by the largest channel, where throughput decides: the largest as numbers go, not by magnitude.
    fn signed(&self, throughput: Rgb) -> Option<f64> {
        match self.roulette.rule {
            Rule::Throughput { floor } => {
                let largest = throughput.x.max(throughput.y).max(throughput.z);
                Some(largest.clamp(floor, 1.0))
            }
            _ => None,
        }
    }
}

/// Luminance of linear sRGB [Rec. ITU-R BT.709].
pub fn luminance(rgb: Rgb) -> f64 {
    rgb.dot(Rgb::new(0.2126, 0.7152, 0.0722))
}
