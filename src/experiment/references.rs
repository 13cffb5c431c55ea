//! Stored images that an experiment file names: read and held against their scenes before anything is sampled.

use super::cell::TILES;
use super::error::Error;
use super::file::{STORED, bytes};
use super::inside;
use super::plan::CellPlan;
use super::spec::{ReferenceSpec, Spec};
use crate::scene::library::SceneKind;
use crate::truth::{BadReference, Reference};
use std::path::Path;
use std::sync::Arc;

/// A stored image and what it is of.
#[derive(Clone, Debug)]
pub struct NamedReference {
    /// Label of the scene.
    pub scene: String,
    /// Where it was read, as the file names it.
    pub file: String,
    /// The image.
    pub reference: Arc<Reference>,
}

/// Reads all references of a file, whose text is `source`; those that lie outside of its project only if that is allowed.
pub fn load(
    spec: &Spec,
    cells: &[CellPlan],
    file: &Path,
    source: &str,
    outside: bool,
) -> Result<Vec<NamedReference>, Error> {
    let mut all: Vec<NamedReference> = Vec::new();
    for written in &spec.reference {
        let scene = scene_of(written, cells).map_err(|e| Error::at(file, source, written.scene.span(), e))?;
        let at = |message: String| Error::at(file, source, written.file.span(), message);
        let reference = read(written, scene, file, outside).map_err(at)?;
        let name = written.scene.get_ref().clone();
        let independent = |r: &Reference| r.provenance.is_none();
        let second = |r: &NamedReference| r.scene == name && independent(&r.reference);
        if independent(&reference) && all.iter().any(second) {
            let message = format!("`{name}` has a reference already; leave only one of them");
            return Err(Error::at(file, source, written.scene.span(), message));
        }
        let file = written.file.get_ref().display().to_string();
        all.push(NamedReference { scene: name, file, reference: Arc::new(reference) });
    }
    Ok(all)
}

/// The scene of a label; one image cannot be of several.
fn scene_of<'a>(written: &ReferenceSpec, cells: &'a [CellPlan]) -> Result<&'a SceneKind, String> {
    let name = written.scene.get_ref();
    let mut scenes = cells.iter().filter(|cell| cell.scene_label == *name).map(|cell| &cell.scene);
    let Some(first) = scenes.next() else {
        let mut known: Vec<&str> = cells.iter().map(|cell| cell.scene_label.as_str()).collect();
        known.dedup();
        return Err(format!("no scene is called `{name}`; there are: {}", known.join(", ")));
    };
    match scenes.all(|scene| scene == first) {
        true => Ok(first),
        false => Err(format!("several scenes are called `{name}`, and one image cannot be of all of them")),
    }
}

fn read(written: &ReferenceSpec, scene: &SceneKind, file: &Path, outside: bool) -> Result<Reference, String> {
    let path = inside::resolve(file, written.file.get_ref(), outside)?;
    let bad = |why: String| format!("{} is no reference: {why}", path.display());
    let stored = bytes(&path, STORED).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
    let mut reference = Reference::read(&stored).map_err(|e| bad(e.to_string()))?;
    let (width, height) = scene.build().sensor.resolution();
    if width != height {
        return Err(format!("references are square, and this scene's image has {width} x {height} pixels"));
    }
    reference.fits(width as usize, TILES as usize).map_err(|e: BadReference| bad(e.to_string()))?;
    reference.systematic = written.systematic;
    match &reference.provenance {
        Some(provenance) if provenance.scene != *scene => {
            return Err(format!("{} was made for another scene than this one", path.display()));
        }
        Some(_) => {}
        None => reference.df = written.degrees_of_freedom.map_or(reference.df, f64::from),
    }
    Ok(reference)
}
