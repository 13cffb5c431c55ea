//! Reads a journal from beginning to end and notes where everything is, without keeping it.

use super::header::Header;
use super::line::Line;
use crate::experiment::error::Error;
use crate::experiment::guard::Failure;
use rayon::prelude::*;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Take};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What a journal holds.
#[derive(Debug)]
pub struct Scan {
    /// The file.
    pub path: PathBuf,
    /// Its last header.
    pub header: Header,
    /// Where blocks are, in the order of lines.
    pub places: Vec<Place>,
    /// Blocks that could not be made, with their cells, since the last header.
    pub failures: Vec<(usize, Failure)>,
    /// Seconds spent on each cell.
    pub seconds: Vec<f64>,
    /// Whether the last run came to its end.
    pub ended: bool,
    /// What could not be read.
    pub damage: Damage,
}

/// Where a line of blocks is.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The cell.
    pub cell: u32,
    /// Number of its first block.
    pub first: u64,
    /// How many there are.
    pub count: u32,
    /// Its number, from 1.
    pub line: u32,
    /// Bytes before it.
    pub offset: u64,
    /// Its bytes.
    pub length: u32,
    /// The journal, by its index among those that are read together.
    pub journal: u32,
}

impl Place {
    /// The numbers of its blocks.
    pub fn numbers(&self) -> Range<u64> {
        self.first..self.first + u64::from(self.count)
    }
}

/// Lines that cannot be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Damage {
    /// How many there are before the last one that can be.
    pub lines: usize,
    /// Where the last one that can be read ends: what follows is torn.
    pub end: u64,
    /// Bytes of what follows.
    pub torn: u64,
}

impl Damage {
    /// What is to be said of it; `None` if there is none.
    pub fn told(&self, path: &Path) -> Option<String> {
        let Damage { lines, torn, .. } = *self;
        let lost = match (lines, torn) {
            (0, 0) => return None,
            (0, torn) => format!("its last {torn} bytes are torn"),
            (1, 0) => "a line is damaged".to_owned(),
            (lines, 0) => format!("{lines} lines are damaged"),
            (lines, torn) => format!("{lines} lines are damaged, and its last {torn} bytes are torn"),
        };
        Some(format!("{}: {lost}; nothing else is lost", path.display()))
    }
}

/// A header is no longer than this.
const LONGEST_HEADER: u64 = 1 << 26;

/// Bytes of a block at most, without pixels.
const LONGEST_BLOCK: u64 = 1 << 17;

/// Reads a journal.
///
/// # Errors
///
/// When the file cannot be read, or does not begin with a header that can be.
pub fn scan(path: &Path) -> Result<Scan, Error> {
    let failed = |e| Error::io("cannot read", path, e);
    let file = File::open(path).map_err(failed)?;
    let mut reader = BufReader::with_capacity(1 << 20, file).take(0);
    let mut line = Vec::new();
    let mut read = |line: &mut Vec<u8>, longest| next(&mut reader, line, longest).map_err(failed);
    read(&mut line, LONGEST_HEADER)?;
    let header = header_of(&line).ok_or_else(|| {
        let why = "its first line is none of a journal of this version, or is damaged";
        Error::Refused(format!("{}: {why}; --fresh starts over", path.display()))
    })?;
    let mut scan = Scan {
        path: path.to_owned(),
        seconds: vec![0.0; header.cells.len()],
        header,
        places: Vec::new(),
        failures: Vec::new(),
        ended: false,
        damage: Damage::default(),
    };
    let (mut offset, mut bad) = (line.len() as u64, 0);
    scan.damage.end = offset;
    for number in 2.. {
        let longest = longest(&scan.header);
        read(&mut line, longest)?;
        if line.is_empty() {
            break;
        }
        let length = line.len() as u64;
        match Line::read(&line).and_then(|line| scan.take(&line, number, offset, length)) {
            Some(()) => {
                scan.damage.lines += std::mem::take(&mut bad);
                scan.damage.end = offset + length;
            }
            None => bad += 1,
        }
        offset += length;
    }
    scan.damage.torn = offset - scan.damage.end;
    Ok(scan)
}

/// Reads several journals, a thread each as far as there are processors.
///
/// # Errors
///
/// The first one of [`scan`].
pub fn scan_all(paths: &[PathBuf]) -> Result<Vec<Scan>, Error> {
    paths.par_iter().map(|path| scan(path)).collect()
}

/// The next line, or as much of it as there may be.
fn next(reader: &mut Take<BufReader<File>>, line: &mut Vec<u8>, longest: u64) -> std::io::Result<()> {
    line.clear();
    reader.set_limit(longest);
    reader.read_until(b'\n', line)?;
    Ok(())
}

/// The longest line of blocks: escapes may double it.
fn longest(header: &Header) -> u64 {
    let of_cell = header.cells.iter().map(|cell| {
        let pixels = cell.pixels.min(1 << 32) * 48;
        2 * (cell.unit.min(1 << 10) * LONGEST_BLOCK + pixels)
    });
    of_cell.max().unwrap_or(0).max(LONGEST_HEADER)
}

fn header_of(line: &[u8]) -> Option<Header> {
    match Line::read(line)? {
        Line::Header(json) => serde_json::from_slice(json).ok(),
        _ => None,
    }
}

impl Scan {
    /// Takes a line; `None` if it does not belong here.
    fn take(&mut self, line: &Line<'_>, number: u32, offset: u64, length: u64) -> Option<()> {
        match line {
            Line::Header(json) => {
                let header: Header = serde_json::from_slice(json).ok()?;
                if self.header.difference(&header).is_some() || self.header.shard != header.shard {
                    return None;
                }
                self.header = header;
                self.failures.clear();
                self.ended = false;
            }
            Line::Blocks { cell, numbers, .. } => {
                self.header.cells.get(*cell)?;
                self.places.push(Place {
                    cell: *cell as u32,
                    first: numbers.start,
                    count: u32::try_from(numbers.end - numbers.start).ok()?,
                    line: number,
                    offset,
                    length: u32::try_from(length).ok()?,
                    journal: 0,
                });
            }
            Line::Failed(cell, failure) => {
                self.header.cells.get(*cell)?;
                self.failures.push((*cell, failure.clone()));
            }
            Line::Seconds(cell, seconds) => *self.seconds.get_mut(*cell)? += seconds,
            Line::End => self.ended = true,
        }
        Some(())
    }
}
