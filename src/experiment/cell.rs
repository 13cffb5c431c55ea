//! What is kept of the realizations: mergeable moments, never single samples.

pub use super::block::{Block, Channels, Trace};
use super::block::{merge, push};
use super::guard::Failure;
use super::ledger::LENGTHS;
use super::pixels::Pixels;
use super::row::Estimand;
use super::unit::Unit;
use crate::estimator::BINS;
use crate::scene::Rgb;
use crate::stats::replicates;
use crate::stats::tails::Tail;
use crate::stats::{Bets, Moments, Verdict};
use serde::{Deserialize, Serialize};

/// The merged blocks of one cell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Value of a realization.
    pub total: Channels,
    /// Means of blocks: their spread gives the standard error.
    pub blocks: Channels,
    /// Block means of each bounce; the last bin holds all later ones.
    pub bounces: Vec<Channels>,
    /// Rays of a realization.
    pub cost: Moments,
    /// Realizations whose value is zero in all channels.
    pub zeros: u64,
    /// Contributions that were not finite.
    pub non_finite: u64,
    /// Contributions that were negative.
    pub negative: u64,
    /// Walks that were cut.
    pub runaway: u64,
    /// Gathers of the k nearest photons that found fewer.
    #[serde(default)]
    pub starved: u64,
    /// Variance of one sample of a pixel, averaged over the image, a value a block; unused for a probe.
    pub pixel_variance: Channels,
    /// Median over the image of the variance of a pixel's sample.
    pub median_variance: [f64; 3],
    /// What was won by betting, a stream each, in the plan's order.
    pub bets: Vec<Bets>,
    /// How many realizations took 0, 1, 2, ... rays; the last bin holds all longer ones.
    pub lengths: Vec<u64>,
    /// The largest values.
    pub tails: [Tail; 3],
    /// Blocks that are the same, realization by realization, as an earlier one.
    pub repeats: u64,
    /// Correlation of each block's mean with the next one's, and its two-sided p-value.
    pub serial: [Option<(f64, f64)>; 3],
    /// What was seen on the way, at numbers of samples that grow in proportion.
    pub history: Vec<Snapshot>,
    /// Questions that were decided before the last sample was in.
    pub decided: Vec<Decided>,
    /// Means of [`TILES`] x [`TILES`] tiles, row by row from the top left; empty if they do not divide the image.
    pub tiles: Vec<[Measured; 3]>,
    /// Value of a realization, in each block; kept only where cells share their random numbers, for paired comparisons.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub block_means: Vec<[f64; 3]>,
    /// How the mean of each block grew; kept only where blocks are runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub traces: Vec<Trace>,
    /// Why it ended before its samples were taken, if a block could not be made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<Failure>,
    /// Pixel by pixel; empty for a probe. Kept as an image, not in the store.
    #[serde(skip)]
    pub pixels: Pixels,
    /// Of each block; known while sampling.
    #[serde(skip)]
    keys: Vec<u64>,
    /// Value of a realization, in each block; known while sampling.
    #[serde(skip)]
    means: Vec<[f64; 3]>,
    /// The same with all moments, for the rules of other tools; kept only in studies.
    #[serde(skip)]
    pub parts: Vec<Channels>,
}

/// What is kept of each block beside its mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Keep {
    /// How its mean grew: blocks are runs.
    pub traces: bool,
    /// All moments of its value: other tools' rules want them.
    pub parts: bool,
}

/// What a cell had seen after some of its blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Value of a realization.
    pub total: Channels,
    /// Rays of a realization.
    pub rays: f64,
    /// Logarithm of the e-values against "at most" and "at least" the guess of the mean, for the first three streams.
    pub log_e: Vec<(f64, Option<f64>)>,
}

/// A question and the number of realizations after which it was decided.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decided {
    /// What is measured.
    pub estimand: Estimand,
    /// In which channel.
    pub channel: Option<usize>,
    /// How.
    pub verdict: Verdict,
    /// Realizations.
    pub samples: u64,
}

/// An image is divided into so many tiles along each edge.
pub const TILES: u32 = 4;

/// A mean with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub std_error: f64,
}

impl Cell {
    /// Keeps the means of blocks, for comparisons with a cell that has the same random numbers.
    pub fn keep_block_means(&mut self) {
        self.block_means.clone_from(&self.means);
    }

