//! `index.html`: question, answer, verdicts, what is wrong and where, costs, figures, images and numbers in one page that
//! needs no network. All of it is a function of what was measured, but for one line, which is of the run.

mod assets;
mod baseline;
mod bounces;
mod costs;
mod details;
mod evidence;
mod faults;
mod figures;
mod images;
mod packed;
mod places;
mod provenance;
mod trajectory;
mod verdicts;

pub use provenance::repeat;
pub use verdicts::badge;

use super::costs::Cost;
use super::figure::Figure;
use super::lookup::Lookup;
use super::pictures::Picture;
use super::run::Run;
use super::summary::{self, Line};
use crate::experiment::baseline::Comparison;
use crate::experiment::{Cell, Plan};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use rayon::prelude::*;
use serde_json::json;

/// A figure as the page shows it.
pub struct Drawn {
    /// File name without extension.
    pub name: String,
    /// What it shows.
    pub figure: Figure,
}

/// What a page is made of.
pub struct Content<'a> {
    /// The rows.
    pub lookup: &'a Lookup<'a>,
    /// What was measured.
    pub cells: &'a [Option<Cell>],
    /// The answer in words.
    pub answer: &'a [String],
    /// What cells cost.
    pub costs: &'a [Cost],
    /// Figures.
    pub figures: &'a [Drawn],
    /// Images.
    pub pictures: &'a [Picture],
    /// Which run it was.
    pub run: &'a Run,
    /// How it differs from an earlier one, if that was asked for.
    pub comparison: Option<&'a Comparison>,
}

/// The whole page.
pub fn page(content: &Content<'_>) -> String {
    let Content { lookup, cells, figures, .. } = content;
    let plan = lookup.plan;
    let finished: Vec<usize> = (0..plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty()).collect();
    let lines: Vec<(usize, Line)> = finished.iter().map(|&c| (c, summary::line(lookup, c))).collect();
    let data = json!({
        "columns": details::columns(),
        "cells": finished.par_iter().map(|&c| details::of(lookup, cells, c)).collect::<Vec<_>>(),
        "figures": figures::json(figures),
        "costs": costs::json(lookup, content.costs),
    });
    let main = html! {
        section #answer {
            h2 { "Answer" }
            @if finished.len() < plan.cells.len() {
                p.warn { "Interrupted: " (finished.len()) " of " (plan.cells.len()) " cells finished." }
            }
            (verdicts::counts(lookup, &lines))
            ul { @for sentence in content.answer { li { (sentence) } } }
        }
        section #verdicts { h2 { "Verdicts" } (verdicts::verdicts(&lines)) (verdicts::claims(lookup)) }
        (baseline::section(content.comparison))
        (places::section(lookup))
        (faults::section(lookup))
        (costs::section(lookup, content.costs))
        (figures::section(figures))
        (images::section(lookup, content.pictures))
        section #repeat { h2 { "How to repeat this" } (provenance::section(lookup)) }
        (packed::json("data", &data))
    };
    frame(plan, &main, content.run)
}

/// A page about an experiment: its name and question, and what there is to say.
pub(super) fn frame(plan: &Plan, main: &Markup, run: &Run) -> String {
    let header = html! { h1 { (plan.name) } p.question { (plan.spec.question) } };
    bare(&plan.name, &header, &html! { (main) (provenance::line(run)) })
}

/// Any page.
pub(super) fn bare(title: &str, header: &Markup, main: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "furnace: " (title) }
                style { (PreEscaped(assets::style())) }
            }
            body {
                header { (header) }
                main { (main) }
                script { (PreEscaped(assets::script())) }
            }
        }
    }
    .into_string()
}
