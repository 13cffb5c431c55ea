//! `index.html`: question, answer, verdicts, figures, images and numbers in one page that needs no network.

use super::difference::FULL;
use super::figure;
use super::lookup::Lookup;
use super::summary::{self, Line};
use super::table;
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Claim;
use crate::experiment::{Estimand, Row};
use crate::stats::Verdict;
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
pub fn page(lookup: &Lookup<'_>, answer: &[String], figures: &[Drawn], pictures: &[Picture]) -> String {
    let plan = lookup.plan;
    let finished: Vec<usize> = (0..plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty()).collect();
    let lines: Vec<Line> = finished.iter().map(|&c| summary::line(lookup, c)).collect();
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
                header {
                    h1 { (plan.name) }
                    p.question { (plan.spec.question) }
                }
                main {
                    section {
                        h2 { "Answer" }
                        @if finished.len() < plan.cells.len() {
                            p.warn { "Interrupted: " (finished.len()) " of " (plan.cells.len()) " cells finished." }
                        }
                        ul { @for sentence in answer { li { (sentence) } } }
                    }
                    section { h2 { "Verdicts" } (claims(lookup)) (verdicts(&lines)) }
                    @if !figures.is_empty() {
                        section { h2 { "Figures" } @for drawn in figures { (figure_block(drawn)) } }
                    }
                    @if !pictures.is_empty() {
                        section { h2 { "Images" } (gallery(pictures)) }
                    }
                    section { h2 { "Numbers" } @for &cell in &finished { (numbers(lookup, cell)) } }
                    section { h2 { "How to repeat this" } (provenance(lookup)) }
                }
            }
        }
    }
    .into_string()
}

fn claims(lookup: &Lookup<'_>) -> Markup {
    let about = |claim: &Claim| match claim {
        Claim::Unbiased(l) => ("mean and each bounce", l.scene.clone(), Some(l.margin)),
        Claim::Tiles(l) => ("means of the image's 4 × 4 tiles", l.scene.clone(), Some(l.margin)),
        Claim::Variance(l) => ("variance", l.scene.clone(), Some(l.margin)),
        Claim::Cost(l) => ("rays a sample", l.scene.clone(), Some(l.margin)),
        Claim::Length(c) => ("lengths of paths", c.scene.clone(), None),
        Claim::Independent(c) => ("independence of realizations", c.scene.clone(), None),
        Claim::Agree { estimator, roulette, margin, .. } => {
            ("mean, against another cell", Some(format!("{estimator}, {roulette}")), Some(*margin))
        }
    };
    html! {
        ul {
            @for claim in &lookup.plan.spec.claim {
                @let (what, scope, margin) = about(claim);
                li {
                    (what) @if let Some(scope) = scope { " (" (scope) ")" }
                    @match asked(lookup, claim) {
                        0 => ": nothing could be asked (the numbers below say why)",
                        count => {
                            ": " (count) " questions, "
                            @match margin {
                                Some(margin) => { "equivalent within " (100.0 * margin) " %" }
                                None => "which can be refuted and never shown",
                            }
                            ", any false alarm with probability at most " (claim.alpha())
                        }
                    }
                }
            }
        }
        p {
            "PASS: shown to lie within the margin. FAIL: shown to differ. INCONCLUSIVE: neither, with these samples. "
            "INVALID: NaN, infinity, negative radiance or a runaway walk. No verdict: nothing is claimed, or the test's "
            "conditions do not hold (the numbers below say why). All questions of a claim share its error probability by "
            "Holm's method, which is a little sharper than the simultaneous intervals that are drawn. mde: the smallest bias "
            "of the mean that would have been found with a probability of 90 %, in the worst channel. truth: its source "
            "and its own error, standard error and bound added. One bias stands for three that read alike. efficiency: "
            "1 / (variance × rays) in (W m⁻² sr⁻¹)⁻², variances of the channels added, in an image those of its pixels."
        }
    }
}

