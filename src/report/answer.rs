//! The answer in words, generated from the rows: which rule is best, what sampling lights gains, what a clamp costs,
//! and whether the claims hold.

use super::lookup::Lookup;
use super::{compare, family, mistakes, number};
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Claim;
use crate::experiment::{CellPlan, Estimand, Row};
use crate::stats::Verdict;
use crate::truth::best_constant_q;

/// One sentence on each thing that the experiment shows.
pub fn sentences(lookup: &Lookup<'_>) -> Vec<String> {
    let mut sentences = Vec::new();
    let mut rules: Vec<(String, Vec<String>, String)> = Vec::new();
    for group in groups(lookup, |a, b| a.scene == b.scene && a.estimator_label == b.estimator_label) {
        let cell = &lookup.plan.cells[group[0]];
        let (scene, estimator) = (&cell.scene_label, cell.estimator_label.clone());
        let same = |rule: &str| rules.iter().position(|known| known.0 == *scene && known.2 == rule);
        if let Some(rule) = best_rule(lookup, &group) {
            match same(&rule) {
                Some(known) => rules[known].1.push(estimator),
                None => rules.push((scene.clone(), vec![estimator], rule)),
            }
        }
        sentences.extend(clamp(lookup, &group));
    }
    let told = |(scene, names, rule): (String, Vec<String>, String)| {
        format!("{scene}, {}: the most efficient unbiased rule tried is {rule}.", number::list(&names, "and"))
    };
    sentences.splice(0..0, rules.into_iter().map(told));
    let families = family::families(lookup);
    sentences.extend(families.iter().filter_map(|family| compare::gain(lookup, family)));
    sentences.extend(families.iter().flat_map(|family| compare::missed(lookup, family)));
    sentences.extend(truths(lookup));
    sentences.extend(mistakes::sentences(lookup));
    sentences.extend(left_out(lookup));
    sentences.extend(claims(lookup));
    sentences
}

/// Cells that were asked for and not run.
fn left_out(lookup: &Lookup<'_>) -> impl Iterator<Item = String> {
    lookup
        .plan
        .left_out
        .iter()
        .map(|out| format!("Left out is {}: {}.", lookup.plan.label(&out.cell), out.why))
}

/// Finished cells without a known mistake, grouped by what `alike` says.
fn groups(lookup: &Lookup<'_>, alike: impl Fn(&CellPlan, &CellPlan) -> bool) -> Vec<Vec<usize>> {
    let cells = &lookup.plan.cells;
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in sound(lookup).filter(|&i| !lookup.cell(i).is_empty()) {
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

/// The most efficient of a group's unbiased rules, channel by channel unless all agree.
fn best_rule(lookup: &Lookup<'_>, group: &[usize]) -> Option<String> {
    let fit = |&c: &usize| {
        let wrong = matches!(lookup.verdict(c), Some(Verdict::Fail | Verdict::Invalid));
        lookup.plan.cells[c].is_unbiased() && !wrong
    };
    let candidates: Vec<usize> = group.iter().copied().filter(fit).collect();
    if candidates.len() < 2 {
        return None;
    }
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
        return Some(kinds.join(", and "));
    }
    let of_channel = |channel: usize| {
        let efficiency = |c: usize| lookup.row(c, Estimand::Mean, Some(channel))?.efficiency;
        let (label, cell) = most_efficient(lookup, &candidates, &efficiency)?;
        Some((CHANNELS[channel], format!("{label}{}", theory(&lookup.plan.cells[cell], channel))))
    };
    let best: Vec<(&str, String)> = (0..3).filter_map(of_channel).collect();
    let first = &best.first()?.1;
    if best.iter().all(|(_, rule)| rule == first) {
        return Some(first.clone());
    }
    Some(best.iter().map(|(channel, rule)| format!("{channel} {rule}")).collect::<Vec<_>>().join("; "))
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

/// Questions that were asked against truths of one source.
struct Asked<'a> {
    source: &'a str,
    passed: usize,
    asked: usize,
    /// Scenes where not all of them passed.
    open: Vec<&'a str>,
}

/// Cells without a known mistake.
fn sound(lookup: &Lookup<'_>) -> impl Iterator<Item = usize> {
    (0..lookup.plan.cells.len()).filter(|&c| !lookup.is_faulty(c))
}

/// All judged questions about sound cells by the source of their truth.
fn by_source<'a>(lookup: &Lookup<'a>) -> Vec<Asked<'a>> {
    let rows = sound(lookup).flat_map(|c| lookup.cell(c).iter().copied());
    let mut sources: Vec<Asked<'a>> = Vec::new();
    for row in rows.filter(|row| row.verdict.is_some() && !row.source.is_empty()) {
        let scene = lookup.plan.cells[row.cell].scene_label.as_str();
        let at = sources.iter().position(|known| known.source == row.source).unwrap_or_else(|| {
            sources.push(Asked { source: row.source, passed: 0, asked: 0, open: Vec::new() });
            sources.len() - 1
        });
        let of = &mut sources[at];
        of.asked += 1;
        let passed = row.verdict == Some(Verdict::Pass);
        of.passed += usize::from(passed);
        if !passed && !of.open.contains(&scene) {
            of.open.push(scene);
        }
    }
    sources
}

/// How the questions ended, truth by truth; the last sentence says it where there is only one kind.
fn truths(lookup: &Lookup<'_>) -> Vec<String> {
    let sources = by_source(lookup);
    let told = |Asked { source, passed, asked, open }: &Asked<'_>| {
        let rest = if open.is_empty() { String::new() } else { format!("; not all in {}", open.join(", ")) };
        format!("Against {}: {passed} of {asked} questions passed{rest}.", source_name(source))
    };
    if sources.len() < 2 { Vec::new() } else { sources.iter().map(told).collect() }
}

/// A truth's source as a sentence names it.
fn source_name(source: &str) -> &str {
    match source {
        "closed form" => "closed forms",
        "deterministic" => "deterministic solutions",
        "independent renderer" => "images of an independent renderer",
        "own reference" => "references of our own by another kind of estimator",
        other => other,
    }
}

fn claims(lookup: &Lookup<'_>) -> Option<String> {
    let plan = lookup.plan;
    let rows: Vec<&Row> = sound(lookup).flat_map(|c| lookup.cell(c).iter().copied()).collect();
    let count = |verdict| rows.iter().filter(|r| r.verdict == Some(verdict)).count();
    let judged = rows.iter().filter(|r| r.verdict.is_some()).count();
    let has_faults = plan.cells.iter().any(|cell| cell.fault.is_some());
    if judged == 0 {
        return (!has_faults).then(|| "Nothing was judged.".to_owned());
    }
    let about = if has_faults { " about estimators without a mistake" } else { "" };
    let alpha: f64 = plan.spec.claim.iter().map(Claim::alpha).sum();
    let sources = by_source(lookup);
    let (against, open) = match sources.as_slice() {
        [only] if only.open.is_empty() => (format!(" against {}", source_name(only.source)), String::new()),
        [only] => {
            let open = format!(" Not all passed in {}.", only.open.join(", "));
            (format!(" against {}", source_name(only.source)), open)
        }
        _ => (String::new(), String::new()),
    };
    Some(format!(
        "Of {judged} questions{about}{against} {} passed, {} failed, {} stayed inconclusive and {} were invalid; were all well, \
         any false alarm among them had a probability of at most {alpha:.4}.{open}",
        count(Verdict::Pass),
        count(Verdict::Fail),
        count(Verdict::Inconclusive),
        count(Verdict::Invalid)
    ))
}
