//! What people write: experiment files, and changes of them.

use super::{NOWHERE, SMALL, says_where};
use furnace::experiment::{Overrides, Plan};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

#[path = "../../../src/bin/experiment/set.rs"]
mod set;

fn file() -> PathBuf {
    Path::new(NOWHERE).join("hostile.toml")
}

/// An experiment file, up to the point where it would be sampled.
pub fn experiment(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let plan = match Plan::new("hostile", &file(), text, &Overrides::default()) {
        Ok(plan) => plan,
        Err(error) => return says_where(&error, &file()),
    };
    let labels: BTreeSet<String> = plan.cells.iter().map(|cell| plan.label(cell)).collect();
    assert_eq!(labels.len(), plan.cells.len(), "two cells of one name");
    for cell in &plan.cells {
        assert!(cell.block > 0 && cell.samples >= 2 && cell.samples.is_multiple_of(cell.block));
        assert!(cell.total_rays() <= 1e11, "{} rays are out of proportion", cell.total_rays());
    }
    // a cell alone has the samples that it has among the others
    let first = &plan.cells[0];
    let only = Overrides { only: Some(plan.label(first)), ..Overrides::default() };
    let alone = Plan::new("hostile", &file(), text, &only).expect("each cell can be run alone");
    assert_eq!((alone.cells[0].samples, alone.cells[0].block), (first.samples, first.block));
}

/// Values of `--set`, a line each, that change the small experiment.
pub fn set(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let changes: Vec<String> = text.lines().map(str::to_owned).collect();
    let changed = match set::all(&file(), SMALL.to_owned(), &changes) {
        Ok(changed) => changed,
        Err(error) => return says_where(&error, Path::new("--set")),
    };
    let again = set::all(&file(), changed.clone(), &changes[changes.len().saturating_sub(1)..]);
    assert_eq!(again.ok().as_ref(), Some(&changed), "the last change once more changes something");
    if let Err(error) = Plan::new("hostile", &file(), &changed, &Overrides::default()) {
        says_where(&set::blame(error, &changes), &file());
    }
}
