//! How far the parts of a run have come.

use crate::HELD;
use anstream::println;
use furnace::experiment::Error;
use furnace::experiment::journal::{self, Header, OfCell, Scan, Shard};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Shows how far the journals of some folders have come.
pub fn status(folders: &[PathBuf]) -> Result<u8, Error> {
    let mut parts = Vec::new();
    for folder in folders {
        let (mut done, mut all) = (0, 0);
        for path in journal::all(folder)? {
            match journal::scan(&path) {
                Ok(scan) => {
                    let part = state(&scan, &path);
                    (done, all) = (done + part.done, all + part.all);
                    parts.push(part);
                }
                Err(error) => println!("{error}"),
            }
        }
        println!("{}: {}", folder.display(), share(done, all));
    }
    let counts: BTreeSet<u64> = parts.iter().map(|part| part.header.shard.count).collect();
    counts.iter().filter_map(|count| not_begun(&parts, *count)).for_each(|line| println!("{line}"));
    Ok(HELD)
}

/// A part that has begun.
struct Part {
    header: Header,
    /// Lines that are there.
    done: u64,
    /// Lines that are to be there.
    all: u64,
}

/// Prints a line about a journal.
fn state(scan: &Scan, path: &Path) -> Part {
    let shard = scan.header.shard;
    let mut done = 0;
    for (i, cell) in scan.header.cells.iter().enumerate() {
        let mut first: Vec<u64> =
            scan.places.iter().filter(|p| p.cell as usize == i).map(|p| p.first / cell.unit.max(1)).collect();
        first.sort_unstable();
        first.dedup();
        done += first.iter().filter(|unit| **unit < units(cell)).count() as u64;
    }
    let state = match (scan.ended, journal::is_written(path)) {
        (_, true) => "running",
        (true, false) => "finished",
        (false, false) => "stopped",
    };
    let failures = match scan.failures.len() {
        0 => String::new(),
        n => format!(", {n} blocks failed"),
    };
    let all = owned(&scan.header, shard);
    println!("{shard}: {state}, {}{failures}", share(done, all));
    Part { header: scan.header.clone(), done, all }
}

/// Of a run that is divided into so many parts: those of which there is no journal, and how much of the whole is there.
fn not_begun(parts: &[Part], count: u64) -> Option<String> {
    const SHOWN: usize = 12;
    // a part that is in two folders counts once
    let mut begun: BTreeMap<u64, u64> = BTreeMap::new();
    for part in parts.iter().filter(|part| part.header.shard.count == count) {
        let done = begun.entry(part.header.shard.number).or_default();
        *done = part.done.max(*done);
    }
    let header = &parts.iter().find(|part| part.header.shard.count == count)?.header;
    let missing = (1..=count).filter(|number| !begun.contains_key(number));
    let mut named: Vec<String> = missing.take(SHOWN).map(|number| format!("{number}/{count}")).collect();
    let unnamed = count - begun.len() as u64 - named.len() as u64;
    if unnamed > 0 {
        named.push(format!("and {unnamed} more"));
    }
    let whole = share(begun.values().sum(), owned(header, Shard::WHOLE));
    (!named.is_empty()).then(|| format!("not begun: {}; of the whole: {whole}", named.join(", ")))
}

/// Lines of a part of a run.
fn owned(header: &Header, shard: Shard) -> u64 {
    let of_cell = |(i, cell)| (0..units(cell)).filter(|unit| shard.owns(i, *unit)).count() as u64;
    header.cells.iter().enumerate().map(of_cell).sum()
}

/// Lines of a cell.
fn units(cell: &OfCell) -> u64 {
    cell.samples.checked_div(cell.block).unwrap_or(0).div_ceil(cell.unit.max(1))
}

fn share(done: u64, all: u64) -> String {
    let percent = if all == 0 { 100.0 } else { 100.0 * done as f64 / all as f64 };
    format!("{done} of {all} lines ({percent:.1} %)")
}
