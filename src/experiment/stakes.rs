//! What is bet on, how many questions will be asked, and when a cell may stop: all that follows from the plan, before the
//! first sample.

use super::cell::TILES;
use super::core::Core;
use super::ledger::Stream;
use super::plan::{CellPlan, Plan};
use super::spec::Claim;
use super::subject::counted;
use crate::estimator::BINS;
use crate::faults::Slip;
use crate::stats::Stake;
use crate::stats::power::Samples;
use crate::truth::{Counted, Known, Truth, bound};

/// Lays the stakes of each cell.
pub fn lay(plan: &mut Plan) {
    let laid: Vec<_> = plan.cells.iter().map(|cell| (streams(plan, cell), may_stop(plan, cell))).collect();
    for (cell, (streams, may_stop)) in plan.cells.iter_mut().zip(laid) {
        (cell.streams, cell.may_stop) = (streams, may_stop);
    }
}

/// Paths are bet on where a claim asks for their mean and the truth has no noise. The realizations of an image are too
/// few and too much alike for bets: there a t test decides.
fn streams(plan: &Plan, cell: &CellPlan) -> Vec<Stream> {
    let claimed = plan.spec.claim.iter().filter_map(Claim::unbiased).any(|l| l.covers(&cell.scene_label));
    if cell.pixels > 1 || !claimed {
        return Vec::new();
    }
    let truth = plan.truth(cell);
    let bins = (0..BINS).map(|bin| (Some(bin), counted(bin)));
    let all = std::iter::once((None, Counted::All)).chain(bins);
    let stream = |(bin, counted): (Option<usize>, Counted), channel: usize| {
        Some(Stream { bin, channel, stake: stake(plan, cell, &truth, channel, counted)? })
    };
    all.flat_map(|what| (0..3).filter_map(move |channel| stream(what, channel))).collect()
}

fn stake(plan: &Plan, cell: &CellPlan, truth: &Truth, channel: usize, counted: Counted) -> Option<Stake> {
    let expected = truth.expected(channel, counted).filter(|e| e.std_error == 0.0 && e.value > 0.0)?;
    let steady = truth.theory().is_some_and(|t| t.central(channel, counted, 2) == Known::Value(0.0));
    if steady {
        return None; // without noise there is nothing to win: values are compared
    }
    // photons are no paths, and a path's bound is none of theirs
    let is_path = cell.fault.is_none_or(|fault| !matches!(fault.slip, Slip::Density(_)));
    // without a closed form nobody knows the variance, and so whether a bound would ask for too many samples
    let is_planned = is_path && truth.theory().is_some();
    // cosines along a short way to a light have no digits in single precision, and so their product no bound
    let is_bounded = cell.core == Core::Textbook || !cell.estimator.samples_lights();
    let bound =
        bound::of(&cell.scene, &cell.estimator, channel, counted).filter(|_| is_planned && is_bounded);
    // a path of 500 bounces rounds as often a few times
    let bound = bound.map(|bound| bound * (1.0 + 10.0 * cell.core.rounding()));
    let stake = Stake { scale: expected.value, bound: bound.filter(|bound| *bound > expected.value) };
    let [above, below] = is_worth_it(plan, cell, truth, channel, &stake);
    // the bound of a bounce is worth what it is: whether its samples suffice is foreseen
    let stake = if below || counted != Counted::All { stake } else { Stake { bound: None, ..stake } };
    (above && stake.defect().is_none()).then_some(stake)
}

/// More samples than this times those of a t test are not taken for the sake of an exact answer.
const DEAR: f64 = 3.0;

/// Whether bets on the mean, above and below, take about as few samples as a t test: few bets show nothing, however little
/// there is to scatter, nor do bets against a mean that may hide in one sample of a thousand. By theory's variance, before
/// the first sample.
fn is_worth_it(plan: &Plan, cell: &CellPlan, truth: &Truth, channel: usize, stake: &Stake) -> [bool; 2] {
    let variance = truth.theory().and_then(|t| t.central(channel, Counted::All, 2).value());
    let claims = plan.spec.claim.iter().enumerate();
    let claim =
        claims.filter_map(|(i, c)| Some((i, c.unbiased()?))).find(|(_, l)| l.covers(&cell.scene_label));
    let whole = truth.expected(channel, Counted::All);
    let (Some(variance), Some((claim, limits)), Some(whole)) = (variance, claim, whole) else {
        return [true; 2];
    };
    let margin = limits.margin * truth.mean(channel, Counted::All).map_or(whole.value, |right| right.value);
    let level = plan.spec.claim[claim].alpha() / plan.questions(claim) as f64;
    let needed = |bets| Samples { variance, bets }.needed(margin, level, 0.99);
    let is_cheap = |room: f64| needed(Some((room, stake.samples_per_bet()))) <= DEAR * needed(None);
    [is_cheap(whole.value), stake.bound.is_none_or(|bound| is_cheap(bound - stake.scale))]
}

/// Cells that others are compared with, and images, of which one wants to see as much as was asked for, go on to the end.
fn may_stop(plan: &Plan, cell: &CellPlan) -> bool {
    let here = |claim: &Claim| claim.scene().is_none_or(|scene| *scene == cell.scene_label);
    let compared = plan.spec.claim.iter().any(|c| matches!(c, Claim::Agree { .. }) && here(c));
    let judged = plan.spec.claim.iter().filter_map(Claim::unbiased).any(|l| l.covers(&cell.scene_label));
    judged && !compared && cell.pixels == 1 && !cell.traced
}

/// What the samples of a cell are like, in one channel, for planning how many are needed.
pub fn samples(cell: &CellPlan, bin: Option<usize>, channel: usize, variance: f64) -> Samples {
    let stream = cell.streams.iter().find(|s| (s.bin, s.channel) == (bin, channel));
    let bets = stream.and_then(|s| Some((s.stake.bound? - s.stake.scale, s.stake.samples_per_bet())));
    Samples { variance, bets }
}

/// At most so many questions are asked under a claim.
pub fn questions(plan: &Plan, claim: &Claim) -> usize {
    let about = |cell: &&CellPlan| claim.scene().is_none_or(|scene| *scene == cell.scene_label);
    let cells = plan.cells.iter().filter(about);
    let tiles = (TILES * TILES) as usize;
    let of_cell = |cell: &CellPlan| match claim {
        Claim::Unbiased(_) | Claim::Agree { .. } => 3 * (BINS + 1),
        Claim::Tiles(_) if cell.pixels > 1 => 3 * tiles,
        Claim::Tiles(_) => 0,
        Claim::Variance(_) => 3,
        Claim::Rate(_) if cell.traced => 9,
        Claim::Rate(_) => 0,
        Claim::Cost(_) | Claim::Length(_) => 1,
        Claim::Independent(_) => 4,
    };
    cells.map(of_cell).sum::<usize>().max(1)
}
