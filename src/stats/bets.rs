//! Betting on the mean of non-negative samples: evidence that may be looked at, and stopped by, at any time.
//!
//! A gambler who stakes the share λ of a fortune on "the mean exceeds m" has Π (1 + λ (X/m - 1)) after the samples X. If
//! the mean is at most m, that is a non-negative supermartingale, and it ever exceeds 1/α with probability α at most
//! [Ville 1939], whatever the variance, which may be infinite. Likewise Y = B - X >= 0 for a known bound B gives evidence
//! that the mean lies below m; without a bound no such evidence can exist [Bahadur & Savage 1956]. The fortune is spread
//! evenly over a grid of shares [Waudby-Smith & Ramdas 2024, sec. 4].
//!
//! With c = λ / ((1 - λ) m) the logarithm of the fortune is Σ ln(1 + c X) - n ln(1 + c m): for a grid of fixed c, the sums
//! do not depend on m. So they are all that is kept; blocks merge by adding them, and every m is tested afterwards, which
//! inverts to confidence limits that hold at all times together.

use multiversion::multiversion;
use serde::{Deserialize, Serialize};
use std::f64::consts::LN_2;

/// Shares in the grid: 15/16, 1/2, 1/4, ... of a fortune.
pub const BETS: usize = 16;

/// The largest share in the grid: a little is kept, or one sample without light would take all.
pub const BOLDEST: f64 = 15.0 / 16.0;

/// What must be known before the first sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stake {
    /// About how large the mean is, > 0: the grid of bets is laid around it. A wrong guess costs power, never validity.
    pub scale: f64,
    /// No sample exceeds it; above `scale`.
    pub bound: Option<f64>,
}

/// Logarithms of fortunes after `n` samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bets {
    /// The guess and the bound.
    pub stake: Stake,
    /// Number of samples that were bet on.
    pub n: u64,
    /// Samples above the bound, or which are no non-negative number: the evidence is void.
    pub void: u64,
    /// Whether any sample was positive.
    positive: bool,
    /// Σ ln(1 + c X), a c each.
    above: [f64; BETS],
    /// Σ ln(1 + d (B - X)), a d each; zero without a bound.
    below: [f64; BETS],
}

/// A sample may exceed its bound by so much, relative to it: sums of contributions are rounded.
const ROUNDING: f64 = 1e-9;

/// A sample so many times the scale could overflow a product of [`BEFORE_SPLIT`] factors.
const HUGE: f64 = 1e60;

/// So many samples are averaged before they are bet on, see [`Stake::samples_per_bet`].
pub const PER_BET: u64 = 16;

/// Factors that are multiplied before exponents are set apart.
const BEFORE_SPLIT: u32 = 4;

impl Stake {
    /// λ / (1 - λ) for each share, per unit of `scale`.
    fn grid(scale: f64) -> [f64; BETS] {
        let mut next = 0.5;
        let mut share = BOLDEST;
        [(); BETS].map(|()| {
            let odds = share / (1.0 - share) / scale;
            (share, next) = (next, 0.5 * next);
            odds
        })
    }

    pub(super) fn above(&self) -> [f64; BETS] {
        Stake::grid(self.scale)
    }

    pub(super) fn below(&self) -> [f64; BETS] {
        Stake::grid(self.bound.map_or(1.0, |bound| bound - self.scale))
    }

    /// Samples that the bench averages before it bets on them, because a bet costs as much as a bounce. Where a sample may
    /// be many times the mean, which can only be if it seldom is, an average has the same bound but hides how seldom.
    pub fn samples_per_bet(&self) -> u64 {
        if self.bound.is_some_and(|bound| bound >= PER_BET as f64 * self.scale) { 1 } else { PER_BET }
    }

    /// Why one cannot bet like this.
    pub fn defect(&self) -> Option<&'static str> {
        let is_positive = |x: f64| x.is_finite() && x > 0.0;
        if !is_positive(self.scale) {
            return Some("a guess of the mean is finite and positive");
        }
        let bounded = self.bound.is_none_or(|bound| is_positive(bound - self.scale));
        (!bounded).then_some("a bound is finite and lies above the mean")
    }
}

impl Bets {
    /// Before the first sample.
    pub fn new(stake: Stake) -> Self {
        assert_eq!(stake.defect(), None);
        Bets { stake, n: 0, void: 0, positive: false, above: [0.0; BETS], below: [0.0; BETS] }
    }

    /// Adds the samples that `other` has bet on; in the order of blocks, for the same bits.
    pub fn merge(&mut self, other: &Bets) {
        assert_eq!(self.stake, other.stake);
        self.n += other.n;
        self.void += other.void;
        self.positive |= other.positive;
        for j in 0..BETS {
            self.above[j] += other.above[j];
            self.below[j] += other.below[j];
        }
    }

    /// Logarithm of the e-value against "the mean is at most `m`".
    pub fn log_above(&self, m: f64) -> f64 {
        // no sample is negative, so no mean is
        if m < 0.0 || (m == 0.0 && self.positive) {
            return f64::INFINITY;
        }
        mix(&self.above, &self.stake.above(), self.n, m)
    }

