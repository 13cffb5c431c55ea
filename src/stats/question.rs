//! What [`judge`](super::judge::judge) is asked and what it answers.

use super::bets::Bets;
use super::moments::Moments;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Outcome of one question, ordered by severity: the worst of many is their
/// maximum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Verdict {
    /// Shown to lie within the margin.
    Pass,
    /// Neither shown to lie within the margin nor shown to differ.
    Inconclusive,
    /// Shown to differ.
    Fail,
    /// There is no number to judge.
    Invalid,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(match self {
            Verdict::Pass => "PASS",
            Verdict::Inconclusive => "INCONCLUSIVE",
            Verdict::Fail => "FAIL",
            Verdict::Invalid => "INVALID",
        })
    }
}

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// Bets: the error probability holds for any number of samples, at any stopping time.
    Exact,
    /// A t test decides at least one side: its error probability is approached as samples grow.
    Asymptotic,
    /// Theory and measurement are without noise.
    Comparison,
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(match self {
            Engine::Exact => "exact",
            Engine::Asymptotic => "asymptotic",
            Engine::Comparison => "comparison",
        })
    }
}

/// One question: is the expected value of this estimand what it should be?
///
/// All quantities but the degrees of freedom are in the estimand's unit. Not
/// serialisable, as JSON has no infinity for `expected_df`.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Measured mean.
    pub mean: f64,
    /// Standard error of `mean`, >= 0, estimated from block means.
    pub std_error: f64,
    /// Degrees of freedom of `std_error`: blocks - 1.
    pub df: f64,
    /// What theory or a reference says.
    pub expected: f64,
    /// Standard error of `expected`; 0 if it is exact.
    pub expected_std_error: f64,
    /// Degrees of freedom of `expected_std_error`; infinite if it is exact.
    pub expected_df: f64,
    /// Bound, >= 0, on the absolute systematic error of `expected`.
    pub systematic: f64,
    /// Absolute differences below this, > 0, count as equivalence.
    pub margin: f64,
    /// Theory says that the variance is exactly zero.
    pub noise_free: bool,
    /// Why the caller knows that there is no number to judge, such as a NaN,
    /// an infinity or a negative radiance among the samples.
    pub invalid: Option<String>,
    /// What was won by betting on the samples, where that was done.
    pub bets: Option<Bets>,
    /// Skewness of the distribution of `mean`: that of a sample by √n.
    pub skewness: f64,
    /// How many times the measurement is looked at, this one included, before
    /// the last sample is in: a t test has to share its level among them.
    pub looks: u32,
    /// Why no t test may decide, such as a tail that is too heavy for one.
    pub unfit: Option<String>,
}

impl Question {
    /// Whether the mean of `blocks` is `expected`, which is known exactly, give or take `margin` (absolute).
    pub fn about(blocks: &Moments, invalid: Option<String>, expected: f64, margin: f64) -> Self {
        Question {
            mean: blocks.mean,
            std_error: blocks.std_error().unwrap_or(f64::NAN),
            df: blocks.n as f64 - 1.0,
            expected,
            expected_std_error: 0.0,
            expected_df: f64::INFINITY,
            systematic: 0.0,
            margin,
            noise_free: false,
            invalid,
            bets: None,
            skewness: 0.0,
            looks: 1,
            unfit: None,
        }
    }

    /// Why a question has no answer.
    pub(super) fn defect(&self, alpha: f64) -> Option<String> {
        let is_error = |x: f64| x.is_finite() && x >= 0.0;
        // without degrees of freedom there is no standard error to look at
        let requirements = [
            (alpha > 0.0 && alpha < 1.0, "alpha is not between 0 and 1"),
            (self.margin.is_finite() && self.margin > 0.0, "the margin is not finite and positive"),
            (self.mean.is_finite(), "the mean is not finite"),
            (self.expected.is_finite(), "the expected value is not finite"),
            ((self.mean - self.expected).is_finite(), "the difference is not finite"),
            (is_error(self.systematic), "the systematic error is not finite or negative"),
            (!self.df.is_nan() && !self.expected_df.is_nan(), "the degrees of freedom are NaN"),
            (self.df < 1.0 || is_error(self.std_error), "the standard error is not finite or negative"),
            (
                self.expected_df < 1.0 || is_error(self.expected_std_error),
                "the reference's standard error is not finite or negative",
            ),
        ];
        let unmet = requirements.iter().find(|(met, _)| !met).map(|(_, reason)| reason.to_string());
        let void = self.bets.as_ref().filter(|bets| bets.void > 0).map(|bets| match bets.stake.bound {
            Some(bound) => format!("{} samples exceed the bound {bound:.6e}, or are no numbers", bets.void),
            None => format!("{} samples are no non-negative numbers", bets.void),
        });
        self.invalid.clone().or(void).or(unmet)
    }
}

