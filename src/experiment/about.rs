//! Claims and plots must be about what is run: one of what is not there would hold for ever.

use super::error::Error;
use super::plan::{CellPlan, Plan};
use super::spec::{Claim, Plot};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// Where a file writes its claims and plots.
#[derive(Default, Deserialize)]
struct Places {
    #[serde(default)]
    claim: Vec<Spanned<IgnoredAny>>,
    #[serde(default)]
    plot: Vec<Spanned<IgnoredAny>>,
}

/// A name that nothing has, and why that is wrong.
type Wrong = (String, String);

/// Refuses claims and plots of what is not run, at their places in the file, whose text is `source`.
pub fn something(plan: &Plan, file: &Path, source: &str) -> Result<(), Error> {
    let places: Places = toml::from_str(source).unwrap_or_default();
    let at = |place: Option<&Spanned<IgnoredAny>>, (name, why): Wrong| {
        Error::at(file, source, named(source, place.map_or(0, |place| place.span().start), &name), why)
    };
    for (i, claim) in plan.spec.claim.iter().enumerate() {
        claimed(&plan.cells, claim).map_err(|wrong| at(places.claim.get(i), wrong))?;
    }
    for (i, plot) in plan.spec.plot.iter().enumerate() {
        drawn(plan, plot).map_err(|wrong| at(places.plot.get(i), wrong))?;
    }
    Ok(())
}

/// Where `name` stands in quotes from `start` on.
fn named(source: &str, start: usize, name: &str) -> Range<usize> {
    let quoted = [format!("\"{name}\""), format!("'{name}'")];
    let found = quoted.iter().find_map(|name| Some((source[start..].find(name)?, name.len())));
    found.map_or(start..start + 1, |(at, length)| start + at..start + at + length)
}

/// The scene must be there.
fn scene(cells: &[CellPlan], what: &str, name: &String) -> Result<(), Wrong> {
    if cells.iter().any(|cell| cell.scene_label == *name) {
        return Ok(());
    }
    let mut known: Vec<&str> = cells.iter().map(|cell| cell.scene_label.as_str()).collect();
    known.dedup();
    Err((name.clone(), format!("{what} names the scene `{name}`; there are: {}", known.join(", "))))
}

fn claimed(cells: &[CellPlan], claim: &Claim) -> Result<(), Wrong> {
    claim.scene().map_or(Ok(()), |name| scene(cells, "a claim", name))?;
    let Claim::Agree { estimator, roulette, .. } = claim else { return Ok(()) };
    if cells.iter().any(|c| c.estimator_label == *estimator && c.roulette_label == *roulette) {
        return Ok(());
    }
    let known = cells.iter().map(|c| format!("`{}` with `{}`", c.estimator_label, c.roulette_label));
    let known = known.collect::<BTreeSet<String>>().into_iter().collect::<Vec<_>>().join(", ");
    let has_estimator = cells.iter().any(|c| c.estimator_label == *estimator);
    let name = if has_estimator { roulette } else { estimator };
    Err((name.clone(), format!("agree names `{estimator}` with `{roulette}`; there are: {known}")))
}

fn drawn(plan: &Plan, plot: &Plot) -> Result<(), Wrong> {
    match plot {
        Plot::Bars { scene: name } | Plot::Convergence { scene: name, .. } => {
            scene(&plan.cells, "a plot", name)
        }
        Plot::Shares { scene: name, of } => {
            scene(&plan.cells, "a plot", name)?;
            let is_run = plan.cells.iter().any(|c| c.scene_label == *name && c.estimator_label == *of);
            let why = || format!("a plot takes shares of `{of}`, which is not run in {name}");
            if is_run { Ok(()) } else { Err((of.clone(), why())) }
        }
        Plot::Over { parameter, .. } if !plan.swept.contains(parameter) => {
            let known = plan.swept.join(", ");
            let why = format!("a plot goes over `{parameter}`, which is not swept; swept are: {known}");
            Err((parameter.clone(), why))
        }
        _ => Ok(()),
    }
}
