//! Sentences that compare the estimators of a family: what sampling lights gains, which is best, which light is missed.

use super::family::Family;
use super::lookup::Lookup;
use super::number;
use crate::estimator::Estimator;
use crate::experiment::Estimand;
use crate::stats::Verdict;

/// Efficiencies within so many standard errors are not told apart.
const APART: f64 = 3.0;

/// What follows the name of an estimator whose samples are all alike.
const NOISE_FREE: &str = ", without noise";

/// What the estimators of a family are to each other; nothing where rules are swept, which have their own sentence.
pub fn gain(lookup: &Lookup<'_>, family: &Family) -> Option<String> {
    let rules = lookup.plan.swept.iter().any(|name| name == "q")
        && lookup.plan.cells[family.cells[0]].params.contains_key("q");
    if rules {
        return None;
    }
    let ratio = explicit_to_implicit(lookup, family);
    let most =
        if ratio.is_some() && family.estimators(lookup).len() == 2 { None } else { best(lookup, family) };
    let parts: Vec<String> = ratio.into_iter().chain(most).collect();
    (!parts.is_empty()).then(|| format!("{}: {}.", family.subject(lookup), parts.join("; ")))
}

/// 1 / (variance x rays) of a cell that finds all light, with its standard error; infinite without noise.
fn efficiency(lookup: &Lookup<'_>, cell: usize) -> Option<(f64, f64)> {
    let wrong = matches!(lookup.verdict(cell), Some(Verdict::Fail | Verdict::Invalid));
    if wrong || !lookup.finds_all(cell) {
        return None;
    }
    if lookup.is_noise_free(cell) {
        return Some((f64::INFINITY, 0.0));
    }
    let estimand = if lookup.is_image(cell) { Estimand::PixelVariance } else { Estimand::Mean };
    lookup.efficiency(cell, estimand).map(|(value, error)| (value, error.unwrap_or(0.0)))
}

/// "explicit is 51.0 ± 0.7 times as efficient as implicit at light_fraction = 0.02, 1.66 ± 0.01 times at 0.9".
fn explicit_to_implicit(lookup: &Lookup<'_>, family: &Family) -> Option<String> {
    let of = |cells: &[usize], name: &str| {
        let cell = cells.iter().copied().find(|&c| lookup.plan.cells[c].estimator_label == name)?;
        efficiency(lookup, cell).filter(|(value, _)| value.is_finite())
    };
    let ratio = |(value, cells): (f64, Vec<usize>)| {
        let (slow, fast) = (of(&cells, "implicit")?, of(&cells, "explicit")?);
        let ratio = fast.0 / slow.0;
        Some((value, ratio, ratio * (slow.1 / slow.0).hypot(fast.1 / fast.0)))
    };
    let ratios: Vec<(f64, f64, f64)> = family.points(lookup).into_iter().filter_map(ratio).collect();
    let (first, last) = (ratios.first()?, ratios.last()?);
    let least = ratios.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let most = ratios.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut told = vec![first, least, most, last];
    told.sort_by(|a, b| a.0.total_cmp(&b.0));
    told.dedup_by_key(|point| point.0);
    let text = |&(_, ratio, error): &(f64, f64, f64)| number::with_error(ratio, error);
    let Some(parameter) = family.parameter else {
        return Some(format!("explicit is {} times as efficient as implicit", text(first)));
    };
    let rest = told[1..].iter().map(|point| format!(", {} times at {}", text(point), point.0));
    let (start, rest) = (text(told[0]), rest.collect::<String>());
    Some(format!("explicit is {start} times as efficient as implicit at {parameter} = {}{rest}", told[0].0))
}

/// The most efficient estimator, or those that are not told apart from it, over the parameter.
fn best(lookup: &Lookup<'_>, family: &Family) -> Option<String> {
    let points = family.points(lookup);
    let sets = points.iter().filter_map(|(value, cells)| Some((*value, winners(lookup, cells)?)));
    let sets: Vec<(f64, Vec<String>)> = sets.collect();
    let mut common = sets.first()?.1.clone();
    common.retain(|name| sets.iter().all(|(_, set)| set.contains(name)));
    let Some(parameter) = family.parameter else {
        return Some(format!("most efficient: {}", either(&common)));
    };
    if !common.is_empty() {
        return Some(format!("most efficient at every {parameter}: {}", either(&common)));
    }
    let mut runs: Vec<(f64, f64, &[String])> = Vec::new();
    for (value, set) in &sets {
        match runs.last_mut() {
            Some(run) if run.2 == set.as_slice() => run.1 = *value,
            _ => runs.push((*value, *value, set)),
        }
    }
    let told = runs.iter().map(|&(from, to, set)| {
        let place = if from == to { format!("{from}") } else { format!("{from} to {to}") };
        format!("at {place} {}", either(set))
    });
    Some(format!("most efficient over {parameter}: {}", told.collect::<Vec<_>>().join(", ")))
}

