//! How many samples each cell gets, and in which blocks.

use super::cell::Channels;
use super::plan::{CellPlan, Overrides, Plan};
use super::run::LOOKS_IN_ALL;
use super::runs;
use super::spec::Limits;
use super::stakes;
use super::study;
use crate::truth::{ClosedForm, Counted, Known};

/// Paths a block, at most, where the file says nothing.
const BLOCK_PATHS: u64 = 4096;

/// Blocks a cell, at least, if it has the samples.
const MIN_BLOCKS: u64 = 64;

impl Plan {
    /// Fixes each cell's samples and blocks.
    pub(super) fn allot(&mut self, overrides: &Overrides) {
        let claims = &self.spec.claim;
        let asked: Vec<(&Limits, f64)> = (claims.iter().enumerate())
            .filter_map(|(index, claim)| {
                Some((claim.unbiased()?, claim.alpha() / self.questions(index) as f64))
            })
            .collect();
        let blocks = self.blocks();
        let runs = u64::from(self.spec.seeds.unwrap_or(1));
        for cell in &mut self.cells {
            cell.runs = runs;
            if cell.traced {
                cell.samples = runs::whole(cell, overrides);
                continue;
            }
            let limits = asked.iter().find(|(limits, _)| limits.covers(&cell.scene_label));
            match (overrides.samples, self.spec.max_samples, limits) {
                (Some(samples), _, _) => cell.samples = samples,
                (None, Some(most), Some((limits, level))) if most > cell.samples => {
                    let wanted = wanted_samples(cell, limits.margin, *level, None);
                    cell.samples = wanted.map_or(cell.samples, |n| n.clamp(cell.samples, most));
                }
                _ => {}
            }
            if overrides.quick {
                cell.samples = (cell.samples / 100).max(2);
            }
            (cell.samples, cell.block) = whole_blocks(cell.samples, cell.pixels, blocks);
        }
    }

    /// Blocks a cell, at least, if it has the samples: many, or the t quantile is large.
    fn blocks(&self) -> Blocks {
        let least = if self.spec.seeds.is_some() { study::BLOCKS } else { MIN_BLOCKS };
        Blocks { least, paths: self.spec.block.unwrap_or(BLOCK_PATHS) }
    }

    /// What `--samples` must say for a cell to get the samples and blocks that it has.
    pub fn asking_for(&self, cell: &CellPlan) -> u64 {
        if cell.traced {
            return cell.samples; // whole runs
        }
        let least = (cell.samples + 1).saturating_sub(cell.block).max(1);
        let same = |&n: &u64| whole_blocks(n, cell.pixels, self.blocks()) == (cell.samples, cell.block);
        (least..=cell.samples).rev().find(same).unwrap_or(cell.samples)
    }
}

/// How samples are cut.
#[derive(Clone, Copy)]
struct Blocks {
    /// As many, at least, if there are the samples.
    least: u64,
    /// Paths of one, at most.
    paths: u64,
}

/// About so many samples of an image of so many pixels in whole blocks: their number, and that of a block.
fn whole_blocks(samples: u64, pixels: u64, blocks: Blocks) -> (u64, u64) {
    // two passes at least, whose difference shows a pixel's variance
    let block = (samples / blocks.least).min(blocks.paths / pixels).max(2);
    // two blocks at least, or there is no standard error
    (samples.div_ceil(block).max(2) * block, block)
}

/// Realizations after which a cell is shown to be within the relative margin in each channel, where each question has
/// `level`: by theory's mean and variance, or where theory knows none by those that were `measured`.
pub fn wanted_samples(cell: &CellPlan, margin: f64, level: f64, measured: Option<&Channels>) -> Option<u64> {
    const POWER: f64 = 0.999;
    let closed = ClosedForm::of(&cell.scene, &cell.estimator);
    let of_sample = |c: usize| measured.and_then(|m| Some((m[c].mean, m[c].variance()?)));
    let by_theory = |c: usize| {
        let closed = closed.as_ref()?;
        Some((closed.truth(c, Counted::All), closed.central(c, Counted::All, 2).value()?))
    };
    let infinite = |c: usize| {
        closed.as_ref().is_some_and(|closed| closed.central(c, Counted::All, 2) == Known::Infinite)
    };
    let needed = |c: usize| {
        let (mean, variance) = by_theory(c).or_else(|| of_sample(c).filter(|_| !infinite(c)))?;
        let margin = margin * mean;
        let samples = stakes::samples(cell, None, c, variance);
        // a t test shares its level among its looks
        let looks = if cell.may_stop && samples.bets.is_none() { f64::from(LOOKS_IN_ALL) } else { 1.0 };
        (margin > 0.0).then(|| samples.needed(margin, level / looks, POWER))
    };
    (0..3).filter_map(needed).reduce(f64::max).map(|n| n.ceil() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_can_be_asked_for_again() {
        let paths = BLOCK_PATHS;
        let few = Blocks { least: MIN_BLOCKS, paths };
        for (pixels, blocks) in [
            (1, few),
            (1, Blocks { least: study::BLOCKS, paths }),
            (256, few),
            (1 << 14, few),
            (1, Blocks { paths: 1 << 20, ..few }),
        ] {
            for asked in (1..3000).chain([100_000, 1_048_576, 1_048_577, 67_108_863]) {
                let (samples, block) = whole_blocks(asked, pixels, blocks);
                let least = (samples + 1).saturating_sub(block).max(1);
                let again = |&n: &u64| whole_blocks(n, pixels, blocks) == (samples, block);
                let found = (least..=samples).rev().find(again);
                assert!(found.is_some(), "{asked} samples of {pixels} pixels in {} blocks", blocks.least);
            }
        }
        // not all numbers of samples would do
        assert_ne!(whole_blocks(191, 1, few), whole_blocks(192, 1, few));
    }
}
