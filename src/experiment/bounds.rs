//! How much one file may ask for: refused before memory or time is taken for it, at the place where it is written.

use super::plan::{CellPlan, Plan, RAYS_PER_SECOND};
use super::spec::Spec;
use crate::estimator::{Estimator, MAX_RAYS};

/// Cells of an experiment, and so values of one sweep.
pub const CELLS: usize = 100_000;

/// Tables of one kind: claims, plots, references, laws.
pub const TABLES: usize = 1000;

/// Numbers in a list that is gone through pair by pair.
pub const LISTED: usize = 100;

/// Patches of an integrating sphere, whose chain has a matrix of their square.
pub const PATCHES: usize = 100;

/// Surfaces and lights in all scenes of a file together: those built, and those that cells keep a copy of.
pub const SURFACES: usize = 4_000_000;

/// Photons that one map may be expected to hold, or marks that particles leave in one picture: about 10 GB at worst.
const LANDED: f64 = 1e8;

/// Pixels of all images of an experiment together; each keeps a mean and a variance a channel until the report is written.
const PIXELS: u64 = 1 << 27;

/// Bytes of a pixel's mean and variance.
const PIXEL: u64 = 48;

/// More rays than this in one cell are out of proportion: hours on one core. So are more samples of a law.
const RAYS: f64 = 1e11;

/// Refuses more combinations than an experiment may have cells, before they are written out; `of` says of what.
pub fn combinations(counts: &[usize], of: &str) -> Result<(), String> {
    match counts.iter().try_fold(1, |product: usize, &count| product.checked_mul(count)) {
        Some(product) if product <= CELLS => Ok(()),
        product => {
            let product = product.map_or("more than 10^19".to_owned(), |product| product.to_string());
            Err(format!(
                "{of} make {product} cells, and an experiment has at most {CELLS}; sweep fewer values"
            ))
        }
    }
}

/// Refuses scenes of more surfaces than a file may have in all.
pub fn surfaces(count: usize, what: &str) -> Result<(), String> {
    if count <= SURFACES {
        return Ok(());
    }
    Err(format!("up to here {what} {count} surfaces, and at most {SURFACES} are allowed in one file"))
}

/// Refuses maps and pictures of particles that would not fit into memory; `walk` is how often one particle lands.
pub fn landed(estimator: &Estimator, walk: f64) -> Result<(), String> {
    let (sent, what) = match estimator {
        Estimator::LightTracing(e) => (e.particles, "particles"),
        Estimator::PhotonMap(e) => (e.photons, "photons"),
        _ => return Ok(()),
    };
    let landed = sent as f64 * walk;
    if landed <= LANDED {
        return Ok(());
    }
    Err(format!(
        "{sent} {what} may land {landed:.1e} times, and memory is taken for at most {LANDED:.0e}; send fewer a \
         realization, and take more samples"
    ))
}

/// Refuses what is not meant to be run without --force.
pub fn proportionate(plan: &Plan, force: bool) -> Result<(), String> {
    plan.cells.iter().try_for_each(|cell| cell_is(plan, cell, force))?;
    if force {
        return Ok(());
    }
    laws(&plan.spec, &plan.name)?;
    let pixels: u64 = plan.cells.iter().map(|cell| cell.pixels).filter(|pixels| *pixels > 1).sum();
    if pixels > PIXELS {
        let gigabytes = (pixels * PIXEL) as f64 / 1e9;
        return Err(format!(
            "{}: images of {pixels} pixels in all keep about {gigabytes:.0} GB in memory, and more than {PIXELS} are \
             out of proportion; lower the resolution, run fewer cells at once (--filter), or add --force",
            plan.name
        ));
    }
    Ok(())
}

fn cell_is(plan: &Plan, cell: &CellPlan, force: bool) -> Result<(), String> {
    let label = plan.label(cell);
    let one = cell.rays / cell.pixels as f64;
    // what is no number is not proportionate either
    if !one.is_finite() || one > MAX_RAYS as f64 {
        return Err(format!(
            "{label}: one sample would trace {one:.2e} rays, and a walk is cut at {MAX_RAYS}; \
             lower n or depth"
        ));
    }
    let total = cell.total_rays();
    if total > RAYS && !force {
        let hours = total / RAYS_PER_SECOND / 3600.0;
        return Err(format!(
            "{label}: {total:.2e} rays, about {hours:.0} hours on one core; lower n, depth or samples, \
             or add --force to run it all the same"
        ));
    }
    Ok(())
}

/// Laws are sampled as often as they say.
fn laws(spec: &Spec, name: &str) -> Result<(), String> {
    for null in &spec.null {
        let samples = null.samples as f64 * null.runs as f64 * null.bias.len() as f64;
        if samples > RAYS {
            return Err(format!(
                "{name}: {} is sampled {samples:.1e} times, and more than {RAYS:.0e} are out of proportion; lower \
                 samples or runs, or add --force to run it all the same",
                null.law
            ));
        }
    }
    Ok(())
}
