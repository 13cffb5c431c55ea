//! What one block of realizations yields: mergeable moments, never single samples.

use super::ledger::{LENGTHS, Ledger, Stream};
use super::pixels::Pixels;
use crate::estimator::Tally;
use crate::scene::Rgb;
use crate::stats::replicates;
use crate::stats::tails::{KEPT, Tail};
use crate::stats::{Bets, Moments};
use serde::{Deserialize, Serialize};

/// One set of moments a channel.
pub type Channels = [Moments; 3];

/// Adds a value a channel.
pub(super) fn push(channels: &mut Channels, value: Rgb) {
    for (moments, x) in channels.iter_mut().zip(value.to_array()) {
        moments.push(x);
    }
}

/// Adds what others have seen.
pub(super) fn merge(channels: &mut Channels, other: &Channels) {
    for (moments, o) in channels.iter_mut().zip(other) {
        moments.merge(o);
    }
}

/// What one block of realizations yields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Value of a realization: a path's radiance, or the mean of an image pass.
    pub total: Channels,
    /// Rays of a realization.
    pub cost: Moments,
    /// Realizations whose value is zero in all channels.
    pub zeros: u64,
    /// Contributions by bounce, and what went wrong.
    pub tally: Tally,
    /// Variance of one sample of a pixel, averaged over the image; unused for a probe.
    pub pixel_variance: Rgb,
    /// Pixel by pixel; empty for a probe. Journals keep those of several blocks together.
    #[serde(skip)]
    pub pixels: Pixels,
    /// What was won by betting, a stream each.
    pub bets: Vec<Bets>,
    /// The largest values.
    pub tails: [Tail; 3],
    /// How many realizations took so many rays; the last bin holds all longer ones.
    pub lengths: Vec<u64>,
    /// Of the realizations' values and rays, in their order.
    pub(super) key: u64,
    /// How its mean grew.
    pub(super) trace: Trace,
}

/// The mean of a block's first 1, 2, 4, 8, ... realizations, and of all of them.
pub type Trace = Vec<[f64; 3]>;

/// A block whose realizations are being taken.
pub struct OpenBlock {
    block: Block,
    ledger: Ledger,
    sum: Rgb,
    pass: Rgb,
}

impl OpenBlock {
    /// An empty block for a sensor of this resolution, which bets on these streams.
    pub fn new(width: u32, height: u32, streams: &[Stream]) -> Self {
        let count = if width * height > 1 { (width * height) as usize } else { 0 };
        let empty = vec![Rgb::ZERO; count];
        let block = Block {
            total: Channels::default(),
            cost: Moments::default(),
            zeros: 0,
            tally: Tally::default(),
            pixel_variance: Rgb::ZERO,
            pixels: Pixels { width, height, n: 0, mean: empty.clone(), m2: empty },
            bets: Vec::new(),
            tails: Default::default(),
            lengths: Vec::new(),
            key: 0,
            trace: Trace::new(),
        };
        OpenBlock { block, ledger: Ledger::new(streams), sum: Rgb::ZERO, pass: Rgb::ZERO }
    }

    /// Takes one pixel's sample of the present realization.
    #[inline]
    pub fn pixel(&mut self, pixel: usize, value: Rgb) {
        self.pass += value;
        let pixels = &mut self.block.pixels;
        if let Some(mean) = pixels.mean.get_mut(pixel) {
            let delta = value - *mean;
            *mean += delta * (1.0 / (pixels.n + 1) as f64);
            pixels.m2[pixel] += delta * (value - *mean);
        }
    }

    /// Closes a realization that traced so many rays; `tally` is that of the block so far.
    #[inline]
    pub fn realization(&mut self, rays: u64, tally: &Tally) {
        let block = &mut self.block;
        let pixels = f64::from(block.pixels.width) * f64::from(block.pixels.height);
        let value = self.pass / pixels;
        block.zeros += u64::from(value == Rgb::ZERO);
        push(&mut block.total, value);
        block.key = replicates::chain(block.key, rays);
        for (tail, x) in block.tails.iter_mut().zip(value.to_array()) {
            tail.push(x);
            block.key = replicates::chain(block.key, x.to_bits());
        }
        block.cost.push(rays as f64);
        self.sum += value;
        self.ledger.realization(rays, tally, self.sum);
        block.pixels.n += 1;
        self.pass = Rgb::ZERO;
        if block.cost.n.is_power_of_two() {
            self.look();
        }
    }

    /// Remembers the mean so far.
    fn look(&mut self) {
        let mean = self.sum / self.block.cost.n as f64;
        self.block.trace.push(mean.to_array());
    }

    /// Takes over the tally of all its paths, and is done.
    pub fn close(mut self, tally: Tally) -> Block {
        if !self.block.cost.n.is_power_of_two() {
            self.look();
        }
        let OpenBlock { mut block, mut ledger, sum, .. } = self;
        block.bets = ledger.close(&tally, sum);
        block.lengths = ledger.lengths.to_vec();
        block.tally = tally;
        if block.pixels.is_image() {
            let variance = block.pixels.variance();
            block.pixel_variance = variance.iter().sum::<Rgb>() / variance.len() as f64;
        }
        block
    }
}

impl Block {
    /// Whether it has so many realizations and these bets, and all lists have their length: it may come from a file.
    pub(super) fn fits(&self, realizations: u64, streams: &[Stream]) -> bool {
        let counts = self.total.iter().chain([&self.cost]).map(|moments| moments.n);
        let Tally { rays, non_finite, negative, runaway, starved, .. } = self.tally;
        let few = [rays, non_finite, negative, runaway, starved].iter().all(|count| *count < 1 << 60);
        let lengths = self.lengths.iter().try_fold(0, |sum: u64, count| sum.checked_add(*count));
        counts.chain(self.tails.iter().map(|tail| tail.n)).all(|n| n == realizations)
            && few
            && self.zeros <= realizations
            && lengths == Some(realizations)
            && self.bets.iter().all(|bets| bets.void <= bets.n && bets.n <= realizations)
            && self.bets.iter().map(|bets| bets.stake).eq(streams.iter().map(|stream| stream.stake))
            && self.lengths.len() == LENGTHS
            && self.tails.iter().all(|tail| tail.largest.len() <= KEPT)
    }

    /// Its pixels; a probe counts as one.
    pub(super) fn into_pixels(self) -> Pixels {
        if self.pixels.is_image() {
            return self.pixels;
        }
        let of = |value: fn(&Moments) -> f64| vec![Rgb::from_array(self.total.map(|m| value(&m)))];
        Pixels { mean: of(|m| m.mean), m2: of(|m| m.m2), ..self.pixels }
    }
}
