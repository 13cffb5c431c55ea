//! How often do the instruments find a mistake, and how often do they cry wolf? Each cell is run with many seeds, and each
//! run is judged on its own, as if it were the whole experiment, by all instruments and by the rules of other tools.

use super::cell::{Cell, Channels};
use super::mistake;
use super::plan::{CellPlan, Plan};
use super::row::{Estimand, Row};
use super::run::{block_of, run_cell_here};
use super::verdict;
use crate::stats::binomial::clopper_pearson;
use crate::stats::rate::{self, Rate};
use crate::stats::{Engine, Moments, Question, Verdict, judge, rivals};
use crate::truth::Counted;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};

/// Blocks of a run, which to other tools' rules are the pixels of an image of 32 x 32.
pub const BLOCKS: u64 = 1024;

/// What looks for mistakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Instrument {
    /// Verdict of the bench: any of its own instruments.
    Verdict,
    /// Bets on the mean and on single bounces.
    Bets,
    /// The t test of the mean, at a fixed number of samples.
    Student,
    /// Variance against theory.
    Variance,
    /// Rays against theory.
    Cost,
    /// Lengths of paths against the law of roulette.
    Length,
    /// Blocks that repeat or follow from each other.
    Independent,
    /// Numbers that are none, negative radiance, runaway walks, bounds that are exceeded.
    Invalid,
    /// Mitsuba's rule for rendered images.
    Mitsuba,
    /// pbrt's tolerance.
    Pbrt,
    /// Nori's t test.
    Nori,
    /// The Welch map, read as a test.
    Welch,
}

impl Instrument {
    /// All of them, the bench's own first.
    pub const ALL: [Instrument; 12] = [
        Instrument::Verdict,
        Instrument::Bets,
        Instrument::Student,
        Instrument::Variance,
        Instrument::Cost,
        Instrument::Length,
        Instrument::Independent,
        Instrument::Invalid,
        Instrument::Mitsuba,
        Instrument::Pbrt,
        Instrument::Nori,
        Instrument::Welch,
    ];

    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Instrument::Verdict => "verdict",
            Instrument::Bets => "bets",
            Instrument::Student => "t",
            Instrument::Variance => "variance",
            Instrument::Cost => "cost",
            Instrument::Length => "length",
            Instrument::Independent => "independence",
            Instrument::Invalid => "invalid",
            Instrument::Mitsuba => "Mitsuba",
            Instrument::Pbrt => "pbrt",
            Instrument::Nori => "Nori",
            Instrument::Welch => "Welch map",
        }
    }

    /// Whether it is the rule of another tool.
    pub fn is_rival(self) -> bool {
        matches!(self, Instrument::Mitsuba | Instrument::Pbrt | Instrument::Nori | Instrument::Welch)
    }
}

/// What the runs of one cell have shown.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Detection {
    /// Runs.
    pub seeds: u64,
    /// In how many of them each of [`Instrument::ALL`] found something; `None` where it has nothing to look at.
    pub found: Vec<Option<u64>>,
    /// Samples after which half of those runs that the bench caught were caught.
    pub needed: Option<u64>,
    /// Mean over all runs; JSON has no word for what is not a number but null.
    #[serde(deserialize_with = "null_is_nan")]
    pub mean: [f64; 3],
    /// Exponent of the mean squared error over the samples, with its 99.9 % interval: -1 for a sound estimator.
    pub rate: Option<(f64, f64, f64)>,
}

fn null_is_nan<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    let mean = <[Option<f64>; 3]>::deserialize(deserializer)?;
    Ok(mean.map(|mean| mean.unwrap_or(f64::NAN)))
}

impl Detection {
    /// Whether each instrument has its count, and none found more than there was.
    pub fn is_whole(&self) -> bool {
        let is_possible = |found: &u64| *found <= self.seeds;
        self.seeds > 0
            && self.found.len() == Instrument::ALL.len()
            && self.found.iter().flatten().all(is_possible)
    }

    /// How often an instrument found something, with its 99 % interval [Clopper & Pearson 1934].
    pub fn share(&self, instrument: Instrument) -> Option<(f64, f64, f64)> {
        let at = Instrument::ALL.iter().position(|i| *i == instrument)?;
        let found = self.found[at]?;
        let (low, high) = clopper_pearson(found, self.seeds, 0.99);
        Some((found as f64 / self.seeds as f64, low, high))
    }
}

/// One run.
struct Trial {
    found: Vec<Option<bool>>,
    needed: Option<u64>,
    mean: [f64; 3],
    /// Errors of the mean of the first channel that has a truth, at numbers of samples that double.
    errors: Vec<(f64, f64)>,
}

