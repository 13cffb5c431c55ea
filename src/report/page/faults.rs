//! Known mistakes that were tried, and what became of them.

use super::verdicts::badge;
use crate::experiment::Row;
use crate::experiment::row::CHANNELS;
use crate::report::lookup::Lookup;
use crate::report::mistakes::{self, Tried};
use crate::report::number;
use maud::{Markup, html};

/// All of them; nothing where none was tried.
pub fn section(lookup: &Lookup<'_>) -> Markup {
    let tried = mistakes::tried(lookup);
    html! {
        @if !tried.is_empty() {
            section {
                h2 { "Mistakes" }
                p {
                    "Estimators with a known mistake, to show that the bench notices it. Where theory knows the wrong value "
                    "to which a mistake leads, the measured mean is to have just that."
                }
                div.wide { table {
                    thead { tr {
                        th { "mistake" } th { "where it was tried" } th { "what became of it" }
                        th { "wrong value by theory, and measured" }
                    } }
                    tbody { @for one in &tried { (line(lookup, one)) } }
                } }
            }
        }
    }
}

fn line(lookup: &Lookup<'_>, tried: &Tried<'_>) -> Markup {
    let fault = tried.fault;
    let cell = &lookup.plan.cells[tried.cell];
    html! {
        tr {
            td {
                b { (fault.name) } @if !fault.number.is_empty() { " (" (fault.number) ")" }
                div { (fault.about) } div.note { "Seen: " (fault.seen) }
            }
            td { (cell.scene_label) div { (cell.estimator_label) } div { (lookup.plan.rule_label(cell)) } }
            td.outcome { (tried.outcome()) }
            td { @if tried.values.is_empty() { "no closed form" } @else {
                @for row in &tried.values { div.value { (value(row)) } }
            } }
        }
    }
}

/// "R 1.2500, measured 1.2503 (1.2497 to 1.2509)".
fn value(row: &Row) -> Markup {
    let wrong = row.truth.unwrap_or(f64::NAN);
    html! {
        (row.channel.map_or("", |c| CHANNELS[c])) " " (format!("{wrong:.6}")) ", measured " (format!("{:.6}", row.mean))
        @match row.ci {
            Some((low, high)) => { " (" (format!("{:.6}", wrong + low)) " to " (format!("{:.6}", wrong + high)) ") " }
            None => " (no interval) ",
        }
        (badge(row.verdict))
        @if row.verdict.is_none() && !row.note.is_empty() { span.note { " " (row.note) } }
        @if row.truth == Some(0.0) && row.mean != 0.0 { span.note { " off by " (number::signed(row.mean)) } }
    }
}
