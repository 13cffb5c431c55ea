//! Studies: every cell with many seeds.

use crate::args::{Format, Options};
use crate::files::Source;
use crate::progress::Progress;
use crate::run::{pool, provenance};
use crate::{HELD, INTERRUPTED, NOT_HELD};
use furnace::experiment::store::Store;
use furnace::experiment::study::{Detection, detect};
use furnace::experiment::{Error, Plan};
use furnace::report::study::{self, Studied};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// What a study keeps.
const STUDY: &str = "study.json";

/// Runs a study.
pub fn one(source: &Source, plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    let store = Store::open(&source.report_folder(options))?;
    let (detections, timing) = sample(plan, options, stop)?;
    let interrupted = detections.iter().any(Option::is_none);
    store.write("timing.csv", timing.as_bytes())?;
    store.write("run.json", provenance(source, plan).as_bytes())?;
    store.write(STUDY, &serde_json::to_vec(&detections).expect("counts have a JSON form"))?;
    let held = write(plan, &detections, &store)?;
    let partial = format!("{}-interrupted", source.name);
    let folder = store.publish(interrupted.then_some(partial.as_str()))?;
    print(plan, &detections, &folder, options);
    Ok(if interrupted { INTERRUPTED } else { held })
}

/// Judges a study without a report.
pub fn claims(plan: &Plan, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    let (detections, _) = sample(plan, options, stop)?;
    let studied = Studied::new(plan, &detections);
    println!("{}:", plan.name);
    study::sentences(&studied).iter().for_each(|sentence| println!("    {sentence}"));
    let interrupted = detections.iter().any(Option::is_none);
    Ok(if interrupted { INTERRUPTED } else { status(&studied) })
}

fn status(studied: &Studied<'_>) -> u8 {
    if studied.holds() { HELD } else { NOT_HELD }
}

/// What the runs of each cell have shown, and how long they took.
fn sample(
    plan: &Plan,
    options: &Options,
    stop: &AtomicBool,
) -> Result<(Vec<Option<Detection>>, String), Error> {
    let pool = pool(options)?;
    let progress = Progress::new(plan, options.quiet || options.format == Format::Json);
    let mut detections = Vec::new();
    let mut timing = String::from("cell,seconds\n");
    for (i, cell) in plan.cells.iter().enumerate() {
        let label = plan.label(cell);
        progress.cell(&label);
        let start = Instant::now();
        let detection = pool.install(|| detect(plan, i, stop, &|rays| progress.rays(rays)));
        let seconds = start.elapsed().as_secs_f64();
        if detection.is_some() {
            progress.done(&label, i + 1, plan, seconds);
            timing.push_str(&format!("{i},{seconds:.4}\n"));
        }
        detections.push(detection);
    }
    progress.finish();
    Ok((detections, timing))
}

/// Rebuilds the report of a stored study.
pub fn report(plan: &Plan, folder: &Path, options: &Options) -> Result<u8, Error> {
    let path = folder.join(STUDY);
    let text = std::fs::read(&path).map_err(|e| Error::io("cannot read", &path, e))?;
    let damaged = |e: serde_json::Error| Error::Refused(format!("{} is damaged: {e}", path.display()));
    let detections: Vec<Option<Detection>> = serde_json::from_slice(&text).map_err(damaged)?;
    if detections.len() != plan.cells.len() {
        let why = format!("{} holds other cells than are planned now; run the study again", path.display());
        return Err(Error::Refused(why));
    }
    let store = Store::open(folder)?;
    for file in ["timing.csv", "run.json", STUDY] {
        let path = folder.join(file);
        store.write(file, &std::fs::read(&path).map_err(|e| Error::io("cannot read", &path, e))?)?;
    }
    let held = write(plan, &detections, &store)?;
    let folder = store.publish(None)?;
    print(plan, &detections, &folder, options);
    Ok(held)
}

fn write(plan: &Plan, detections: &[Option<Detection>], store: &Store) -> Result<u8, Error> {
    let studied = Studied::new(plan, detections);
    store.write("results.csv", &study::csv(&studied))?;
    let interrupted = detections.iter().any(Option::is_none);
    store.write("index.html", study::page(&studied, interrupted).as_bytes())?;
    Ok(status(&studied))
}

fn print(plan: &Plan, detections: &[Option<Detection>], folder: &Path, options: &Options) {
    let sentences = study::sentences(&Studied::new(plan, detections));
    let page = folder.join("index.html");
    if options.format == Format::Json {
        let object = serde_json::json!({
            "schema": 1, "experiment": plan.name, "answer": sentences, "detections": detections, "page": page,
        });
        println!("{object}");
        return;
    }
    println!("{}\n", plan.spec.question);
    sentences.iter().for_each(|sentence| println!("- {sentence}"));
    println!("\nThe page: {}", page.display());
}
