//! What a journal's blocks are of.

use super::Shard;
use crate::experiment::plan::{CellPlan, Overrides, Plan};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::PathBuf;

/// All that tells whether two journals are of the same run, and that it takes to plan that run again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Version of this program.
    pub version: String,
    /// Of the sources that sample, see `SOURCES`.
    pub sources: String,
    /// The part of the run.
    pub shard: Shard,
    /// Name of the experiment.
    pub name: String,
    /// Its file, as it was named: stored images are looked for from there.
    pub file: PathBuf,
    /// The file's text, with the changes of `--set`.
    pub spec: String,
    /// What the command line changed.
    pub overrides: Overrides,
    /// The seed.
    pub seed: u64,
    /// The cells, in the plan's order.
    pub cells: Vec<OfCell>,
}

/// What is to be known of a cell's blocks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OfCell {
    /// What it is called.
    pub label: String,
    /// Of all that a block is a function of, and its number.
    pub key: String,
    /// Realizations.
    pub samples: u64,
    /// Realizations a block.
    pub block: u64,
    /// Blocks that are kept together.
    pub unit: u64,
    /// Pixels of an image.
    pub pixels: u64,
}

/// A sum of the sources that decide what is sampled and of the crates that they use: who changes an estimator wants none of
/// the blocks of the old one.
pub const SOURCES: &str = env!("FURNACE_SOURCES");

impl Header {
    /// Of a part of a plan, which was made from the text of a file.
    pub fn new(plan: &Plan, file: PathBuf, spec: &str, overrides: Overrides, shard: Shard) -> Self {
        let of_cell = |cell: &CellPlan| OfCell {
            label: plan.label(cell),
            key: key(cell),
            samples: cell.samples,
            block: cell.block,
            unit: cell.unit(),
            pixels: cell.pixels,
        };
        Header {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            sources: SOURCES.to_owned(),
            shard,
            name: plan.name.clone(),
            file,
            spec: spec.to_owned(),
            overrides,
            seed: plan.spec.seed,
            cells: plan.cells.iter().map(of_cell).collect(),
        }
    }

    /// Why blocks of a run with the `other` header are none of this one's; `None` if they are. How many there are to be may
    /// differ, and so may all of the file that has no influence on them.
    pub fn difference(&self, other: &Header) -> Option<String> {
        let differ = |what: &str, ours: &dyn std::fmt::Display, theirs: &dyn std::fmt::Display| {
            Some(format!("{what} {theirs} there and {ours} here"))
        };
        if self.name != other.name {
            return differ("the experiment is", &self.name, &other.name);
        }
        if self.version != other.version {
            return differ("the version of this program is", &self.version, &other.version);
        }
        if self.seed != other.seed {
            return differ("the seed is", &self.seed, &other.seed);
        }
        let (ours, theirs) = (&self.cells, &other.cells);
        if let Some((ours, theirs)) = ours.iter().zip(theirs).find(|(o, t)| o.label != t.label) {
            return differ("a cell is", &ours.label, &theirs.label);
        }
        if ours.len() != theirs.len() {
            return differ("the number of cells is", &ours.len(), &theirs.len());
        }
        let changed = |(o, t): &(&OfCell, &OfCell)| (&o.key, o.block, o.unit) != (&t.key, t.block, t.unit);
        if let Some((ours, theirs)) = ours.iter().zip(theirs).find(changed) {
            let label = &ours.label;
            if ours.block != theirs.block {
                return differ(
                    &format!("the realizations of a block of `{label}` are"),
                    &ours.block,
                    &theirs.block,
                );
            }
            return Some(match first_difference(&self.spec, &other.spec) {
                Some((line, ours, theirs)) => {
                    format!("`{label}` is another: line {line} of the file was `{theirs}` and is `{ours}`")
                }
                None => format!("`{label}` is another, after other options"),
            });
        }
        (self.sources != other.sources)
            .then(|| "the program was built from other sources, and may sample something else".to_owned())
    }
}

/// Of all that a cell's blocks are functions of.
fn key(cell: &CellPlan) -> String {
    let CellPlan { scene, estimator, fault, core, block, pixels, address, streams, traced, .. } = cell;
    let fault = fault.map(|fault| fault.name);
    let all = format!("{:?}", (scene, estimator, fault, core, block, pixels, address, streams, traced));
    Sha256::digest(all).iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

/// The first line that differs: its number, what it is in one text and in the other.
fn first_difference<'a>(ours: &'a str, theirs: &'a str) -> Option<(usize, &'a str, &'a str)> {
    let (mut ours, mut theirs) = (ours.lines(), theirs.lines());
    (1..)
        .map_while(|line| Some((line, ours.next(), theirs.next())))
        .take_while(|(_, o, t)| o.is_some() || t.is_some())
        .find(|(_, o, t)| o != t)
        .map(|(line, o, t)| (line, o.unwrap_or("").trim(), t.unwrap_or("").trim()))
}