/// Runs one cell with all seeds, `None` if `stop` was raised before the end.
pub fn detect(
    plan: &Plan,
    index: usize,
    stop: &AtomicBool,
    progress: &(dyn Fn(f64) + Sync),
) -> Option<Detection> {
    let seeds = u64::from(plan.spec.seeds.unwrap_or(1));
    let trials: Vec<Option<Trial>> =
        (0..seeds).into_par_iter().map(|seed| trial(plan, index, seed, stop, progress)).collect();
    let trials: Vec<Trial> = trials.into_iter().collect::<Option<_>>()?;
    let found = (0..Instrument::ALL.len()).map(|i| {
        let looked: Vec<bool> = trials.iter().filter_map(|t| t.found[i]).collect();
        (!looked.is_empty()).then(|| looked.iter().filter(|found| **found).count() as u64)
    });
    let mut needed: Vec<u64> = trials.iter().filter_map(|t| t.needed).collect();
    needed.sort_unstable();
    let mean = [0, 1, 2].map(|c| trials.iter().map(|t| t.mean[c]).sum::<f64>() / seeds as f64);
    let found = found.collect();
    let half = needed.get(needed.len() / 2).copied();
    Some(Detection { seeds, found, needed: half, mean, rate: rate_of(&trials) })
}

/// How fast the error falls, over all runs.
fn rate_of(trials: &[Trial]) -> Option<(f64, f64, f64)> {
    let levels = trials[0].errors.iter().enumerate().map(|(level, &(n, _))| {
        (n, trials.iter().filter_map(|t| t.errors.get(level)).map(|&(_, error)| error).collect())
    });
    let levels: Vec<(f64, Vec<f64>)> = levels.collect();
    rate::slope(&levels).map(|Rate { slope, low, high }| (slope, low, high))
}

fn trial(plan: &Plan, index: usize, seed: u64, stop: &AtomicBool, progress: &dyn Fn(f64)) -> Option<Trial> {
    let mut cell_plan = plan.cells[index].clone();
    cell_plan.address = cell_plan.address.repetition(seed);
    cell_plan.may_stop = true;
    cell_plan.studied = true;
    let mut alone = Plan { cells: vec![cell_plan], ..plan.clone() };
    alone.count_questions();
    let cell_plan = &alone.cells[0];
    // looked at on the way, to learn when it was caught, but run to the end: other rules know no early end
    let look = |cell: &mut Cell| {
        verdict::is_decided(&alone, 0, cell);
        false
    };
    let cell = run_cell_here(cell_plan, stop, progress, &look)?;
    if stop.load(Ordering::Relaxed) {
        return None;
    }
    let cells = [Some(cell)];
    let rows = verdict::rows(&alone, &cells);
    let [Some(cell)] = &cells else { return None };
    let bad = |v: Verdict| matches!(v, Verdict::Fail | Verdict::Invalid);
    let early = cell.decided.iter().filter(|d| bad(d.verdict) && d.estimand != Estimand::Wrong);
    let early = early.map(|d| d.samples).chain(by_bets(&alone, cell)).min();
    let caught = mistake::is_caught(&rows.iter().collect::<Vec<_>>());
    Some(Trial {
        found: found(&alone, cell, &rows, caught),
        needed: caught.then(|| early.unwrap_or(cell.cost.n)),
        mean: cell.total.map(|m| m.mean),
        errors: errors(&alone, cell),
    })
}

/// Samples after which bets on the whole had won enough.
fn by_bets(plan: &Plan, cell: &Cell) -> Option<u64> {
    let claim = plan.spec.claim.iter().position(|claim| claim.unbiased().is_some())?;
    // two sides share the level
    let enough = -libm::log(0.5 * verdict::level(plan, claim));
    let won = |(above, below): &(f64, Option<f64>)| above.max(below.unwrap_or(0.0)) >= enough;
    cell.history.iter().find(|snapshot| snapshot.log_e.iter().any(won)).map(|snapshot| snapshot.total[0].n)
}

