//! Where finished blocks are kept while a run goes on, so that whatever ends it, the next one goes on from there.
//!
//! A journal is a file of lines, each with its checksum, that is only ever appended to: first a [`Header`], which says what
//! is sampled, then the blocks as they are finished. Whole runs write `1-of-1.journal`, shards `3-of-16.journal`; any set of
//! them is read as [`Kept`] blocks. What a torn write or a rotten disk has damaged is recognised by its checksum and sampled
//! again.

mod header;
mod kept;
mod line;
mod scan;
mod write;

pub use header::{Header, OfCell};
pub use kept::{Found, Kept, Overlap, expected};
pub use line::Line;
pub use scan::{Damage, Scan, scan, scan_all};
pub use write::{Journal, Start, is_written};

use super::error::Error;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A part of a run: the units of a cell go round among the parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Shard {
    /// From 1.
    pub number: u64,
    /// Of so many.
    pub count: u64,
}

impl Shard {
    /// All of a run.
    pub const WHOLE: Shard = Shard { number: 1, count: 1 };

    /// Whether a unit of a cell belongs to this part, however many units there are. Cells begin with different parts, at steps
    /// of the golden ratio, or the first parts would have more.
    pub fn owns(&self, cell: usize, unit: u64) -> bool {
        const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
        let share = u128::from((cell as u64).wrapping_mul(GOLDEN)) * u128::from(self.count);
        (u128::from(unit) + (share >> 64)) % u128::from(self.count) == u128::from(self.number - 1)
    }

    /// The name of its journal.
    fn file(&self) -> String {
        format!("{}-of-{}.{EXTENSION}", self.number, self.count)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((number, count)) if (1..=count).contains(&number) => Ok(Shard { number, count }),
            Some((_, count)) if count > 0 => {
                Err(format!("shards are counted from 1/{count} to {count}/{count}"))
            }
            _ => Err("a shard is written as 3/16: the third of sixteen".to_owned()),
        }
    }
}

/// Blocks by their numbers.
pub fn named(blocks: &Range<u64>) -> String {
    match blocks.end - blocks.start {
        1 => format!("block {}", blocks.start),
        _ => format!("blocks {} to {}", blocks.start, blocks.end - 1),
    }
}

/// What names of journals and of their folders end with.
const EXTENSION: &str = "journal";

/// The folder of an experiment's journals, beside that of its results.
pub fn folder(results: &Path) -> PathBuf {
    let mut name = results.file_name().unwrap_or_default().to_owned();
    name.push(".");
    name.push(EXTENSION);
    results.with_file_name(name)
}

/// All journals of a folder, by name.
///
/// # Errors
///
/// When it cannot be read, or holds none.
pub fn all(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let failed = |e| Error::io("cannot read", folder, e);
    let entries = fs::read_dir(folder).map_err(failed)?;
    let paths = entries.map(|entry| Ok(entry.map_err(failed)?.path())).collect::<Result<Vec<_>, Error>>()?;
    let is_journal = |path: &PathBuf| path.extension().is_some_and(|e| e == EXTENSION) && path.is_file();
    let mut journals: Vec<PathBuf> = paths.into_iter().filter(is_journal).collect();
    journals.sort();
    match journals.is_empty() {
        true => Err(Error::Refused(format!("{} holds no journals", folder.display()))),
        false => Ok(journals),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_all_units_evenly() {
        for count in [1, 2, 3, 16] {
            let shards = (1..=count).map(|number| Shard { number, count });
            let owned = shards.map(|s| (0..5).flat_map(|c| (0..7).filter(move |u| s.owns(c, *u))).count());
            let owned: Vec<usize> = owned.collect();
            assert_eq!(owned.iter().sum::<usize>(), 35);
            assert!(owned.iter().max().unwrap() - owned.iter().min().unwrap() <= 2, "{owned:?}");
        }
    }

    #[test]
    fn shards_are_written_as_fractions() {
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, count: 16 }));
        assert_eq!(Shard { number: 3, count: 16 }.to_string(), "3/16");
        for (text, why) in [
            ("0/4", "counted from 1/4 to 4/4"),
            ("5/4", "counted from 1/4 to 4/4"),
            ("1/0", "written as 3/16"),
            ("3", "written as 3/16"),
            ("a/b", "written as 3/16"),
            ("-1/4", "written as 3/16"),
        ] {
            assert!(text.parse::<Shard>().unwrap_err().contains(why), "{text}");
        }
    }
}
