//! The tail guard: whether a mean and a variance may be trusted at all.
//!
//! A [`Tail`] keeps the largest values beside their sums. From the share of the
//! largest in the sum of squares [`Tail::apparent_index`] reads how heavy the
//! tail looks, and [`Tail::guard`] turns that into a [`Light`]. No finite sample
//! can prove a variance finite (Bahadur & Savage 1956): green means that nothing
//! speaks against it, red that tests built on the variance mean nothing.

use serde::{Deserialize, Serialize};
use std::fmt;

/// How many of the largest values are kept.
pub const KEPT: usize = 32;
/// Below it red; where the variance is infinite most samples look like 2 to 2.2. See [`Tail::guard`].
pub const RED_INDEX: f64 = 2.25;
/// Below it yellow. See [`Tail::guard`].
pub const YELLOW_INDEX: f64 = 2.6;
/// Fewer effective values are red: `n >= 25 G1²` (Cochran 1977, 2.15) for rare events.
pub const RED_EFFECTIVE: f64 = 25.0;
/// Fewer are yellow: the same rule scaled to a level of 0.2 %, (3.1 / 1.96)² times as many.
pub const YELLOW_EFFECTIVE: f64 = 64.0;

/// How far something may be trusted; later is worse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Light {
    /// Nothing speaks against it.
    Green,
    /// Doubtful.
    Yellow,
    /// Not valid.
    Red,
}

impl fmt::Display for Light {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Light::Green => "green",
            Light::Yellow => "yellow",
            Light::Red => "red",
        })
    }
}

/// The largest magnitudes of a sample, and the sums to compare them with.
///
/// Values in the unit u. `largest` does not depend on order or on the split into
/// blocks; the sums are floating-point sums in the order of pushing and merging.
/// A NaN is not kept but poisons the sums, so that the guard turns red.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tail {
    /// Number of values.
    pub n: u64,
    /// Sum of |x|, unit u.
    pub sum: f64,
    /// Sum of x², unit u².
    pub sum_sq: f64,
    /// Up to [`KEPT`] largest |x| > 0, ascending, unit u.
    pub largest: Vec<f64>,
    /// Smaller values are not worth keeping: 0, or the smallest kept if all places are taken.
    floor: f64,
}

impl Tail {
    /// Adds one value.
    #[inline]
    pub fn push(&mut self, x: f64) {
        let x = x.abs();
        self.n += 1;
        self.sum += x;
        self.sum_sq += x * x;
        if x > self.floor {
            self.keep(x);
        }
    }

    /// Adds all values that `other` has seen.
    pub fn merge(&mut self, other: &Tail) {
        self.n += other.n;
        self.sum += other.sum;
        self.sum_sq += other.sum_sq;
        // the largest first, so that the floor rises early
        for &x in other.largest.iter().rev() {
            if x <= self.floor {
                break;
            }
            self.keep(x);
        }
    }

    #[cold]
    fn keep(&mut self, x: f64) {
        if self.largest.len() == KEPT {
            self.largest.remove(0);
        }
        let place = self.largest.partition_point(|&kept| kept < x);
        self.largest.insert(place, x);
        if self.largest.len() == KEPT {
            self.floor = self.largest[0];
        }
    }

    /// max |x|^p / Σ |x|^p for p = 1 or 2, in 0..=1. It tends to zero with n
    /// if and only if E|X|^p is finite (O'Brien 1980; Embrechts, Klüppelberg &
    /// Mikosch 1997, 6.2.6). None if the sum is not positive and finite, or for another p.
    pub fn max_to_sum(&self, p: u32) -> Option<f64> {
        let max = self.largest.last()?;
        match p {
            1 => share(*max, self.sum),
            2 => share(max * max, self.sum_sq),
            _ => None,
        }
    }

    /// Share of the [`KEPT`] largest in Σ |x|, in 0..=1; none if the sum is not
    /// positive and finite.
    pub fn share_of_largest(&self) -> Option<f64> {
        share(self.largest.iter().rev().sum(), self.sum)
    }

    /// (Σ|x|)² / Σx²: the number of equal values that would weigh as much (Kish
    /// 1965), between 0 and n; for a rare event the number of hits. NaN if a
    /// value was not finite.
    pub fn effective(&self) -> f64 {
        if self.sum_sq == 0.0 { 0.0 } else { self.sum * (self.sum / self.sum_sq) }
    }

