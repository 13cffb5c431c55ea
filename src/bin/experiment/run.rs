//! Running, planning, listing and reporting experiments.

use crate::args::{Format, Options};
use crate::baseline::{self, Wanted};
use crate::files::{self, Source};
use crate::progress::Progress;
use crate::{HELD, INTERRUPTED, NOT_HELD, claims, provenance, study};
use anstream::{eprintln, println};
use furnace::experiment::baseline::Comparison;
use furnace::experiment::store::{self, Store, Stored};
use furnace::experiment::{Cell, Error, Plan, Row, mistake, run_cell, verdict};
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
        worst = worst.max(match options.claims {
            true => claims::one(plan, options, stop)?,
            false => one(source, plan, wanted, options, stop)?,
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
    let folder = source.report_folder(options);
    let store = Store::open(&folder)?;
    let mut run = provenance::begin(source, plan, options);
    let (cells, seconds) = sample(plan, options, stop)?;
    run.seconds.clone_from(&seconds);
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
        seconds,
    };
    store.write_cells(&stored)?;
    let partial = format!("{}-interrupted", source.name);
    let folder = store.publish(interrupted.then_some(partial.as_str()))?;
    overview::write(&source.reports(options))?;
    print(plan, &rows, interrupted, &folder, comparison.as_ref(), options);
    wanted.save(plan, &stored.cells, &rows, run.commit)?;
    if interrupted {
        eprintln!(
            "interrupted: {finished} of {} cells are finished and kept in {}",
            plan.cells.len(),
            folder.display()
        );
        return Ok(INTERRUPTED);
    }
    Ok(status(plan, &rows))
}

/// The finished cells, and the seconds of each.
pub fn sample(
    plan: &Plan,
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
        let cell = pool.install(|| {
            let is_decided = |cell: &mut Cell| verdict::is_decided(plan, i, cell);
            run_cell(cell_plan, stop, &|rays| progress.rays(rays), &is_decided)
        });
        seconds.push(start.elapsed().as_secs_f64());
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