/// How many questions a claim led to.
fn asked(lookup: &Lookup<'_>, claim: &Claim) -> usize {
    let about = |row: &Row, scene: &str| match claim {
        Claim::Unbiased(l) => matches!(row.estimand, Estimand::Mean | Estimand::Bounce(_)) && l.covers(scene),
        Claim::Tiles(l) => matches!(row.estimand, Estimand::Tile(_)) && l.covers(scene),
        Claim::Variance(l) => row.estimand == Estimand::Variance && l.covers(scene),
        Claim::Cost(l) => row.estimand == Estimand::Cost && l.covers(scene),
        Claim::Length(c) => row.estimand == Estimand::Length && covers(&c.scene, scene),
        Claim::Independent(c) => {
            matches!(row.estimand, Estimand::Repeats | Estimand::Serial) && covers(&c.scene, scene)
        }
        Claim::Agree { scene: of, .. } => row.estimand.is_agreement() && covers(of, scene),
    };
    let cells = lookup.plan.cells.iter().enumerate();
    let rows = cells.flat_map(|(i, cell)| lookup.cell(i).iter().map(|row| (*row, cell.scene_label.as_str())));
    rows.filter(|(row, scene)| row.engine.is_some() && about(row, scene)).count()
}

fn covers(only: &Option<String>, scene: &str) -> bool {
    only.as_ref().is_none_or(|only| only == scene)
}

fn verdicts(lines: &[Line]) -> Markup {
    html! {
        div.wide { table {
            thead { tr {
                th { "scene" } th { "estimator" } th { "rule" } th { "verdict" } th.n { "bias [%] R G B" }
                th.n { "mde [%]" } th { "truth" } th.n { "rays" } th.n { "efficiency" } th.n { "samples" }
            } }
            tbody { @for line in lines { tr {
                td { (line.scene) } td { (line.estimator) } td { (line.rule) }
                td { (badge(line.verdict)) @if !line.note.is_empty() { div.note { (line.note) } } }
                td.n { (line.bias) } td.n { (line.mde) } td.truth { (line.truth) } td.n { (line.rays) }
                td.n { (line.efficiency) } td.n { (line.samples) }
            } } }
        } }
    }
}

fn badge(verdict: Option<Verdict>) -> Markup {
    let class = match verdict {
        Some(Verdict::Pass) => "pass",
        Some(Verdict::Fail | Verdict::Invalid) => "fail",
        Some(Verdict::Inconclusive) => "open",
        None => "none",
    };
    html! { span class={ "badge " (class) } { @if let Some(v) = verdict { (v) } @else { "–" } } }
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

/// All rows of one cell, folded away.
fn numbers(lookup: &Lookup<'_>, cell: usize) -> Markup {
    html! {
        details {
            summary { (lookup.plan.label(&lookup.plan.cells[cell])) " " (badge(lookup.verdict(cell))) }
            div.wide { table {
                thead { tr {
                    th { "estimand" } th { "channel" } th.n { "measured" } th.n { "std. error" } th.n { "right" }
                    th.n { "its std. error" } th.n { "its bound" } th.n { "expected bias" } th.n { "bias" } th.n { "interval of the bias" } th.n { "p" }
                    th.n { "smallest bias found" } th { "verdict" } th { "source, note" }
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
            td.n { (small(row.p_value)) } td.n { (small(row.mde)) }
            td { @if precise { (badge(row.verdict)) } } td { (row.source) " " (row.note) }
        }
    }
}

fn provenance(lookup: &Lookup<'_>) -> Markup {
    let plan = lookup.plan;
    html! {
        @for r in &plan.references { p { "Reference of " (r.scene) ": " code { (r.file) } "." } }
        pre { "cargo run --bin experiment -- " (plan.name) " --seed " (plan.spec.seed) (samples(lookup)) }
        p {
            "furnace " (env!("CARGO_PKG_VERSION")) ", seed " (plan.spec.seed) ". The same bytes for any number of threads. "
            a href="results.csv" { "results.csv" } ", " a href="timing.csv" { "timing.csv" } ", "
            a href="run.json" { "run.json" } "."
        }
    }
}

/// The option that gives all cells the samples that they have, where the file would not.
fn samples(lookup: &Lookup<'_>) -> String {
    let (plan, spec) = (lookup.plan, &lookup.plan.spec);
    let first = plan.cells[0].samples;
    let as_written = spec.grid.0.iter().all(|grid| grid.samples.unwrap_or(spec.samples) == first);
    let alike = plan.cells.iter().all(|cell| cell.samples == first);
    if alike && !as_written { format!(" --samples {first}") } else { String::new() }
}

pub(super) fn style() -> String {
    let font = STANDARD.encode(figure::WOFF2);
    format!(
        "@font-face{{font-family:'Furnace Sans';src:url(data:font/woff2;base64,{font}) format('woff2')}}{}",
        include_str!("page.css")
    )
}
