//! How small a difference is found, and how many samples that takes.

use super::bets::{BETS, BOLDEST};
use super::question::Engine;
use super::student::{quantile, upper_quantile};

/// How many standard errors of the mean a difference must have for a one-sided p-value of `level` with probability
/// `power`, for many samples.
///
/// A t test needs the sum of two quantiles. A bet's fortune grows as exp(x²/2 + z x) over x standard errors with z their
/// noise, and is one of [`BETS`]; a fortune of 1/level is asked for.
pub fn reach(engine: Engine, df: f64, level: f64, power: f64) -> f64 {
    let z = quantile(power, f64::INFINITY);
    match engine {
        Engine::Exact => z + (z * z + 2.0 * (BETS as f64 / level).ln()).sqrt(),
        Engine::Asymptotic => upper_quantile(level, df) + z,
        Engine::Comparison => 0.0,
    }
}

/// Samples that are planned for.
#[derive(Clone, Copy, Debug)]
pub struct Samples {
    /// Variance of one of them.
    pub variance: f64,
    /// What bets on "below" are made with: how far the bound lies above the mean, and how many samples are averaged for
    /// each bet; `None` where a t test decides.
    pub bets: Option<(f64, u64)>,
}

impl Samples {
    /// How many are needed for equivalence within ± `margin` to be shown with probability `power`, were there no
    /// difference, where each of the two one-sided tests has `level`.
    ///
    /// The logarithm of a fortune grows by λ d - λ² s² / 2 a bet, d the margin and s the standard error of what is bet on,
    /// both relative to the room below the bound; the share λ is the best one, but not more than there is.
    pub fn needed(&self, margin: f64, level: f64, power: f64) -> f64 {
        // each of the two tests may miss half as often
        let power = 0.5 * (1.0 + power);
        let engine = if self.bets.is_some() { Engine::Exact } else { Engine::Asymptotic };
        let reach = reach(engine, f64::INFINITY, level, power);
        let (room, together) = self.bets.unwrap_or((0.0, 1));
        let (d, s2) = (margin / room, self.variance / (together as f64 * room * room));
        if room == 0.0 || d <= BOLDEST * s2 {
            return reach * reach * self.variance / (margin * margin);
        }
        let growth = BOLDEST * d - 0.5 * BOLDEST * BOLDEST * s2;
        0.5 * reach * reach * together as f64 / growth
    }
}
