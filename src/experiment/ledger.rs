//! What each block gathers beside its moments: bets on streams of samples, and how many rays each path took.

use crate::estimator::{BINS, Tally};
use crate::scene::Rgb;
use crate::stats::bets::PER_BET;
use crate::stats::{Bets, Stake, Table};
use serde::{Deserialize, Serialize};

/// A sequence of samples that is bet on: a path's value, or what one bounce adds to it, in one channel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stream {
    /// The bin of bounces; `None` for all of them.
    pub bin: Option<usize>,
    /// 0, 1, 2 for red, green, blue.
    pub channel: usize,
    /// The guess of its mean, and its bound.
    pub stake: Stake,
}

/// Paths of so many rays have a bin each; the last one holds all longer ones.
pub const LENGTHS: usize = 65;

/// The gathering of one block.
#[derive(Clone, Debug)]
pub struct Ledger {
    /// Bets on each realization, and on averages of several.
    single: Sitting,
    several: Sitting,
    waiting: u64,
    order: Vec<Stream>,
    /// How many realizations took so many rays.
    pub lengths: [u64; LENGTHS],
}

/// Bets made at the same time, by bin of bounces; the last entry is about all of them.
#[derive(Clone, Debug, Default)]
struct Sitting {
    tables: [Vec<(Stream, Table)>; BINS + 1],
    /// Sums at the last bet.
    before: [Rgb; BINS + 1],
    bets: u64,
}

impl Ledger {
    /// Before the first realization.
    pub fn new(streams: &[Stream]) -> Self {
        let (mut single, mut several) = (Sitting::default(), Sitting::default());
        for stream in streams {
            let sitting = if stream.stake.samples_per_bet() == 1 { &mut single } else { &mut several };
            sitting.tables[stream.bin.unwrap_or(BINS)].push((*stream, Table::new(stream.stake)));
        }
        Ledger { single, several, waiting: 0, order: streams.to_vec(), lengths: [0; LENGTHS] }
    }

    /// Takes a realization's rays; `tally` and `total` have added up the block's contributions so far.
    #[inline]
    pub fn realization(&mut self, rays: u64, tally: &Tally, total: Rgb) {
        self.lengths[(rays as usize).min(LENGTHS - 1)] += 1;
        if self.order.is_empty() {
            return;
        }
        // light that was scattered k times took k rays at least
        self.single.bet(1.0, rays as usize + 1, tally, total);
        self.waiting += 1;
        if self.waiting == PER_BET {
            self.several.bet(1.0 / PER_BET as f64, BINS, tally, total);
            self.waiting = 0;
        }
    }

    /// Bets on what is left, and gives what was won.
    pub fn close(&mut self, tally: &Tally, total: Rgb) -> Vec<Bets> {
        if self.waiting > 0 && !self.order.is_empty() {
            self.several.bet(1.0 / self.waiting as f64, BINS, tally, total);
        }
        let won = |stream: &Stream| {
            let sitting = if stream.stake.samples_per_bet() == 1 { &self.single } else { &self.several };
            let tables = &sitting.tables[stream.bin.unwrap_or(BINS)];
            tables.iter().find(|(s, _)| s == stream).map(|(_, table)| table.close(sitting.bets))
        };
        self.order.iter().filter_map(won).collect()
    }
}

impl Sitting {
    /// Bets on what was added since the last bet, to the first `bins` bins and in all.
    #[inline]
    fn bet(&mut self, share: f64, bins: usize, tally: &Tally, total: Rgb) {
        self.bets += 1;
        for bin in 0..bins.min(BINS) {
            self.bet_on(bin, share, tally.bounces[bin]);
        }
        self.bet_on(BINS, share, total);
    }

    #[inline]
    fn bet_on(&mut self, bin: usize, share: f64, sum: Rgb) {
        let tables = &mut self.tables[bin];
        // most paths add nothing to most bins
        if !tables.is_empty() && sum != self.before[bin] {
            let added = (sum - self.before[bin]) * share;
            tables.iter_mut().for_each(|(stream, table)| table.push(added[stream.channel]));
            self.before[bin] = sum;
        }
    }
}
