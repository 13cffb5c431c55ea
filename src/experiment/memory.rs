//! What a cell takes of the memory, foreseen before it is sampled, and how much there is.

use super::plan::CellPlan;
use crate::estimator::Estimator;
use crate::scene::Rgb;
use std::fs;
use std::path::Path;

/// Mean and spread of a pixel.
const PIXEL: f64 = 2.0 * size_of::<Rgb>() as f64;

/// A block of a probe without its bets.
const BLOCK: f64 = 4096.0;

/// A stream of bets: its tables, and their sums.
const STREAM: f64 = 1024.0;

/// A photon in its map, with its place in the tree: each particle that is sent lands a few times.
const PARTICLE: f64 = 400.0;

/// The record of a block of a probe, and of each of its bets.
const RECORD: f64 = 1650.0;
const BETS: f64 = 285.0;

/// What a finished block leaves in its cell.
const LEFT: f64 = 256.0;

/// Blocks that wait to be merged may take so much, where two threads' are not more than that.
const WAITING: f64 = 268_435_456.0;

/// Most blocks that wait to be merged.
const MOST: f64 = 256.0;

/// Bytes of an image of a cell.
fn image(cell: &CellPlan) -> f64 {
    if cell.pixels > 1 { PIXEL * cell.pixels as f64 } else { 0.0 }
}

/// Bytes of one block.
fn block(cell: &CellPlan) -> f64 {
    BLOCK + image(cell) + STREAM * cell.streams.len() as f64
}

/// Blocks that may be begun and not merged: two a thread at least, so that none waits for the one that merges.
pub fn window(cell: &CellPlan, threads: usize) -> usize {
    let fit = (WAITING / block(cell)).min(MOST);
    (fit as usize).max(2 * threads)
}

/// About how many bytes a cell takes at most while it is sampled by so many threads; the program itself is not counted.
pub fn foreseen(cell: &CellPlan, threads: usize) -> f64 {
    let waiting = window(cell, threads).min(cell.blocks() as usize) as f64 * block(cell);
    // the merged image, a unit of it, its bytes, and the variance of its pixels
    let merged = 4.0 * image(cell) + LEFT * cell.blocks() as f64;
    let maps = match &cell.estimator {
        Estimator::PhotonMap(map) => threads as f64 * PARTICLE * map.photons as f64,
        _ => 0.0,
    };
    waiting + merged + maps
}

/// About how many bytes the journal of a cell will have.
pub fn journal(cell: &CellPlan) -> f64 {
    let blocks = cell.blocks() as f64;
    let units = (blocks / cell.unit() as f64).ceil();
    blocks * (RECORD + BETS * cell.streams.len() as f64) + units * image(cell)
}

/// Of several cells, which are sampled one after the other.
///
/// # Errors
///
/// When the largest of them takes more than there is.
pub fn enough(cells: &[CellPlan], threads: usize) -> Result<(), String> {
    let Some(available) = available() else { return Ok(()) };
    let most = cells.iter().map(|cell| foreseen(cell, threads)).fold(0.0, f64::max);
    match most > available {
        false => Ok(()),
        true => Err(format!(
            "about {:.1} GiB of memory are needed with {threads} threads, and {:.1} GiB are left; take fewer threads (--jobs), \
             pixels, photons or samples, or add --force to try all the same",
            most / GIB,
            available / GIB
        )),
    }
}

/// Bytes of a GiB.
pub const GIB: f64 = 1_073_741_824.0;

/// Bytes that this process may still take, as Linux tells: what is free, within the limit of its control group.
pub fn available() -> Option<f64> {
    let free = fs::read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        Some(1024.0 * line.split_whitespace().next()?.parse::<f64>().ok()?)
    });
    [free, group("memory.max", "memory.current")].into_iter().flatten().reduce(f64::min)
}

/// What a control group leaves of its limit.
fn group(limit: &str, taken: &str) -> Option<f64> {
    let own = fs::read_to_string("/proc/self/cgroup").ok()?;
    let own = own.lines().find_map(|line| line.strip_prefix("0::/"))?.to_owned();
    let folder = Path::new("/sys/fs/cgroup").join(own);
    let read = |name: &str| fs::read_to_string(folder.join(name)).ok()?.trim().parse::<f64>().ok();
    Some(read(limit)? - read(taken)?)
}
