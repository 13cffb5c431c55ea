//! Running, planning, listing and reporting experiments.

use crate::args::{Format, Options};
use crate::baseline::{self, Wanted};
use crate::files::{self, Source};
use crate::progress::Progress;
use crate::{HELD, INTERRUPTED, NOT_HELD, claims, provenance, shards, study};
use anstream::{eprintln, println};
use furnace::experiment::baseline::Comparison;
use furnace::experiment::cell::Block;
use furnace::experiment::journal::{self, Journal, Shard};
use furnace::experiment::store::{self, Store, Stored};
use furnace::experiment::{
    Cell, CellPlan, Error, Plan, Row, memory, mistake, one_block, resume, run_cell, verdict,
};
use furnace::report::json::{self, Content, Object};
use furnace::report::run::Run;
use furnace::report::{self, Lookup, answer, overview, terminal};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Runs each named experiment; the worst exit status counts.
pub fn all(names: &[String], options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    let every = if options.all { files::names()? } else { Vec::new() };
    let names = if options.all { &every } else { names };
    let fresh = Options {
        seed: options.seed.or_else(|| options.claims.then(|| fresh_seed(options.format))),
        ..options.clone()
    };
    let options = &fresh;
    let sources = names.iter().map(|name| Source::read(name, options)).collect::<Result<Vec<_>, _>>()?;
    // a mistake in the last file shall not cost the time of the first
    let plans = sources.iter().map(|source| source.plan(options)).collect::<Result<Vec<_>, _>>()?;
    let wanted = sources.iter().zip(&plans).map(|(source, plan)| baseline::wanted(source, plan, options));
    let wanted = wanted.collect::<Result<Vec<_>, _>>()?;
    let mut worst = HELD;
    for ((source, plan), wanted) in sources.iter().zip(&plans).zip(&wanted) {
        worst = worst.max(match (options.block, options.claims) {
            (Some(number), _) => block(plan, number)?,
            (None, true) => claims::one(plan, options, stop)?,
            (None, false) => one(source, plan, wanted, options, stop)?,
        });
        if stop.load(Ordering::Relaxed) {
            break;
        }
    }
    Ok(worst)
}

/// A seed that nobody has chosen; it is printed, so that the run can be repeated.
fn fresh_seed(format: Format) -> u64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let seed = now.map_or(0, |now| now.as_nanos() as u64 % 1_000_000_007);
    // objects name their seed
    if format != Format::Json {
        println!("seed {seed}: --seed {seed} repeats this");
    }
    seed
}

/// A pool of `--jobs` threads.
pub fn pool(options: &Options) -> Result<rayon::ThreadPool, Error> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.jobs.into()).build();
    pool.map_err(|e| Error::Refused(format!("cannot start {} threads: {e}", options.jobs)))
}

fn one(
    source: &Source,
    plan: &Plan,
    wanted: &Wanted,
    options: &Options,
    stop: &AtomicBool,
) -> Result<u8, Error> {
    if plan.spec.seeds.is_some() {
        return study::one(source, plan, options, stop);
    }
    if !options.force {
        let short = |why| Error::Refused(format!("{}: {why}", plan.name));
        memory::enough(&plan.cells, options.threads()).map_err(short)?;
    }
    let folder = source.report_folder(options);
    if let Some(shard) = options.shard {
        return shards::one(source, plan, shard, options, stop);
    }
    Store::open(&folder)?; // fails before anything is sampled, if it must
    let mut journal = open_journal(source, plan, Shard::WHOLE, options)?;
    let run = provenance::begin(source, plan, options);
    let (cells, seconds) = sample(plan, Some(&mut journal), options, stop)?;
    let interrupted = cells.iter().any(Option::is_none);
    let run = Run { seconds, ..run };
    let status = publish(source, plan, Finished { cells, run, wanted }, options)?;
    if !interrupted {
        journal.end()?;
    }
    Ok(status)
}

/// Makes one block of each cell, and says what it has shown.
fn block(plan: &Plan, number: u64) -> Result<u8, Error> {
    for cell in &plan.cells {
        let label = plan.label(cell);
        if number >= cell.blocks() {
            let most = cell.blocks() - 1;
            return Err(Error::Refused(format!("{label}: its blocks are numbered from 0 to {most}")));
        }
        let Block { total, cost, .. } = one_block(cell, number);
        println!(
            "{label}, block {number}: mean {:?}, {} rays a realization",
            total.map(|m| m.mean),
            cost.mean
        );
    }
    Ok(HELD)
}

/// What is to be reported.
pub struct Finished<'a> {
    pub cells: Vec<Option<Cell>>,
    pub run: Run,
    pub wanted: &'a Wanted,
}

/// Judges the cells, and reports them in the folder of the experiment; beside it, if some are missing.
pub fn publish(
    source: &Source,
    plan: &Plan,
    Finished { cells, run, wanted }: Finished<'_>,
    options: &Options,
) -> Result<u8, Error> {
    let store = Store::open(&source.report_folder(options))?;
    let rows = verdict::rows(plan, &cells);
    let comparison = wanted.compare(plan, &cells, &rows);
    pool(options)?.install(|| report::write(plan, &cells, &rows, &run, &store, None, comparison.as_ref()))?;
    let interrupted = cells.iter().any(Option::is_none);
    let finished = cells.iter().filter(|cell| cell.is_some()).count();
    let stored = Stored {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        spec: source.text.clone(),
        seed: plan.spec.seed,
        samples: plan.cells.iter().map(|cell| cell.samples).collect(),
        cores: plan.cells.iter().map(|cell| cell.core).collect(),
        labels: plan.cells.iter().map(|cell| plan.label(cell)).collect(),
        cells,
        seconds: run.seconds,
    };
    store.write_cells(&stored)?;
    let partial = format!("{}-interrupted", source.name);
    let folder = store.publish(interrupted.then_some(partial.as_str()))?;
    overview::write(&source.reports(options))?;
    print(plan, &rows, interrupted, &folder, comparison.as_ref(), options);
    wanted.save(plan, &stored.cells, &rows, run.commit)?;
    if interrupted {
        eprintln!(
            "interrupted: {finished} of {} cells are finished and kept in {}; the same command goes on from here",
            plan.cells.len(),
            folder.display()
        );
        return Ok(INTERRUPTED);
    }
    Ok(status(plan, &rows))
}

