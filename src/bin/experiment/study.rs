//! Studies: every cell with many seeds.

use crate::args::{Format, Options};
use crate::files::Source;
use crate::progress::Progress;
use crate::run::pool;
use crate::{HELD, INTERRUPTED, NOT_HELD, provenance};
use anstream::println;
use furnace::experiment::outcome::Outcome;
use furnace::experiment::store::Store;
use furnace::experiment::study::{Detection, Instrument, detect};
use furnace::experiment::{Error, Plan, file};
use furnace::report::json::{Content, Object, Study};
use furnace::report::overview::{self, Summary};
use furnace::report::run::{self, Run};
use furnace::report::study::{self, Studied};
use furnace::stats::Verdict;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// What a study keeps.
const STUDY: &str = "study.json";

/// Runs a study.
pub fn one(source: &Source, plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    if options.shard.is_some() || options.resume {
        let why = "is a study: it has no journal to go on from, and is not cut into shards";
        return Err(Error::Refused(format!("{} {why}", source.name)));
    }
    let store = Store::open(&source.report_folder(options))?;
    let mut run = provenance::begin(source, plan, options);
    let (outcome, timing, seconds) = sample(plan, options, stop)?;
    run.seconds = seconds;
    let interrupted = !outcome.whole;
    store.write("timing.csv", timing.as_bytes())?;
    store.write(STUDY, &serde_json::to_vec(&outcome).expect("counts have a JSON form"))?;
    let held = write(plan, &outcome, &run, &store)?;
    let partial = format!("{}-interrupted", source.name);
    let folder = store.publish(interrupted.then_some(partial.as_str()))?;
    overview::write(&source.reports(options))?;
    print(plan, &outcome, &folder, options);
    Ok(if interrupted { INTERRUPTED } else { held })
}

/// Judges a study without a report.
pub fn claims(plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    let (outcome, ..) = sample(plan, options, stop)?;
    let studied = Studied::new(plan, &outcome.detections, &outcome.nulls);
    if options.format == Format::Json {
        println!("{}", json_line(&studied, &outcome, None));
    } else {
        println!("{}:", plan.name);
        study::sentences(&studied).iter().for_each(|sentence| println!("    {sentence}"));
    }
    Ok(if outcome.whole { status(&studied) } else { INTERRUPTED })
}

fn status(studied: &Studied<'_>) -> u8 {
    if studied.holds() { HELD } else { NOT_HELD }
}

/// What the runs of each cell have shown, the text of `timing.csv`, and the seconds of each cell.
fn sample(plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<(Outcome, String, Vec<f64>), Error> {
    let pool = pool(options)?;
    let progress = Progress::new(plan, options.quiet || options.format == Format::Json);
    let mut detections = Vec::new();
    let mut taken = Vec::new();
    let mut timing = String::from("cell,seconds\n");
    for (i, cell) in plan.cells.iter().enumerate() {
        let label = plan.label(cell);
        progress.cell(&label);
        let start = Instant::now();
        let detection = pool.install(|| detect(plan, i, stop, &|rays| progress.rays(rays)));
        let seconds = start.elapsed().as_secs_f64();
        taken.push(seconds);
        if let Some(detection) = &detection {
            progress.done(&label, i + 1, plan, seconds, &shown(detection));
            timing.push_str(&format!("{i},{seconds:.4}\n"));
        }
        detections.push(detection);
    }
    let mut nulls = Vec::new();
    for null in &plan.spec.null {
        let null = null.planned(options.quick);
        progress.cell(&null.law.to_string());
        let start = Instant::now();
        nulls.push(pool.install(|| null.rows(plan.spec.seed, stop)));
        timing.push_str(&format!("{},{:.4}\n", null.law, start.elapsed().as_secs_f64()));
    }
    progress.finish();
    let whole = detections.iter().all(Option::is_some) && nulls.iter().all(Option::is_some);
    let nulls = nulls.into_iter().flatten().flatten().collect();
    Ok((Outcome { detections, nulls, whole }, timing, taken))
}

/// In how many runs the bench found something.
fn shown(detection: &Detection) -> String {
    let found = Instrument::ALL.iter().zip(&detection.found).find(|(i, _)| **i == Instrument::Verdict);
    let found = found.and_then(|(_, found)| *found).unwrap_or(0);
    format!("something found in {found} of {} runs", detection.seeds)
}

/// Rebuilds the report of a stored study.
pub fn report(source: &Source, plan: &Plan, options: &Options) -> Result<u8, Error> {
    let folder = source.report_folder(options);
    let path = folder.join(STUDY);
    let read = |path: &Path| file::bytes(path, file::STORED).map_err(|e| Error::io("cannot read", path, e));
    let outcome = Outcome::parse(&path, &read(&path)?, plan)?;
    let store = Store::open(&folder)?;
    for name in ["timing.csv", STUDY] {
        store.write(name, &read(&folder.join(name))?)?;
    }
    let held = write(plan, &outcome, &Run::read(&folder)?, &store)?;
    let folder = store.publish(None)?;
    overview::write(&source.reports(options))?;
    print(plan, &outcome, &folder, options);
    Ok(held)
}

fn write(plan: &Plan, outcome: &Outcome, run: &Run, store: &Store) -> Result<u8, Error> {
    let studied = Studied::new(plan, &outcome.detections, &outcome.nulls);
    if !outcome.nulls.is_empty() {
        store.write("nulls.csv", &study::nulls::csv(&outcome.nulls))?;
    }
    store.write("results.csv", &study::csv(&studied))?;
    let held = studied.holds();
    let verdict = if held { Verdict::Pass } else { Verdict::Fail };
    let summary = Summary {
        experiment: plan.name.clone(),
        question: plan.spec.question.clone(),
        answer: study::sentences(&studied),
        cells: plan.cells.len(),
        verdicts: vec![(verdict, 1)],
        figure: None,
    };
    store.write(overview::FILE, summary.text().as_bytes())?;
    store.write(run::FILE, run.text().as_bytes())?;
    store.write("index.html", study::page(&studied, !outcome.whole, run).as_bytes())?;
    Ok(status(&studied))
}

fn print(plan: &Plan, outcome: &Outcome, folder: &Path, options: &Options) {
    let studied = Studied::new(plan, &outcome.detections, &outcome.nulls);
    if options.format == Format::Json {
        println!("{}", json_line(&studied, outcome, Some(folder)));
        return;
    }
    println!("{}\n", plan.spec.question);
    study::sentences(&studied).iter().for_each(|sentence| println!("- {sentence}"));
    println!("\nThe page: {}", folder.join("index.html").display());
}

fn json_line(studied: &Studied<'_>, outcome: &Outcome, folder: Option<&Path>) -> String {
    Object::new(studied.plan(), Content::Study(Study::new(studied, !outcome.whole, folder))).line()
}
