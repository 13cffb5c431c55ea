//! What was measured, as the lines of a table.

use super::{Count, Instrument, Rates, Setting, measure_at, predicted};
use crate::stats::nulls::Law;
use crate::stats::question::Engine;
use crate::stats::skewed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// A line: one instrument on one law, at one level and bias.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NullRow {
    /// What the law is called.
    pub law: String,
    /// Samples a run.
    pub samples: u64,
    /// Runs about which the instrument had anything to say.
    pub runs: u64,
    /// Nominal error probability.
    pub level: f64,
    /// Samples were multiplied by one more than this.
    pub bias: f64,
    /// What judged, see [`Instrument::name`].
    pub instrument: String,
    /// Runs in which it rejected.
    pub rejected: u64,
    /// Lower limit of the rate's interval of 99.9 %, in 0..=1.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
    /// What one should know about it.
    pub note: String,
}

/// All lines of a law: bias by bias, level by level, instrument by instrument. Each bias multiplies the same samples.
/// `None` if `stop` was raised before the end.
pub fn rows(setting: &Setting, levels: &[f64], biases: &[f64], stop: &AtomicBool) -> Option<Vec<NullRow>> {
    let mut rows = Vec::new();
    for &bias in biases {
        for rates in measure_at(&Setting { bias, ..*setting }, levels, stop)? {
            rows.extend(Instrument::ALL.iter().map(|instrument| row(&rates, *instrument)));
        }
    }
    Some(rows)
}

fn row(rates: &Rates, instrument: Instrument) -> NullRow {
    let count = rates.count(instrument);
    let (low, high) = count.interval();
    NullRow {
        law: rates.law.to_string(),
        samples: rates.samples,
        runs: count.of,
        level: rates.level,
        bias: rates.bias,
        instrument: instrument.name().to_owned(),
        rejected: count.rejected,
        low,
        high,
        note: note(rates, instrument, count),
    }
}

fn note(rates: &Rates, instrument: Instrument, count: Count) -> String {
    let Rates { law, samples, level, bias, runs, .. } = rates;
    let expected = |engine: Engine, below: bool| {
        let at = predicted(law, *samples, engine, *level).map(|(low, high)| if below { low } else { high });
        match at.filter(|at| at.is_finite() && *bias != 0.0) {
            Some(at) => format!("90 % expected at a bias of {at:+.3}"),
            None => String::new(),
        }
    };
    match instrument {
        Instrument::BetsAbove => expected(Engine::Exact, false),
        Instrument::BetsBelow if count.of == 0 => "without a bound there is no such evidence".to_owned(),
        Instrument::BetsBelow => expected(Engine::Exact, true),
        Instrument::KnownBelow | Instrument::KnownAbove if count.of == 0 => lacking(law, *level),
        Instrument::KnownBelow => expected(Engine::Asymptotic, true),
        Instrument::KnownAbove => expected(Engine::Asymptotic, false),
        Instrument::GuardedBelow | Instrument::GuardedAbove => {
            format!("decides {} of {runs} runs", count.of)
        }
        Instrument::Interval if law.bound().is_none() => "lower limit only".to_owned(),
        Instrument::Peeks => "decides nothing: shows what looking again costs".to_owned(),
        Instrument::Red => "no test: how often the samples warn of themselves".to_owned(),
        _ => String::new(),
    }
}

/// Why theory lets no t test decide.
fn lacking(law: &Law, level: f64) -> String {
    match (law.variance(), law.skewness()) {
        (None, _) => "infinite variance: decides nothing".to_owned(),
        (_, None) => "infinite skewness: decides nothing".to_owned(),
        (_, Some(skewness)) => {
            let needed = skewed::enough(skewness, (2.0 * level).min(1.0));
            format!("skewness {skewness:.0}: {needed:.0} samples would be needed to decide")
        }
    }
}