/// The journal of a part of a run, and on standard error what is to be told of it.
pub fn open_journal(source: &Source, plan: &Plan, shard: Shard, options: &Options) -> Result<Journal, Error> {
    let folder = journal::folder(&source.report_folder(options));
    let journal = Journal::open(&folder, &source.header(plan, options, shard), options.start())?;
    journal.told.iter().for_each(|told| eprintln!("warning: {told}"));
    let kept = |(i, cell): (usize, &CellPlan)| journal.kept.count(i, cell);
    let kept: u64 = plan.cells.iter().enumerate().map(kept).sum();
    if kept > 0 && !options.quiet && options.format != Format::Json {
        eprintln!("{kept} blocks are in {} already", journal.path().display());
    }
    Ok(journal)
}

/// The finished cells, and the seconds of each; with a journal, which is gone on from.
pub fn sample(
    plan: &Plan,
    mut journal: Option<&mut Journal>,
    options: &Options,
    stop: &AtomicBool,
) -> Result<(Vec<Option<Cell>>, Vec<f64>), Error> {
    let pool = pool(options)?;
    let progress = Progress::new(plan, options.quiet || options.format == Format::Json);
    let mut cells = Vec::new();
    let mut seconds = Vec::new();
    for (i, cell_plan) in plan.cells.iter().enumerate() {
        let label = plan.label(cell_plan);
        progress.cell(&label);
        let start = Instant::now();
        let rays = |rays| progress.rays(rays);
        let is_decided = |cell: &mut Cell| verdict::is_decided(plan, i, cell);
        let cell = pool.install(|| match journal.as_deref_mut() {
            Some(journal) => resume::go_on(cell_plan, i, journal, stop, &rays, &is_decided),
            None => Ok(run_cell(cell_plan, stop, &rays, &is_decided)),
        })?;
        seconds.push(journal.as_ref().map_or(start.elapsed().as_secs_f64(), |journal| journal.seconds[i]));
        if let Some(failure) = cell.as_ref().and_then(|cell| cell.failure.as_ref()) {
            progress.failed(plan, i, failure);
        }
        if let Some(cell) = cell.as_ref().filter(|_| !progress.is_silent()) {
            let verdict = verdict::so_far(plan, i, cell);
            let shown = verdict.map_or_else(
                || "not judged so far".to_owned(),
                |verdict| format!("{} so far", terminal::verdict(verdict)),
            );
            progress.done(&label, i + 1, plan, seconds[i], &shown);
        }
        cells.push(cell);
    }
    progress.finish();
    if let Some(journal) = journal {
        journal.flush()?;
    }
    Ok((cells, seconds))
}

pub fn status(plan: &Plan, rows: &[Row]) -> u8 {
    if mistake::all_held(plan, rows) { HELD } else { NOT_HELD }
}

/// The object of a run.
pub fn json_line(
    lookup: &Lookup<'_>,
    interrupted: bool,
    folder: Option<&Path>,
    comparison: Option<&Comparison>,
) -> String {
    Object::new(lookup.plan, Content::Run(json::Run::new(lookup, interrupted, folder, comparison))).line()
}

fn print(
    plan: &Plan,
    rows: &[Row],
    interrupted: bool,
    folder: &Path,
    comparison: Option<&Comparison>,
    options: &Options,
) {
    let lookup = Lookup::new(plan, rows);
    if options.format == Format::Json {
        println!("{}", json_line(&lookup, interrupted, Some(folder), comparison));
        return;
    }
    let sentences = answer::sentences(&lookup);
    println!("{}", plan.spec.question);
    println!();
    println!("{}", terminal::table(&lookup));
    if let Some(comparison) = comparison {
        println!("{}", report::baseline::text(comparison));
    }
    sentences.iter().for_each(|sentence| println!("- {sentence}"));
    println!("\nThe page: {}", folder.join("index.html").display());
}

/// Rebuilds the reports of stored runs.
pub fn reports(names: &[String], options: &Options) -> Result<u8, Error> {
    let mut worst = HELD;
    for name in names {
        let source = Source::read(name, options)?;
        let mut plan = source.plan(options)?;
        let wanted = baseline::wanted(&source, &plan, options)?;
        if plan.spec.seeds.is_some() {
            worst = worst.max(study::report(&source, &plan, options)?);
            continue;
        }
        let folder = source.report_folder(options);
        let stored = store::load(&folder, &mut plan)?;
        let rows = verdict::rows(&plan, &stored.cells);
        let store = Store::open(&folder)?;
        let run = Run::read(&folder)?;
        let comparison = wanted.compare(&plan, &stored.cells, &rows);
        let write =
            || report::write(&plan, &stored.cells, &rows, &run, &store, Some(&folder), comparison.as_ref());
        pool(options)?.install(write)?;
        store.write_cells(&stored)?;
        let folder = store.publish(None)?;
        overview::write(&source.reports(options))?;
        print(&plan, &rows, stored.cells.iter().any(Option::is_none), &folder, comparison.as_ref(), options);
        wanted.save(&plan, &stored.cells, &rows, run.commit)?;
        worst = worst.max(status(&plan, &rows));
    }
    Ok(worst)
}
