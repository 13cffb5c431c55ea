//! Laws whose mean is known exactly, so that what the instruments say of their samples is known to be right or wrong.
//!
//! They are what light transport has at its worst, without any light: events that are seldom and bright, a tail that is
//! heavy but tame, and a walk in a furnace, whose tail index is a dial. How often the instruments err on them is measured
//! by [`super::calibrate`].

use super::source::Source;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, de::Error as _};
use std::fmt;

pub use super::calibrate::{
    Count, Instrument, NullRow, Rates, Setting, measure, measure_at, predicted, rows,
};

/// A law of non-negative samples. Written in files as `{ rare = { p = 0.001 } }`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Law {
    /// 1/p with probability p, else 0: mean 1.
    Rare {
        /// In (0, 1].
        #[serde(deserialize_with = "p")]
        #[schemars(range(max = 1), extend("exclusiveMinimum" = 0))]
        p: f64,
    },
    /// exp(σ Z - σ²/2) with Z standard normal: mean 1, all moments finite.
    Lognormal {
        /// In (0, 3]: at 3 the variance is 8100, and nothing is learned from any number of samples that one can take.
        #[serde(deserialize_with = "sigma")]
        #[schemars(range(max = 3), extend("exclusiveMinimum" = 0))]
        sigma: f64,
    },
    /// Roulette in a furnace of emission 1: Σ (albedo/q)^k over the steps k = 0, 1, ... that are survived, each with
    /// probability q. The mean is 1 / (1 - albedo), the tail index ln(1/q) / ln(albedo/q), the variance infinite for
    /// q <= albedo².
    Walk {
        /// In [0, 1).
        #[serde(deserialize_with = "albedo")]
        #[schemars(range(min = 0), extend("exclusiveMaximum" = 1))]
        albedo: f64,
        /// In (0, 1).
        #[serde(deserialize_with = "q")]
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        q: f64,
    },
}

/// A number for which `holds`, or why it is none.
fn within<'de, D: Deserializer<'de>>(
    d: D,
    wanted: &str,
    holds: impl Fn(f64) -> bool,
) -> Result<f64, D::Error> {
    let v = f64::deserialize(d)?;
    if holds(v) { Ok(v) } else { Err(D::Error::custom(format!("{v} is out of range: {wanted}"))) }
}

fn p<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    within(d, "the probability of a rare event lies in (0, 1]", |v| v > 0.0 && v <= 1.0)
}

fn sigma<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    within(d, "sigma lies in (0, 3]; beyond, the variance exceeds 8100 squared means", |v| {
        v > 0.0 && v <= 3.0
    })
}

fn albedo<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    within(d, "the albedo of a walk lies in [0, 1); at 1 its mean is infinite", |v| (0.0..1.0).contains(&v))
}

fn q<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    within(d, "a walk survives each step with a probability q inside (0, 1)", |v| v > 0.0 && v < 1.0)
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&match self {
            Law::Rare { p } => format!("rare p={p}"),
            Law::Lognormal { sigma } => format!("lognormal sigma={sigma}"),
            Law::Walk { albedo, q } => format!("walk albedo={albedo} q={q}"),
        })
    }
}

impl Law {
    /// The mean.
    pub fn mean(&self) -> f64 {
        match self {
            Law::Rare { .. } | Law::Lognormal { .. } => 1.0,
            Law::Walk { albedo, .. } => 1.0 / (1.0 - albedo),
        }
    }

    /// What no sample exceeds, if there is such a value.
    pub fn bound(&self) -> Option<f64> {
        match self {
            Law::Rare { p } => Some(1.0 / p),
            Law::Lognormal { .. } => None,
            // the whole geometric series
            Law::Walk { albedo, q } => (q > albedo).then(|| 1.0 / (1.0 - albedo / q)),
        }
    }

    /// The variance; `None` where it is infinite.
    pub fn variance(&self) -> Option<f64> {
        match self {
            Law::Rare { p } => Some((1.0 - p) / p),
            Law::Lognormal { sigma } => Some(libm::expm1(sigma * sigma)),
            Law::Walk { .. } => self.second().map(|second| second - self.mean() * self.mean()),
        }
    }

    /// Skewness, 0 where nothing varies; `None` where it is infinite.
    pub fn skewness(&self) -> Option<f64> {
        let variance = self.variance()?;
        if variance <= 0.0 {
            return Some(0.0);
        }
        match self {
            Law::Rare { p } => Some((1.0 - 2.0 * p) / libm::sqrt(p * (1.0 - p))),
            Law::Lognormal { .. } => Some((variance + 3.0) * libm::sqrt(variance)),
            Law::Walk { albedo, q } => {
                let (mean, second) = (self.mean(), self.second()?);
                let left = 1.0 - albedo * albedo * albedo / (q * q);
                let third = (1.0 + 3.0 * albedo * mean + 3.0 * albedo * albedo / q * second) / left;
                let central = third - 3.0 * mean * second + 2.0 * mean * mean * mean;
                (left > 0.0).then(|| central / (variance * libm::sqrt(variance)))
            }
        }
    }