/// What each instrument says of one run.
fn found(plan: &Plan, cell: &Cell, rows: &[Row], caught: bool) -> Vec<Option<bool>> {
    let fails = |of: &dyn Fn(&Row) -> bool| {
        let asked: Vec<&Row> = rows.iter().filter(|r| r.engine.is_some() && of(r)).collect();
        (!asked.is_empty()).then(|| asked.iter().any(|row| row.verdict == Some(Verdict::Fail)))
    };
    let is_mean = |row: &Row| matches!(row.estimand, Estimand::Mean | Estimand::Bounce(_));
    let invalid = rows.iter().any(|row| row.verdict == Some(Verdict::Invalid));
    let truth = plan.truth(&plan.cells[0]);
    let right = [0, 1, 2].map(|c| truth.expected(c, Counted::All).map(|value| value.value));
    let variance = [0, 1, 2].map(|c| truth.theory().and_then(|t| t.central(c, Counted::All, 2).value()));
    Instrument::ALL
        .iter()
        .map(|instrument| match instrument {
            Instrument::Verdict => Some(caught),
            Instrument::Bets => {
                fails(&|row| is_mean(row) && row.e_value.is_some() && row.engine != Some(Engine::Comparison))
            }
            Instrument::Student => student(plan, cell, right),
            Instrument::Variance => fails(&|row| row.estimand == Estimand::Variance),
            Instrument::Cost => fails(&|row| row.estimand == Estimand::Cost),
            Instrument::Length => fails(&|row| row.estimand == Estimand::Length),
            Instrument::Independent => {
                fails(&|row| matches!(row.estimand, Estimand::Repeats | Estimand::Serial))
            }
            Instrument::Invalid => Some(invalid),
            Instrument::Mitsuba => Some((0..3).any(|c| {
                let pixels: Vec<Moments> = cell.parts.iter().map(|part| part[c]).collect();
                let spread = variance[c].or(cell.total[c].variance()).unwrap_or(0.0);
                right[c].is_some_and(|right| rivals::mitsuba(&pixels, right, spread))
            })),
            Instrument::Pbrt => right[1].map(|right| rivals::pbrt(cell.total[1].mean, right)),
            Instrument::Nori => right[1].map(|right| rivals::nori(&cell.total[1], right)),
            Instrument::Welch => welch(&plan.cells[0], cell),
        })
        .collect()
}

/// The t test of the means of the channels, at the level of the claim.
fn student(plan: &Plan, cell: &Cell, right: [Option<f64>; 3]) -> Option<bool> {
    let alpha = plan.spec.claim.iter().find(|claim| claim.unbiased().is_some())?.alpha();
    let question = |c: usize| {
        let (total, right) = (&cell.total[c], right[c]?);
        let noise_free = total.m2 == 0.0;
        let skewness = total.skewness().unwrap_or(0.0) / (total.n as f64).sqrt();
        let question = Question::about(total, cell.invalid(), right, f64::MIN_POSITIVE);
        Some(Question { noise_free, skewness, ..question })
    };
    let questions: Vec<Question> = (0..3).filter_map(question).collect();
    let answers = judge(&questions, alpha);
    (!answers.is_empty()).then(|| answers.iter().any(|answer| answer.verdict == Verdict::Fail))
}

/// The Welch map against an image that the sound estimator makes from other random numbers.
fn welch(cell_plan: &CellPlan, cell: &Cell) -> Option<bool> {
    let scene = cell_plan.scene.build();
    let address = cell_plan.address.repetition(u64::MAX);
    let draw = |number, pixel| address.stream(number, pixel);
    let blocks = 0..cell_plan.samples / cell_plan.block;
    let of_block = |b: u64| {
        let numbers = b * cell_plan.block..(b + 1) * cell_plan.block;
        block_of(&scene, &cell_plan.estimator, &draw, &[], numbers).total
    };
    let theirs: Vec<Channels> = blocks.map(of_block).collect();
    let tiles = |parts: &[Channels], c: usize| parts.iter().map(|part| part[c]).collect::<Vec<Moments>>();
    Some((0..3).any(|c| rivals::welch_map(&tiles(&cell.parts, c), &tiles(&theirs, c)).fires()))
}

/// Errors of the mean at numbers of samples that double.
fn errors(plan: &Plan, cell: &Cell) -> Vec<(f64, f64)> {
    let truth = plan.truth(&plan.cells[0]);
    let Some(right) = truth.expected(1, Counted::All).filter(|_| cell.total[1].m2 > 0.0) else {
        return Vec::new(); // nothing converges where nothing varies
    };
    let doubled = |n: u64| (n / plan.cells[0].block).is_power_of_two();
    let snapshots = cell.history.iter().map(|snapshot| &snapshot.total[1]);
    snapshots.filter(|m| doubled(m.n)).map(|m| (m.n as f64, m.mean - right.value)).collect()
}

#[cfg(test)]
mod tests {
    use super::Detection;

    #[test]
    fn what_is_not_a_number_is_read_back() {
        let text = r#"{"seeds":40,"found":[40,null],"needed":null,"mean":[null,0.5,null],"rate":null}"#;
        let read: Detection = serde_json::from_str(text).unwrap();
        assert!(read.mean[0].is_nan() && read.mean[1] == 0.5);
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
    }
}
