//! `results.csv`, tidy: one row for each cell x estimand x channel. And `timing.csv`, apart from it, because seconds
//! differ from run to run and results do not.

use crate::estimator::BINS;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Cell, Estimand, Plan, Row};
use crate::stats::tails::Light;

/// The text of `results.csv`.
pub fn results(plan: &Plan, cells: &[Option<Cell>], rows: &[Row]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let fixed = ["experiment", "scene", "estimator", "roulette", "core"];
    let measured = [
        "estimand",
        "bounce",
        "channel",
        "samples",
        "mean",
        "std_error",
        "variance",
        "truth",
        "truth_error",
        "truth_bound",
        "truth_source",
        "bias",
        "expected_bias",
        "ci_low",
        "ci_high",
        "e_value",
        "p_value",
        "mde",
        "verdict",
        "decided_by",
        "needed",
        "rays_per_sample",
        "efficiency",
        "efficiency_error",
        "guard",
        "guard_note",
        "note",
    ];
    let swept = plan.swept.iter().map(String::as_str);
    csv.write_record(fixed.into_iter().chain(swept).chain(measured)).expect("a Vec takes all");
    for row in rows {
        csv.write_record(record(plan, cells[row.cell].as_ref(), row)).expect("a Vec takes all");
    }
    csv.into_inner().expect("a Vec takes all")
}

fn record(plan: &Plan, measured: Option<&Cell>, row: &Row) -> Vec<String> {
    let cell = &plan.cells[row.cell];
    let guard = guard(measured, row);
    let mut record = vec![
        plan.name.clone(),
        cell.scene_label.clone(),
        cell.estimator_label.clone(),
        cell.roulette_label.clone(),
        cell.core.to_string(),
    ];
    record.extend(plan.swept.iter().map(|name| number(cell.params.get(name).copied())));
    record.extend([
        row.estimand.to_string(),
        row.estimand.index().map_or_else(String::new, |i| index(row.estimand, i)),
        row.channel.map_or_else(String::new, |c| CHANNELS[c].to_owned()),
        row.samples.to_string(),
        number(Some(row.mean)),
        number(row.std_error),
        number(row.variance),
        number(row.truth),
        number(row.truth_error),
        number(row.truth_bound),
        row.source.to_owned(),
        number(row.bias),
        number(row.expected_bias),
        derived(row.ci.map(|ci| ci.0)),
        derived(row.ci.map(|ci| ci.1)),
        derived(row.e_value),
        derived(row.p_value),
        derived(row.mde),
        row.verdict.map_or_else(String::new, |verdict| verdict.to_string()),
        row.engine.map_or_else(String::new, |engine| engine.to_string()),
        row.needed.map_or_else(String::new, |n| n.to_string()),
        number(row.rays),
        number(row.efficiency),
        number(row.efficiency_error),
        guard.as_ref().map_or_else(String::new, |(light, _)| light.to_string()),
        guard.map_or_else(String::new, |(_, why)| why),
        row.note.clone(),
    ]);
    record
}

/// Whether mean and variance can be trusted, and why, for rows of the mean.
fn guard(cell: Option<&Cell>, row: &Row) -> Option<(Light, String)> {
    let channel = row.channel.filter(|_| row.estimand == Estimand::Mean)?;
    Some(cell?.tails[channel].guard())
}

/// "3", or "8+" for the bin of all later bounces; a tile's number.
pub fn index(estimand: Estimand, i: usize) -> String {
    let is_tail = !matches!(estimand, Estimand::Tile(_)) && i + 1 == BINS;
    if is_tail { format!("{i}+") } else { i.to_string() }
}

/// Shortest digits that read back to the same number.
pub(super) fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| format!("{v:?}"))
}

/// Nine digits: quantiles and tail probabilities pass through the platform's logarithm, whose last bits may differ.
pub(super) fn derived(value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| format!("{v:.8e}"))
}

/// The text of `timing.csv`; the last column is the time after which all questions about a cell were decided, by the
/// share of its samples that they needed, and empty where nothing was asked.
pub fn timing(plan: &Plan, cells: &[Option<Cell>], seconds: &[f64], rows: &[Row]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let header = ["experiment", "cell", "core", "realizations", "rays", "seconds", "rays_per_second"];
    csv.write_record(header.into_iter().chain(["seconds_to_verdict"])).expect("a Vec takes all");
    for (index, ((cell_plan, cell), seconds)) in plan.cells.iter().zip(cells).zip(seconds).enumerate() {
        let Some(cell) = cell else { continue };
        let judged = rows.iter().filter(|row| row.cell == index && row.verdict.is_some());
        let needed = judged.map(|row| row.needed.unwrap_or(row.samples)).max();
        let to_verdict = needed.map(|n| seconds * n as f64 / cell.cost.n as f64);
        let rays = cell.cost.mean * cell.cost.n as f64;
        let record = [
            plan.name.clone(),
            plan.label(cell_plan),
            cell_plan.core.on_this_machine(),
            cell.cost.n.to_string(),
            format!("{rays:.0}"),
            format!("{seconds:.4}"),
            format!("{:.0}", rays / seconds),
            to_verdict.map_or_else(String::new, |seconds| format!("{seconds:.4}")),
        ];
        csv.write_record(record).expect("a Vec takes all");
    }
    csv.into_inner().expect("a Vec takes all")
}
