//! One line a cell: what was measured, what is concluded.

use super::lookup::Lookup;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Row};
use crate::stats::Verdict;

/// What the table says of a cell.
pub struct Line {
    /// The scene.
    pub scene: String,
    /// The estimator.
    pub estimator: String,
    /// The termination rule with swept parameters.
    pub rule: String,
    /// Realizations.
    pub samples: u64,
    /// Bias relative to the truth in each channel [%]; "-" without a truth.
    pub bias: String,
    /// Smallest relative bias of the mean that would have been found, worst channel [%].
    pub mde: String,
    /// Rays a sample.
    pub rays: String,
    /// Efficiency in each channel.
    pub efficiency: String,
    /// The worst verdict.
    pub verdict: Option<Verdict>,
    /// What else to know.
    pub note: String,
}

/// The line of a finished cell.
pub fn line(lookup: &Lookup<'_>, cell: usize) -> Line {
    let plan = &lookup.plan.cells[cell];
    let means: Vec<&Row> = (0..3).filter_map(|c| lookup.row(cell, Estimand::Mean, Some(c))).collect();
    let grey = means.windows(2).all(|pair| pair[0].mean == pair[1].mean && pair[0].truth == pair[1].truth);
    let shown = if grey { &means[..1] } else { &means[..] };
    let percent = |row: &&Row| match (row.bias, row.truth) {
        (Some(bias), Some(truth)) if truth != 0.0 => format!("{:+.3}", 100.0 * bias / truth),
        _ => "-".to_owned(),
    };
    let mde = shown.iter().filter_map(|r| Some(100.0 * r.mde? / r.truth?)).fold(f64::NAN, f64::max);
    let number = |v: Option<f64>| v.map_or_else(|| "-".to_owned(), |v| format!("{v:.3e}"));
    Line {
        scene: plan.scene_label.clone(),
        estimator: plan.estimator_label.clone(),
        rule: lookup.plan.rule_label(plan),
        samples: plan.samples,
        bias: shown.iter().map(percent).collect::<Vec<_>>().join(" "),
        mde: if mde.is_nan() { "-".to_owned() } else { format!("{mde:.3}") },
        rays: lookup
            .row(cell, Estimand::Cost, None)
            .map_or_else(String::new, |row| format!("{:.2}", row.mean / plan.pixels as f64)),
        efficiency: shown.iter().map(|r| number(r.efficiency)).collect::<Vec<_>>().join(" "),
        verdict: lookup.verdict(cell),
        note: note(lookup, cell, shown),
    }
}

/// Why a channel was not judged, or the first thing that is not well.
fn note(lookup: &Lookup<'_>, cell: usize, means: &[&Row]) -> String {
    let rows = lookup.cell(cell);
    let worst = lookup.verdict(cell).filter(|&v| v != Verdict::Pass);
    if let Some(row) = worst.and_then(|worst| rows.iter().find(|r| r.verdict == Some(worst))) {
        let channel = row.channel.map_or("", |c| CHANNELS[c]);
        let index = row.estimand.index().map_or_else(String::new, |i| format!(" {i}"));
        return format!("{}{index} {channel}: {}", row.estimand, row.note);
    }
    if !lookup.plan.cells[cell].is_unbiased() && lookup.verdict(cell).is_some() {
        return "biased as theory says".to_owned();
    }
    let infinite: Vec<&str> = means
        .iter()
        .filter(|r| r.note.starts_with("infinite variance"))
        .filter_map(|r| r.channel.map(|c| CHANNELS[c]))
        .collect();
    if infinite.is_empty() { String::new() } else { format!("infinite variance in {}", infinite.join(", ")) }
}
