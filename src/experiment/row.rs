//! One row of `results.csv`: one estimand of one cell in one channel.

use crate::stats::{Engine, Verdict};
use crate::truth::Value;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What a row measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Estimand {
    /// Mean of a realization, all bounces.
    Mean,
    /// Mean of what one bounce adds; the last bin holds all later ones.
    Bounce(usize),
    /// Mean over one of the image's tiles, counted row by row from the top left.
    Tile(usize),
    /// Variance of a realization.
    Variance,
    /// Rays a realization.
    Cost,
    /// Variance of a pixel's sample, averaged over the image.
    PixelVariance,
    /// Median over the image of the variance of a pixel's sample.
    MedianPixelVariance,
    /// Share of realizations that are zero in every channel.
    Zeros,
    /// Mean, compared with that of another cell.
    Agree,
    /// What one bounce adds, compared with another cell.
    AgreeBounce(usize),
    /// Mean, all bounces, against the wrong value that theory says a mistake has.
    Wrong,
    /// How many rays each realization takes, against the law of roulette; stated is their mean.
    Length,
    /// Number of blocks that repeat an earlier one.
    Repeats,
    /// Correlation of successive blocks.
    Serial,
    /// The power of the number of samples with which the mean squared error of a run falls.
    RateMse,
    /// The same of the variance.
    RateVariance,
    /// The same of the bias.
    RateBias,
}

impl fmt::Display for Estimand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Estimand::Mean => "mean",
            Estimand::Bounce(_) => "bounce",
            Estimand::Tile(_) => "tile",
            Estimand::Variance => "variance",
            Estimand::Cost => "cost",
            Estimand::PixelVariance => "pixel_variance",
            Estimand::MedianPixelVariance => "median_pixel_variance",
            Estimand::Zeros => "zeros",
            Estimand::Agree => "agree",
            Estimand::AgreeBounce(_) => "agree_bounce",
            Estimand::Wrong => "wrong_mean",
            Estimand::Length => "length",
            Estimand::Repeats => "repeats",
            Estimand::Serial => "serial",
            Estimand::RateMse => "rate_mse",
            Estimand::RateVariance => "rate_variance",
            Estimand::RateBias => "rate_bias",
        })
    }
}

impl Estimand {
    /// Whether it compares two cells, of which neither is the truth.
    pub fn is_agreement(self) -> bool {
        matches!(self, Estimand::Agree | Estimand::AgreeBounce(_))
    }

    /// What is promised of an estimand that can only be refuted.
    pub(super) fn promise(self) -> &'static str {
        match self {
            Estimand::Length => "paths end with the probabilities that the rule promises",
            Estimand::Repeats => "no block repeats another",
            Estimand::Serial => "blocks do not depend on the ones before",
            _ => "",
        }
    }

    /// The bounce or tile that it is about.
    pub fn index(self) -> Option<usize> {
        match self {
            Estimand::Bounce(i) | Estimand::AgreeBounce(i) | Estimand::Tile(i) => Some(i),
            _ => None,
        }
    }
}

/// A row; what does not apply is `None`.
#[derive(Clone, Debug)]
pub struct Row {
    /// Index of the cell in the plan.
    pub cell: usize,
    /// What is measured.
    pub estimand: Estimand,
    /// 0, 1, 2 for red, green, blue; `None` if it has no colour.
    pub channel: Option<usize>,
    /// Realizations.
    pub samples: u64,
    /// The measured value.
    pub mean: f64,
    /// Its standard error.
    pub std_error: Option<f64>,
    /// Variance of one realization.
    pub variance: Option<f64>,
    /// The right value.
    pub truth: Option<f64>,
    /// Its standard error; 0 for a closed form.
    pub truth_error: Option<f64>,
    /// Bound on its systematic error; 0 for a closed form.
    pub truth_bound: Option<f64>,
    /// Where the truth comes from.
    pub source: &'static str,
    /// What theory expects of this estimator, less the truth.
    pub expected_bias: Option<f64>,
    /// The measured value less the truth.
    pub bias: Option<f64>,
    /// Simultaneous interval of the bias.
    pub ci: Option<(f64, f64)>,
    /// Probability, were all well, of a deviation from the expected bias at least as large.
    pub p_value: Option<f64>,
    /// e-value against the expected value, where samples were bet on.
    pub e_value: Option<f64>,
    /// Smallest deviation that would have been found with 90 % power.
    pub mde: Option<f64>,
    /// The claim, by its index, under which something was asked.
    pub claim: Option<usize>,
    /// What the verdict rests on.
    pub engine: Option<Engine>,
    /// Realizations after which the verdict was certain, if that was before the last one.
    pub needed: Option<u64>,
    /// What is concluded; `None` if nothing was claimed.
    pub verdict: Option<Verdict>,
    /// Expected number of rays a realization, as measured.
    pub rays: Option<f64>,
    /// 1 / (variance x rays).
    pub efficiency: Option<f64>,
    /// Its standard error.
    pub efficiency_error: Option<f64>,
    /// Why there is no verdict or no number, or what else to know.
    pub note: String,
}

impl Row {
    /// A row with nothing but its value.
    pub fn new(cell: usize, estimand: Estimand, channel: Option<usize>, samples: u64, mean: f64) -> Self {
        Row {
            cell,
            estimand,
            channel,
            samples,
            mean,
            std_error: None,
            variance: None,
            truth: None,
            truth_error: None,
            truth_bound: None,
            source: "",
            expected_bias: None,
            bias: None,
            ci: None,
            p_value: None,
            e_value: None,
            mde: None,
            claim: None,
            engine: None,
            needed: None,
            verdict: None,
            rays: None,
            efficiency: None,
            efficiency_error: None,
            note: String::new(),
        }
    }

    /// States the efficiency, with its standard error by the relative error of the variance.
    pub fn rate(&mut self, variance_error: Option<f64>) {
        let (Some(variance), Some(rays)) = (self.variance, self.rays) else { return };
        if variance > 0.0 {
            let efficiency = 1.0 / (variance * rays);
            self.efficiency = Some(efficiency);
            self.efficiency_error = variance_error.map(|error| efficiency * error / variance);
        }
    }

    /// States the right value and what this estimator is expected to make of it.
    pub fn against(&mut self, right: &Value, expected: Option<f64>) {
        self.compared_with(right.value, right.std_error, right.source.name());
        self.truth_bound = Some(right.bound);
        self.expected_bias = expected.map(|expected| expected - right.value);
    }

    /// States a value that is known no better than by measurement: that of another cell.
    pub fn compared_with(&mut self, value: f64, error: f64, source: &'static str) {
        self.truth = Some(value);
        self.truth_error = Some(error);
        self.source = source;
        self.bias = Some(self.mean - value);
        self.expected_bias = Some(0.0);
    }
}

/// Letters of the channels.
pub const CHANNELS: [&str; 3] = ["R", "G", "B"];
