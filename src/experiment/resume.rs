//! Cells whose blocks are kept in journals: gone on from, sampled in parts, put together.

use super::cell::Cell;
use super::error::Error;
use super::guard::Failure;
use super::journal::{Found, Journal, Kept, Shard, expected};
use super::plan::CellPlan;
use super::run::{Next, Sampled, merged};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

/// Runs one cell as [`super::run_cell`] does, but goes on from a journal, which receives what is new.
///
/// # Errors
///
/// When the journal cannot be read or written.
pub fn go_on(
    plan: &CellPlan,
    index: usize,
    journal: &mut Journal,
    stop: &AtomicBool,
    progress: &dyn Fn(f64),
    is_decided: &dyn Fn(&mut Cell) -> bool,
) -> Result<Option<Cell>, Error> {
    let missing = missing(plan, index, &journal.kept, Shard::WHOLE);
    let mut sampler = Sampler::new(plan, index, missing);
    let mut source = |blocks: Range<u64>, look| {
        if stop.load(Ordering::Relaxed) {
            return Ok(Next::Stopped);
        }
        match journal.kept.unit(index, plan, &blocks)? {
            Found::Unit(unit) => Ok(Next::Unit(unit)),
            // another try: time may have been short
            Found::Missing | Found::Failed(_) => sampler.next(blocks, look, journal, stop),
        }
    };
    let cell = merged(plan, &mut source, progress, is_decided)?;
    sampler.end(journal)?;
    Ok(cell)
}

/// How the part of a cell has ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// All of it is in the journal.
    Whole,
    /// A block cannot be made.
    Failed(Failure),
    /// The flag was raised.
    Stopped,
}

/// Samples the part of a cell that belongs to a shard, as far as it is not in its journal yet.
///
/// # Errors
///
/// When the journal cannot be written.
pub fn sample_part(
    plan: &CellPlan,
    index: usize,
    shard: Shard,
    journal: &mut Journal,
    stop: &AtomicBool,
    progress: &dyn Fn(f64),
) -> Result<Part, Error> {
    let missing = missing(plan, index, &journal.kept, shard);
    let mut sampler = Sampler::new(plan, index, missing.clone());
    let mut part = Part::Whole;
    for blocks in missing {
        match sampler.next(blocks, u64::MAX, journal, stop)? {
            Next::Unit(unit) => progress(unit.rays()),
            Next::Failed(failure) => part = Part::Failed(failure),
            Next::Stopped => part = Part::Stopped,
        }
        if part != Part::Whole {
            break;
        }
    }
    sampler.end(journal)?;
    Ok(part)
}

/// Puts a cell together from journals, as if it had been run at once; where blocks are missing that it cannot do without, it
/// gives all of the cell that are.
///
/// # Errors
///
/// When a journal cannot be read.
pub fn join(
    plan: &CellPlan,
    index: usize,
    kept: &mut Kept,
    is_decided: &dyn Fn(&mut Cell) -> bool,
) -> Result<Result<Cell, Vec<Range<u64>>>, Error> {
    let cell = thread::scope(|scope| {
        // one thread reads ahead of the one that merges; it ends when nobody takes any more
        let (give, take) = mpsc::sync_channel(AHEAD);
        scope.spawn(|| {
            let give = give; // ends with this thread
            let units = plan.blocks().div_ceil(plan.unit());
            let mut blocks = (0..units).map(|unit| expected(plan, unit * plan.unit())).peekable();
            while blocks.peek().is_some() {
                let some = blocks.by_ref().take(if plan.pixels == 1 { TOGETHER } else { 1 });
                let found: Vec<_> = some.map(|blocks| kept.unit(index, plan, &blocks)).collect();
                if give.send(found).is_err() {
                    break;
                }
            }
        });
        let mut read = take.into_iter().flatten();
        let mut source = |_, _| {
            Ok(match read.next().expect("all blocks are read")? {
                Found::Unit(unit) => Next::Unit(unit),
                Found::Failed(failure) => Next::Failed(failure),
                Found::Missing => Next::Stopped,
            })
        };
        let cell = merged(plan, &mut source, &|_| (), is_decided);
        drop(read);
        cell
    })?;
    Ok(cell.ok_or_else(|| missing(plan, index, kept, Shard::WHOLE)))
}

/// How often is read ahead.
const AHEAD: usize = 2;

/// Blocks of a probe that are read at a time: waiting for each takes longer than reading it.
const TOGETHER: usize = 128;

/// Units of a cell that belong to a part and are not there.
pub fn missing(plan: &CellPlan, index: usize, kept: &Kept, shard: Shard) -> Vec<Range<u64>> {
    let owned = (0..plan.blocks().div_ceil(plan.unit())).filter(|unit| shard.owns(index, *unit));
    let blocks = owned.map(|unit| expected(plan, unit * plan.unit()));
    blocks.filter(|blocks| !kept.has(index, blocks)).collect()
}

/// Samples what is missing of a cell, once something of it is asked for.
struct Sampler<'a> {
    plan: &'a CellPlan,
    index: usize,
    missing: Vec<Range<u64>>,
    started: Option<(Sampled, Instant)>,
}

impl<'a> Sampler<'a> {
    fn new(plan: &'a CellPlan, index: usize, missing: Vec<Range<u64>>) -> Self {
        Sampler { plan, index, missing, started: None }
    }

    /// The next missing blocks, which go to the journal.
    fn next(
        &mut self,
        blocks: Range<u64>,
        look: u64,
        journal: &mut Journal,
        stop: &AtomicBool,
    ) -> Result<Next, Error> {
        let missing = &mut self.missing;
        let start = || {
            let numbers = std::mem::take(missing).into_iter().flatten();
            (Sampled::start(self.plan, numbers, look, true), Instant::now())
        };
        let (sampled, _) = self.started.get_or_insert_with(start);
        let next = sampled.next(blocks.clone(), look, stop, &mut || journal.flush_if_due())?;
        match &next {
            Next::Unit(unit) => {
                journal.blocks(self.index, blocks, &mut sampled.records, unit)?;
            }
            Next::Failed(failure) => journal.failure(self.index, failure)?,
            Next::Stopped => {}
        }
        Ok(next)
    }

    /// Notes how long it took.
    fn end(&self, journal: &mut Journal) -> Result<(), Error> {
        match &self.started {
            Some((_, start)) => journal.spent(self.index, start.elapsed().as_secs_f64()),
            None => Ok(()),
        }
    }
}
