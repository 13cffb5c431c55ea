//! Estimators against each other: where no theory says what is right, all unbiased ones must at least say the same.

use super::cell::Cell;
use super::plan::{CellPlan, Plan};
use super::row::{Estimand, Row};
use super::spec::Claim;
use super::verdict::{Asked, MIN_EFFECTIVE};
use crate::estimator::BINS;
use crate::stats::{Moments, Question};

/// Compares every unbiased cell with the anchor of its scene, total and per bounce.
pub(super) fn compare(plan: &Plan, cells: &[Option<Cell>], rows: &mut Vec<Row>, asked: &mut Vec<Asked>) {
    for (claim, margin, is_anchor) in plan.spec.claim.iter().enumerate().filter_map(anchor_of) {
        for (index, cell_plan) in plan.cells.iter().enumerate() {
            let same_scene = |other: &CellPlan| other.scene == cell_plan.scene;
            let anchor = plan.cells.iter().position(|other| same_scene(other) && is_anchor(other));
            let Some(anchor) = anchor.filter(|&a| a != index && cell_plan.is_unbiased()) else { continue };
            let (Some(cell), Some(anchor)) = (&cells[index], &cells[anchor]) else { continue };
            if cell.failure.is_some() {
                continue; // its own row says so
            }
            let invalid = cell.invalid().or_else(|| anchor.invalid());
            for channel in 0..3 {
                let margin = margin * anchor.blocks[channel].mean.abs();
                let bounce =
                    |bin: usize| (Estimand::AgreeBounce(bin), &cell.bounces[bin], &anchor.bounces[bin]);
                let bounces = (0..BINS).map(bounce);
                let pairs = std::iter::once((Estimand::Agree, &cell.blocks, &anchor.blocks)).chain(bounces);
                for (estimand, ours, theirs) in pairs {
                    let (ours, theirs) = (&ours[channel], &theirs[channel]);
                    let (row, rare) = row(index, estimand, channel, cell, ours, theirs);
                    rows.push(row);
                    if !rare {
                        let pairs = paired(cell, anchor, channel).filter(|_| estimand == Estimand::Agree);
                        let question = match pairs {
                            Some(pairs) => Question::about(&pairs, invalid.clone(), 0.0, margin),
                            None => difference(ours, theirs, margin, invalid.clone()),
                        };
                        asked.push(Asked { claim, row: rows.len() - 1, question, foreseen: None });
                    }
                }
            }
        }
    }
}

type IsAnchor<'a> = Box<dyn Fn(&CellPlan) -> bool + 'a>;

fn anchor_of((index, claim): (usize, &Claim)) -> Option<(usize, f64, IsAnchor<'_>)> {
    let Claim::Agree { estimator, roulette, scene, margin, .. } = claim else { return None };
    let is_anchor = move |c: &CellPlan| {
        c.estimator_label == *estimator
            && c.roulette_label == *roulette
            && scene.as_ref().is_none_or(|only| *only == c.scene_label)
    };
    Some((index, *margin, Box::new(is_anchor)))
}

/// The row of one comparison, and whether too few paths got there to judge it.
fn row(
    index: usize,
    estimand: Estimand,
    channel: usize,
    cell: &Cell,
    ours: &Moments,
    theirs: &Moments,
) -> (Row, bool) {
    let mut row = Row::new(index, estimand, Some(channel), cell.cost.n, ours.mean);
    row.std_error = ours.std_error();
    row.compared_with(theirs.mean, theirs.std_error().unwrap_or(f64::NAN), "another cell");
    let rare = effective(ours).min(effective(theirs)) < MIN_EFFECTIVE;
    if rare {
        row.note = format!("fewer than {MIN_EFFECTIVE} paths get here: not judged");
    }
    (row, rare)
}

/// mean² / (squared standard error): the number of equal contributions that would scatter as much.
pub(super) fn effective(blocks: &Moments) -> f64 {
    match blocks.std_error() {
        Some(error) if error > 0.0 => (blocks.mean / error) * (blocks.mean / error),
        _ if blocks.mean != 0.0 => f64::INFINITY,
        _ => 0.0,
    }
}

/// Differences of blocks that had the same random numbers: what both share cancels.
fn paired(ours: &Cell, theirs: &Cell, channel: usize) -> Option<Moments> {
    let (ours, theirs) = (&ours.block_means, &theirs.block_means);
    if ours.is_empty() || ours.len() != theirs.len() {
        return None;
    }
    let mut differences = Moments::default();
    ours.iter().zip(theirs).for_each(|(a, b)| differences.push(a[channel] - b[channel]));
    (differences.m2 > 0.0).then_some(differences)
}

fn difference(ours: &Moments, theirs: &Moments, margin: f64, invalid: Option<String>) -> Question {
    let question = Question::about(ours, invalid, theirs.mean, margin);
    let expected_std_error = theirs.std_error().unwrap_or(f64::NAN);
    let noise_free = question.std_error == 0.0 && expected_std_error == 0.0;
    Question { expected_std_error, expected_df: theirs.n as f64 - 1.0, noise_free, ..question }
}