    /// Tail index of the Pareto law whose k = min(32, n/32) largest of n values
    /// have the share s in Σx² that was found: `2 / (1 - ln s / ln(k/n))`, at
    /// least 2 by construction. None below 32 values, and without a positive,
    /// finite sum.
    ///
    /// From the share of the largest fraction f of a Pareto law of index a > 2
    /// in its second moment, f^(1 - 2/a). Unlike the estimators of Hill or of
    /// the generalized Pareto fit, it does not need different values: paths in a
    /// furnace take only a handful.
    pub fn apparent_index(&self) -> Option<f64> {
        let k = (self.n / 32).min(KEPT as u64);
        if k == 0 {
            return None;
        }
        let squares = self.largest.iter().rev().take(k as usize).map(|x| x * x).sum();
        let s = share(squares, self.sum_sq)?;
        let ratio = libm::log(s) / libm::log(k as f64 / self.n as f64);
        // equal values make it 1 up to rounding
        Some(if ratio < 1.0 - 1e-9 { 2.0 / (1.0 - ratio) } else { f64::INFINITY })
    }

    /// Whether mean and variance of the sample may be used for inference, and why.
    ///
    /// Red: a value was not finite, or fewer than [`RED_EFFECTIVE`] values
    /// matter, or the tail looks like an index below [`RED_INDEX`]. Yellow:
    /// [`YELLOW_EFFECTIVE`], [`YELLOW_INDEX`]. The thresholds are from
    /// 1000 simulations each of a walk in a furnace of albedo 1/2 with constant survival q
    /// (tail index ln(1/q) / ln(1/(2q)), 2 at q = 1/4), n = 10^6:
    ///
    /// | q | index | median of the apparent index, 5..95 % | red | green |
    /// |---|---|---|---|---|
    /// | 0.15 | 1.58 | 2.06, 2.01..2.16 | 100 % | 0 |
    /// | 0.2 | 1.76 | 2.12, 2.02..2.22 | 98 % | 0 |
    /// | 0.25 | 2 | 2.21, 2.05..2.33 | 71 % | 0 |
    /// | 0.3 | 2.36 | 2.39, 2.19..2.52 | 12 % | 1 % |
    /// | 0.35 | 2.94 | 2.69, 2.47..2.84 | 0.3 % | 80 % |
    /// | 0.5 | infinite | 5.36, 5.25..5.46 | 0 | 100 % |
    ///
    /// It can not be perfect: no function of a sample separates q = 0.25 from
    /// 0.26. Between, yellow is the honest answer; the normal approximation is
    /// poor there, too. Heavy but finite tails look heavier the fewer the values:
    /// lognormal with sigma = 1 is mostly yellow at n = 10^3, green in 85 % at 10^4 and
    /// always at 10^5. A rare event is red below about 100 hits in 10^6.
    pub fn guard(&self) -> (Light, String) {
        let effective = self.effective();
        if !effective.is_finite() {
            return (Light::Red, "a value is not finite".to_string());
        }
        let index = self.apparent_index().unwrap_or(f64::INFINITY);
        let light = if effective < RED_EFFECTIVE || index < RED_INDEX {
            Light::Red
        } else if effective < YELLOW_EFFECTIVE || index < YELLOW_INDEX {
            Light::Yellow
        } else {
            Light::Green
        };
        let weigh = format!("{} values weigh as much as {effective:.3} equal ones", self.n);
        (light, format!("{weigh}; the largest look like a tail index of {index:.2}"))
    }
}