#[cfg(test)]
impl Question {
    /// Sixteen blocks around an exact 10, as expected; the margin is too small.
    pub(super) fn example() -> Question {
        Question {
            mean: 10.0,
            std_error: 0.25,
            df: 15.0,
            expected: 10.0,
            expected_std_error: 0.0,
            expected_df: f64::INFINITY,
            systematic: 0.0,
            margin: 1e-3,
            noise_free: false,
            invalid: None,
            bets: None,
            skewness: 0.0,
            looks: 1,
            unfit: None,
        }
    }
}

/// What is known about one question, the other questions taken into account.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The conclusion.
    pub verdict: Verdict,
    /// Why, in a sentence for the reader of the report.
    pub reason: String,
    /// p-value, not adjusted for multiplicity, of "there is no difference but
    /// the reference's systematic error". NaN if invalid.
    pub p_different: f64,
    /// p-value, not adjusted for multiplicity, of "the difference is at least
    /// the margin". NaN if invalid.
    pub p_outside: f64,
    /// Bounds on the difference mean - expected: all intervals of the family
    /// hold together with probability 1 - alpha (Bonferroni). Holm's test may
    /// decide where the interval, a little wider, does not. NaN if invalid.
    pub ci: (f64, f64),
    /// Smallest absolute bias that the test at alpha / questions would have
    /// found with about 90 % power (88 % with 16 blocks); infinite if none. NaN if invalid.
    pub mde: f64,
    /// e-value against "there is no difference but the reference's systematic
    /// error", of the sides on which bets were made.
    pub e_value: Option<f64>,
    /// What the verdict rests on.
    pub engine: Engine,
}

#[cfg(test)]
mod tests {
    use super::Question;
    use super::Verdict::{self, *};

    #[test]
    fn the_worst_verdict_is_the_maximum() {
        assert_eq!([Pass, Fail, Inconclusive].into_iter().max(), Some(Fail));
        assert_eq!([Invalid, Fail].into_iter().max(), Some(Invalid));
        assert_eq!([Pass, Inconclusive].into_iter().max(), Some(Inconclusive));
    }

    #[test]
    fn verdicts_have_one_name() {
        for verdict in [Pass, Inconclusive, Fail, Invalid] {
            let json = serde_json::to_string(&verdict).unwrap();
            assert_eq!(json, format!("\"{verdict}\""));
            assert_eq!(serde_json::from_str::<Verdict>(&json).unwrap(), verdict);
        }
        assert_eq!(format!("{Pass:>6}"), "  PASS");
    }

    #[test]
    fn defects() {
        let mut broken = vec![Question { invalid: Some("NaN".to_string()), ..Question::example() }];
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            broken.push(Question { std_error: bad, ..Question::example() });
            broken.push(Question { expected_std_error: bad, ..Question::example() });
            broken.push(Question { systematic: bad, ..Question::example() });
            broken.push(Question { margin: bad, ..Question::example() });
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            broken.push(Question { mean: bad, ..Question::example() });
            broken.push(Question { expected: bad, ..Question::example() });
        }
        broken.push(Question { margin: 0.0, ..Question::example() });
        broken.push(Question { df: f64::NAN, ..Question::example() });
        broken.push(Question { expected_df: f64::NAN, ..Question::example() });
        broken.push(Question { mean: 1e308, expected: -1e308, ..Question::example() });
        for q in broken {
            assert!(q.defect(0.05).is_some(), "{q:?}");
        }
        for alpha in [0.0, 1.0, -0.1, f64::NAN] {
            assert!(Question::example().defect(alpha).unwrap().contains("alpha"));
        }
    }
}
