//! From plan to cells: blocks of realizations are pure functions of (plan, cell, block), made by several threads and merged
//! in block order, serially, so that results have the same bits for any number of threads.

use super::ahead::{Ahead, Limits};
use super::block::OpenBlock;
use super::cell::{Block, Cell, Keep};
use super::core::Sampler;
use super::error::Error;
use super::guard::{Failure, guarded};
use super::ledger::Stream;
use super::memory;
use super::plan::CellPlan;
use super::unit::{self, Unit};
use crate::estimator::{Ctx, Estimate, Tally};
use crate::sampling::Address;
use crate::scene::Scene;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Eighths of a cell's blocks after which one looks whether all is decided.
const LOOKS: [u64; 4] = [1, 2, 4, 6];

/// How many times a cell is looked at, if it may stop early: a t test shares its level among them.
pub const LOOKS_IN_ALL: u32 = LOOKS.len() as u32 + 1;

/// The pixel whose random numbers are those that all pixels of a realization share.
const SHARED: u64 = u64::MAX;

/// Between two looks at the stop flag and the clock, where nothing else happens.
const TICK: Duration = Duration::from_millis(50);

/// What comes next of a cell.
pub enum Next {
    /// The next blocks.
    Unit(Unit),
    /// They cannot be made.
    Failed(Failure),
    /// They will not be made now.
    Stopped,
}

/// Where the blocks of a cell come from: asked for some, it is also told the first of those that may never be wanted.
pub type Source<'a> = &'a mut dyn FnMut(Range<u64>, u64) -> Result<Next, Error>;

/// Merges the blocks of a cell in their order, `None` if they stop before its end. Where `is_decided` says so at one of the
/// looks, it ends before all of its samples are taken; where a block fails, with those before it. `progress` is told of the
/// rays that were traced.
pub fn merged(
    plan: &CellPlan,
    source: Source<'_>,
    progress: &dyn Fn(f64),
    is_decided: &dyn Fn(&mut Cell) -> bool,
) -> Result<Option<Cell>, Error> {
    let blocks = plan.blocks();
    let mut cell = Cell::default();
    let mut first = 0;
    while first < blocks {
        let look = next_look(plan, first);
        let last = (first + plan.unit()).min(blocks);
        match source(first..last, look)? {
            Next::Stopped => return Ok(None),
            Next::Failed(failure) => {
                cell.failure = Some(failure);
                break;
            }
            Next::Unit(unit) => {
                cell.merge_unit(&unit, plan.keep());
                progress(unit.rays());
            }
        }
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
    Ok(Some(cell))
}

/// The first block after `first` at which one looks whether all is decided, or the end: who may not stop has no use for a
/// look.
fn next_look(plan: &CellPlan, first: u64) -> u64 {
    let blocks = plan.blocks();
    let looks = LOOKS.map(|eighths| (blocks * eighths).div_ceil(8));
    looks.into_iter().find(|&look| plan.may_stop && look > first).unwrap_or(blocks)
}

/// Runs one cell on as many threads as the current pool has, `None` if `stop` was raised before its end; for the others see
/// [`merged`].
pub fn run_cell(
    plan: &CellPlan,
    stop: &AtomicBool,
    progress: &dyn Fn(f64),
    is_decided: &dyn Fn(&mut Cell) -> bool,
) -> Option<Cell> {
    let mut sampled = Sampled::start(plan, 0..plan.blocks(), next_look(plan, 0), false);
    let mut source = |blocks: Range<u64>, look| sampled.next(blocks, look, stop, &mut || Ok(()));
    merged(plan, &mut source, progress, is_decided).expect("nothing is read or written")
}

/// The same on this thread alone.
pub(super) fn run_cell_here(
    plan: &CellPlan,
    stop: &AtomicBool,
    progress: &dyn Fn(f64),
    is_decided: &dyn Fn(&mut Cell) -> bool,
) -> Option<Cell> {
    let scene = plan.scene.build();
    let sampler = Sampler::new(plan, &scene);
    let mut source = |blocks: Range<u64>, _| {
        let mut unit = Unit::default();
        for number in blocks {
            if stop.load(Ordering::Relaxed) {
                return Ok(Next::Stopped);
            }
            match guarded(number, |number| sampler.block(number)) {
                Ok(block) => unit.push(block),
                Err(failure) => return Ok(Next::Failed(failure)),
            }
        }
        Ok(Next::Unit(unit))
    };
    merged(plan, &mut source, progress, is_decided).expect("nothing is read or written")
}

/// One block of a cell, made on this thread and without a guard.
pub fn one_block(plan: &CellPlan, number: u64) -> Block {
    let scene = plan.scene.build();
    Sampler::new(plan, &scene).block(number)
}

/// Blocks of a cell that are sampled, ahead of who wants them.
pub(super) struct Sampled {
    ahead: Ahead<Made>,
    /// Records of the blocks that came last.
    pub records: Vec<u8>,
}

/// A block with its record, if there is to be one.
pub(super) struct Made {
    block: Block,
    record: Vec<u8>,
}

impl Sampled {
    /// Starts to sample the blocks `numbers` of a cell before `until`, with their records if they are to be `kept`.
    pub fn start(
        plan: &CellPlan,
        numbers: impl Iterator<Item = u64> + Send + 'static,
        until: u64,
        kept: bool,
    ) -> Self {
        let threads = rayon::current_num_threads();
        let limits =
            Limits { threads, window: memory::window(plan, threads), patience: plan.patience, until };
        let scene = Arc::new(plan.scene.build());
        let plan = Arc::new(plan.clone());
        let ahead = Ahead::start(limits, numbers, move |queue| {
            let sampler = Sampler::new(&plan, &scene);
            queue.work(|number| {
                let block = sampler.block(number);
                let record = if kept { unit::record(&block) } else { Vec::new() };
                Made { block, record }
            });
        });
        Sampled { ahead, records: Vec::new() }
    }

    /// The next blocks, which must be `blocks`; those from `look` on are not begun yet. `meanwhile` is called now and then.
    pub fn next(
        &mut self,
        blocks: Range<u64>,
        look: u64,
        stop: &AtomicBool,
        meanwhile: &mut dyn FnMut() -> Result<(), Error>,
    ) -> Result<Next, Error> {
        self.ahead.until(look);
        self.records.clear();
        let mut unit = Unit::default();
        for number in blocks {
            let made = loop {
                if stop.load(Ordering::Relaxed) {
                    return Ok(Next::Stopped);
                }
                match self.ahead.take(TICK) {
                    Some((_, Err(failure))) => return Ok(Next::Failed(failure)),
                    Some((taken, Ok(made))) => {
                        assert_eq!(taken, number, "blocks come in order");
                        break made;
                    }
                    None => meanwhile()?,
                }
            };
            self.records.extend(&made.record);
            unit.push(made.block);
        }
        Ok(Next::Unit(unit))
    }
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
    for block in blocks {
        let mut unit = Unit::default();
        unit.push(block);
        cell.merge_unit(&unit, Keep { traces: true, parts: false });
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
    let mut block = OpenBlock::new(width, height, streams);
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
    block.close(tally)
}
