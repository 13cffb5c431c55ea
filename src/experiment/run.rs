//! From plan to cells: blocks of realizations are pure functions of (plan, cell, block), run in parallel and merged in
//! block order, serially, so that results have the same bits for any number of threads.

use super::cell::{Block, Cell};
use super::core::Sampler;
use super::ledger::Stream;
use super::plan::CellPlan;
use crate::estimator::{Ctx, Estimate, Tally};
use crate::sampling::Address;
use crate::scene::Scene;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Paths between two looks at the stop flag; also bounds how many blocks are held at once.
pub(super) const WAVE_PATHS: u64 = 1 << 18;

/// Eighths of a cell's blocks after which one looks whether all is decided.
const LOOKS: [u64; 4] = [1, 2, 4, 6];

/// How many times a cell is looked at, if it may stop early: a t test shares its level among them.
pub const LOOKS_IN_ALL: u32 = LOOKS.len() as u32 + 1;

/// The pixel whose random numbers are those that all pixels of a realization share.
const SHARED: u64 = u64::MAX;

/// Runs one cell on the current thread pool, `None` if `stop` was raised before its end. Where `is_decided` says so at
/// one of the looks, it ends before all of its samples are taken. `progress` is told of the rays traced by each finished
/// wave.
pub fn run_cell(
    plan: &CellPlan,
    stop: &AtomicBool,
    progress: &dyn Fn(f64),
    is_decided: &dyn Fn(&mut Cell) -> bool,
) -> Option<Cell> {
    let scene = plan.scene.build();
    let sampler = Sampler::new(plan, &scene);
    let blocks = plan.samples / plan.block;
    let wave = (WAVE_PATHS / (plan.block * plan.pixels)).max(8);
    let looks = LOOKS.map(|eighths| (blocks * eighths).div_ceil(8));
    let mut cell = Cell::default();
    let mut first = 0;
    while first < blocks {
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        // who may not stop has no use for a look: few large blocks run beside each other
        let next = looks.into_iter().find(|&look| plan.may_stop && look > first);
        let look = next.unwrap_or(blocks);
        let last = (first + wave).min(look);
        let finished: Vec<Block> = (first..last).into_par_iter().map(|b| sampler.block(b)).collect();
        for block in &finished {
            cell.merge(block);
            if plan.traced {
                cell.keep_trace(block);
            }
        }
        progress(finished.iter().map(|block| block.tally.rays as f64).sum());
        first = last;
        // two blocks at least, or there is no standard error
        if last == look && last < blocks && last > 1 && is_decided(&mut cell) {
            break;
        }
    }
    cell.finish();
    if plan.paired {
        cell.keep_block_means();
    }
    Some(cell)
}

/// Samples an estimator of one's own: `samples` realizations in blocks of `block`, each of them a run, on the current
/// thread pool.
pub fn sample(scene: &Scene, estimator: &impl Estimate, address: &Address, samples: u64, block: u64) -> Cell {
    let draw = |number, pixel| address.stream(number, pixel);
    let blocks: Vec<Block> = (0..samples / block)
        .into_par_iter()
        .map(|b| block_of(scene, estimator, &draw, &[], b * block..(b + 1) * block))
        .collect();
    let mut cell = Cell::default();
    for block in &blocks {
        cell.merge(block);
        cell.keep_trace(block);
    }
    cell.finish();
    cell
}

/// One block of realizations, which bets on the given streams of samples. `draw` gives the random numbers of a realization's
/// pixel.
pub fn block_of(
    scene: &Scene,
    estimator: &impl Estimate,
    draw: &impl Fn(u64, u64) -> crate::sampling::Stream,
    streams: &[Stream],
    realizations: Range<u64>,
) -> Block {
    let (width, height) = scene.sensor.resolution();
    let mut block = Block::new(width, height, streams);
    let mut tally = Tally::default();
    for realization in realizations {
        let rays_before = tally.rays;
        let shared = draw(realization, SHARED);
        let pass = estimator.begin(realization, &mut Ctx::shared(scene, shared, &mut tally));
        for y in 0..height {
            for x in 0..width {
                let pixel = u64::from(y) * u64::from(width) + u64::from(x);
                let mut stream = draw(realization, pixel);
                let start = scene.start((x, y), &mut stream);
                estimator.estimate(&pass, start.ray, &mut Ctx::new(scene, stream, &mut tally, &start));
                block.pixel(pixel as usize, tally.value);
            }
        }
        block.realization(tally.rays - rays_before, &tally);
    }
    block.close(tally);
    block
}
