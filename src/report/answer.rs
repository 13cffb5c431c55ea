//! The answer in words, generated from the rows: which rule is best, what sampling lights gains, what a clamp costs,
//! and whether the claims hold.

use super::lookup::Lookup;
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Claim;
use crate::experiment::{CellPlan, Estimand, Row};
use crate::stats::Verdict;
use crate::truth::best_constant_q;

/// One sentence on each thing that the experiment shows.
pub fn sentences(lookup: &Lookup<'_>) -> Vec<String> {
    let mut sentences = Vec::new();
    for group in groups(lookup, |a, b| a.scene == b.scene && a.estimator_label == b.estimator_label) {
        sentences.extend(best_rule(lookup, &group));
        sentences.extend(clamp(lookup, &group));
    }
    sentences.extend(gain(lookup));
    sentences.push(claims(lookup));
    sentences
}

/// Finished cells, grouped by what `alike` says.
fn groups(lookup: &Lookup<'_>, alike: impl Fn(&CellPlan, &CellPlan) -> bool) -> Vec<Vec<usize>> {
    let cells = &lookup.plan.cells;
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in (0..cells.len()).filter(|&i| !lookup.cell(i).is_empty()) {
        match groups.iter_mut().find(|group| alike(&cells[group[0]], &cells[i])) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

fn subject(cell: &CellPlan) -> String {
    format!("{}, {}", cell.scene_label, cell.estimator_label)
}

/// The most efficient of a group's unbiased rules.
fn best_rule(lookup: &Lookup<'_>, group: &[usize]) -> Option<String> {
    let fit = |&c: &usize| {
        let wrong = matches!(lookup.verdict(c), Some(Verdict::Fail | Verdict::Invalid));
        lookup.plan.cells[c].is_unbiased() && !wrong
    };
    let candidates: Vec<usize> = group.iter().copied().filter(fit).collect();
    if candidates.len() < 2 {
        return None;
    }
    let subject = subject(&lookup.plan.cells[candidates[0]]);
    if lookup.is_image(candidates[0]) {
        let by = |estimand, what: &str| {
            let efficiency = |c| Some(lookup.efficiency(c, estimand)?.0);
            most_efficient(lookup, &candidates, &efficiency).map(|(label, _)| format!("{label} by {what}"))
        };
        let kinds = [
            by(Estimand::MedianPixelVariance, "the median pixel's variance"),
            by(Estimand::PixelVariance, "the variance averaged over pixels"),
        ];
        let kinds: Vec<String> = kinds.into_iter().flatten().collect();
        return Some(format!("{subject}: the most efficient unbiased rule is {}.", kinds.join(", and ")));
    }
    let of_channel = |channel: usize| {
        let efficiency = |c: usize| lookup.row(c, Estimand::Mean, Some(channel))?.efficiency;
        let (label, cell) = most_efficient(lookup, &candidates, &efficiency)?;
        Some(format!("{} {label}{}", CHANNELS[channel], theory(&lookup.plan.cells[cell], channel)))
    };
    let best: Vec<String> = (0..3).filter_map(of_channel).collect();
    Some(format!("{subject}: the most efficient unbiased rule tried is {}.", best.join("; ")))
}

/// The cell of the highest efficiency: its label and number.
fn most_efficient(
    lookup: &Lookup<'_>,
    candidates: &[usize],
    efficiency: &dyn Fn(usize) -> Option<f64>,
) -> Option<(String, usize)> {
    let known = candidates.iter().filter_map(|&c| Some((c, efficiency(c)?)));
    let (cell, _) = known.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((lookup.plan.rule_label(&lookup.plan.cells[cell]), cell))
}

/// What theory says of constant q.
fn theory(cell: &CellPlan, channel: usize) -> String {
    let Some(optimum) = best_constant_q(&cell.scene, &cell.estimator, channel) else { return String::new() };
    let infinite = format!("infinite variance up to q = {:.3}", optimum.infinite_up_to);
    match optimum.best {
        Some(q) => format!(" (theory: the best constant q is {q:.3}; {infinite})"),
        None => format!(" (theory: no constant q is best, efficiency only grows towards q = 1; {infinite})"),
    }
}

/// What the shortest and the longest clamp of a group leave out, and what they cost.
fn clamp(lookup: &Lookup<'_>, group: &[usize]) -> Option<String> {
    let depth = |c: usize| lookup.plan.cells[c].estimator.roulette().clamp;
    let clamped: Vec<usize> = group.iter().copied().filter(|&c| depth(c).is_some()).collect();
    let (&first, &last) =
        (clamped.iter().min_by_key(|&&c| depth(c))?, clamped.iter().max_by_key(|&&c| depth(c))?);
    let part = |c: usize| {
        let percent = |channel: usize| {
            let row = lookup.row(c, Estimand::Mean, Some(channel))?;
            Some(format!("{:+.3}", 100.0 * row.bias? / row.truth?))
        };
        let bias: Vec<String> = (0..3).map(percent).collect::<Option<_>>()?;
        let rays = lookup.row(c, Estimand::Cost, None)?.mean / lookup.plan.cells[c].pixels as f64;
        Some(format!("at {} bounces {} % (R G B) for {rays:.1} rays", depth(c)?, bias.join(" ")))
    };
    let subject = subject(&lookup.plan.cells[first]);
    (depth(first) != depth(last))
        .then(|| Some(format!("{subject}: cut {}; {}.", part(first)?, part(last)?)))
        .flatten()
}

/// How much more efficient explicit is than implicit under the same rule.
fn gain(lookup: &Lookup<'_>) -> Vec<String> {
    let cells = &lookup.plan.cells;
    let pairs = groups(lookup, |a, b| {
        a.scene == b.scene && a.roulette_label == b.roulette_label && a.params == b.params && a.is_unbiased()
    });
    let sentence = |group: &Vec<usize>| {
        let of = |name: &str| group.iter().copied().find(|&c| cells[c].estimator_label == name);
        let (implicit, explicit) = (of("implicit")?, of("explicit")?);
        let estimand = if lookup.is_image(implicit) { Estimand::PixelVariance } else { Estimand::Mean };
        let (slow, fast) = (lookup.efficiency(implicit, estimand)?, lookup.efficiency(explicit, estimand)?);
        let ratio = fast.0 / slow.0;
        let relative = |(value, error): (f64, Option<f64>)| error.unwrap_or(f64::NAN) / value;
        let error = ratio * relative(slow).hypot(relative(fast));
        let label = lookup.plan.rule_label(&cells[implicit]);
        let scene = &cells[implicit].scene_label;
        Some(format!(
            "{scene}, {label}: explicit is {ratio:.3} ± {error:.3} times as efficient as implicit, all channels added."
        ))
    };
    let sentences: Vec<String> = pairs.iter().filter_map(sentence).collect();
    // a sweep over rules has its own answer
    let rules = lookup.plan.swept.iter().any(|name| name == "q");
    if rules { Vec::new() } else { sentences }
}

fn claims(lookup: &Lookup<'_>) -> String {
    let plan = lookup.plan;
    let rows: Vec<&Row> = (0..plan.cells.len()).flat_map(|c| lookup.cell(c).iter().copied()).collect();
    let count = |verdict| rows.iter().filter(|r| r.verdict == Some(verdict)).count();
    let judged = rows.iter().filter(|r| r.verdict.is_some()).count();
    if judged == 0 {
        return "Nothing was judged.".to_owned();
    }
    let alpha: f64 = plan.spec.claim.iter().map(Claim::alpha).sum();
    format!(
        "Of {judged} questions {} passed, {} failed, {} stayed inconclusive and {} were invalid; were all well, \
         any false alarm among them had a probability of at most {alpha:.4}.",
        count(Verdict::Pass),
        count(Verdict::Fail),
        count(Verdict::Inconclusive),
        count(Verdict::Invalid)
    )
}
