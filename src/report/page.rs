//! `index.html`: question, answer, verdicts, what is wrong and where, figures, images and numbers in one page that needs no
//! network.

mod assets;
mod baseline;
mod evidence;
mod faults;
mod images;
mod numbers;
mod packed;
mod places;
mod trajectory;
mod verdicts;

use super::lookup::Lookup;
use super::summary::{self, Line};
use crate::experiment::baseline::Comparison;
use crate::experiment::{Cell, Core, Plan};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A figure as the page shows it.
pub struct Drawn {
    /// File name without extension.
    pub name: String,
    /// The SVG.
    pub svg: String,
}

/// An image as the page shows it.
pub struct Picture {
    /// What the cell is called.
    pub label: String,
    /// File name without extension.
    pub name: String,
    /// The PNG.
    pub png: Vec<u8>,
    /// The PNG of the signed difference from a stored image, if there is one.
    pub map: Option<Vec<u8>>,
}

/// The whole page.
pub fn page(
    lookup: &Lookup<'_>,
    cells: &[Option<Cell>],
    answer: &[String],
    figures: &[Drawn],
    pictures: &[Picture],
    comparison: Option<&Comparison>,
) -> String {
    let plan = lookup.plan;
    let finished: Vec<usize> = (0..plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty()).collect();
    let lines: Vec<Line> = finished.iter().map(|&c| summary::line(lookup, c)).collect();
    let main = html! {
        section {
            h2 { "Answer" }
            @if finished.len() < plan.cells.len() {
                p.warn { "Interrupted: " (finished.len()) " of " (plan.cells.len()) " cells finished." }
            }
            ul { @for sentence in answer { li { (sentence) } } }
        }
        section { h2 { "Verdicts" } (verdicts::claims(lookup)) (verdicts::verdicts(&lines)) }
        (baseline::section(comparison))
        (places::section(lookup))
        (faults::section(lookup))
        @if !figures.is_empty() {
            section { h2 { "Figures" } @for drawn in figures { (figure_block(drawn)) } }
        }
        (images::section(pictures))
        section { h2 { "Numbers" } @for &cell in &finished { (numbers::numbers(lookup, cells, cell)) } }
        section { h2 { "How to repeat this" } (provenance(lookup)) }
    };
    frame(plan, &main)
}

/// A page about an experiment: its name and question, and what there is to say.
pub(super) fn frame(plan: &Plan, main: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "furnace: " (plan.name) }
                style { (PreEscaped(assets::style())) }
            }
            body {
                header { h1 { (plan.name) } p.question { (plan.spec.question) } }
                main { (main) }
                script { (PreEscaped(assets::script())) }
            }
        }
    }
    .into_string()
}

fn figure_block(drawn: &Drawn) -> Markup {
    html! {
        figure {
            (PreEscaped(&drawn.svg))
            figcaption { a href={ (drawn.name) ".svg" } { "SVG" } " · " a href={ (drawn.name) ".png" } { "PNG" } }
        }
    }
}

fn provenance(lookup: &Lookup<'_>) -> Markup {
    let plan = lookup.plan;
    html! {
        @for r in &plan.references { p { "Reference of " (r.scene) ": " code { (r.file) } "." } }
        @if let Some(cores) = cores(plan) { p { (cores) } }
        pre { "cargo run --bin experiment -- " (plan.name) " --seed " (plan.spec.seed) (samples(lookup)) (core(plan)) }
        p {
            "furnace " (env!("CARGO_PKG_VERSION")) ", seed " (plan.spec.seed) ". The same bytes for any number of threads. "
            a href="results.csv" { "results.csv" } ", "
            @if plan.cells.iter().any(|cell| cell.traced) { a href="convergence.csv" { "convergence.csv" } ", " } a href="timing.csv" { "timing.csv" } ", "
            a href="run.json" { "run.json" } "."
        }
    }
}

/// The option that makes the fast path sample; that of the file may be another.
fn core(plan: &Plan) -> &'static str {
    let is_fast = plan.cells.iter().any(|cell| cell.core == Core::Fast);
    if is_fast { " --core fast" } else { "" }
}

/// Which cells the fast path has sampled, if any.
fn cores(plan: &Plan) -> Option<String> {
    let fast = plan.cells.iter().filter(|cell| cell.core == Core::Fast).count();
    let all = plan.cells.len();
    let which = if fast == all { "All cells were".to_owned() } else { format!("{fast} of {all} cells were") };
    let how = "sampled by the fast path: single precision, sixteen paths side by side";
    let rest = if fast == all { "." } else { "; the others by the textbook, in double precision." };
    (fast > 0).then(|| format!("{which} {how}{rest}"))
}

/// The option that gives all cells the samples that they have, where the file would not.
fn samples(lookup: &Lookup<'_>) -> String {
    let (plan, spec) = (lookup.plan, &lookup.plan.spec);
    let first = plan.cells[0].samples;
    let as_written = spec.grid.0.iter().all(|grid| grid.samples.unwrap_or(spec.samples) == first);
    let alike = plan.cells.iter().all(|cell| cell.samples == first);
    if alike && !as_written { format!(" --samples {first}") } else { String::new() }
}
