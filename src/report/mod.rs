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
pub mod json;
pub mod lookup;
mod mistakes;
pub mod mitsuba;
mod number;
mod page;
pub mod plots;
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
use crate::truth::{Reference, Truth};
use page::{Drawn, Picture};
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
    let pictures = match images {
        None => draw_images(plan, cells, store)?,
        Some(folder) => copy_images(plan, cells, store, folder)?,
    };
    let answer = answer::sentences(&lookup);
    store.write("index.html", page::page(&lookup, cells, &answer, &drawn, &pictures).as_bytes())
}

fn failed(store: &Store, error: &dyn std::error::Error) -> Error {
    Error::io("cannot write to", store.path(), io::Error::other(error.to_string()))
}

/// Indices of the cells that have an image.
fn with_images<'a>(plan: &'a Plan, cells: &'a [Option<Cell>]) -> impl Iterator<Item = (usize, &'a Cell)> {
    let cells = cells.iter().enumerate().filter_map(|(i, cell)| Some((i, cell.as_ref()?)));
    cells.filter(|&(i, _)| plan.cells[i].pixels > 1)
}

/// A cell's file name; with its number where another cell's label differs only in what file names cannot hold.
fn image_name(plan: &Plan, cell: usize) -> String {
    let name = |i: usize| plots::file_name(&[&plan.label(&plan.cells[i])]);
    let taken = (0..plan.cells.len()).any(|other| other != cell && name(other) == name(cell));
    if taken { format!("{}_{cell}", name(cell)) } else { name(cell) }
}

fn draw_images(plan: &Plan, cells: &[Option<Cell>], store: &Store) -> Result<Vec<Picture>, Error> {
    let mut pictures = Vec::new();
    // one exposure for all: pictures of a scene are there to be compared
    let exposure = with_images(plan, cells).map(|(_, cell)| images::exposure(&cell.pixels)).reduce(f64::min);
    figure::font::register().map_err(|e| failed(store, &e))?;
    for (i, cell) in with_images(plan, cells) {
        let name = image_name(plan, i);
        let truth = plan.truth(&plan.cells[i]);
        let exr = images::exr(&cell.pixels, truth.reference()).map_err(|e| failed(store, &e))?;
        store.write(&format!("{name}.exr"), &exr)?;
        let png = images::png(&cell.pixels, exposure.unwrap_or(1.0));
        store.write(&format!("{name}.png"), &png)?;
        let map = mapped(plan, i, &truth).map(|reference| difference::map(&cell.pixels, reference));
        if let Some(map) = &map {
            store.write(&format!("{name}{MAP}"), map)?;
        }
        pictures.push(Picture { label: plan.label(&plan.cells[i]), name, png, map });
    }
    Ok(pictures)
}

/// What follows an image's name in the name of its difference map.
const MAP: &str = "_difference.png";

/// The stored image against which a cell's image gets a difference map.
fn mapped<'a>(plan: &Plan, cell: usize, truth: &'a Truth) -> Option<&'a Reference> {
    let (width, height) = plan.cells[cell].scene.build().sensor.resolution();
    truth.reference().filter(|_| width == height)
}

/// Rebuilding a report samples nothing, so the images are those of the run.
fn copy_images(
    plan: &Plan,
    cells: &[Option<Cell>],
    store: &Store,
    folder: &Path,
) -> Result<Vec<Picture>, Error> {
    let mut pictures = Vec::new();
    for (i, _) in with_images(plan, cells) {
        let name = image_name(plan, i);
        let copy = |file: String| {
            let path = folder.join(&file);
            let bytes = std::fs::read(&path).map_err(|e| Error::io("cannot read", &path, e))?;
            store.write(&file, &bytes).map(|()| bytes)
        };
        copy(format!("{name}.exr"))?;
        let png = copy(format!("{name}.png"))?;
        let has_map = mapped(plan, i, &plan.truth(&plan.cells[i])).is_some();
        let map = has_map.then(|| copy(format!("{name}{MAP}"))).transpose()?;
        pictures.push(Picture { label: plan.label(&plan.cells[i]), name, png, map });
    }
    Ok(pictures)
}
