//! Running, planning, listing and reporting experiments.

use crate::args::{Format, Options};
use crate::files::{self, Source};
use crate::progress::Progress;
use crate::{HELD, INTERRUPTED, NOT_HELD, claims, study};
use anstream::{eprintln, println};
use furnace::experiment::store::{self, Store, Stored};
use furnace::experiment::{Cell, Error, Plan, Row, mistake, run_cell, verdict};
use furnace::report::json::{Content, Object, Run};
use furnace::report::{self, Lookup, answer, table, terminal};
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
    let mut worst = HELD;
    for (source, plan) in sources.iter().zip(&plans) {
        worst = worst.max(match options.claims {
            true => claims::one(plan, options, stop)?,
            false => one(source, plan, options, stop)?,
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

fn one(source: &Source, plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    if plan.spec.seeds.is_some() {
        return study::one(source, plan, options, stop);
    }
    let folder = source.report_folder(options);
    let store = Store::open(&folder)?;
    let (cells, seconds) = sample(plan, options, stop)?;
    let rows = verdict::rows(plan, &cells);
    store.write("timing.csv", &table::timing(plan, &cells, &seconds, &rows))?;
    store.write("run.json", provenance(source, plan).as_bytes())?;
    report::write(plan, &cells, &rows, &store, None)?;
    let interrupted = cells.iter().any(Option::is_none);
    let finished = cells.iter().filter(|cell| cell.is_some()).count();
    store.write_cells(&Stored {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        spec: source.text.clone(),
        seed: plan.spec.seed,
        samples: plan.cells.iter().map(|cell| cell.samples).collect(),
        cores: plan.cells.iter().map(|cell| cell.core).collect(),
        labels: plan.cells.iter().map(|cell| plan.label(cell)).collect(),
        cells,
        seconds,
    })?;
    let partial = format!("{}-interrupted", source.name);
    let folder = store.publish(interrupted.then_some(partial.as_str()))?;
    print(plan, &rows, interrupted, &folder, options);
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
pub fn json_line(lookup: &Lookup<'_>, interrupted: bool, folder: Option<&Path>) -> String {
    Object::new(lookup.plan, Content::Run(Run::new(lookup, interrupted, folder))).line()
}

fn print(plan: &Plan, rows: &[Row], interrupted: bool, folder: &Path, options: &Options) {
    let lookup = Lookup::new(plan, rows);
    if options.format == Format::Json {
        println!("{}", json_line(&lookup, interrupted, Some(folder)));
        return;
    }
    let sentences = answer::sentences(&lookup);
    println!("{}", plan.spec.question);
    println!();
    println!("{}", terminal::table(&lookup));
    sentences.iter().for_each(|sentence| println!("- {sentence}"));
    println!("\nThe page: {}", folder.join("index.html").display());
}

pub fn provenance(source: &Source, plan: &Plan) -> String {
    let git = std::process::Command::new("git").args(["rev-parse", "HEAD"]).output();
    let commit = git.ok().filter(|out| out.status.success());
    let commit = commit.map(|out| String::from_utf8_lossy(&out.stdout).trim().to_owned());
    let object = serde_json::json!({
        "experiment": source.name,
        "spec": source.text,
        "seed": plan.spec.seed,
        "version": env!("CARGO_PKG_VERSION"),
        "commit": commit,
        "machine": { "architecture": std::env::consts::ARCH, "system": std::env::consts::OS,
            "cores": std::thread::available_parallelism().map_or(0, usize::from) },
    });
    serde_json::to_string_pretty(&object).expect("a JSON value has a text") + "\n"
}

/// Rebuilds the reports of stored runs.
pub fn reports(names: &[String], options: &Options) -> Result<u8, Error> {
    let mut worst = HELD;
    for name in names {
        let source = Source::read(name, options)?;
        let mut plan = source.plan(options)?;
        let folder = source.report_folder(options);
        if plan.spec.seeds.is_some() {
            worst = worst.max(study::report(&plan, &folder, options)?);
            continue;
        }
        let stored = store::load(&folder, &mut plan)?;
        let rows = verdict::rows(&plan, &stored.cells);
        let store = Store::open(&folder)?;
        for file in ["timing.csv", "run.json"] {
            let path = folder.join(file);
            let text = std::fs::read(&path).map_err(|e| Error::io("cannot read", &path, e))?;
            store.write(file, &text)?;
        }
        report::write(&plan, &stored.cells, &rows, &store, Some(&folder))?;
        store.write_cells(&stored)?;
        let folder = store.publish(None)?;
        print(&plan, &rows, stored.cells.iter().any(Option::is_none), &folder, options);
        worst = worst.max(status(&plan, &rows));
    }
    Ok(worst)
}
