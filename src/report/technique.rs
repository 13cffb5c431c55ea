//! Which technique is wrong: cells that differ in nothing but how direct light is found, side by side.

use super::lookup::Lookup;
use super::{number, wrong};
use crate::estimator::{Estimator, Technique};
use crate::experiment::CellPlan;
use crate::scene::{Directions, LightSampling};
use crate::stats::Verdict;

/// How direct light is found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Light,
    Direction,
    Both,
}

/// Technique and what else a cell's estimator is made of: how points on lights are drawn, where that matters.
fn made_of(estimator: &Estimator) -> Option<(Kind, Directions, Option<LightSampling>)> {
    match estimator {
        Estimator::Implicit(e) => Some((Kind::Direction, e.directions, None)),
        Estimator::Explicit(e) => Some(match e.technique {
            Technique::Light => (Kind::Light, e.directions, Some(e.lights)),
            Technique::Direction => (Kind::Direction, e.directions, None),
            Technique::Both(_) => (Kind::Both, e.directions, Some(e.lights)),
        }),
        Estimator::Recursive(_) | Estimator::LightTracing(_) | Estimator::PhotonMap(_) => None,
    }
}

/// Whether two cells differ in their technique only.
fn are_alike(a: &CellPlan, b: &CellPlan) -> bool {
    let (Some(left), Some(right)) = (made_of(&a.estimator), made_of(&b.estimator)) else { return false };
    let lights = left.2.is_none() || right.2.is_none() || left.2 == right.2;
    lights
        && left.1 == right.1
        && a.scene == b.scene
        && a.scene_label == b.scene_label
        && a.params == b.params
        && a.estimator.roulette() == b.estimator.roulette()
        && a.fault.map(|fault| fault.name) == b.fault.map(|fault| fault.name)
}

/// "explicit is wrong, implicit is right: the mistake is in sampled lights", if others stand beside a wrong cell.
pub fn sentence(lookup: &Lookup<'_>, cell: usize) -> Option<String> {
    let cells = &lookup.plan.cells;
    let finished = (0..cells.len()).filter(|&c| !lookup.cell(c).is_empty());
    let alike: Vec<usize> = finished.filter(|&c| are_alike(&cells[cell], &cells[c])).collect();
    if alike.len() < 2 {
        return None;
    }
    let is_right = |c: usize| lookup.verdict(c) == Some(Verdict::Pass);
    let named = |of: &dyn Fn(usize) -> bool, one: &str, several: &str| {
        let names: Vec<String> =
            alike.iter().filter(|&&c| of(c)).map(|&c| cells[c].estimator_label.clone()).collect();
        let verb = if names.len() == 1 { one } else { several };
        (!names.is_empty()).then(|| format!("{} {verb}", number::list(&names, "and")))
    };
    let parts = [
        named(&|c| wrong::is_wrong(lookup, c), "is wrong", "are wrong"),
        named(&is_right, "is right", "are right"),
        named(&|c| !wrong::is_wrong(lookup, c) && !is_right(c), "is undecided", "are undecided"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    let state = |kind: Kind| {
        let of_kind =
            alike.iter().copied().filter(|&c| made_of(&cells[c].estimator).is_some_and(|m| m.0 == kind));
        State::of(lookup, &of_kind.collect::<Vec<_>>())
    };
    let culprit = culprit(state(Kind::Light), state(Kind::Direction), state(Kind::Both));
    let culprit = culprit.map_or_else(String::new, |culprit| format!(". The mistake is {culprit}"));
    Some(format!("Techniques, all else alike: {}{culprit}.", parts.join("; ")))
}

/// What is known of the cells of a technique together.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Right,
    Wrong,
    Unknown,
}

impl State {
    fn of(lookup: &Lookup<'_>, cells: &[usize]) -> Self {
        if cells.iter().any(|&c| wrong::is_wrong(lookup, c)) {
            State::Wrong
        } else if !cells.is_empty() && cells.iter().all(|&c| lookup.verdict(c) == Some(Verdict::Pass)) {
            State::Right
        } else {
            State::Unknown
        }
    }
}

/// Where the mistake must be, if the techniques tell.
fn culprit(light: State, direction: State, both: State) -> Option<&'static str> {
    use State::{Right, Wrong};
    match (light, direction, both) {
        (Wrong, Right, _) => Some("where lights are sampled"),
        (Right, Wrong, _) => Some("where continued directions find light"),
        (Right, Right, Wrong) => Some("in the weights that combine both techniques"),
        (Wrong, Wrong, _) => Some("in what all of them share: materials, continued directions, roulette"),
        _ => None,
    }
}
