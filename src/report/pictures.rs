//! The images of a run: EXR files with everything in them, PNG files to look at, and what the page shows of the former.

use super::metrics::{self, Image, Metrics};
use super::raster::Raster;
use super::{difference, figure, images, plots};
use crate::experiment::store::Store;
use crate::experiment::{Cell, Error, Plan, file};
use crate::scene::Rgb;
use crate::truth::{Reference, Truth};
use rayon::prelude::*;
use std::io;
use std::path::Path;

/// An image as the page shows it: a function of its EXR file and of the references of the plan.
pub struct Picture {
    /// The cell, by its index.
    pub cell: usize,
    /// File name without extension.
    pub name: String,
    /// What the EXR file holds.
    pub raster: Raster,
    /// The stored image against which it is shown, if there is one.
    pub reference: Option<Raster>,
    /// How far it is from the reference, on the grid of that; `None` where there is none or not all pixels are numbers.
    pub metrics: Option<Metrics>,
    /// Whether a map of its difference from the reference lies beside it.
    pub has_map: bool,
}

impl Picture {
    /// Compares it with its reference on the grid that both have.
    fn measure(&mut self) {
        let Some(reference) = &self.reference else { return };
        let ours = self.raster.reduced(self.raster.width / reference.width);
        let [mean, error, right, noise] = &[ours.rgb(), reference.rgb()].concat()[..] else { return };
        let is_finite = |pixels: &Vec<Rgb>| pixels.iter().all(|pixel| pixel.is_finite());
        if [mean, error, right, noise].into_iter().all(is_finite) {
            let (width, height) = (ours.width, ours.height);
            let image = Image { width, height, pixels: mean, std_error: Some(error) };
            self.metrics = Some(metrics::of(image, Image { pixels: right, std_error: Some(noise), ..image }));
        }
    }
}

/// What follows an image's name in the name of its difference map.
pub const MAP: &str = "_difference.png";

/// Writes the images of all cells into `store`. Rebuilding a report samples nothing: then they are those of the run, which
/// lie in `folder`.
pub fn write(
    plan: &Plan,
    cells: &[Option<Cell>],
    store: &Store,
    folder: Option<&Path>,
) -> Result<Vec<Picture>, Error> {
    let mut pictures = Vec::new();
    for (i, cell) in with_images(plan, cells) {
        let (name, truth) = (image_name(plan, i), plan.truth(&plan.cells[i]));
        let file = format!("{name}.exr");
        let exr = match folder {
            Some(folder) => read(folder, &file)?,
            None => images::exr(&cell.pixels, truth.reference()).map_err(|e| failed(store, &e))?,
        };
        store.write(&file, &exr)?;
        let size = resolution(plan, i);
        let raster = Raster::read(&exr, size).map_err(|why| {
            let path = folder.unwrap_or(store.path()).join(&file);
            let advice = "run the experiment again";
            Error::Refused(format!("{} is not the image of this run: {why}; {advice}", path.display()))
        })?;
        let reference = truth.reference().and_then(|reference| Raster::of_reference(reference, size));
        let has_map = mapped(plan, i, &truth).is_some();
        pictures.push(Picture { cell: i, name, raster, reference, metrics: None, has_map });
    }
    pictures.par_iter_mut().for_each(Picture::measure);
    match folder {
        Some(folder) => copy_previews(&pictures, store, folder)?,
        None => draw_previews(plan, cells, &pictures, store)?,
    }
    Ok(pictures)
}

/// One exposure for all: pictures of a scene are there to be compared.
pub fn exposure(pictures: &[Picture]) -> f64 {
    pictures.iter().map(|picture| picture.raster.exposure()).reduce(f64::min).unwrap_or(1.0)
}

fn draw_previews(
    plan: &Plan,
    cells: &[Option<Cell>],
    pictures: &[Picture],
    store: &Store,
) -> Result<(), Error> {
    let exposure = exposure(pictures);
    figure::font::register().map_err(|e| failed(store, &e))?;
    for picture in pictures {
        let Some(cell) = &cells[picture.cell] else { continue };
        store.write(&format!("{}.png", picture.name), &images::png(&cell.pixels, exposure))?;
        if let Some(reference) = mapped(plan, picture.cell, &plan.truth(&plan.cells[picture.cell])) {
            store.write(&format!("{}{MAP}", picture.name), &difference::map(&cell.pixels, reference))?;
        }
    }
    Ok(())
}

fn copy_previews(pictures: &[Picture], store: &Store, folder: &Path) -> Result<(), Error> {
    let copy = |file: String| store.write(&file, &read(folder, &file)?);
    for picture in pictures {
        copy(format!("{}.png", picture.name))?;
        if picture.has_map {
            copy(format!("{}{MAP}", picture.name))?;
        }
    }
    Ok(())
}

fn read(folder: &Path, file: &str) -> Result<Vec<u8>, Error> {
    let path = folder.join(file);
    file::bytes(&path, file::STORED).map_err(|e| Error::io("cannot read", &path, e))
}

fn failed(store: &Store, error: &dyn std::error::Error) -> Error {
    Error::io("cannot write to", store.path(), io::Error::other(error.to_string()))
}

/// Indices of the cells that have an image.
fn with_images<'a>(plan: &'a Plan, cells: &'a [Option<Cell>]) -> impl Iterator<Item = (usize, &'a Cell)> {
    let cells = cells.iter().enumerate().filter_map(|(i, cell)| Some((i, cell.as_ref()?)));
    cells.filter(|&(i, cell)| plan.cells[i].pixels > 1 && cell.failure.is_none())
}

/// A cell's file name; with its number where another cell's label differs only in what file names cannot hold.
fn image_name(plan: &Plan, cell: usize) -> String {
    let name = |i: usize| plots::file_name(&[&plan.label(&plan.cells[i])]);
    let taken = (0..plan.cells.len()).any(|other| other != cell && name(other) == name(cell));
    if taken { format!("{}_{cell}", name(cell)) } else { name(cell) }
}

fn resolution(plan: &Plan, cell: usize) -> (usize, usize) {
    let (width, height) = plan.cells[cell].scene.build().sensor.resolution();
    (width as usize, height as usize)
}

/// The stored image against which a cell's image gets a difference map.
fn mapped<'a>(plan: &Plan, cell: usize, truth: &'a Truth) -> Option<&'a Reference> {
    let (width, height) = resolution(plan, cell);
    truth.reference().filter(|_| width == height)
}
