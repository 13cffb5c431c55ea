//! What is planned, as an object.

use super::{LeftOut, Subject, finite, left_out};
use crate::experiment::allot::wanted_samples;
use crate::experiment::plan::RAYS_PER_SECOND;
use crate::experiment::spec::Claim;
use crate::experiment::store::Stored;
use crate::experiment::verdict::level;
use crate::experiment::{CellPlan, Plan};
use schemars::JsonSchema;
use serde::Serialize;

/// What would be run.
#[derive(Serialize, JsonSchema)]
pub struct Planned {
    /// All chance would follow from it.
    seed: u64,
    #[serde(flatten)]
    cost: Cost,
    /// All cells.
    cells: Vec<PlannedCell>,
    /// Cells that cannot be run.
    left_out: Vec<LeftOut>,
}

/// A cell that would be run.
#[derive(Serialize, JsonSchema)]
pub struct PlannedCell {
    #[serde(flatten)]
    subject: Subject,
    /// Realizations.
    samples: u64,
    /// Rays of the whole cell, at most about.
    rays: Option<f64>,
    /// The relative margin for which `samples_for_margin` is meant; null where no mean is claimed.
    margin: Option<f64>,
    /// Realizations that the margin takes; null where no variance is known.
    samples_for_margin: Option<u64>,
}

/// An experiment in the list of all.
#[derive(Serialize, JsonSchema)]
pub struct Listed {
    /// The answer that its file states.
    answer: String,
    /// Number of cells.
    cells: usize,
    #[serde(flatten)]
    cost: Cost,
}

/// What it would cost.
#[derive(Serialize, JsonSchema)]
pub struct Cost {
    /// Rays, at most about.
    rays: Option<f64>,
    /// Seconds on one core.
    core_seconds: Option<f64>,
}

impl Cost {
    fn of(plan: &Plan) -> Self {
        let rays: f64 = plan.cells.iter().map(CellPlan::total_rays).sum();
        Cost { rays: finite(rays), core_seconds: finite(rays / RAYS_PER_SECOND) }
    }
}

impl Planned {
    /// The plan, for another relative margin than that of the claims if one is given; an earlier run knows variances.
    pub fn new(plan: &Plan, wanted: Option<f64>, stored: Option<&Stored>) -> Self {
        let cell = |(index, cell): (usize, &CellPlan)| {
            let (margin, samples) = margin(plan, index, wanted, stored).unzip();
            PlannedCell {
                subject: Subject::new(plan, cell),
                samples: cell.samples,
                rays: finite(cell.total_rays()),
                margin,
                samples_for_margin: samples.flatten(),
            }
        };
        let cells = plan.cells.iter().enumerate().map(cell).collect();
        Planned { seed: plan.spec.seed, cost: Cost::of(plan), cells, left_out: left_out(plan) }
    }
}

impl Listed {
    /// A line of the list.
    pub fn new(plan: &Plan) -> Self {
        Listed { answer: plan.spec.answer.clone(), cells: plan.cells.len(), cost: Cost::of(plan) }
    }
}

/// The margin of a cell and how many realizations it takes, if a variance is known; nothing where no mean is claimed.
pub fn margin(
    plan: &Plan,
    index: usize,
    wanted: Option<f64>,
    stored: Option<&Stored>,
) -> Option<(f64, Option<u64>)> {
    let cell = &plan.cells[index];
    let about = |claim: &Claim| claim.unbiased().is_some_and(|limits| limits.covers(&cell.scene_label));
    let claim = plan.spec.claim.iter().position(about)?;
    let margin = wanted.or(plan.spec.claim[claim].unbiased().map(|limits| limits.margin))?;
    let measured = stored.and_then(|s| s.cells.get(index)?.as_ref()).map(|cell| &cell.total);
    Some((margin, wanted_samples(cell, margin, level(plan, claim), measured)))
}