/// Those that are best together, and why none of them is better.
fn either(names: &[String]) -> String {
    let bare: Vec<String> =
        names.iter().filter_map(|name| Some(name.strip_suffix(NOISE_FREE)?.to_owned())).collect();
    match names {
        [one] => one.clone(),
        _ if bare.len() == names.len() => format!("{}{NOISE_FREE}", number::list(&bare, "and")),
        _ => format!("{} (not told apart)", number::list(names, "and")),
    }
}

/// The most efficient of at least two cells and those not told apart from it.
fn winners(lookup: &Lookup<'_>, cells: &[usize]) -> Option<Vec<String>> {
    let rivals: Vec<(usize, (f64, f64))> =
        cells.iter().filter_map(|&c| Some((c, efficiency(lookup, c)?))).collect();
    if rivals.len() < 2 {
        return None;
    }
    let (_, best) = *rivals.iter().max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    let close = |&&(_, (value, error)): &&(usize, (f64, f64))| {
        value == best.0 || best.0 - value < APART * error.hypot(best.1)
    };
    let name = |&(cell, (value, _)): &(usize, (f64, f64))| {
        let noise = if value.is_infinite() { NOISE_FREE } else { "" };
        format!("{}{noise}", lookup.plan.cells[cell].estimator_label)
    };
    Some(rivals.iter().filter(close).map(name).collect())
}

/// The light that estimators of a family have no way to find: not what their clamp cuts.
pub fn missed(lookup: &Lookup<'_>, family: &Family) -> Vec<String> {
    let points = family.points(lookup);
    let misses = |&&cell: &&usize| {
        let plan = &lookup.plan.cells[cell];
        let beside = points.iter().filter(|(_, cells)| cells.contains(&cell)).flat_map(|(_, cells)| cells);
        let possible =
            plan.estimator.roulette().clamp.is_none() || beside.clone().any(|&c| lookup.finds_all(c));
        // a photon map misses no light: it blurs it
        let is_map = matches!(plan.estimator, Estimator::PhotonMap(_));
        possible && !is_map && !lookup.finds_all(cell)
    };
    let mut told: Vec<(Vec<String>, String)> = Vec::new();
    for name in family.estimators(lookup) {
        let of_name = |&&cell: &&usize| lookup.plan.cells[cell].estimator_label == name;
        let cells: Vec<usize> = family.cells.iter().filter(of_name).filter(misses).copied().collect();
        let Some(text) = shares(lookup, &cells) else { continue };
        match told.iter_mut().find(|(_, other)| *other == text) {
            Some((names, _)) => names.push(name.to_owned()),
            None => told.push((vec![name.to_owned()], text)),
        }
    }
    let subject = family.subject(lookup);
    let sentence = |(names, text): (Vec<String>, String)| {
        let verb = if names.len() == 1 { "misses" } else { "miss" };
        format!("{subject}: {} {verb} {text}.", number::list(&names, "and"))
    };
    told.into_iter().map(sentence).collect()
}

/// "19.8 to 34.2 % of the light (theory: 20 to 34.1 %)", over channels and cells.
fn shares(lookup: &Lookup<'_>, cells: &[usize]) -> Option<String> {
    let rows = || {
        let of = |&cell: &usize| (0..3).filter_map(move |c| lookup.row(cell, Estimand::Mean, Some(c)));
        cells.iter().flat_map(of).filter(|row| row.truth.is_some_and(|truth| truth != 0.0))
    };
    let span = |values: Vec<f64>| {
        let low = values.iter().copied().reduce(f64::min)?;
        Some(number::range(low, values.iter().copied().fold(low, f64::max)))
    };
    let measured = span(rows().filter_map(|row| Some(-100.0 * row.bias? / row.truth?)).collect())?;
    let theory = span(rows().filter_map(|row| Some(-100.0 * row.expected_bias? / row.truth?)).collect())?;
    Some(if measured == theory {
        format!("{measured} % of the light, as theory says")
    } else {
        format!("{measured} % of the light (theory: {theory} %)")
    })
}
