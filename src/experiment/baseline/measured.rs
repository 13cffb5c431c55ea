//! What is kept of a cell.

use crate::experiment::cell::Cell;
use crate::experiment::plan::Plan;
use crate::experiment::row::{Estimand, Row};
use crate::experiment::run::LOOKS_IN_ALL;
use crate::stats::change::Measure;
use crate::stats::tails::Light;
use serde::{Deserialize, Serialize};

/// Below this share of the mean, a standard deviation is rounding.
const NO_NOISE: f64 = 1e-11;

/// A measured value with its standard error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Value {
    /// The value; 0 where nothing is known of it.
    pub value: f64,
    /// Its standard error; 0 where nothing is known of it.
    pub std_error: f64,
    /// Values that the standard error was estimated from, less one.
    pub df: u64,
    /// Why nothing can be concluded from it, if so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unknown: Option<String>,
}

impl Value {
    /// A value with its standard error; unknown where the error is, for the reason given.
    fn new(value: f64, std_error: Option<f64>, n: u64, why: &str) -> Self {
        let known = std_error.filter(|error| error.is_finite() && value.is_finite() && n > 1);
        Value {
            value: if value.is_finite() { value } else { 0.0 },
            std_error: known.unwrap_or(0.0),
            df: n.saturating_sub(1).max(1),
            unknown: known.is_none().then(|| why.to_owned()),
        }
    }

    fn unless(self, unknown: Option<&String>) -> Self {
        Value { unknown: unknown.cloned().or(self.unknown), ..self }
    }

    /// For statistics.
    pub fn measure(&self) -> Measure {
        Measure { value: self.value, std_error: self.std_error, df: self.df as f64 }
    }
}

/// What is kept of a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// Its label, by which it is found.
    pub label: String,
    /// Realizations.
    pub samples: u64,
    /// How many times it was looked at whether it could end.
    pub looks: u32,
    /// Relative error that rounding may leave in a mean.
    pub rounding: f64,
    /// Mean of each channel.
    pub mean: [Value; 3],
    /// Variance of each channel: of a realization, or of a pixel's sample where there is an image.
    pub variance: [Value; 3],
    /// Rays a realization.
    pub rays: Value,
}

impl Measured {
    /// What is kept of a finished cell, whose rows are given.
    pub(super) fn of(plan: &Plan, index: usize, cell: &Cell, rows: &[&Row]) -> Self {
        let cell_plan = &plan.cells[index];
        let invalid = cell.invalid();
        let n = cell.cost.n;
        let doubts = [0, 1, 2].map(|channel| invalid.clone().or_else(|| doubt(cell, channel)));
        let mean = |channel: usize| {
            let row = find(rows, Estimand::Mean, channel);
            let why = row.map_or("no standard error", |row| row.note.as_str());
            Value::new(cell.total[channel].mean, row.and_then(|row| row.std_error), n, why)
                .unless(doubts[channel].as_ref())
        };
        Measured {
            label: plan.label(cell_plan),
            samples: n,
            looks: if cell_plan.may_stop { LOOKS_IN_ALL } else { 1 },
            rounding: cell_plan.core.rounding().max(NO_NOISE),
            mean: [0, 1, 2].map(mean),
            variance: [0, 1, 2].map(|channel| variance(cell, rows, channel).unless(doubts[channel].as_ref())),
            rays: Value::new(cell.cost.mean, cell.cost.std_error(), n, "no standard error")
                .unless(invalid.as_ref()),
        }
    }

    /// 1 / (variance x rays) of a channel. How variance and rays go together is not kept: their relative errors add up, as
    /// they do at worst.
    pub(super) fn efficiency(&self, channel: usize) -> Value {
        let (variance, rays) = (&self.variance[channel], &self.rays);
        let value = 1.0 / (variance.value * rays.value);
        let error = variance.std_error / variance.value + rays.std_error / rays.value;
        let unknown = variance.unknown.as_ref().or(rays.unknown.as_ref());
        let n = variance.df.min(rays.df) + 1;
        Value::new(value, Some(value * error), n, "zero, or without noise").unless(unknown)
    }
}

fn find<'a>(rows: &[&'a Row], estimand: Estimand, channel: usize) -> Option<&'a Row> {
    rows.iter().find(|row| row.estimand == estimand && row.channel == Some(channel)).copied()
}

/// Why the noise of a channel cannot be trusted.
fn doubt(cell: &Cell, channel: usize) -> Option<String> {
    let (light, why) = cell.tails[channel].guard();
    // where there is no light, there is nothing to doubt
    (light == Light::Red && cell.total[channel].mean != 0.0).then(|| format!("the guard is red: {why}"))
}

/// The variance of a channel. Its own error comes from theory's fourth moment where that is known, else from that of the
/// samples if the guard is green, and of images from the spread of the blocks.
fn variance(cell: &Cell, rows: &[&Row], channel: usize) -> Value {
    let total = &cell.total[channel];
    let blocks = cell.blocks[channel].n;
    let mean = find(rows, Estimand::Mean, channel);
    let row = find(rows, Estimand::PixelVariance, channel).or(mean);
    let Some(value) = row.and_then(|row| row.variance) else {
        return Value::new(0.0, None, blocks, row.map_or("no variance", |row| row.note.as_str()));
    };
    if value.sqrt() <= NO_NOISE * total.mean.abs() {
        return Value::new(value, None, blocks, "without noise");
    }
    let (error, why) = match row.filter(|row| row.estimand == Estimand::PixelVariance) {
        Some(row) => (row.std_error, "one block of samples only"),
        None => match find(rows, Estimand::Variance, channel) {
            Some(row) if row.note.is_empty() || row.std_error.is_some() => {
                (row.std_error, "no error of the variance is known")
            }
            Some(row) => (row.std_error, row.note.as_str()),
            None if cell.tails[channel].guard().0 == Light::Green => {
                (total.variance_std_error(), "no error of the variance is known")
            }
            None => (None, "the guard is not green: the variance has no interval"),
        },
    };
    Value::new(value, error, blocks, why)
}
