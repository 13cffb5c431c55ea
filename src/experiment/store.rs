//! Where results are kept: written beside the old ones and put in their place only when complete.

use super::cell::Cell;
use super::core::Core;
use super::error::Error;
use super::file;
use super::input::MOST_SAMPLES;
use super::plan::Plan;
use crate::stats::decay::MIN_RUNS;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The finished cells of a run, as stored in `cells.json`.
#[derive(Debug, Serialize, Deserialize)]
pub struct Stored {
    /// Version of this program.
    pub version: String,
    /// The experiment file's text.
    pub spec: String,
    /// The seed of the run.
    pub seed: u64,
    /// Labels of the cells, in the plan's order.
    pub labels: Vec<String>,
    /// Realizations of each cell.
    pub samples: Vec<u64>,
    /// What followed the paths of each cell; the textbook, where nothing is said.
    #[serde(default)]
    pub cores: Vec<Core>,
    /// The cells; `None` where the run was interrupted.
    pub cells: Vec<Option<Cell>>,
    /// Wall-clock seconds of each cell.
    pub seconds: Vec<f64>,
}

/// A folder that receives a run's files.
pub struct Store {
    folder: PathBuf,
    staging: TempDir,
}

/// The stored cells.
const CELLS: &str = "cells.json";

/// Whether a folder holds results of an experiment: all of them, or those that a repository keeps.
fn is_ours(folder: &Path) -> bool {
    let has = |name: &str| folder.join(name).exists();
    has(CELLS) || (has("results.csv") && has("index.html"))
}

impl Store {
    /// Prepares to write `folder`; fails at once, before anything is sampled, if that cannot work.
    pub fn open(folder: &Path) -> Result<Self, Error> {
        let parent = folder.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(parent).map_err(|e| Error::io("cannot create the output folder", parent, e))?;
        if folder.exists() && !is_ours(folder) && !is_empty(folder) {
            return Err(Error::Refused(format!(
                "{} exists and holds no results of an experiment; it will not be overwritten, choose another --out",
                folder.display()
            )));
        }
        let staging = tempfile::Builder::new()
            .prefix(".unfinished-")
            .tempdir_in(parent)
            .map_err(|e| Error::io("cannot write to the output folder", parent, e))?;
        Ok(Store { folder: folder.to_owned(), staging })
    }

    /// Where files are written until [`Store::publish`].
    pub fn path(&self) -> &Path {
        self.staging.path()
    }

    /// Writes one file.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), Error> {
        let path = self.path().join(name);
        fs::write(&path, contents).map_err(|e| Error::io("cannot write", &path, e))
    }

    /// Writes the cells.
    pub fn write_cells(&self, stored: &Stored) -> Result<(), Error> {
        let text = serde_json::to_vec(stored).expect("moments have a JSON form");
        self.write(CELLS, &text)
    }

    /// Puts the complete files in the place of older ones; `name` replaces the folder's own name, if given.
    pub fn publish(self, name: Option<&str>) -> Result<PathBuf, Error> {
        let folder = name.map_or(self.folder.clone(), |name| free(&self.folder, name));
        let staged = self.staging.keep();
        readable(&staged).map_err(|e| Error::io("cannot set permissions of", &staged, e))?;
        let old = staged.with_extension("old");
        if folder.exists() {
            fs::rename(&folder, &old).map_err(|e| Error::io("cannot replace", &folder, e))?;
        }
        fs::rename(&staged, &folder).map_err(|e| Error::io("cannot write", &folder, e))?;
        if old.exists() {
            fs::remove_dir_all(&old).map_err(|e| Error::io("cannot remove", &old, e))?;
        }
        Ok(folder)
    }
}

/// The cells stored in `folder`, if they belong to `plan`, which learns the seed, samples and blocks of their run.
pub fn load(folder: &Path, plan: &mut Plan) -> Result<Stored, Error> {
    let path = folder.join(CELLS);
    let text = file::bytes(&path, file::STORED).map_err(|e| Error::io("cannot read", &path, e))?;
    read(&path, &text, plan)
}

/// As [`load`], from the bytes of the file `path`.
pub fn read(path: &Path, text: &[u8], plan: &mut Plan) -> Result<Stored, Error> {
    let stored: Stored = serde_json::from_slice(text)
        .map_err(|e| Error::Refused(format!("{} is damaged: {e}", path.display())))?;
    let whole = stored.cells.iter().flatten().all(|cell| cell.is_whole() && has_whole_runs(cell));
    let counted = stored.samples.iter().all(|samples| (1..=2 * MOST_SAMPLES as u64).contains(samples));
    if !whole || !counted || stored.samples.len() != stored.cells.len() {
        return Err(Error::Refused(format!(
            "{} is damaged: lists are too short, or numbers none",
            path.display()
        )));
    }
    let labels: Vec<String> = plan.cells.iter().map(|cell| plan.label(cell)).collect();
    if stored.labels != labels || stored.cells.len() != labels.len() {
        return Err(Error::Refused(format!(
            "{} holds other cells than {} plans now; run the experiment again",
            path.display(),
            plan.name
        )));
    }
    plan.spec.seed = stored.seed;
    for (cell, (&samples, kept)) in plan.cells.iter_mut().zip(stored.samples.iter().zip(&stored.cells)) {
        cell.samples = samples;
        let block = kept.as_ref().and_then(|kept| kept.cost.n.checked_div(kept.blocks[0].n));
        cell.block = block.filter(|block| *block > 0).unwrap_or(cell.block);
    }
    for (i, cell) in plan.cells.iter_mut().enumerate() {
        cell.core = stored.cores.get(i).copied().unwrap_or_default();
    }
    Ok(stored)
}

/// Whether all of its runs, if it has some, were looked at as often.
fn has_whole_runs(cell: &Cell) -> bool {
    let looks = cell.traces.first().map_or(1, Vec::len);
    let is_enough = cell.traces.is_empty() || cell.traces.len() >= MIN_RUNS;
    is_enough && (1..64).contains(&looks) && cell.traces.iter().all(|trace| trace.len() == looks)
}

/// The folder `name` beside `folder`, or `name-2` and so on where that one holds something that is not ours.
fn free(folder: &Path, name: &str) -> PathBuf {
    let numbered = (2..).map(|i| folder.with_file_name(format!("{name}-{i}")));
    let mut candidates = std::iter::once(folder.with_file_name(name)).chain(numbered);
    candidates.find(|f| !f.exists() || is_ours(f)).expect("numbers do not end")
}

fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}

/// Temporary folders are private to their owner; results are not.
fn readable(folder: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(folder, fs::Permissions::from_mode(0o755))?;
    }
    let _ = folder;
    Ok(())
}
