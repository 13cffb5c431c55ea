//! Parts of a run, each sampled by itself.

use crate::args::{Format, Options};
use crate::files::Source;
use crate::progress::Progress;
use crate::run::{open_journal, pool};
use crate::{HELD, INTERRUPTED};
use anstream::{eprintln, println};
use furnace::experiment::journal::Shard;
use furnace::experiment::resume::{self, Part};
use furnace::experiment::{Error, Plan};
use std::sync::atomic::AtomicBool;

/// Samples one part.
pub fn one(
    source: &Source,
    plan: &Plan,
    shard: Shard,
    options: &Options,
    stop: &AtomicBool,
) -> Result<u8, Error> {
    if options.format == Format::Json {
        return Err(Error::Refused("a shard has no results, and so no object; `merge` has".to_owned()));
    }
    let mut journal = open_journal(source, plan, shard, options)?;
    let pool = pool(options)?;
    let progress = Progress::new(plan, options.quiet);
    for (i, cell) in plan.cells.iter().enumerate() {
        let label = plan.label(cell);
        progress.cell(&label);
        let rays = |rays| progress.rays(rays * shard.count as f64);
        let part = pool.install(|| resume::sample_part(cell, i, shard, &mut journal, stop, &rays))?;
        match part {
            Part::Whole => progress.done(&label, i + 1, plan, journal.seconds[i], "its part is kept"),
            Part::Failed(failure) => progress.failed(plan, i, &failure),
            Part::Stopped => {
                journal.flush()?;
                let path = journal.path().display();
                eprintln!(
                    "interrupted: what is finished is kept in {path}; the same command goes on from here"
                );
                return Ok(INTERRUPTED);
            }
        }
    }
    progress.finish();
    journal.end()?;
    println!("shard {shard} of {}: {}", plan.name, journal.path().display());
    Ok(HELD)
}
