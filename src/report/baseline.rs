//! What has changed since an earlier run: as text, as `baseline.csv`, as JSON.

use super::number;
use super::table::derived;
use crate::experiment::baseline::{Answer, Compared, Comparison, Finding, LEVEL, NOISE};
use crate::experiment::row::CHANNELS;
use serde_json::{Value, json};
use std::fmt::Write;

/// A quantity's name and its answers: one a channel, or a single one.
pub type Quantity<'a> = (&'static str, &'a [Answer]);

/// The quantities of a cell in the order in which they are told.
pub fn quantities(cell: &Compared) -> [Quantity<'_>; 4] {
    [
        ("mean", &cell.mean),
        ("variance", &cell.variance),
        ("efficiency", &cell.efficiency),
        ("rays", std::slice::from_ref(&cell.rays)),
    ]
}

/// What a finding is called.
pub fn word(finding: Finding) -> &'static str {
    match finding {
        Finding::Identical => "identical, bit for bit",
        Finding::None => "no change detected",
        Finding::Noise => "change within noise threshold",
        Finding::Unknown => "not known",
        Finding::Improved => "improved",
        Finding::Changed => "changed",
        Finding::Regressed => "regressed",
    }
}

/// The channel of which most is to be told.
fn worst<'a>((name, answers): Quantity<'a>) -> (usize, &'a Answer) {
    let unchanged = if name == "mean" { 0.0 } else { 1.0 };
    let weight = |answer: &Answer| {
        let change = answer.change?;
        Some((change.estimate - unchanged).abs() / (change.high - change.low).max(f64::MIN_POSITIVE))
    };
    let order = |a: &(usize, &Answer), b: &(usize, &Answer)| {
        let by_weight = weight(a.1).unwrap_or(0.0).total_cmp(&weight(b.1).unwrap_or(0.0));
        a.1.finding.cmp(&b.1.finding).then(by_weight)
    };
    // of equals the first
    answers.iter().enumerate().rev().max_by(order).expect("a quantity has an answer")
}

/// "-0.02 [-0.14, +0.10] % R" of a mean, "1.02 [0.98, 1.05] G" of the rest: of the worst channel, without its letter where
/// all read alike.
pub fn read((name, answers): Quantity<'_>) -> String {
    let one = |answer: &Answer| match (answer.change, answer.finding) {
        (_, Finding::Identical) => "=".to_owned(),
        (Some(change), finding) if finding != Finding::Unknown => {
            let (value, unit): (fn(f64) -> String, _) =
                if name == "mean" { (percent, " %") } else { (ratio, "") };
            format!("{} [{}, {}]{unit}", value(change.estimate), value(change.low), value(change.high))
        }
        _ => "-".to_owned(),
    };
    let (channel, answer) = worst((name, answers));
    let text = one(answer);
    let alike = answers.iter().all(|other| one(other) == text);
    if alike { text } else { format!("{text} {}", CHANNELS[channel]) }
}

/// Percent with a sign; what rounding leaves is nothing.
fn percent(value: f64) -> String {
    if value.abs() < 1e-6 { "0".to_owned() } else { number::signed(value) }
}

/// Near 1 with as many decimals on either side of it.
fn ratio(value: f64) -> String {
    if (0.1..10.0).contains(&value) { format!("{value:.3}") } else { number::short(value) }
}

/// What is concluded about a cell: "no change detected", or every quantity of which there is more to say.
pub fn conclusion(cell: &Compared) -> String {
    let found = quantities(cell).map(|quantity| (quantity.0, worst(quantity).1.finding));
    if found.iter().all(|(_, finding)| *finding == Finding::Identical) {
        return word(Finding::Identical).to_owned();
    }
    let told = found.iter().filter(|(_, finding)| *finding > Finding::None);
    let told: Vec<String> = told.map(|(name, finding)| format!("{name} {}", word(*finding))).collect();
    if told.is_empty() { word(Finding::None).to_owned() } else { told.join(", ") }
}

/// "not known: mean R, variance": of which channels, or of which quantities in all channels, nothing can be said.
pub fn unknown(cell: &Compared) -> Option<String> {
    let of_quantity = |(name, answers): Quantity<'_>| {
        let channels = answers.iter().zip(CHANNELS).filter(|(answer, _)| answer.finding == Finding::Unknown);
        let letters: Vec<&str> = channels.map(|(_, letter)| letter).collect();
        match letters.len() {
            0 => None,
            all if all == answers.len() => Some(name.to_owned()),
            _ => Some(format!("{name} {}", letters.join(" "))),
        }
    };
    let unknown: Vec<String> = quantities(cell).into_iter().filter_map(of_quantity).collect();
    (!unknown.is_empty()).then(|| format!("{}: {}", word(Finding::Unknown), unknown.join(", ")))
}

/// The most serious finding about a cell.
pub fn most(cell: &Compared) -> Finding {
    let findings = quantities(cell).map(|quantity| worst(quantity).1.finding);
    findings.into_iter().max().expect("there are four")
}

/// "the baseline main (furnace 0.1.0, commit e40075d, seed 1)".
pub fn subject(comparison: &Comparison) -> String {
    let before = &comparison.before;
    let commit = before.commit.as_ref().map_or_else(String::new, |commit| {
        let short: String = commit.chars().take(8).collect();
        format!(", commit {short}")
    });
    format!("the baseline {} (furnace {}{commit}, seed {})", comparison.name, before.version, before.seed)
}

