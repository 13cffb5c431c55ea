//! `index.html` of a study.

use super::{FOUND, Studied, nulls, sentences};
use crate::experiment::study::{Detection, Instrument};
use crate::faults::Fault;
use crate::report::page::{frame, repeat};
use crate::report::run::Run;
use crate::truth::Counted;
use maud::{Markup, html};

/// The page of a study.
pub fn page(studied: &Studied<'_>, interrupted: bool, run: &Run) -> String {
    let plan = studied.plan;
    let seeds = plan.spec.seeds.unwrap_or(1);
    let command = format!("cargo run --bin experiment -- {} --seed {}", plan.name, plan.spec.seed);
    let files: &[&str] = match studied.nulls.is_empty() {
        true => &["results.csv", "timing.csv", "run.json"],
        false => &["results.csv", "nulls.csv", "timing.csv", "run.json"],
    };
    let main = html! {
        section {
            h2 { "Answer" }
            @if interrupted { p.warn { "Interrupted: some cells are missing." } }
            ul { @for sentence in sentences(studied) { li { (sentence) } } }
        }
        section { h2 { "Detections" } p { (legend(seeds)) } (matrix(studied)) }
        @if !studied.nulls.is_empty() {
            section { h2 { "Samples of known mean" } (nulls::table(studied.nulls)) }
        }
        (catalogue(studied))
        section { h2 { "How to repeat this" } (repeat(plan, &command, files)) }
    };
    frame(plan, &main, run)
}

fn legend(seeds: u32) -> String {
    format!(
        "Percent of {seeds} runs, a seed each, in which an instrument found something, the claims of the file shared among \
         the questions of the one run. With 99 % confidence the true rate lies within the interval that the pointer shows. \
         verdict: any instrument of the bench. bets: exact tests of mean and bounces. t: a t test of the mean. Mitsuba, \
         pbrt, Nori, Welch map: the rules of those tools on the same samples, as an image of 32 × 32 pixels. needed: samples \
         after which half of the catches were made; the bench looks at an eighth, a quarter, a half and three quarters of \
         them. rate: exponent of the mean squared error, -1 for a sound estimator. –: nothing to look at."
    )
}

fn matrix(studied: &Studied<'_>) -> Markup {
    html! {
        div.wide { table.matrix {
            thead { tr {
                th { "estimator" } th { "scene" } th { "rule" } th { "effect" } th.n { "samples" }
                @for instrument in Instrument::ALL { th.n { (instrument.name()) } }
                th.n { "needed" } th.n { "rate" } th.n { "mean G" } th.n { "right" } th.n { "wrong, by theory" }
            } }
            tbody { @for &(index, detection) in &studied.cells { (matrix_row(studied, index, detection)) } }
        } }
    }
}

fn matrix_row(studied: &Studied<'_>, index: usize, detection: &Detection) -> Markup {
    let plan = studied.plan;
    let cell = &plan.cells[index];
    let effect =
        studied.effect(index).map_or_else(|| "sound".to_owned(), |e| format!("{e:?}").to_lowercase());
    let right = plan.truth(cell).mean(1, Counted::All).map(|value| value.value);
    let wrong = cell.faulty().and_then(|faulty| faulty.wrong(&cell.scene, 1));
    let value = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| format!("{v:.5}"));
    html! {
        tr {
            td { (cell.estimator_label) } td { (cell.scene_label) } td { (plan.rule_label(cell)) }
            td { (effect) } td.n { (cell.samples) }
            @for instrument in Instrument::ALL { (share_cell(detection, instrument)) }
            td.n { @match detection.needed { Some(n) => { (n) } None => { "–" } } }
            td.n { @if let Some((slope, low, high)) = detection.rate {
                span title={ (format!("{low:.2} to {high:.2}")) } { (format!("{slope:.2}")) }
            } @else { "–" } }
            td.n { (value(Some(detection.mean[1]))) } td.n { (value(right)) } td.n { (value(wrong)) }
        }
    }
}

/// One entry: darker for more detections.
fn share_cell(detection: &Detection, instrument: Instrument) -> Markup {
    let Some((share, low, high)) = detection.share(instrument) else { return html! { td.n { "–" } } };
    let class = match share {
        s if s >= FOUND => "n found",
        s if s >= 0.5 => "n often",
        s if s > 0.0 => "n seldom",
        _ => "n never",
    };
    let title = format!("{:.1} % to {:.1} %", 100.0 * low, 100.0 * high);
    html! { td class=(class) title=(title) { (format!("{:.0}", 100.0 * share)) } }
}

/// What the mistakes are.
fn catalogue(studied: &Studied<'_>) -> Markup {
    let mut faults = Vec::new();
    for (cell, _) in &studied.cells {
        if let Some(fault) = studied.plan.cells[*cell].fault
            && !faults.iter().any(|known: &&Fault| known.name == fault.name)
        {
            faults.push(fault);
        }
    }
    html! {
        @if !faults.is_empty() {
            section {
                h2 { "Mistakes" }
                div.wide { table {
                    thead { tr { th { "name" } th { "no." } th { "what is wrong" } th { "seen" } } }
                    tbody { @for fault in faults { tr {
                        td { (fault.name) } td { (fault.number) } td { (fault.about) } td { (fault.seen) }
                    } } }
                } }
            }
        }
    }
}
