//! What will be run, what it will cost, and how many samples it takes.

use crate::HELD;
use crate::args::Options;
use crate::files::{self, Source};
use furnace::experiment::allot::wanted_samples;
use furnace::experiment::plan::RAYS_PER_SECOND;
use furnace::experiment::store::{self, Stored};
use furnace::experiment::verdict::level;
use furnace::experiment::{CellPlan, Error, Plan};

/// Prints the resolved grid of each experiment.
pub fn plans(names: &[String], margin: Option<f64>, options: &Options) -> Result<u8, Error> {
    for name in names {
        let source = Source::read(name, options)?;
        let plan = source.plan(options)?;
        // an earlier run knows variances that theory does not
        let stored = store::load(&source.report_folder(options), &mut plan.clone()).ok();
        println!("{}: {}\n", plan.name, plan.spec.question);
        for (i, cell) in plan.cells.iter().enumerate() {
            println!(
                "{:<64} {:>12} samples {:>10.2e} rays{}",
                plan.label(cell),
                cell.samples,
                cell.total_rays(),
                needed(&plan, cell, i, margin, stored.as_ref())
            );
        }
        for out in &plan.left_out {
            println!("{:<64} left out: {}", plan.label(&out.cell), out.why);
        }
        println!("{}", cost(&plan));
    }
    Ok(HELD)
}

/// How many samples the margin will take; nothing where no mean is claimed.
fn needed(
    plan: &Plan,
    cell: &CellPlan,
    index: usize,
    margin: Option<f64>,
    stored: Option<&Stored>,
) -> String {
    let about = |claim: &&furnace::experiment::spec::Claim| {
        claim.unbiased().is_some_and(|l| l.covers(&cell.scene_label))
    };
    let Some(claim) = plan.spec.claim.iter().position(|claim| about(&claim)) else { return String::new() };
    let limits = plan.spec.claim[claim].unbiased();
    let Some(margin) = margin.or(limits.map(|limits| limits.margin)) else { return String::new() };
    let measured = stored.and_then(|s| s.cells.get(index)?.as_ref()).map(|cell| &cell.total);
    let percent = 100.0 * margin;
    match wanted_samples(cell, margin, level(plan, claim), measured) {
        Some(n) => format!("   ±{percent} % takes {n} samples"),
        None => format!("   ±{percent} %: no variance is known; run it once, --quick will do"),
    }
}

/// Prints a paragraph on each experiment.
pub fn list(options: &Options) -> Result<u8, Error> {
    for name in files::names()? {
        let plan = Source::read(&name, options)?.plan(options)?;
        println!("{}: {}\n    {}", plan.name, plan.spec.question, cost(&plan));
    }
    Ok(HELD)
}

fn cost(plan: &Plan) -> String {
    let rays: f64 = plan.cells.iter().map(|cell| cell.total_rays()).sum();
    let seconds = rays / RAYS_PER_SECOND;
    format!("{} cells, at most about {rays:.1e} rays, {seconds:.0} core-seconds", plan.cells.len())
}
