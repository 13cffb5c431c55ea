//! How far the parts of a run have come.

use crate::HELD;
use anstream::println;
use furnace::experiment::Error;
use furnace::experiment::journal::{self, Scan};
use std::path::{Path, PathBuf};

/// Shows how far the journals of some folders have come.
pub fn status(folders: &[PathBuf]) -> Result<u8, Error> {
    for folder in folders {
        let mut rows = Vec::new();
        for path in journal::all(folder)? {
            rows.push(match journal::scan(&path) {
                Ok(scan) => state(&scan, &path),
                Err(error) => (0, 0, error.to_string()),
            });
        }
        let (done, all) = rows.iter().fold((0, 0), |(d, a), (done, all, _)| (d + done, a + all));
        rows.iter().for_each(|(.., line)| println!("{line}"));
        println!("{}: {}", folder.display(), share(done, all));
    }
    Ok(HELD)
}

/// Blocks of a journal that are there, that are to be there, and a line about it.
fn state(scan: &Scan, path: &Path) -> (u64, u64, String) {
    let shard = scan.header.shard;
    let (mut done, mut all) = (0, 0);
    for (i, cell) in scan.header.cells.iter().enumerate() {
        let mut first: Vec<u64> =
            scan.places.iter().filter(|p| p.cell as usize == i).map(|p| p.first / cell.unit.max(1)).collect();
        first.sort_unstable();
        first.dedup();
        let units = cell.samples.checked_div(cell.block).unwrap_or(0).div_ceil(cell.unit.max(1));
        done += first.iter().filter(|unit| **unit < units).count() as u64;
        all += (0..units).filter(|unit| shard.owns(i, *unit)).count() as u64;
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
    (done, all, format!("{shard}: {state}, {}{failures}", share(done, all)))
}

fn share(done: u64, all: u64) -> String {
    let percent = if all == 0 { 100.0 } else { 100.0 * done as f64 / all as f64 };
    format!("{done} of {all} lines ({percent:.1} %)")
}