    /// Looks at the blocks together and sums up the image, once all blocks are in.
    pub fn finish(&mut self) {
        // where the first block failed there are none
        self.bounces.resize(BINS, Channels::default());
        self.lengths.resize(LENGTHS, 0);
        self.repeats = replicates::repeats(&self.keys) as u64;
        self.serial = [0, 1, 2].map(|c| {
            let means: Vec<f64> = self.means.iter().map(|means| means[c]).collect();
            replicates::lag_correlation(&means)
        });
        let pixels = &self.pixels;
        if !pixels.is_image() {
            return;
        }
        let variance = pixels.variance();
        self.median_variance = [0, 1, 2].map(|c| {
            let mut values: Vec<f64> = variance.iter().map(|v| v[c]).collect();
            values.sort_by(f64::total_cmp);
            0.5 * (values[(values.len() - 1) / 2] + values[values.len() / 2])
        });
        if pixels.width.is_multiple_of(TILES) && pixels.height.is_multiple_of(TILES) {
            self.tiles = (0..TILES * TILES).map(|tile| pixels.tile(tile % TILES, tile / TILES)).collect();
        }
    }

    /// Adds the next blocks, which must come in order.
    pub fn merge_unit(&mut self, unit: &Unit, keep: Keep) {
        for block in &unit.blocks {
            self.merge(block, u64::from(unit.pixels.width) * u64::from(unit.pixels.height));
            if keep.traces {
                self.traces.push(block.trace.clone());
            }
            if keep.parts {
                self.parts.push(block.total);
            }
        }
        if unit.pixels.is_image() {
            self.pixels.merge(&unit.pixels);
        }
    }

    /// Adds the next block of an image of so many pixels; 0 for a probe.
    fn merge(&mut self, block: &Block, pixels: u64) {
        merge(&mut self.total, &block.total);
        self.cost.merge(&block.cost);
        let mean = |moments: &Channels| Rgb::from_array(moments.map(|m| m.mean));
        push(&mut self.blocks, mean(&block.total));
        self.means.push(block.total.map(|m| m.mean));
        self.keys.push(block.key);
        self.tails.iter_mut().zip(&block.tails).for_each(|(ours, theirs)| ours.merge(theirs));
        self.bounces.resize(BINS, Channels::default());
        let paths = (block.cost.n * pixels.max(1)) as f64;
        for (bounce, &sum) in self.bounces.iter_mut().zip(&block.tally.bounces) {
            push(bounce, sum / paths);
        }
        match self.bets.is_empty() {
            true => self.bets.clone_from(&block.bets),
            false => self.bets.iter_mut().zip(&block.bets).for_each(|(ours, theirs)| ours.merge(theirs)),
        }
        self.lengths.resize(LENGTHS, 0);
        self.lengths.iter_mut().zip(&block.lengths).for_each(|(ours, theirs)| *ours += theirs);
        self.zeros += block.zeros;
        self.non_finite += block.tally.non_finite;
        self.negative += block.tally.negative;
        self.runaway += block.tally.runaway;
        self.starved += block.tally.starved;
        if pixels > 0 {
            push(&mut self.pixel_variance, block.pixel_variance);
        }
        self.remember();
    }

    /// Keeps what was seen after 1, 2, 3, ... blocks, less and less often: eight times while samples double.
    fn remember(&mut self) {
        let step = |n: u64| libm::floor(8.0 * libm::log2(n as f64));
        let blocks = self.blocks[0].n;
        if blocks == 1 || step(blocks) > step(blocks - 1) {
            let log_e = |bets: &Bets| (bets.log_above(bets.stake.scale), bets.log_below(bets.stake.scale));
            let log_e = self.bets.iter().take(3).map(log_e).collect();
            self.history.push(Snapshot { total: self.total, rays: self.cost.mean, log_e });
        }
    }

    /// Whether all lists have their length; a store may have been damaged.
    pub fn is_whole(&self) -> bool {
        self.bounces.len() == BINS
            && self.lengths.len() == LENGTHS
            && [0, (TILES * TILES) as usize].contains(&self.tiles.len())
    }

    /// Why nothing can be concluded from this cell, if so.
    pub fn invalid(&self) -> Option<String> {
        if let Some(failure) = &self.failure {
            return Some(failure.to_string());
        }
        complaint([self.non_finite, self.negative, self.runaway, self.starved])
    }
}

/// What is wrong with samples of which so many were not finite or negative, whose walks were cut, or who looked for
/// photons that there were not.
pub(super) fn complaint(counts: [u64; 4]) -> Option<String> {
    const WHAT: [&str; 4] = [
        "contributions were not finite",
        "contributions were negative",
        "walks ran away and were cut",
        "times a map held fewer photons than are to be gathered: send more, or lower k",
    ];
    let (count, what) = counts.into_iter().zip(WHAT).find(|&(count, _)| count > 0)?;
    Some(format!("{count} {what}"))
}
