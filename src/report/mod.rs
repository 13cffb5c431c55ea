//! From verdicts to things to read: CSV, figures, images, a page. Samples nothing.

pub mod answer;
mod axes;
mod budget;
mod compare;
mod curves;
mod decline;
pub mod difference;
mod family;
pub mod figure;
mod forest;
pub mod images;
pub mod lookup;
mod mistakes;
pub mod mitsuba;
mod number;
mod page;
mod pictures;
pub mod plots;
pub mod raster;
mod replay;
mod shares;
pub mod study;
mod summary;
pub mod table;
mod technique;
pub mod terminal;
mod tilemap;
mod wrong;

pub use lookup::Lookup;

use crate::experiment::store::Store;
use crate::experiment::{Cell, Error, Plan, Row};
use page::Drawn;
use std::io;
use std::path::Path;

/// Writes everything that follows from the cells into `store`; `images` of an earlier run are taken over from there.
pub fn write(
    plan: &Plan,
    cells: &[Option<Cell>],
    rows: &[Row],
    store: &Store,
    images: Option<&Path>,
) -> Result<(), Error> {
    let lookup = Lookup::new(plan, rows);
    store.write("results.csv", &table::results(plan, cells, rows))?;
    if cells.iter().flatten().any(|cell| !cell.traces.is_empty()) {
        store.write("convergence.csv", &decline::csv(plan, cells))?;
    }
    let mut drawn = Vec::new();
    for plots::Named { name, figure } in plots::figures(&lookup, cells) {
        let svg = figure::write(&figure, &store.path().join(&name)).map_err(|e| failed(store, &e))?;
        drawn.push(Drawn { name, svg });
    }
    let pictures = pictures::write(plan, cells, store, images)?;
    let answer = answer::sentences(&lookup);
    store.write("index.html", page::page(&lookup, cells, &answer, &drawn, &pictures).as_bytes())
}

fn failed(store: &Store, error: &dyn std::error::Error) -> Error {
    Error::io("cannot write to", store.path(), io::Error::other(error.to_string()))
}