/// `part / whole`, if that means anything; rounding may not make it exceed 1.
fn share(part: f64, whole: f64) -> Option<f64> {
    (whole > 0.0 && whole.is_finite()).then(|| (part / whole).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::source::Source;

    fn pushed(values: &[f64]) -> Tail {
        let mut tail = Tail::default();
        values.iter().for_each(|&x| tail.push(x));
        tail
    }

    fn drawn(n: u64, seed: u64, mut law: impl FnMut(&mut Source) -> f64) -> Tail {
        let (mut tail, mut source) = (Tail::default(), Source(seed));
        (0..n).for_each(|_| tail.push(law(&mut source)));
        tail
    }

    /// Of `runs` samples of size `n`: how many are red, yellow, green.
    fn lights(n: u64, runs: u64, law: impl Fn(&mut Source) -> f64) -> [usize; 3] {
        let all: Vec<Light> = (0..runs).map(|run| drawn(n, run << 40, &law).guard().0).collect();
        [Light::Red, Light::Yellow, Light::Green].map(|l| all.iter().filter(|&&x| x == l).count())
    }

    #[test]
    fn an_infinite_variance_is_red_and_a_light_tail_is_not() {
        let [red, _, green] = lights(1_000_000, 40, |s| s.furnace(0.2));
        assert!(red >= 37 && green == 0, "{red} {green}");
        assert_eq!(lights(1_000_000, 20, |s| s.furnace(0.5)), [0, 0, 20]);
        // between: doubtful
        let [red, yellow, green] = lights(100_000, 100, |s| s.furnace(0.3));
        assert!(red <= 25 && yellow >= 70 && green <= 5, "{red} {yellow} {green}");
    }

    #[test]
    fn lognormal_is_green_when_large_and_rare_events_are_red() {
        assert_eq!(lights(100_000, 50, |s| libm::exp(s.normal())), [0, 0, 50]);
        for n in [200, 10_000, 1_000_000] {
            let hits = |count: usize| {
                let mut tail = pushed(&vec![n as f64; count]);
                (count..n).for_each(|_| tail.push(0.0));
                tail.guard().0
            };
            assert_eq!((0..25).find(|&count| hits(count) != Light::Red), None, "{n}");
        }
        assert_eq!(lights(1_000_000, 3, |s| s.rare(1e-3)), [0, 0, 3]);
    }

    #[test]
    fn few_values_are_never_green() {
        assert_eq!(pushed(&[1.0; 24]).guard().0, Light::Red);
        assert_eq!(pushed(&[1.0; 63]).guard().0, Light::Yellow);
        assert_eq!(pushed(&[1.0; 64]).guard().0, Light::Green);
        assert_eq!(Tail::default().guard().0, Light::Red);
        assert_eq!(pushed(&[0.0; 1000]).guard().0, Light::Red);
        let mut values = vec![1.0; 1000];
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            values[500] = bad;
            assert_eq!(pushed(&values).guard(), (Light::Red, "a value is not finite".to_string()));
        }
    }

    #[test]
    fn the_largest_do_not_depend_on_the_split() {
        let mut source = Source(5);
        // a lattice: ties among the largest
        let mut values: Vec<f64> = (0..10_000).map(|_| source.furnace(0.2)).collect();
        values.extend([-500.0, 0.0]);
        let all = pushed(&values);
        for block in [1, 7, 33, 5000] {
            let mut merged = Tail::default();
            values.chunks(block).for_each(|part| merged.merge(&pushed(part)));
            assert_eq!((&merged.largest, merged.floor, merged.n), (&all.largest, all.floor, all.n));
            assert!((merged.sum_sq / all.sum_sq - 1.0).abs() < 1e-13);
        }
        let mut sorted: Vec<f64> = values.iter().map(|x| x.abs()).collect();
        sorted.sort_by(f64::total_cmp);
        assert_eq!(all.largest, sorted[sorted.len() - KEPT..]);
    }

    #[test]
    fn ratios() {
        let tail = pushed(&[1.0, -3.0, 2.0, 4.0]);
        assert_eq!((tail.max_to_sum(1), tail.max_to_sum(2)), (Some(0.4), Some(16.0 / 30.0)));
        assert_eq!((tail.max_to_sum(3), tail.share_of_largest()), (None, Some(1.0)));
        assert!((tail.effective() - 100.0 / 30.0).abs() < 1e-15);
        let empty = Tail::default();
        assert_eq!(empty.max_to_sum(1).or(empty.share_of_largest()).or(empty.apparent_index()), None);
        assert_eq!(pushed(&[0.1; 1000]).apparent_index(), Some(f64::INFINITY));
        // k = 2 of 64, half of the sum of squares: 2 / (1 - ln 2 / ln 32)
        let mut values = vec![1.0; 62];
        values.extend([31_f64.sqrt(); 2]);
        assert!((pushed(&values).apparent_index().unwrap() - 2.5).abs() < 1e-12);
    }

    #[test]
    fn lights_are_ordered_and_plain_text() {
        assert!(Light::Green < Light::Yellow && Light::Yellow < Light::Red);
        assert_eq!(serde_json::to_string(&Light::Yellow).unwrap(), "\"yellow\"");
        assert_eq!(Light::Red.to_string(), "red");
        let tail = drawn(100, 3, Source::exponential);
        assert_eq!(serde_json::from_str::<Tail>(&serde_json::to_string(&tail).unwrap()).unwrap(), tail);
    }
}
