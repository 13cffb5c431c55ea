//! How to repeat a run, and what ran.

use crate::experiment::{Core, Plan};
use crate::report::lookup::Lookup;
use crate::report::run::Run;
use maud::{Markup, PreEscaped, html};
use serde_json::json;

/// The command, the file, the references and where the data is.
pub fn section(lookup: &Lookup<'_>) -> Markup {
    let plan = lookup.plan;
    let files: &[&str] = match plan.cells.iter().any(|cell| cell.traced) {
        true => &["results.csv", "convergence.csv", "timing.csv", "run.json"],
        false => &["results.csv", "timing.csv", "run.json"],
    };
    let command = format!(
        "cargo run --bin experiment -- {} --seed {}{}{}",
        plan.name,
        plan.spec.seed,
        samples(lookup),
        core(plan)
    );
    html! {
        @for r in &plan.references { p { "Reference of " (r.scene) ": " code { (r.file) } "." } }
        @if let Some(cores) = cores(plan) { p { (cores) } }
        (repeat(plan, &command, files))
    }
}

/// The command that repeats a run, the numbers of this one, which the script fills in, and the files beside the page.
pub fn repeat(plan: &Plan, command: &str, files: &[&str]) -> Markup {
    html! {
        pre.command { (command) }
        p { "Seed " (plan.spec.seed) ". The same bytes for any number of threads, on any machine." }
        dl #provenance {}
        p { "Data: " @for (i, file) in files.iter().enumerate() { @if i > 0 { ", " } a href=(file) { (file) } } "." }
    }
}

/// The one line of the page that is of this run: all else is a function of what was measured.
pub fn line(run: &Run) -> Markup {
    let data = json!({
        "version": run.version,
        "commit": run.commit,
        "started": run.started,
        "threads": run.threads,
        "machine": run.machine,
        "seconds": run.seconds,
    });
    // a letter that ends the element stays inside the string
    let text = data.to_string().replace('<', "\\u003c");
    html! { "\n" script type="application/json" id="run" { (PreEscaped(text)) } "\n" }
}

/// The option that makes the fast path sample; that of the file may be another.
fn core(plan: &Plan) -> &'static str {
    let is_fast = plan.cells.iter().any(|cell| cell.core == Core::Fast);
    if is_fast { " --core fast" } else { "" }
}

/// Which cells the fast path has sampled, if any.
fn cores(plan: &Plan) -> Option<String> {
    let fast = plan.cells.iter().filter(|cell| cell.core == Core::Fast).count();
    let all = plan.cells.len();
    let which = if fast == all { "All cells were".to_owned() } else { format!("{fast} of {all} cells were") };
    let how = "sampled by the fast path: single precision, sixteen paths side by side";
    let rest = if fast == all { "." } else { "; the others by the textbook, in double precision." };
    (fast > 0).then(|| format!("{which} {how}{rest}"))
}

/// The option that gives all cells the samples that they have, where the file would not.
fn samples(lookup: &Lookup<'_>) -> String {
    let (plan, spec) = (lookup.plan, &lookup.plan.spec);
    let first = plan.cells[0].samples;
    let as_written = spec.grid.0.iter().all(|grid| grid.samples.unwrap_or(spec.samples) == first);
    let alike = plan.cells.iter().all(|cell| cell.samples == first);
    if alike && !as_written { format!(" --samples {first}") } else { String::new() }
}
