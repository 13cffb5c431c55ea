//! Whether replicates are independent: the assumption behind every standard error.

use super::student;

/// Fewer replicates say nothing about correlation.
const MIN_REPLICATES: usize = 8;

/// Serial correlation of replicates in their order, and its p-value, two-sided.
///
/// The circular statistic of Wald & Wolfowitz (1943) on ranks, r = Σ d_i d_(i+1) /
/// Σ d_i² with deviations d from the mean rank, the last followed by the first: in
/// -1..=1. The p-value is normal, with the exact mean, -1/(n-1), and variance of r
/// over all orders. Ranks, because on values the normal law fails for a heavy
/// tail: a nominal 1 % became 2.7 % for 64 walks of infinite variance; on ranks it
/// is 0.9 to 1.0 % from 64 replicates on, 0.7 % for 20 and less below. Ties do not
/// matter until most values are the same (0 in 9 of 10: 1.8 %). None below 8
/// values, if all are the same, or if one is not finite.
pub fn lag_correlation(means: &[f64]) -> Option<(f64, f64)> {
    if means.len() < MIN_REPLICATES || means.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let (r, mean, variance) = circular(&ranks(means))?;
    let z = (r - mean) / libm::sqrt(variance);
    z.is_finite().then(|| (r, student::two_sided_p(z, f64::INFINITY)))
}

/// Ranks from 1, equal values sharing their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = |&x: &f64| {
        let (below, upto) = (sorted.partition_point(|&y| y < x), sorted.partition_point(|&y| y <= x));
        (below + upto + 1) as f64 / 2.0
    };
    values.iter().map(rank).collect()
}

/// The statistic, and its mean and variance over all permutations.
fn circular(values: &[f64]) -> Option<(f64, f64, f64)> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let d: Vec<f64> = values.iter().map(|x| x - mean).collect();
    let s2: f64 = d.iter().map(|x| x * x).sum();
    let s4: f64 = d.iter().map(|x| x * x * x * x).sum();
    let follower = d.iter().cycle().skip(1);
    let r = d.iter().zip(follower).map(|(a, b)| a * b).sum::<f64>() / s2;
    let spread = s4 / (s2 * s2);
    let expected = -1.0 / (n - 1.0);
    let variance =
        (1.0 - spread) / (n - 1.0) + (1.0 - 2.0 * spread) / ((n - 1.0) * (n - 2.0)) - expected * expected;
    (r.is_finite() && variance > 0.0).then_some((r, expected, variance))
}

/// The key of a sequence that is longer by one word: equal for sequences that hold the same bits in the same order, and
/// for others with a chance of 2^-64.
#[inline]
pub fn chain(key: u64, word: u64) -> u64 {
    mix(key ^ word)
}

/// An upper limit of the chance that any two of `blocks` blocks of `n` samples each are the same though all are
/// independent, where the classes that samples fall into were counted: two samples are alike with the sum of squared
/// shares at most, and there are blocks (blocks - 1) / 2 pairs.
///
/// A repeat of a continuous quantity is proof of a repeated stream; samples that take few values (hits and misses, walks
/// in a furnace) repeat legitimately in small blocks.
pub fn chance_of_repeats(counts: &[u64], n: u64, blocks: u64) -> f64 {
    let total: u64 = counts.iter().sum();
    let alike: f64 =
        counts.iter().map(|&count| (count as f64 / total as f64) * (count as f64 / total as f64)).sum();
    let pairs = 0.5 * blocks as f64 * (blocks as f64 - 1.0);
    (pairs * libm::pow(alike, n as f64)).min(1.0)
}

