//! From verdicts to things to read: CSV, figures, images, a page. Samples nothing.

pub mod answer;
mod axes;
pub mod baseline;
mod budget;
mod compare;
pub mod costs;
mod curves;
mod decline;
pub mod difference;
mod family;
pub mod figure;
mod forest;
pub mod images;
pub mod json;
pub mod latex;
pub mod lookup;
pub mod metrics;
mod mistakes;
pub mod mitsuba;
mod number;
pub mod overview;
mod page;
mod pictures;
pub mod plots;
pub mod raster;
pub mod replay;
pub mod run;
mod shares;
pub mod study;
mod summary;
pub mod table;
mod technique;
pub mod terminal;
mod tilemap;
mod wrong;

pub use lookup::Lookup;

use crate::experiment::baseline::Comparison;
use crate::experiment::store::Store;
use crate::experiment::{Cell, Error, Plan, Row};
use crate::stats::Verdict;
use overview::Summary;
use page::{Content, Drawn};
use rayon::prelude::*;
use run::Run;
use std::io;
use std::path::Path;

/// Writes everything that follows from the cells into `store`; `images` of an earlier run are taken over from there, and
/// `comparison` is what has changed since a baseline.
pub fn write(
    plan: &Plan,
    cells: &[Option<Cell>],
    rows: &[Row],
    run: &Run,
    store: &Store,
    images: Option<&Path>,
    comparison: Option<&Comparison>,
) -> Result<(), Error> {
    let lookup = Lookup::new(plan, rows);
    store.write(run::FILE, run.text().as_bytes())?;
    store.write("timing.csv", &table::timing(plan, cells, &run.seconds, rows))?;
    store.write("results.csv", &table::results(plan, cells, rows))?;
    if cells.iter().flatten().any(|cell| !cell.traces.is_empty()) {
        store.write("convergence.csv", &decline::csv(plan, cells))?;
    }
    if let Some(comparison) = comparison {
        store.write("baseline.csv", &baseline::csv(comparison))?;
    }
    let named = plots::figures(&lookup, cells).into_iter();
    let drawn: Vec<Drawn> = named.map(|plots::Named { name, figure }| Drawn { name, figure }).collect();
    let draw = |drawn: &Drawn| figure::write(&drawn.figure, &store.path().join(&drawn.name));
    let pictures = pictures::write(plan, cells, store, images)?;
    let answer = answer::sentences(&lookup);
    let figure = drawn.first().map(|drawn| format!("{}.svg", drawn.name));
    store.write(overview::FILE, summary(&lookup, &answer, figure).text().as_bytes())?;
    let costs = costs::of(&lookup, &pictures);
    if let Some(csv) = costs::csv(&lookup, &costs) {
        store.write("pictures.csv", &csv)?;
    }
    let content = Content {
        lookup: &lookup,
        cells,
        answer: &answer,
        costs: &costs,
        figures: &drawn,
        pictures: &pictures,
        run,
        comparison,
    };
    let (written, page) = rayon::join(|| drawn.par_iter().try_for_each(draw), || page::page(&content));
    written.map_err(|e| failed(store, &e))?;
    store.write("index.html", page.as_bytes())
}

fn summary(lookup: &Lookup<'_>, answer: &[String], figure: Option<String>) -> Summary {
    let finished: Vec<usize> = (0..lookup.plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty()).collect();
    // mistakes are there to be caught: the answer tells of them
    let sound = || finished.iter().filter(|&&cell| !lookup.is_faulty(cell));
    let count = |verdict| sound().filter(|&&cell| lookup.verdict(cell) == Some(verdict)).count();
    let verdicts = [Verdict::Invalid, Verdict::Fail, Verdict::Inconclusive, Verdict::Pass];
    Summary {
        experiment: lookup.plan.name.clone(),
        question: lookup.plan.spec.question.clone(),
        answer: answer.to_vec(),
        cells: finished.len(),
        verdicts: verdicts.map(|v| (v, count(v))).into_iter().filter(|(_, n)| *n > 0).collect(),
        figure,
    }
}

fn failed(store: &Store, error: &dyn std::error::Error) -> Error {
    Error::io("cannot write to", store.path(), io::Error::other(error.to_string()))
}
