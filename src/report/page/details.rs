//! What a row of the verdict table opens to: all numbers of a cell, the evidence behind them, and how to run it again.

use super::{bounces, evidence, trajectory};
use crate::experiment::row::CHANNELS;
use crate::experiment::{Cell, Estimand, Row};
use crate::report::lookup::Lookup;
use crate::report::{figure, replay, table};
use serde_json::{Value, json};

/// Columns of the table of numbers, and whether they hold numbers.
const COLUMNS: [(&str, bool); 17] = [
    ("estimand", false),
    ("channel", false),
    ("measured", true),
    ("std. error", true),
    ("right", true),
    ("its std. error", true),
    ("its bound", true),
    ("expected bias", true),
    ("bias", true),
    ("interval of the bias", true),
    ("p", true),
    ("e", true),
    ("smallest bias found", true),
    ("verdict", false),
    ("by", false),
    ("needed", true),
    ("source, note", false),
];

/// The columns, as `[name, is a number]`.
pub fn columns() -> Value {
    json!(COLUMNS)
}

/// All there is to say of a finished cell.
pub fn of(lookup: &Lookup<'_>, cells: &[Option<Cell>], index: usize) -> Value {
    let measured = cells[index].as_ref();
    let bets = measured.and_then(|cell| trajectory::figure(lookup, index, cell));
    let figures: Vec<Value> = bounces::figure(lookup, index).iter().chain(&bets).map(figure::json).collect();
    json!({
        "cell": index,
        "label": lookup.plan.label(&lookup.plan.cells[index]),
        "replay": replay::command(lookup.plan, index),
        "figures": figures,
        "evidence": measured.map(evidence::of),
        "rows": lookup.cell(index).iter().map(|row| record(row)).collect::<Vec<_>>(),
    })
}

fn record(row: &Row) -> [String; COLUMNS.len()] {
    let n = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:.6}"));
    let small = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:.2e}"));
    let index = row.estimand.index().map_or_else(String::new, |i| table::index(row.estimand, i));
    // the share of samples that are zero is told, and never judged
    let verdict = row.verdict.filter(|_| !matches!(row.estimand, Estimand::Zeros));
    [
        format!("{} {index}", row.estimand).trim_end().to_owned(),
        row.channel.map_or_else(String::new, |c| CHANNELS[c].to_owned()),
        n(Some(row.mean)),
        small(row.std_error),
        n(row.truth),
        small(row.truth_error),
        small(row.truth_bound),
        small(row.expected_bias),
        small(row.bias),
        row.ci.map_or_else(String::new, |(low, high)| format!("{low:+.2e} … {high:+.2e}")),
        small(row.p_value),
        small(row.e_value),
        small(row.mde),
        verdict.map_or_else(String::new, |verdict| verdict.to_string()),
        row.engine.map_or_else(String::new, |engine| engine.to_string()),
        row.needed.map_or_else(String::new, |needed| needed.to_string()),
        format!("{} {}", row.source, row.note).trim().to_owned(),
    ]
}
