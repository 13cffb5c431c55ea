//! `index.html`: question, answer, verdicts, what is wrong and where, figures, images and numbers in one page that needs no
//! network.

mod evidence;
mod faults;
mod numbers;
mod places;
mod trajectory;
mod verdicts;

use super::difference::FULL;
use super::figure;
use super::lookup::Lookup;
use super::summary::{self, Line};
use crate::experiment::{Cell, Core, Plan};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
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
        (places::section(lookup))
        (faults::section(lookup))
        @if !figures.is_empty() {
            section { h2 { "Figures" } @for drawn in figures { (figure_block(drawn)) } }
        }
        @if !pictures.is_empty() {
            section { h2 { "Images" } (gallery(pictures)) }
        }
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
                style { (PreEscaped(style())) }
            }
            body {
                header { h1 { (plan.name) } p.question { (plan.spec.question) } }
                main { (main) }
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

fn gallery(pictures: &[Picture]) -> Markup {
    let data = |png: &[u8]| format!("data:image/png;base64,{}", STANDARD.encode(png));
    html! {
        p {
            "Same exposure for all pictures; the EXR files hold mean, variance, samples and bias against the reference. "
            @if pictures.iter().any(|picture| picture.map.is_some()) {
                "The maps show the signed difference from the reference in units of its standard error, block by block: "
                "red, green, and below them blue; white is none, blue means too dark by " (FULL) " standard errors or "
                "more, orange too bright. Noise alone colours one block of 16,000 fully, more where few paths find light: "
                "there the standard error is itself not well known, and most often too small."
            }
        }
        div.gallery { @for picture in pictures {
            figure {
                div {
                    img src=(data(&picture.png)) alt=(picture.label);
                    @if let Some(map) = &picture.map {
                        img src=(data(map)) alt={ "signed difference of " (picture.label) " from the reference" };
                    }
                }
                figcaption { (picture.label) " · " a href={ (picture.name) ".exr" } { "EXR" } }
            }
        } }
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

fn style() -> String {
    let font = STANDARD.encode(figure::WOFF2);
    format!(
        "@font-face{{font-family:'Furnace Sans';src:url(data:font/woff2;base64,{font}) format('woff2')}}{}",
        include_str!("page.css")
    )
}
