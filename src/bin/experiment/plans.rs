//! What will be run, what it will cost, and how many samples it takes.

use crate::HELD;
use crate::args::{Format, Options};
use crate::files::{self, Source};
use anstream::println;
use furnace::experiment::memory::{self, GIB};
use furnace::experiment::plan::RAYS_PER_SECOND;
use furnace::experiment::store::{self, Stored};
use furnace::experiment::{Error, Plan};
use furnace::report::json::{self, Content, Listed, Object, Planned};

/// Prints the resolved grid of each experiment.
pub fn plans(names: &[String], margin: Option<f64>, options: &Options) -> Result<u8, Error> {
    for name in names {
        let source = Source::read(name, options)?;
        let plan = source.plan(options)?;
        // an earlier run knows variances that theory does not
        let stored = store::load(&source.report_folder(options), &mut plan.clone()).ok();
        match options.format {
            Format::Json => {
                let planned = Planned::new(&plan, margin, stored.as_ref());
                println!("{}", Object::new(&plan, Content::Plan(planned)).line());
            }
            _ => {
                print(&plan, margin, stored.as_ref());
                println!("{}", room(&plan, options));
            }
        }
    }
    Ok(HELD)
}

fn print(plan: &Plan, margin: Option<f64>, stored: Option<&Stored>) {
    println!("{}: {}\n", plan.name, plan.spec.question);
    for (i, cell) in plan.cells.iter().enumerate() {
        let needed = json::margin(plan, i, margin, stored).map_or_else(String::new, needed);
        let (label, samples, rays) = (plan.label(cell), cell.samples, cell.total_rays());
        println!("{label:<64} {samples:>12} samples {rays:>10.2e} rays{needed}");
    }
    for out in &plan.left_out {
        println!("{:<64} left out: {}", plan.label(&out.cell), out.why);
    }
    println!("{}", cost(plan));
}

/// How many samples the margin will take.
fn needed((margin, samples): (f64, Option<u64>)) -> String {
    let percent = 100.0 * margin;
    match samples {
        Some(n) => format!("   ±{percent} % takes {n} samples"),
        None => format!("   ±{percent} %: no variance is known; run it once, --quick will do"),
    }
}

/// Prints a paragraph on each experiment.
pub fn list(options: &Options) -> Result<u8, Error> {
    for name in files::names()? {
        let plan = Source::read(&name, options)?.plan(options)?;
        match options.format {
            Format::Json => println!("{}", Object::new(&plan, Content::Listed(Listed::new(&plan))).line()),
            _ => println!("{}: {}\n    {}", plan.name, plan.spec.question, cost(&plan)),
        }
    }
    Ok(HELD)
}

/// What a run takes of memory and disk.
fn room(plan: &Plan, options: &Options) -> String {
    let threads = options.threads();
    let memory = plan.cells.iter().map(|cell| memory::foreseen(cell, threads)).fold(0.0, f64::max);
    let journal: f64 = plan.cells.iter().map(memory::journal).sum();
    let (memory, journal) = (memory / GIB, journal / GIB);
    format!("about {memory:.2} GiB of memory with {threads} threads, and a journal of {journal:.2} GiB")
}

fn cost(plan: &Plan) -> String {
    let rays: f64 = plan.cells.iter().map(|cell| cell.total_rays()).sum();
    let seconds = rays / RAYS_PER_SECOND;
    format!("{} cells, at most about {rays:.1e} rays, {seconds:.0} core-seconds", plan.cells.len())
}
