//! The two sides of a question, each with the best evidence that there is: bets where samples and bound allow them, else
//! Student's t, corrected for skewness.

use super::bets::Bets;
use super::power::{Samples, reach};
use super::question::{Engine, Question};
use super::skewed;
use super::student::{one_sided_p, upper_quantile, welch_df};

/// Power at which detectable bias and missing samples are stated.
pub(super) const POWER: f64 = 0.9;

/// Evidence that the mean lies above, or below, a value.
#[derive(Clone, Copy)]
pub(super) enum Side<'a> {
    /// By bets: exact at any time.
    Exact(&'a Bets),
    /// By Student's t: for many samples and light tails only.
    Asymptotic(Student),
    /// There is none.
    Unfit,
}

/// Student's t of the measured mean, looked at several times.
#[derive(Clone, Copy)]
pub(super) struct Student {
    mean: f64,
    /// Of measurement and reference together.
    std_error: f64,
    df: f64,
    /// Skewness of the mean's distribution.
    skewness: f64,
    looks: f64,
}

/// Both sides of a question.
pub(super) struct Sides<'a> {
    pub(super) above: Side<'a>,
    pub(super) below: Side<'a>,
}

impl<'a> Sides<'a> {
    pub(super) fn of(q: &'a Question) -> Self {
        let student = match why_no_t(q) {
            Some(_) => Side::Unfit,
            None => Side::Asymptotic(Student::of(q)),
        };
        let Some(bets) = &q.bets else { return Sides { above: student, below: student } };
        let below = if bets.stake.bound.is_some() { Side::Exact(bets) } else { student };
        Sides { above: Side::Exact(bets), below }
    }

    /// Whether neither side has any evidence.
    pub(super) fn are_blind(&self) -> bool {
        matches!((self.above, self.below), (Side::Unfit, Side::Unfit))
    }

    pub(super) fn are_exact(&self) -> bool {
        matches!((self.above, self.below), (Side::Exact(_), Side::Exact(_)))
    }

    /// Whether both sides have evidence at all.
    pub(super) fn are_fit(&self) -> bool {
        !matches!(self.above, Side::Unfit) && !matches!(self.below, Side::Unfit)
    }
}

/// Why a question can not be answered by a t test.
pub(super) fn why_no_t(q: &Question) -> Option<String> {
    if q.unfit.is_some() {
        return q.unfit.clone();
    }
    if q.df < 1.0 || (q.expected_df < 1.0 && q.expected_std_error != 0.0) {
        return Some("fewer than two blocks".to_string());
    }
    // a spread of block means below the rounding of the mean is no variation
    let varies = q.noise_free || q.std_error > f64::EPSILON * q.mean.abs();
    (!varies).then(|| "no variation was seen, so there is no interval".to_string())
}

impl Side<'_> {
    /// p-value against "the mean is at most `m`", valid at any time and after any number of looks.
    pub(super) fn p_above(&self, m: f64) -> f64 {
        match self {
            Side::Exact(bets) => libm::exp(-bets.log_above(m)).min(1.0),
            Side::Asymptotic(t) => (t.looks * one_sided_p(t.from(m), t.df)).min(1.0),
            Side::Unfit => 1.0,
        }
    }

    /// p-value against "the mean is at least `m`".
    pub(super) fn p_below(&self, m: f64) -> f64 {
        match self {
            Side::Exact(bets) => bets.log_below(m).map_or(1.0, |log| libm::exp(-log).min(1.0)),
            Side::Asymptotic(t) => (t.looks * one_sided_p(-t.from(m), t.df)).min(1.0),
            Side::Unfit => 1.0,
        }
    }

    /// The mean lies above it with probability 1 - `level`.
    pub(super) fn lower_limit(&self, level: f64) -> f64 {
        match self {
            Side::Exact(bets) => bets.lower_limit(level),
            Side::Asymptotic(t) => t.reaching(upper_quantile(level / t.looks, t.df)),
            Side::Unfit => f64::NEG_INFINITY,
        }
    }

    /// The mean lies below it with probability 1 - `level`.
    pub(super) fn upper_limit(&self, level: f64) -> f64 {
        match self {
            Side::Exact(bets) => bets.upper_limit(level),
            Side::Asymptotic(t) => t.reaching(-upper_quantile(level / t.looks, t.df)),
            Side::Unfit => f64::INFINITY,
        }
    }

    /// The smallest difference from `expected` that has a p-value of `level` with probability `power`, where the mean has
    /// the standard error `error`.
    pub(super) fn detectable(&self, expected: f64, error: f64, level: f64, power: f64, above: bool) -> f64 {
        let Side::Exact(bets) = self else { return self.reach(level, power) * error };
        let room = if above { Some(expected) } else { bets.stake.bound.map(|bound| bound - expected) };
        let n = bets.n as f64;
        let samples = Samples { variance: error * error * n, bets: room.map(|room| (room, 1)) };
        samples.detectable(n, level, power)
    }

    /// How many standard errors a difference must have for a p-value of `level` with probability `power`.
    pub(super) fn reach(&self, level: f64, power: f64) -> f64 {
        match self {
            Side::Exact(_) => reach(Engine::Exact, f64::INFINITY, level, power),
            Side::Asymptotic(t) => reach(Engine::Asymptotic, t.df, level / t.looks, power),
            Side::Unfit => f64::INFINITY,
        }
    }
}

impl Student {
    fn of(q: &Question) -> Self {
        Student {
            mean: q.mean,
            std_error: q.std_error.hypot(q.expected_std_error),
            df: welch_df(q.std_error, q.df, q.expected_std_error, q.expected_df),
            // a reference has its own skewness, which nobody knows
            skewness: if q.expected_std_error == 0.0 { q.skewness } else { 0.0 },
            looks: f64::from(q.looks),
        }
    }

    /// The distance from `m` in standard errors, made symmetrical.
    fn from(&self, m: f64) -> f64 {
        skewed::symmetrical((self.mean - m) / self.std_error, self.skewness)
    }

    /// So far below the mean, or above for a negative quantile, lies the limit.
    fn reaching(&self, quantile: f64) -> f64 {
        self.mean - self.std_error * skewed::distance(quantile, self.skewness)
    }
}