/// What the words mean, and what else to know.
pub fn notes(comparison: &Comparison) -> Vec<String> {
    let percent = |share: f64| number::short(100.0 * share).replace(".00", "");
    let (level, noise) = (percent(LEVEL), percent(NOISE));
    let mut notes = Vec::new();
    if comparison.questions > 0 {
        notes.push(format!(
            "All intervals hold together: the probability that anything is called changed, improved or regressed although \
             nothing is, is at most {level} % (Bonferroni, {} questions).",
            comparison.questions
        ));
        notes.push(format!(
            "mean: change in percent. The others: ratio to the earlier value, improved or regressed only if the whole interval \
             lies beyond the noise threshold of ±{noise} %. not known: no standard error can be trusted (baseline.csv says why)."
        ));
    }
    if comparison.shares_numbers() {
        notes.push(format!(
            "Both runs have the seed {} and share random numbers: the intervals, which are for independent runs, may be too wide \
             or wrong. Another --seed makes the runs independent.",
            comparison.seed
        ));
    }
    let only = |labels: &[String], whose: &str| {
        (!labels.is_empty()).then(|| format!("Only in {whose}: {}.", labels.join("; ")))
    };
    notes.extend(only(&comparison.only_before, "the baseline"));
    notes.extend(only(&comparison.only_now, "this run"));
    notes
}

/// The names of the columns of [`line()`].
pub const COLUMNS: [&str; 6] = ["cell", "mean", "variance", "efficiency", "rays", ""];

/// A line a cell.
pub fn line(cell: &Compared) -> [String; 6] {
    let [mean, variance, efficiency, rays] = quantities(cell).map(read);
    let unknown = unknown(cell).map_or_else(String::new, |unknown| format!(" ({unknown})"));
    [cell.label.clone(), mean, variance, efficiency, rays, conclusion(cell) + &unknown]
}

/// The comparison as text; columns aligned.
pub fn text(comparison: &Comparison) -> String {
    let lines = comparison.cells.iter().map(line);
    let grid: Vec<[String; 6]> = std::iter::once(COLUMNS.map(str::to_owned)).chain(lines).collect();
    let width = |column: usize| grid.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3, 4, 5].map(width);
    let mut text = format!("Against {}:\n", subject(comparison));
    for row in grid.iter().filter(|_| !comparison.cells.is_empty()) {
        let mut out = String::new();
        for (cell, width) in row.iter().zip(widths) {
            let pad = " ".repeat(width - cell.chars().count());
            let _ = write!(out, "{cell}{pad}  ");
        }
        let _ = writeln!(text, "{}", out.trim_end());
    }
    notes(comparison).iter().for_each(|note| {
        let _ = writeln!(text, "{note}");
    });
    text
}

/// The text of `baseline.csv`: a row a cell, quantity and channel.
pub fn csv(comparison: &Comparison) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let header = ["baseline", "cell", "quantity", "channel", "samples_before", "samples", "unit"];
    let measured = ["change", "low", "high", "finding", "note"];
    csv.write_record(header.into_iter().chain(measured)).expect("a Vec takes all");
    for cell in &comparison.cells {
        for (name, answers) in quantities(cell) {
            for (channel, answer) in answers.iter().enumerate() {
                let letter = if answers.len() == 1 { "" } else { CHANNELS[channel] };
                let unit = if name == "mean" { "percent" } else { "ratio" };
                let change = answer.change;
                let record = [
                    comparison.name.clone(),
                    cell.label.clone(),
                    name.to_owned(),
                    letter.to_owned(),
                    cell.samples.0.to_string(),
                    cell.samples.1.to_string(),
                    unit.to_owned(),
                    derived(change.map(|change| change.estimate)),
                    derived(change.map(|change| change.low)),
                    derived(change.map(|change| change.high)),
                    word(answer.finding).to_owned(),
                    answer.why.clone(),
                ];
                csv.write_record(record).expect("a Vec takes all");
            }
        }
    }
    csv.into_inner().expect("a Vec takes all")
}

/// The comparison as JSON.
pub fn json(comparison: &Comparison) -> Value {
    let answer = |answer: &Answer| {
        let change = answer.change.map(|c| json!({ "estimate": c.estimate, "low": c.low, "high": c.high }));
        json!({ "change": change, "finding": word(answer.finding), "note": answer.why })
    };
    let cell = |cell: &Compared| {
        let mut object =
            json!({ "cell": cell.label, "samples_before": cell.samples.0, "samples": cell.samples.1 });
        for (name, answers) in quantities(cell) {
            object[name] = answers.iter().map(answer).collect();
        }
        object
    };
    json!({
        "name": comparison.name,
        "version": comparison.before.version,
        "commit": comparison.before.commit,
        "seed": comparison.before.seed,
        "level": LEVEL,
        "noise_threshold": NOISE,
        "questions": comparison.questions,
        "shares_random_numbers": comparison.shares_numbers(),
        "cells": comparison.cells.iter().map(cell).collect::<Vec<_>>(),
        "only_in_baseline": comparison.only_before,
        "only_in_this_run": comparison.only_now,
    })
}
