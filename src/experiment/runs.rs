//! Cells that are cut into runs: how many realizations each has, and whether that can work.

use super::plan::{CellPlan, Overrides};
use super::spec::{Grid, Spec};
use crate::estimator::{Estimator, Gather};
use crate::stats::decay::MIN_RUNS;
use std::ops::Range;

/// Where something is wrong, and what.
type Wrong = (Range<usize>, String);

/// A shorter run shows no rate.
const SHORTEST: u64 = 16;

/// Realizations of one run, if the cells of `grid` are cut into runs; `span` is where the estimator is written.
pub fn realizations(
    spec: &Spec,
    grid: &Grid,
    estimator: &Estimator,
    span: &Range<usize>,
) -> Result<Option<u64>, Wrong> {
    let Some(written) = grid.runs.as_ref().or(spec.runs.as_ref()) else { return Ok(None) };
    let (runs, samples) = (written.get_ref().0, grid.samples.unwrap_or(spec.samples));
    let wrong = |message: String| Err((written.span(), message));
    if spec.seeds.is_some() {
        return wrong("a study (`seeds`) repeats its cells itself; leave `runs` out".to_owned());
    }
    let near = (samples / runs).max(SHORTEST) * runs;
    if samples / runs < SHORTEST {
        return wrong(format!(
            "{samples} samples in {runs} runs leave fewer than {SHORTEST} for a run, which show no rate; take \
             {near} samples, or fewer runs"
        ));
    }
    if !samples.is_multiple_of(runs) {
        return wrong(format!("{runs} runs do not divide {samples} samples; take {near} samples, say"));
    }
    let run = samples / runs;
    match estimator {
        Estimator::PhotonMap(map) => match map.gather {
            Gather::Shrinking { passes, .. } if passes != run => Err((
                span.clone(),
                format!(
                    "a run must be one picture, and {samples} samples in {runs} runs make {run} maps a run where a \
                     picture has passes = {passes}; take passes = {run}, or {} samples",
                    passes.saturating_mul(runs)
                ),
            )),
            _ => Ok(Some(run)),
        },
        _ => Ok(Some(run)),
    }
}

/// A claim of rates needs cells that have some.
pub fn are_there(spec: &Spec, cells: &[CellPlan]) -> Result<(), Wrong> {
    for claim in &spec.claim {
        let super::spec::Claim::Rate(limits) = claim else { continue };
        let traced = |cell: &CellPlan| cell.traced && limits.get_ref().covers(&cell.scene_label);
        if !cells.iter().any(traced) {
            let why = "rates are measured between runs, and no cell of this claim is cut into some; add \
                       `runs = 256`, say, to the file or to a grid";
            return Err((limits.span(), why.to_owned()));
        }
    }
    Ok(())
}

/// Samples of a cell that is cut into runs, after the command line's changes: there are fewer or more runs then, not
/// shorter ones.
pub fn whole(cell: &CellPlan, overrides: &Overrides) -> u64 {
    let wanted = overrides.samples.unwrap_or(cell.samples);
    let wanted = if overrides.quick { wanted / 100 } else { wanted };
    (wanted / cell.block).max(MIN_RUNS as u64) * cell.block
}
