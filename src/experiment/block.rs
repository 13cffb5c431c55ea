//! What one block of realizations yields: mergeable moments, never single samples.

use super::ledger::{Ledger, Stream};
use super::pixels::Pixels;
use crate::estimator::Tally;
use crate::scene::Rgb;
use crate::stats::replicates;
use crate::stats::tails::Tail;
use crate::stats::{Bets, Moments};

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
pub struct Block {
    /// Value of a realization: a path's radiance, or the mean of an image pass.
    pub total: Channels,
    /// Rays of a realization.
    pub cost: Moments,
    /// Realizations whose value is zero in all channels.
    pub zeros: u64,
    /// Contributions by bounce, and what went wrong.
    pub tally: Tally,
    /// Pixel by pixel; empty for a probe.
    pub pixels: Pixels,
    /// What was won by betting, a stream each.
    pub bets: Vec<Bets>,
    /// The largest values.
    pub tails: [Tail; 3],
    /// Of the realizations' values and rays, in their order.
    pub(super) key: u64,
    pub(super) ledger: Ledger,
    sum: Rgb,
    pass: Rgb,
    /// How its mean grew.
    pub(super) trace: Trace,
}

/// The mean of a block's first 1, 2, 4, 8, ... realizations, and of all of them.
pub type Trace = Vec<[f64; 3]>;

impl Block {
    /// An empty block for a sensor of this resolution, which bets on these streams.
    pub fn new(width: u32, height: u32, streams: &[Stream]) -> Self {
        let count = if width * height > 1 { (width * height) as usize } else { 0 };
        let empty = vec![Rgb::ZERO; count];
        Block {
            total: Channels::default(),
            cost: Moments::default(),
            zeros: 0,
            tally: Tally::default(),
            pixels: Pixels { width, height, n: 0, mean: empty.clone(), m2: empty },
            bets: Vec::new(),
            tails: Default::default(),
            key: 0,
            ledger: Ledger::new(streams),
            sum: Rgb::ZERO,
            pass: Rgb::ZERO,
            trace: Trace::new(),
        }
    }

    /// Takes one pixel's sample of the present realization.
    #[inline]
    pub fn pixel(&mut self, pixel: usize, value: Rgb) {
        self.pass += value;
        if let Some(mean) = self.pixels.mean.get_mut(pixel) {
            let delta = value - *mean;
            *mean += delta * (1.0 / (self.pixels.n + 1) as f64);
            self.pixels.m2[pixel] += delta * (value - *mean);
        }
    }

    /// Closes a realization that traced so many rays; `tally` is that of the block so far.
    #[inline]
    pub fn realization(&mut self, rays: u64, tally: &Tally) {
        let pixels = f64::from(self.pixels.width) * f64::from(self.pixels.height);
        let value = self.pass / pixels;
        self.zeros += u64::from(value == Rgb::ZERO);
        push(&mut self.total, value);
        self.key = replicates::chain(self.key, rays);
        for (tail, x) in self.tails.iter_mut().zip(value.to_array()) {
            tail.push(x);
            self.key = replicates::chain(self.key, x.to_bits());
        }
        self.cost.push(rays as f64);
        self.sum += value;
        self.ledger.realization(rays, tally, self.sum);
        self.pixels.n += 1;
        self.pass = Rgb::ZERO;
        if self.cost.n.is_power_of_two() {
            self.look();
        }
    }

    /// Remembers the mean so far.
    fn look(&mut self) {
        self.trace.push((self.sum / self.cost.n as f64).to_array());
    }

    /// Its pixels; a probe counts as one.
    pub(super) fn into_pixels(self) -> Pixels {
        if self.pixels.is_image() {
            return self.pixels;
        }
        let of = |value: fn(&Moments) -> f64| vec![Rgb::from_array(self.total.map(|m| value(&m)))];
        Pixels { mean: of(|m| m.mean), m2: of(|m| m.m2), ..self.pixels }
    }

    /// Takes over the tally of all its paths.
    pub fn close(&mut self, tally: Tally) {
        if !self.cost.n.is_power_of_two() {
            self.look();
        }
        self.bets = self.ledger.close(&tally, self.sum);
        self.tally = tally;
    }
}
