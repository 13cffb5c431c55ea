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

    /// The smallest difference, in the unit of the samples, that `n` of them show with probability `power` by a one-sided
    /// test of `level`.
    ///
    /// Few bets cannot show a small difference, however little noise there is: each multiplies the fortune by little more
    /// than 1 + λ d, and λ is [`BOLDEST`] at most. Then it is larger than [`reach`] standard errors.
    pub fn detectable(&self, n: f64, level: f64, power: f64) -> f64 {
        let Some((room, together)) = self.bets else {
            return reach(Engine::Asymptotic, n - 1.0, level, power) * (self.variance / n).sqrt();
        };
        let (bets, variance) = (n / together as f64, self.variance / (together as f64 * room * room));
        let se = (variance / bets).sqrt();
        let noise = quantile(power, f64::INFINITY) * se;
        let boldest = (BETS as f64 / level).ln() / (bets * BOLDEST) + 0.5 * BOLDEST * variance + noise;
        let asked = reach(Engine::Exact, f64::INFINITY, level, power) * se;
        let best = (2.0 * (BETS as f64 / level).ln() / bets).sqrt();
        room * if best > BOLDEST * variance.sqrt() { boldest.max(asked) } else { asked }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_detectable_is_what_samples_are_needed_for() {
        // with few bets, which are as bold as can be, one asks for more than is needed
        for (bets, most) in [(None, 1.01), (Some((1.0, 1)), 1.0 + 1e-9), (Some((2.0, 16)), 2.0)] {
            let plan = Samples { variance: 0.5, bets };
            for n in [2e3, 2e4, 2e6] {
                let needed = plan.needed(plan.detectable(n, 1e-3, 0.95), 1e-3, 0.9);
                assert!(needed > 0.99 * n && needed < most * n, "{bets:?} {n}: {needed}");
            }
        }
    }

    /// 128 bets of 0.94 each: in 16 standard errors there is more than in six, and yet not enough.
    #[test]
    fn few_bets_show_no_small_difference() {
        let single = Samples { variance: 0.01, bets: Some((1.0, 16)) };
        let asked = reach(Engine::Exact, f64::INFINITY, 1e-3, 0.9) * (0.01_f64 / 2048.0).sqrt();
        let found = single.detectable(2048.0, 1e-3, 0.9);
        assert!(found > 4.0 * asked && found > (16e3_f64).ln() / (128.0 * BOLDEST), "{found} {asked}");
        // more and more of them: as reach says
        let many = single.detectable(1e8, 1e-3, 0.9) / (0.01_f64 / 1e8).sqrt();
        assert!((many / reach(Engine::Exact, f64::INFINITY, 1e-3, 0.9) - 1.0).abs() < 1e-12, "{many}");
    }
}
