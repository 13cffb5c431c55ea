//! What has changed since an earlier run.

use crate::experiment::baseline::{Comparison, Finding};
use crate::report::baseline::{COLUMNS, conclusion, line, most, notes, subject, unknown};
use maud::{Markup, html};

/// A line a cell that both runs have; nothing without a comparison.
pub fn section(comparison: Option<&Comparison>) -> Markup {
    let Some(comparison) = comparison else { return html! {} };
    let [cell, columns @ .., _] = COLUMNS;
    html! {
        section #baseline {
            h2 { "What has changed" }
            p { "Against " (subject(comparison)) ". The numbers: " a href="baseline.csv" { "baseline.csv" } "." }
            @if !comparison.cells.is_empty() {
                div.wide { table {
                    thead { tr { th { (cell) } @for name in columns { th.n { (name) } } th { "finding" } } }
                    tbody { @for compared in &comparison.cells {
                        @let [label, changes @ .., _] = line(compared);
                        tr {
                            td { (label) } @for change in changes { td.n { (change) } }
                            td {
                                span class={ "badge " (class(most(compared))) } { (conclusion(compared)) }
                                @if let Some(unknown) = unknown(compared) { div.note { (unknown) } }
                            }
                        }
                    } }
                } }
            }
            @for note in notes(comparison) { p.note { (note) } }
        }
    }
}

/// The colour of a finding.
fn class(finding: Finding) -> &'static str {
    match finding {
        Finding::Identical | Finding::None => "none",
        Finding::Noise | Finding::Unknown => "open",
        Finding::Improved => "pass",
        Finding::Changed | Finding::Regressed => "fail",
    }
}
