//! All numbers of a cell, and the evidence behind them.

use super::evidence;
use super::verdicts::badge;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Cell, Estimand, Row};
use crate::report::lookup::Lookup;
use crate::report::table;
use maud::{Markup, html};

/// All rows of one cell, folded away.
pub fn numbers(lookup: &Lookup<'_>, cells: &[Option<Cell>], cell: usize) -> Markup {
    html! {
        details {
            summary { (lookup.plan.label(&lookup.plan.cells[cell])) " " (badge(lookup.verdict(cell))) }
            @if let Some(measured) = &cells[cell] { (evidence::of(lookup, cell, measured)) }
            div.wide { table {
                thead { tr {
                    th { "estimand" } th { "channel" } th.n { "measured" } th.n { "std. error" } th.n { "right" }
                    th.n { "its std. error" } th.n { "its bound" } th.n { "expected bias" } th.n { "bias" } th.n { "interval of the bias" } th.n { "p" } th.n { "e" }
                    th.n { "smallest bias found" } th { "verdict" } th { "by" } th.n { "needed" } th { "source, note" }
                } }
                tbody { @for row in lookup.cell(cell) { (number_row(row)) } }
            } }
        }
    }
}

fn number_row(row: &Row) -> Markup {
    let n = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:.6}"));
    let small = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:.2e}"));
    let index = row.estimand.index().map_or_else(String::new, |i| table::index(row.estimand, i));
    let precise = !matches!(row.estimand, Estimand::Zeros);
    html! {
        tr {
            td { (row.estimand) " " (index) } td { @if let Some(c) = row.channel { (CHANNELS[c]) } }
            td.n { (n(Some(row.mean))) } td.n { (small(row.std_error)) } td.n { (n(row.truth)) }
            td.n { (small(row.truth_error)) } td.n { (small(row.truth_bound)) }
            td.n { (small(row.expected_bias)) } td.n { (small(row.bias)) }
            td.n { @if let Some((low, high)) = row.ci { (format!("{low:+.2e} … {high:+.2e}")) } }
            td.n { (small(row.p_value)) } td.n { (small(row.e_value)) } td.n { (small(row.mde)) }
            td { @if precise { (badge(row.verdict)) } }
            td { @if let Some(engine) = row.engine { (engine) } }
            td.n { @if let Some(needed) = row.needed { (needed) } }
            td.said { (row.source) " " (row.note) }
        }
    }
}
