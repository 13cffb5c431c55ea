//! Claims without reports: a paragraph an experiment.

use crate::args::{Format, Options};
use crate::run::{json_line, sample, status};
use crate::{INTERRUPTED, study};
use anstream::println;
use furnace::experiment::row::CHANNELS;
use furnace::experiment::{Error, Plan, verdict};
use furnace::report::{Lookup, terminal};
use furnace::stats::Verdict;
use std::sync::atomic::AtomicBool;

/// Judges one experiment and prints what does not hold.
pub fn one(plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    if plan.spec.seeds.is_some() {
        return study::claims(plan, options, stop);
    }
    let (cells, _) = sample(plan, None, options, stop)?;
    let rows = verdict::rows(plan, &cells);
    let interrupted = cells.iter().any(Option::is_none);
    let code = if interrupted { INTERRUPTED } else { status(plan, &rows) };
    if options.format == Format::Json {
        println!("{}", json_line(&Lookup::new(plan, &rows), interrupted, None, None));
        return Ok(code);
    }
    let judged = rows.iter().filter(|row| row.verdict.is_some()).count();
    let held = rows.iter().filter(|row| row.verdict == Some(Verdict::Pass)).count();
    println!("{}: {held} of {judged} questions passed", plan.name);
    for row in &rows {
        let cell = &plan.cells[row.cell];
        // mistakes are there to be caught
        if let Some(verdict) = row.verdict.filter(|v| *v != Verdict::Pass && cell.fault.is_none()) {
            let channel = row.channel.map_or("", |c| CHANNELS[c]);
            let index = row.estimand.index().map_or_else(String::new, |i| format!(" {i}"));
            let (label, estimand, note) = (plan.label(cell), row.estimand, &row.note);
            let verdict = terminal::verdict(verdict);
            println!("    {verdict}: {label}, {estimand}{index} {channel}: {note}");
        }
    }
    Ok(code)
}