    /// E X² of a walk, from X = 1 + (albedo/q) B X' with B the survival of a step and X' a walk; `None` if infinite.
    fn second(&self) -> Option<f64> {
        let Law::Walk { albedo, q } = self else { return None };
        let left = 1.0 - albedo * albedo / q;
        (left > 0.0).then(|| (1.0 + 2.0 * albedo * self.mean()) / left)
    }

    /// Independent samples without end, the same for the same seed and run.
    pub fn samples(&self, seed: u64, run: u64) -> Samples {
        let (ln_q, excess) = match self {
            Law::Walk { albedo, q } => (libm::log(*q), (albedo - q) / q),
            _ => (0.0, 0.0),
        };
        Samples { law: *self, source: Source::keyed(seed, run), ln_q, excess, ln_ratio: libm::log1p(excess) }
    }
}

/// Samples of a law, without end.
#[derive(Clone, Debug)]
pub struct Samples {
    law: Law,
    source: Source,
    /// Of a walk: ln q, the ratio of the series less 1, and the ratio's logarithm.
    ln_q: f64,
    excess: f64,
    ln_ratio: f64,
}

impl Iterator for Samples {
    type Item = f64;

    #[inline]
    fn next(&mut self) -> Option<f64> {
        Some(match self.law {
            Law::Rare { p } => self.source.rare(p),
            Law::Lognormal { sigma } => libm::exp(sigma * (self.source.normal() - 0.5 * sigma)),
            Law::Walk { .. } => {
                // K steps with P(K > k) = q^k, and the K terms' sum, exact also where the ratio is next to 1
                let steps = 1.0 + libm::floor(libm::log(self.source.uniform()) / self.ln_q);
                if self.excess == 0.0 { steps } else { libm::expm1(steps * self.ln_ratio) / self.excess }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Moments;

    const LAWS: [Law; 7] = [
        Law::Rare { p: 0.01 },
        Law::Rare { p: 1.0 },
        Law::Lognormal { sigma: 0.5 },
        Law::Walk { albedo: 0.5, q: 0.5 },
        Law::Walk { albedo: 0.5, q: 0.8 },
        Law::Walk { albedo: 0.8, q: 0.9 },
        Law::Walk { albedo: 0.0, q: 0.3 },
    ];

    #[test]
    fn moments_are_those_stated() {
        for law in LAWS {
            let mut m = Moments::default();
            law.samples(1, 2).take(400_000).for_each(|x| m.push(x));
            let (variance, se) = (law.variance().unwrap(), m.std_error().unwrap());
            assert!((m.mean - law.mean()).abs() <= 4.0 * se + 1e-12, "{law}: {} {se}", m.mean);
            let error = m.variance_std_error().unwrap();
            assert!(
                (m.variance().unwrap() - variance).abs() <= 4.0 * error + 1e-12,
                "{law}: {variance} {error}"
            );
            let skewness = law.skewness().unwrap();
            assert!(
                (m.skewness().unwrap_or(0.0) - skewness).abs() <= 0.05 * skewness.abs() + 0.01,
                "{law}: {skewness}"
            );
        }
    }

    /// A walk as it is walked, a step at a time.
    #[test]
    fn walks_have_the_values_of_the_series() {
        for (albedo, q) in [(0.5, 0.2), (0.8, 0.9), (0.5, 0.5 + 1e-13)] {
            let mut sums = vec![1.0_f64];
            let mut term = 1.0;
            for _ in 0..200 {
                term *= albedo / q;
                sums.push(sums.last().unwrap() + term);
            }
            for x in (Law::Walk { albedo, q }).samples(3, 0).take(1000) {
                let near = sums.iter().map(|s| (s - x).abs() / s).fold(f64::INFINITY, f64::min);
                assert!(near < 1e-13, "{albedo} {q}: {x} is off by {near}");
            }
        }
    }

    #[test]
    fn bounds_hold_and_moments_may_be_infinite() {
        for law in LAWS {
            if let Some(bound) = law.bound() {
                assert!(law.samples(5, 5).take(100_000).all(|x| x <= bound * (1.0 + 1e-12)), "{law}");
            }
        }
        assert_eq!(Law::Walk { albedo: 0.5, q: 0.25 }.variance(), None);
        assert_eq!(Law::Walk { albedo: 0.5, q: 0.3 }.skewness(), None);
        assert!(Law::Walk { albedo: 0.5, q: 0.3 }.variance().is_some());
        assert_eq!(Law::Walk { albedo: 0.5, q: 0.5 }.bound(), None);
    }

    #[test]
    fn runs_differ_and_repeat() {
        let first = |seed, run| LAWS[2].samples(seed, run).next().unwrap();
        assert_eq!(first(1, 1), first(1, 1));
        assert!(first(1, 1) != first(1, 2) && first(1, 1) != first(2, 1) && first(1, 2) != first(2, 1));
        // the same bits on every platform
        assert_eq!(Source::keyed(1, 1).bits(), Source(Source(Source(1).bits() + 1).bits()).bits());
    }
}
