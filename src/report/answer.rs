//! The answer in words, generated from the rows: which rule is best, whether it is right, how sure that is.

use super::lookup::Lookup;
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Claim;
use crate::experiment::{CellPlan, Estimand, Row};
use crate::stats::Verdict;
use crate::truth::best_constant_q;

/// A sentence for each scene and estimator on efficiency, and one on the claims.
pub fn sentences(lookup: &Lookup<'_>) -> Vec<String> {
    let mut sentences = Vec::new();
    for scene in lookup.scenes() {
        let cells = lookup.of_scene(scene);
        let mut estimators: Vec<&str> = Vec::new();
        for &cell in &cells {
            let label = lookup.plan.cells[cell].estimator_label.as_str();
            if !estimators.contains(&label) {
                estimators.push(label);
            }
        }
        for estimator in estimators {
            let unbiased = |&c: &usize| {
                let cell = &lookup.plan.cells[c];
                cell.estimator_label == estimator && cell.is_unbiased() && passes(lookup, c)
            };
            let candidates: Vec<usize> = cells.iter().copied().filter(unbiased).collect();
            if candidates.len() > 1 {
                sentences.push(format!("{scene}, {estimator}: {}.", best(lookup, &candidates)));
            }
        }
    }
    sentences.push(claims(lookup));
    sentences
}

/// Neither shown to be wrong nor invalid.
fn passes(lookup: &Lookup<'_>, cell: usize) -> bool {
    !matches!(lookup.verdict(cell), Some(Verdict::Fail | Verdict::Invalid))
}

fn best(lookup: &Lookup<'_>, candidates: &[usize]) -> String {
    if lookup.is_image(candidates[0]) {
        let by = |estimand, what: &str| {
            most_efficient(lookup, candidates, &|c| Some(lookup.efficiency(c, estimand)?.0))
                .map(|(label, _)| format!("{label} by {what}"))
        };
        let kinds = [
            by(Estimand::MedianPixelVariance, "the median pixel's variance"),
            by(Estimand::PixelVariance, "the mean over pixels"),
        ];
        let kinds: Vec<String> = kinds.into_iter().flatten().collect();
        return format!("the most efficient unbiased rule is {}", kinds.join(", and "));
    }
    let channel_best = |channel: usize| {
        let efficiency = |c: usize| lookup.row(c, Estimand::Mean, Some(channel))?.efficiency;
        let (label, cell) = most_efficient(lookup, candidates, &efficiency)?;
        let note = theory(&lookup.plan.cells[cell], channel);
        Some(format!("{label} for {}{note}", CHANNELS[channel]))
    };
    let best: Vec<String> = (0..3).filter_map(channel_best).collect();
    if best.is_empty() {
        return "no cell has an efficiency to compare".to_owned();
    }
    format!("the most efficient unbiased rule tried is {}", best.join("; "))
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
    match best_constant_q(&cell.scene, &cell.estimator, channel) {
        None => String::new(),
        Some(optimum) => match optimum.best {
            Some(q) => format!(
                " (theory: constant q is best at {q:.3}, of infinite variance up to {:.3})",
                optimum.infinite_up_to
            ),
            None => format!(
                " (theory: no constant q is best, efficiency only grows towards q = 1; infinite variance up to {:.3})",
                optimum.infinite_up_to
            ),
        },
    }
}

fn claims(lookup: &Lookup<'_>) -> String {
    let plan = lookup.plan;
    let rows: Vec<&Row> = (0..plan.cells.len()).flat_map(|c| lookup.cell(c).iter().copied()).collect();
    let count = |verdict| rows.iter().filter(|r| r.verdict == Some(verdict)).count();
    let judged = rows.iter().filter(|r| r.verdict.is_some()).count();
    let alpha: f64 = plan.spec.claim.iter().map(Claim::alpha).sum();
    format!(
        "Of {judged} questions {} passed, {} failed, {} stayed inconclusive and {} were invalid; were all well, \
         any false alarm among them had a probability of at most {alpha}.",
        count(Verdict::Pass),
        count(Verdict::Fail),
        count(Verdict::Inconclusive),
        count(Verdict::Invalid)
    )
}
