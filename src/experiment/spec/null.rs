//! Synthetic samples of known mean, on which an experiment measures how often the instruments err.

use crate::experiment::bounds;
use crate::experiment::input::{Sweep, schema};
use crate::stats::nulls::{self, Law, NullRow, Setting};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, de::Error as _};
use std::fmt::Display;
use std::sync::atomic::AtomicBool;

/// One law, whose samples are judged again and again.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NullSpec {
    /// What the samples are like.
    pub law: Law,
    /// Samples a run: 1 to 10^7.
    #[serde(deserialize_with = "samples")]
    #[schemars(range(min = 1, max = 10_000_000))]
    pub samples: u64,
    /// Runs: 2 to 10^7.
    #[serde(deserialize_with = "runs")]
    #[schemars(range(min = 2, max = 10_000_000))]
    pub runs: u64,
    /// Nominal error probabilities, inside (0, 1): a number, or a list of numbers.
    #[serde(deserialize_with = "level")]
    #[schemars(schema_with = "schema::levels")]
    pub level: Vec<f64>,
    /// Samples are multiplied by one more than this, from above -1 to 10: a number, or a list of numbers.
    #[serde(default = "none", deserialize_with = "bias")]
    #[schemars(schema_with = "schema::biases")]
    pub bias: Vec<f64>,
}

impl NullSpec {
    /// The same with a hundredth of the runs, if it is to be quick.
    pub fn planned(&self, quick: bool) -> Self {
        let runs = if quick { (self.runs / 100).max(2) } else { self.runs };
        NullSpec { runs, ..self.clone() }
    }

    /// The lines of its table, bias by bias; all chance follows from `seed`. `None` if `stop` was raised before the end.
    pub fn rows(&self, seed: u64, stop: &AtomicBool) -> Option<Vec<NullRow>> {
        let setting = Setting { law: self.law, samples: self.samples, runs: self.runs, bias: 0.0, seed };
        nulls::rows(&setting, &self.level, &self.bias, stop)
    }
}

fn none() -> Vec<f64> {
    vec![0.0]
}

fn check<E: serde::de::Error>(holds: bool, value: impl Display, wanted: &str) -> Result<(), E> {
    if holds { Ok(()) } else { Err(E::custom(format!("{value} is out of range: {wanted}"))) }
}

fn samples<'de, D: Deserializer<'de>>(d: D) -> Result<u64, D::Error> {
    let v = i64::deserialize(d)?;
    check((1..=10_000_000).contains(&v), v, "a run takes 1 to 10^7 samples")?;
    Ok(v as u64)
}

fn runs<'de, D: Deserializer<'de>>(d: D) -> Result<u64, D::Error> {
    let v = i64::deserialize(d)?;
    check((2..=10_000_000).contains(&v), v, "a rate needs at least 2 runs, and at most 10^7")?;
    Ok(v as u64)
}

fn level<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<f64>, D::Error> {
    listed(d, "an error probability lies inside (0, 1)", |v| v > 0.0 && v < 1.0)
}

fn bias<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<f64>, D::Error> {
    let wanted = "samples are multiplied by 1 + bias, and a bias lies above -1 and is 10 at most";
    listed(d, wanted, |v| v > -1.0 && v <= 10.0)
}

/// A number, or a list of different numbers.
fn listed<'de, D: Deserializer<'de>>(
    d: D,
    wanted: &str,
    holds: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, D::Error> {
    let Sweep(values) = Sweep::deserialize(d)?;
    let (has, most) = (values.len(), bounds::LISTED);
    check(has <= most, format!("a list of {has}"), &format!("at most {most} numbers"))?;
    for (i, &v) in values.iter().enumerate() {
        check(holds(v), v, wanted)?;
        if values[..i].contains(&v) {
            return Err(D::Error::custom(format!("{v} is listed twice")));
        }
    }
    Ok(values)
}