    /// Logarithm of the e-value against "the mean is at least `m`"; none without a bound.
    pub fn log_below(&self, m: f64) -> Option<f64> {
        let bound = self.stake.bound?;
        let room = bound - m;
        Some(if room < 0.0 { f64::INFINITY } else { mix(&self.below, &self.stake.below(), self.n, room) })
    }

    /// The mean lies at or above it at all times, with probability 1 - `level`.
    pub fn lower_limit(&self, level: f64) -> f64 {
        let enough = -libm::log(level);
        if self.log_above(0.0) < enough {
            return 0.0;
        }
        let mut high = self.stake.scale;
        while self.log_above(high) >= enough {
            high *= 2.0;
        }
        bisect(0.0, high, |m| self.log_above(m) >= enough).0
    }

    /// The mean lies at or below it at all times, with probability 1 - `level`; infinity without a bound.
    pub fn upper_limit(&self, level: f64) -> f64 {
        let Some(bound) = self.stake.bound else { return f64::INFINITY };
        let enough = -libm::log(level);
        let excluded = |m: f64| self.log_below(m).is_some_and(|log| log >= enough);
        if !excluded(bound) {
            return bound;
        }
        if excluded(0.0) {
            return 0.0;
        }
        bisect(0.0, bound, |m| !excluded(m)).1
    }
}

/// Narrows an interval whose lower end has a property that its upper end lacks.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> (f64, f64) {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
    (low, high)
}

/// ln of the mean over the grid of exp(sum - n ln(1 + c m)).
fn mix(sums: &[f64; BETS], grid: &[f64; BETS], n: u64, m: f64) -> f64 {
    let mut logs = [0.0; BETS];
    for j in 0..BETS {
        logs[j] = sums[j] - n as f64 * libm::log1p(grid[j] * m);
    }
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = logs.iter().map(|log| libm::exp(log - largest)).sum();
    largest + libm::log(sum / BETS as f64)
}

/// Products of factors, kept as mantissas and exponents: a logarithm for each factor would cost more than a path.
#[derive(Clone, Debug)]
struct Product {
    mantissa: [f64; BETS],
    exponent: [i64; BETS],
    pending: u32,
}

impl Product {
    const ONE: Product = Product { mantissa: [1.0; BETS], exponent: [0; BETS], pending: 0 };

    #[inline]
    fn multiply(&mut self, grid: &[f64; BETS], y: f64) {
        multiply(&mut self.mantissa, grid, y);
        self.pending += 1;
        if self.pending == BEFORE_SPLIT {
            split(&mut self.mantissa, &mut self.exponent);
            self.pending = 0;
        }
    }

    fn logs(&self) -> [f64; BETS] {
        let mut logs = [0.0; BETS];
        for (j, log) in logs.iter_mut().enumerate() {
            *log = self.exponent[j] as f64 * LN_2 + libm::log(self.mantissa[j]);
        }
        logs
    }
}

// the same bits from each of them: no product is fused with a sum
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn multiply(mantissa: &mut [f64; BETS], grid: &[f64; BETS], y: f64) {
    for (mantissa, c) in mantissa.iter_mut().zip(grid) {
        *mantissa *= 1.0 + c * y;
    }
}

/// Moves the powers of two into the exponents.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn split(mantissa: &mut [f64; BETS], exponent: &mut [i64; BETS]) {
    for (mantissa, exponent) in mantissa.iter_mut().zip(exponent) {
        let bits = mantissa.to_bits();
        *exponent += (bits >> 52) as i64 - 1023;
        *mantissa = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000);
    }
}

/// Bets on the samples of one block.
#[derive(Clone, Debug)]
pub struct Table {
    stake: Stake,
    grid: [[f64; BETS]; 2],
    /// Samples that were not zero.
    lit: u64,
    void: u64,
    above: Product,
    below: Product,
}

impl Table {
    /// Before the first sample.
    pub fn new(stake: Stake) -> Self {
        let grid = [stake.above(), stake.below()];
        Table { stake, grid, lit: 0, void: 0, above: Product::ONE, below: Product::ONE }
    }

    /// Bets on one sample; those that are zero need not be told of.
    #[inline]
    pub fn push(&mut self, x: f64) {
        if x == 0.0 {
            return;
        }
        self.lit += 1;
        if !(x > 0.0 && x < HUGE * self.stake.scale) {
            self.void += 1;
            return;
        }
        self.above.multiply(&self.grid[0], x);
        if let Some(bound) = self.stake.bound {
            self.void += u64::from(x > bound * (1.0 + ROUNDING));
            self.below.multiply(&self.grid[1], (bound - x).max(0.0));
        }
    }

    /// What was won and lost after `n` samples, those that were zero included.
    pub fn close(&self, n: u64) -> Bets {
        let mut below = self.below.logs();
        if let Some(bound) = self.stake.bound {
            let zeros = (n - self.lit) as f64;
            for (log, d) in below.iter_mut().zip(self.grid[1]) {
                *log += zeros * libm::log1p(d * bound);
            }
        }
        let positive = self.lit > self.void;
        Bets { stake: self.stake, n, void: self.void, positive, above: self.above.logs(), below }
    }
}
