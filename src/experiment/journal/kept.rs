//! Blocks that journals hold, found by cell and number.

use super::line::{Line, unescape};
use super::named;
use super::scan::{Place, Scan};
use crate::experiment::error::Error;
use crate::experiment::guard::Failure;
use crate::experiment::plan::CellPlan;
use crate::experiment::unit::Unit;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Blocks of one or several journals.
#[derive(Debug, Default)]
pub struct Kept {
    journals: Vec<PathBuf>,
    /// Of each cell, by the number of the first block and then by how many there are.
    places: Vec<Vec<Place>>,
    failures: Vec<(usize, Failure)>,
    labels: Vec<String>,
    readers: Readers,
    line: Vec<u8>,
    other: Vec<u8>,
    bytes: Vec<u8>,
}

/// What there is of some blocks.
#[derive(Debug)]
pub enum Found {
    /// They are there.
    Unit(Unit),
    /// One of them could not be made.
    Failed(Failure),
    /// Some of them are missing.
    Missing,
}

/// Blocks that two journals have.
#[derive(Debug, Default)]
pub struct Overlap {
    /// How many units.
    pub units: u64,
    /// The first of them: its cell, its blocks, and where they are.
    pub first: Option<(usize, Range<u64>, [PathBuf; 2])>,
}

impl Kept {
    /// All blocks of these journals, which must be of the same run, and which of them several hold.
    ///
    /// # Errors
    ///
    /// When two of them hold the same blocks with other numbers.
    pub fn join(scans: Vec<Scan>) -> Result<(Self, Overlap), Error> {
        let labels =
            scans.first().map(|scan| scan.header.cells.iter().map(|cell| cell.label.clone()).collect());
        let labels: Vec<String> = labels.unwrap_or_default();
        let cells = labels.len();
        let mut kept = Kept { places: vec![Vec::new(); cells], labels, ..Kept::default() };
        for scan in scans {
            let journal = kept.journals.len() as u32;
            for place in scan.places {
                kept.places[place.cell as usize].push(Place { journal, ..place });
            }
            kept.failures.extend(scan.failures);
            kept.journals.push(scan.path);
        }
        kept.readers.room = (READERS / kept.journals.len().max(1)).clamp(1 << 14, 1 << 20);
        let mut overlap = Overlap::default();
        for cell in 0..cells {
            let mut places = std::mem::take(&mut kept.places[cell]);
            places.sort_by_key(|place| (place.first, place.count));
            let mut at = 0;
            let same = |a: &Place, b: &Place| (a.first, a.count) == (b.first, b.count);
            for i in 1..places.len() {
                if same(&places[at], &places[i]) {
                    kept.agree(&places[at], &places[i])?;
                    overlap.note(&kept.journals, &places[at], &places[i]);
                } else {
                    at += 1;
                    places[at] = places[i];
                }
            }
            places.truncate(at + 1);
            places.shrink_to_fit();
            kept.places[cell] = places;
        }
        Ok((kept, overlap))
    }

    /// Makes room for so many cells.
    pub(super) fn cells(&mut self, count: usize) {
        self.places.resize(count, Vec::new());
    }

    /// How many blocks of a cell there are.
    pub fn count(&self, index: usize, cell: &CellPlan) -> u64 {
        let fits = |place: &&Place| place.numbers() == expected(cell, place.first);
        self.places[index].iter().filter(fits).map(|place| u64::from(place.count)).sum()
    }

    /// Whether these blocks are there.
    pub fn has(&self, cell: usize, numbers: &Range<u64>) -> bool {
        self.place(cell, numbers).is_some()
    }

    fn place(&self, cell: usize, numbers: &Range<u64>) -> Option<Place> {
        let count = u32::try_from(numbers.end - numbers.start).ok()?;
        let places = self.places.get(cell)?;
        let found = places.binary_search_by_key(&(numbers.start, count), |place| (place.first, place.count));
        Some(places[found.ok()?])
    }

    /// Reads these blocks of a cell of the plan, by its index.
    ///
    /// # Errors
    ///
    /// When a journal cannot be read any more, or holds something else there.
    pub fn unit(&mut self, index: usize, cell: &CellPlan, numbers: &Range<u64>) -> Result<Found, Error> {
        let Some(place) = self.place(index, numbers) else {
            let failed = self.failures.iter().find(|(c, f)| *c == index && numbers.contains(&f.block));
            return Ok(failed.map_or(Found::Missing, |(_, failure)| Found::Failed(failure.clone())));
        };
        let path = &self.journals[place.journal as usize];
        self.readers.read(path, &place, &mut self.line)?;
        let unit = match Line::read(&self.line) {
            Some(Line::Blocks { bytes, .. }) => {
                unescape(bytes, &mut self.bytes).and_then(|()| Unit::read(cell, numbers, &self.bytes))
            }
            _ => None,
        };
        unit.map(Found::Unit).ok_or_else(|| {
            let (line, path) = (place.line, path.display());
            Error::Refused(format!(
                "{path}: line {line} holds no blocks of this run, or has changed since it was read"
            ))
        })
    }

    /// Whether two lines hold the same.
    fn agree(&mut self, a: &Place, b: &Place) -> Result<(), Error> {
        let [ours, theirs] = [a, b].map(|place| self.journals[place.journal as usize].clone());
        self.readers.read(&ours, a, &mut self.line)?;
        self.readers.read(&theirs, b, &mut self.other)?;
        if self.line == self.other {
            return Ok(());
        }
        let blocks = named(&a.numbers());
        Err(Error::Refused(format!(
            "{blocks} of `{}` in {} (line {}) and in {} (line {}) have other numbers: one of them is wrong",
            self.labels[a.cell as usize],
            ours.display(),
            a.line,
            theirs.display(),
            b.line
        )))
    }
}

/// The unit of a cell that begins with a block.
pub fn expected(cell: &CellPlan, first: u64) -> Range<u64> {
    first..first.saturating_add(cell.unit()).min(cell.blocks()).max(first)
}

impl Overlap {
    fn note(&mut self, journals: &[PathBuf], a: &Place, b: &Place) {
        self.units += 1;
        let paths = [a, b].map(|place| journals[place.journal as usize].clone());
        self.first.get_or_insert((a.cell as usize, a.numbers(), paths));
    }
}

/// Bytes that all readers together hold.
const READERS: usize = 1 << 26;

/// Journals that are open at the same time.
const OPEN: usize = 200;

/// Journals that are being read.
#[derive(Debug, Default)]
struct Readers {
    open: HashMap<PathBuf, BufReader<File>>,
    /// Bytes that each holds.
    room: usize,
}

impl Readers {
    /// Reads a line.
    fn read(&mut self, path: &Path, place: &Place, line: &mut Vec<u8>) -> Result<(), Error> {
        let failed = |e| Error::io("cannot read", path, e);
        if !self.open.contains_key(path) {
            // lines follow each other, mostly: whichever is closed, it is opened again when its turn comes
            if self.open.len() == OPEN {
                self.open.clear();
            }
            let file = File::open(path).map_err(failed)?;
            self.open.insert(path.to_owned(), BufReader::with_capacity(self.room, file));
        }
        let reader = self.open.get_mut(path).expect("it is open");
        let here = reader.stream_position().map_err(failed)?;
        reader.seek_relative(place.offset as i64 - here as i64).map_err(failed)?;
        line.resize(place.length as usize, 0);
        reader.read_exact(line).map_err(failed)
    }
}
