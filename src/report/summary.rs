//! One line a cell: what was measured, what is concluded.

use super::lookup::Lookup;
use super::number;
use super::{budget, mistakes};
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Row};
use crate::stats::{Engine, Verdict};

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
    /// Efficiency, variances of the channels added, of a pixel for an image.
    pub efficiency: String,
    /// Where the truth comes from and its own error relative to it, worst channel [%].
    pub truth: String,
    /// The worst verdict.
    pub verdict: Option<Verdict>,
    /// What decided the questions with that verdict, and how many each.
    pub by: Vec<(Engine, usize)>,
    /// Realizations after which all was decided, if that was before the last.
    pub needed: Option<u64>,
    /// What else to know.
    pub note: String,
}

/// The line of a finished cell.
pub fn line(lookup: &Lookup<'_>, cell: usize) -> Line {
    let plan = &lookup.plan.cells[cell];
    let means: Vec<&Row> = (0..3).filter_map(|c| lookup.row(cell, Estimand::Mean, Some(c))).collect();
    let bias = |row: &&Row| match (row.bias, row.truth) {
        (Some(bias), Some(truth)) if truth != 0.0 => percent(bias / truth),
        _ => "-".to_owned(),
    };
    let mde = means.iter().filter_map(|r| Some(100.0 * r.mde? / r.truth?)).fold(f64::NAN, f64::max);
    let estimand = if lookup.is_image(cell) { Estimand::PixelVariance } else { Estimand::Mean };
    let efficiency = lookup.efficiency(cell, estimand).filter(|_| !lookup.is_noise_free(cell));
    Line {
        scene: plan.scene_label.clone(),
        estimator: plan.estimator_label.clone(),
        rule: lookup.plan.rule_label(plan),
        samples: plan.samples,
        bias: bias_of(means.iter().map(bias).collect()),
        mde: if mde.is_nan() { "-".to_owned() } else { format!("{mde:.3}") },
        rays: lookup
            .row(cell, Estimand::Cost, None)
            .map_or_else(String::new, |row| format!("{:.2}", row.mean / plan.pixels as f64)),
        efficiency: efficiency.map_or_else(|| "-".to_owned(), |(value, _)| number::short(value)),
        truth: truth(&means),
        verdict: lookup.verdict(cell),
        by: by(lookup, cell),
        needed: means.first().map(|row| row.samples).filter(|&taken| taken < plan.samples),
        note: note(lookup, cell, &means),
    }
}

/// What the verdict of a cell rests on.
fn by(lookup: &Lookup<'_>, cell: usize) -> Vec<(Engine, usize)> {
    let Some(verdict) = lookup.verdict(cell) else { return Vec::new() };
    let rows = lookup.cell(cell).iter().filter(|row| row.estimand != Estimand::Wrong);
    let engines: Vec<Engine> =
        rows.filter(|row| row.verdict == Some(verdict)).filter_map(|row| row.engine).collect();
    let counted = |engine: Engine| (engine, engines.iter().filter(|&&e| e == engine).count());
    budget::ENGINES.map(counted).into_iter().filter(|(_, count)| *count > 0).collect()
}

/// "exact", or "27 exact, 4 asymptotic".
pub fn by_text(by: &[(Engine, usize)]) -> String {
    match by {
        [(engine, _)] => engine.to_string(),
        several => several.iter().map(|(e, count)| format!("{count} {e}")).collect::<Vec<_>>().join(", "),
    }
}

/// A signed share in percent; no sign for what rounds to nothing.
fn percent(share: f64) -> String {
    let text = format!("{:+.3}", 100.0 * share);
    if text == "-0.000" || text == "+0.000" { "0.000".to_owned() } else { text }
}

/// The channels' biases; one where they read alike.
fn bias_of(channels: Vec<String>) -> String {
    match channels.as_slice() {
        [first, rest @ ..] if rest.iter().all(|other| other == first) => first.clone(),
        _ => channels.join(" "),
    }
}

/// "closed form", "deterministic ± 0.002 %": standard error and bound together.
fn truth(means: &[&Row]) -> String {
    let Some(row) = means.iter().find(|row| !row.source.is_empty()) else { return "-".to_owned() };
    let own = |row: &&Row| {
        let error = row.truth_error.unwrap_or(0.0) + row.truth_bound.unwrap_or(0.0);
        Some(100.0 * error / row.truth.filter(|&truth| truth != 0.0)?)
    };
    let error = means.iter().filter_map(own).fold(0.0, f64::max);
    if error > 0.0 { format!("{} ± {} %", row.source, number::short(error)) } else { row.source.to_owned() }
}

/// Why a channel was not judged, or the first thing that is not well.
fn note(lookup: &Lookup<'_>, cell: usize, means: &[&Row]) -> String {
    if let Some(note) = mistakes::note(lookup, cell) {
        return note;
    }
    let rows = lookup.cell(cell);
    let worst = lookup.verdict(cell).filter(|&v| v != Verdict::Pass);
    if let Some(row) = worst.and_then(|worst| rows.iter().find(|r| r.verdict == Some(worst))) {
        let channel = row.channel.map_or("", |c| CHANNELS[c]);
        let index = row.estimand.index().map_or_else(String::new, |i| format!(" {i}"));
        return format!("{}{index} {channel}: {}", row.estimand, row.note);
    }
    let is_clamped = !lookup.plan.cells[cell].is_unbiased();
    if lookup.verdict(cell).is_some() && !lookup.finds_all(cell) {
        let all = lookup.expected_shares(cell).iter().all(|share| *share < -1.0 + 1e-9);
        let what = if all {
            "finds no light"
        } else if is_clamped {
            "biased"
        } else {
            "misses light"
        };
        return format!("{what}, as theory says");
    }
    let infinite: Vec<&str> = means
        .iter()
        .filter(|r| r.note.starts_with("infinite variance"))
        .filter_map(|r| r.channel.map(|c| CHANNELS[c]))
        .collect();
    if infinite.is_empty() { String::new() } else { format!("infinite variance in {}", infinite.join(", ")) }
}
