//! A run as an object.

use super::{Files, LeftOut, Subject, finite, left_out};
use crate::experiment::baseline::Comparison;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Plan, mistake};
use crate::report::lookup::Lookup;
use crate::report::{answer, baseline, budget, replay, summary};
use crate::stats::Verdict;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// What a run has shown.
#[derive(Serialize, JsonSchema)]
pub struct Run {
    /// The answer in words.
    answer: Vec<String>,
    /// Whether all that is claimed was shown; the exit status is 0 then.
    held: bool,
    /// Whether Ctrl-C came first; only finished cells are there then.
    interrupted: bool,
    /// How many questions about cells without a known mistake ended how.
    counts: BTreeMap<&'static str, usize>,
    /// Any false alarm among all questions has at most this probability, were all well.
    error_probability: f64,
    /// All chance follows from it.
    seed: u64,
    /// The finished cells.
    cells: Vec<Measured>,
    /// Cells that cannot be run.
    left_out: Vec<LeftOut>,
    /// The changes since the run that --baseline names, as docs/src/json.md tells; null without one.
    #[schemars(required)]
    baseline: Option<serde_json::Value>,
    #[serde(flatten)]
    files: Files,
}

/// A finished cell.
#[derive(Serialize, JsonSchema)]
pub struct Measured {
    #[serde(flatten)]
    subject: Subject,
    /// Realizations that were planned.
    samples: u64,
    /// Realizations after which all was decided, if that was before the last one.
    needed: Option<u64>,
    /// PASS, INCONCLUSIVE, FAIL or INVALID, the worst of its questions; null if its mean was not judged. A cell with a fault
    /// is to FAIL.
    verdict: Option<&'static str>,
    /// By what it was decided: how many of the questions with this verdict exactly, asymptotically and by comparison.
    decided_by: BTreeMap<String, usize>,
    /// What else to know.
    note: String,
    /// The mean of a realization, red, green and blue.
    channels: Vec<Channel>,
    /// Rays a sample.
    rays: Option<f64>,
    /// 1 / (variance x rays), variances of the channels added, of a pixel for an image.
    efficiency: Option<f64>,
    /// Its standard error.
    efficiency_error: Option<f64>,
    /// The command that runs this cell again, with the same samples, bit for bit.
    replay: String,
}

/// One channel of a cell's mean.
#[derive(Serialize, JsonSchema)]
pub struct Channel {
    /// R, G or B.
    channel: &'static str,
    /// Measured.
    mean: Option<f64>,
    /// Its standard error; null where there is none.
    std_error: Option<f64>,
    /// The right value; null where it is not known.
    truth: Option<f64>,
    /// Where the right value comes from.
    truth_source: Option<&'static str>,
    /// Measured less right.
    bias: Option<f64>,
    /// What theory expects of this estimator, less the right value.
    expected_bias: Option<f64>,
    /// Simultaneous interval of the bias.
    interval: Option<[f64; 2]>,
    /// Smallest deviation that would have been found with 90 % power.
    mde: Option<f64>,
    /// The verdict on this mean alone; null if it was not judged.
    verdict: Option<&'static str>,
}

const VERDICTS: [Verdict; 4] = [Verdict::Pass, Verdict::Inconclusive, Verdict::Fail, Verdict::Invalid];

fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "PASS",
        Verdict::Inconclusive => "INCONCLUSIVE",
        Verdict::Fail => "FAIL",
        Verdict::Invalid => "INVALID",
    }
}

impl Run {
    /// What the rows say; `folder` holds the results, if they were written.
    pub fn new(
        lookup: &Lookup<'_>,
        interrupted: bool,
        folder: Option<&Path>,
        comparison: Option<&Comparison>,
    ) -> Self {
        let plan = lookup.plan;
        let cells = 0..plan.cells.len();
        let sound: Vec<_> = cells.clone().filter(|&c| !lookup.is_faulty(c)).collect();
        let count = |verdict| {
            let rows = sound.iter().flat_map(|&c| lookup.cell(c));
            rows.filter(|row| row.verdict == Some(verdict)).count()
        };
        Run {
            answer: answer::sentences(lookup),
            held: mistake::all_held(plan, lookup.rows()),
            interrupted,
            counts: VERDICTS.map(|verdict| (name(verdict), count(verdict))).into_iter().collect(),
            error_probability: budget::total(lookup),
            seed: plan.spec.seed,
            cells: cells.filter(|&c| !lookup.cell(c).is_empty()).map(|c| measured(lookup, plan, c)).collect(),
            baseline: comparison.map(baseline::json),
            left_out: left_out(plan),
            files: Files::of(folder),
        }
    }
}

fn measured(lookup: &Lookup<'_>, plan: &Plan, cell: usize) -> Measured {
    let line = summary::line(lookup, cell);
    let estimand = if lookup.is_image(cell) { Estimand::PixelVariance } else { Estimand::Mean };
    let efficiency = lookup.efficiency(cell, estimand).filter(|_| !lookup.is_noise_free(cell));
    let rays = lookup.row(cell, Estimand::Cost, None).map(|row| row.mean / plan.cells[cell].pixels as f64);
    Measured {
        subject: Subject::new(plan, &plan.cells[cell]),
        samples: line.samples,
        needed: line.needed,
        verdict: line.verdict.map(name),
        decided_by: line.by.iter().map(|(engine, count)| (engine.to_string(), *count)).collect(),
        note: line.note,
        channels: (0..3).filter_map(|c| channel(lookup, cell, c)).collect(),
        rays: rays.and_then(finite),
        efficiency: efficiency.and_then(|(value, _)| finite(value)),
        efficiency_error: efficiency.and_then(|(_, error)| error).and_then(finite),
        replay: replay::command(plan, cell),
    }
}

fn channel(lookup: &Lookup<'_>, cell: usize, channel: usize) -> Option<Channel> {
    let row = lookup.row(cell, Estimand::Mean, Some(channel))?;
    Some(Channel {
        channel: CHANNELS[channel],
        mean: finite(row.mean),
        std_error: row.std_error.and_then(finite),
        truth: row.truth,
        truth_source: Some(row.source).filter(|source| !source.is_empty()),
        bias: row.bias.and_then(finite),
        expected_bias: row.expected_bias.and_then(finite),
        interval: row.ci.map(|(low, high)| [low, high]),
        mde: row.mde,
        verdict: row.verdict.map(name),
    })
}