/// How many keys were seen before, in any order: 0 if all differ.
pub fn repeats(keys: &[u64]) -> usize {
    let mut sorted = keys.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// A bijection that leaves no bit in place (SplitMix64; Steele, Lea & Flood 2014).
fn mix(word: u64) -> u64 {
    let z = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Moments;
    use crate::stats::source::Source;

    /// Calls `f` with every order of `values` (Heap 1963).
    fn permute(values: &mut [f64], k: usize, f: &mut impl FnMut(&[f64])) {
        if k == 1 {
            return f(values);
        }
        for i in 0..k {
            permute(values, k - 1, f);
            values.swap(if k.is_multiple_of(2) { i } else { 0 }, k - 1);
        }
    }

    #[test]
    fn mean_and_variance_are_those_of_all_orders() {
        let mut values = [3.0, -1.0, 0.5, 10.0, 2.0, 2.0, 7.25];
        let (_, mean, variance) = circular(&values).unwrap();
        let mut seen = Moments::default();
        permute(&mut values, 7, &mut |order| seen.push(circular(order).unwrap().0));
        assert_eq!(seen.n, 5040);
        assert!((seen.mean - mean).abs() < 1e-12, "{} {mean}", seen.mean);
        assert!((seen.m2 / 5040.0 - variance).abs() < 1e-12, "{} {variance}", seen.m2 / 5040.0);
    }

    /// How often p < 1 % for 64 replicates of which each keeps `memory` of the last.
    fn alarms(memory: f64, runs: usize, mut noise: impl FnMut(&mut Source) -> f64) -> usize {
        let mut source = Source(21);
        let mut alarm = |_: &usize| {
            let mut last = 0.0;
            let mut next = || {
                last = memory * last + noise(&mut source);
                last
            };
            let values: Vec<f64> = (0..64).map(|_| next()).collect();
            lag_correlation(&values).unwrap().1 < 0.01
        };
        (0..runs).filter(&mut alarm).count()
    }

    #[test]
    fn independent_replicates_raise_few_alarms_and_correlated_ones_many() {
        for noise in [Source::normal, Source::exponential, |s: &mut Source| s.furnace(0.2)] {
            let false_ones = alarms(0.0, 10_000, noise);
            // 100 expected, standard deviation 10
            assert!((70..=130).contains(&false_ones), "{false_ones}");
            assert!(alarms(0.6, 200, noise) >= 190);
        }
    }

    #[test]
    fn sign_and_edges() {
        let rising: Vec<f64> = (0..20).map(f64::from).collect();
        let (r, p) = lag_correlation(&rising).unwrap();
        assert!(r > 0.5 && p < 1e-3, "{r} {p}");
        let swinging: Vec<f64> = (0..20).map(|i| f64::from(i % 2)).collect();
        let (r, p) = lag_correlation(&swinging).unwrap();
        assert!(r == -1.0 && p < 1e-3, "{r} {p}");
        let tiny: Vec<f64> = rising.iter().map(|x| 1e-200 * x.exp()).collect();
        assert_eq!(lag_correlation(&tiny), lag_correlation(&rising));
        assert_eq!(ranks(&[3.0, 1.0, 3.0, -0.0, 0.0]), [4.5, 3.0, 4.5, 1.5, 1.5]);
        assert_eq!(lag_correlation(&rising[..7]), None);
        assert_eq!(lag_correlation(&[1.0; 50]), None);
        assert_eq!(lag_correlation(&[&rising[..], &[f64::NAN]].concat()), None);
        assert_eq!(lag_correlation(&[&rising[..], &[f64::INFINITY]].concat()), None);
    }

    #[test]
    fn a_repeated_block_is_seen() {
        let block = |seed: u64| {
            let mut source = Source(seed << 40);
            (0..100).fold(0, |key, _| chain(key, source.exponential().to_bits()))
        };
        let mut keys: Vec<u64> = (0..1000).map(block).collect();
        assert_eq!(repeats(&keys), 0);
        keys.extend([block(7), block(7), block(500)]);
        assert_eq!(repeats(&keys), 3);
        assert_eq!(repeats(&[]), 0);
        // order matters
        assert_ne!(chain(chain(0, 1), 2), chain(chain(0, 2), 1));
    }

    /// Blocks of hits and misses repeat by chance as often as the limit says, at most.
    #[test]
    fn the_chance_of_repeats_is_a_limit() {
        let (n, blocks, runs) = (12, 20, 4000);
        let mut source = Source(3);
        let mut repeated = 0;
        for _ in 0..runs {
            let block = |source: &mut Source| (0..n).fold(0, |key, _| chain(key, source.rare(0.3).to_bits()));
            let keys: Vec<u64> = (0..blocks).map(|_| block(&mut source)).collect();
            repeated += usize::from(repeats(&keys) > 0);
        }
        let limit = chance_of_repeats(&[700, 300], n, blocks);
        let rate = repeated as f64 / f64::from(runs);
        assert!(rate < limit + 0.03 && rate > 0.5 * limit, "{rate} {limit}");
        assert!(chance_of_repeats(&[700, 300], 4096, 1 << 20) == 0.0);
        assert_eq!(chance_of_repeats(&[5, 0], 10, 4), 1.0);
    }
}
