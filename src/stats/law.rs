//! Counts against a law: path lengths, chosen lights, cells of a histogram.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Smallest expectation of a cell; neighbours are pooled until they have it.
pub const MIN_EXPECTED: f64 = 10.0;

/// How close the probabilities must come to 1 for the rest to count as impossible.
const NOTHING: f64 = 1e-12;

/// Outcome of a test of goodness of fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Pearson's chi-square >= 0, without unit; infinite if something impossible was counted.
    pub statistic: f64,
    /// Degrees of freedom: pooled cells less one.
    pub df: usize,
    /// Probability of a statistic as large or larger if the law is right.
    pub p: f64,
}

/// Chi-square test (Pearson 1900) of `counts` against `probabilities`.
///
/// Counts beyond the last probability, and missing probability, form one more
/// cell, the rest: what is lost is compared, too. If there is to be a rest, give it
/// 1e-9 at least: below 1e-12 it counts as impossible. Cells should be ordered (by
/// path length, say), since neighbours are pooled until each expects
/// [`MIN_EXPECTED`]. None if a probability is negative or NaN, their sum exceeds
/// 1, or fewer than two pooled cells remain (and nothing impossible was counted).
///
/// The p-value is an approximation, a little too small: with 1000 lengths of a
/// geometric law, p < 1e-2, 1e-3, 1e-4 in 1.03e-2, 1.2e-3, 1.6e-4 of 200 000 simulations.
pub fn goodness(counts: &[u64], probabilities: &[f64]) -> Option<Fit> {
    let cells = cells(counts, probabilities)?;
    let n: u64 = cells.iter().map(|cell| cell.0).sum();
    if impossible(&cells) {
        return Some(Fit { statistic: f64::INFINITY, df: cells.len() - 1, p: 0.0 });
    }
    let mut pooled = Vec::<(u64, f64)>::new();
    for (count, probability) in cells {
        let expected = n as f64 * probability;
        match pooled.last_mut().filter(|last| last.1 < MIN_EXPECTED) {
            Some(last) => *last = (last.0 + count, last.1 + expected),
            None => pooled.push((count, expected)),
        }
    }
    // what is left over joins the cell before
    if pooled.len() > 1 && pooled[pooled.len() - 1].1 < MIN_EXPECTED {
        let (count, expected) = pooled.pop()?;
        let last = pooled.last_mut()?;
        *last = (last.0 + count, last.1 + expected);
    }
    if pooled.len() < 2 {
        return None;
    }
    let term =
        |&(count, expected): &(u64, f64)| (count as f64 - expected) * (count as f64 - expected) / expected;
    let statistic = pooled.iter().map(term).sum();
    let df = pooled.len() - 1;
    let p = ChiSquared::new(df as f64).ok()?.sf(statistic);
    Some(Fit { statistic, df, p })
}

/// Logarithm of an e-value against the law: evidence that stays valid when
/// looked at after any number of independent trials.
///
/// If the law is right, it ever exceeds ln(1/alpha) with probability `alpha` at
/// most (Ville 1939). Bayes factor of a mixture of Dirichlet laws about the null,
/// with concentrations 1, 10, .., 10^8 of equal weight, so that both small and
/// large deviations are found. Cells as in [`goodness`], not pooled: no
/// expectation is too small. Infinite if something impossible was counted; NaN
/// where [`goodness`] has no cells.
pub fn log_e_value(counts: &[u64], probabilities: &[f64]) -> f64 {
    let Some(cells) = cells(counts, probabilities) else {
        return f64::NAN;
    };
    if impossible(&cells) {
        return f64::INFINITY;
    }
    let factors: [f64; 9] = std::array::from_fn(|j| log_bayes_factor(&cells, libm::exp10(j as f64)));
    let largest = factors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = factors.iter().map(|factor| libm::exp(factor - largest)).sum();
    largest + libm::log(sum / factors.len() as f64)
}

/// Of the Dirichlet-multinomial law with parameters `concentration * probability`
/// against the multinomial.
fn log_bayes_factor(cells: &[(u64, f64)], concentration: f64) -> f64 {
    let n: u64 = cells.iter().map(|cell| cell.0).sum();
    let rise = |a: f64, count: u64| libm::lgamma(a + count as f64) - libm::lgamma(a);
    let seen = cells.iter().filter(|cell| cell.0 > 0);
    let sum: f64 = seen.map(|&(count, p)| rise(concentration * p, count) - count as f64 * libm::log(p)).sum();
    sum - rise(concentration, n)
}

fn impossible(cells: &[(u64, f64)]) -> bool {
    cells.iter().any(|&(count, probability)| probability == 0.0 && count > 0)
}

/// Counts with their probabilities, the rest last; none if these are no law.
fn cells(counts: &[u64], probabilities: &[f64]) -> Option<Vec<(u64, f64)>> {
    let total: f64 = probabilities.iter().sum();
    // the negated comparisons would let a NaN through
    if !(total <= 1.0 + NOTHING && probabilities.iter().all(|&p| p >= 0.0)) {
        return None;
    }
    let count = |i: usize| counts.get(i).copied().unwrap_or(0);
    let mut cells: Vec<(u64, f64)> = probabilities.iter().enumerate().map(|(i, &p)| (count(i), p)).collect();
    let rest = if 1.0 - total < NOTHING { 0.0 } else { 1.0 - total };
    cells.push((counts.iter().skip(probabilities.len()).sum(), rest));
    Some(cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::source::Source;

    /// P(K = k) for k = 1..=cells, P(K > k) = q^k.
    fn geometric(q: f64, cells: i32) -> Vec<f64> {
        (0..cells).map(|k| (1.0 - q) * q.powi(k)).collect()
    }

    fn lengths(q: f64, n: usize, source: &mut Source) -> Vec<u64> {
        let mut counts = vec![0; 25];
        (0..n).for_each(|_| counts[source.geometric(q).min(25) as usize - 1] += 1);
        counts
    }

    #[test]
    fn chi_square_by_hand() {
        // scipy.stats.chisquare([30, 14, 34, 45, 57, 20], f_exp = 200/6)
        let fit = goodness(&[30, 14, 34, 45, 57, 20], &[1.0 / 6.0; 6]).unwrap();
        assert!((fit.statistic - 37.78).abs() < 1e-12, "{fit:?}");
        assert!((fit.p / 4.177325475265192e-7 - 1.0).abs() < 1e-9 && fit.df == 5, "{fit:?}");
        // 50, 25, 12.5 expected; the rest of 12.5 is a cell; 6.25 and 6.25 would be pooled
        assert_eq!(goodness(&[50, 25, 13, 12], &[0.5, 0.25, 0.125]).unwrap().df, 3);
        assert_eq!(goodness(&[50, 25, 13, 6, 6], &[0.5, 0.25, 0.125, 0.0625]).unwrap().df, 3);
        // a small first cell joins the second, a small last one the one before
        let fit = goodness(&[2, 48, 45, 5], &[0.02, 0.48, 0.45, 0.05]).unwrap();
        assert!(fit.df == 1 && fit.statistic < 1e-20 && fit.p > 0.9999, "{fit:?}");
    }

    #[test]
    fn tails_of_chi_square_are_those_of_scipy() {
        for (df, x, p) in [
            (1.0, 100.0, 1.5239706048320995e-23),
            (1.0, 1000.0, 1.7958327848007363e-219),
            (3.0, 50.0, 7.989179244951495e-11),
            (10.0, 200.0, 1.6139305336977317e-37),
            (100.0, 150.0, 0.0009039320423540184),
            (100.0, 400.0, 1.6927979958857254e-37),
            (1000.0, 1100.0, 0.014614408126295192),
            (1000.0, 2000.0, 4.1436785914539184e-69),
            (30.0, 1500.0, 3.9605925288243954e-297),
        ] {
            let found = ChiSquared::new(df).unwrap().sf(x);
            assert!((found / p - 1.0).abs() < 1e-9, "{df} {x}: {found:e}, not {p:e}");
        }
    }

    #[test]
    fn what_is_impossible_or_no_law() {
        for counts in [[10, 90, 1], [0, 100, 1]] {
            let fit = goodness(&counts, &[0.2, 0.8]).unwrap();
            assert_eq!((fit.statistic, fit.p), (f64::INFINITY, 0.0));
            assert_eq!(log_e_value(&counts, &[0.2, 0.8]), f64::INFINITY);
        }
        assert_eq!(goodness(&[100, 100, 1], &[0.5, 0.5, 0.0]).unwrap().p, 0.0);
        assert_eq!(goodness(&[1, 1], &[1.0]).unwrap().p, 0.0);
        assert_eq!(goodness(&[10, 5], &[0.6, 0.4]), None);
        assert_eq!(goodness(&[], &[]), None);
        for bad in [[0.6, 0.5], [-0.1, 0.5], [f64::NAN, 0.5]] {
            assert_eq!(goodness(&[1000, 1000], &bad), None);
            assert!(log_e_value(&[1000, 1000], &bad).is_nan());
        }
        assert!(log_e_value(&[], &[0.5]).abs() < 1e-12);
    }

    #[test]
    fn p_is_uniform_under_the_law_and_one_percent_in_q_is_found() {
        let (law, mut source, mut small, mut found) = (geometric(0.5, 20), Source(8), 0, 0);
        for _ in 0..2000 {
            let fit = goodness(&lengths(0.5, 1000, &mut source), &law).unwrap();
            small += usize::from(fit.p < 0.05);
        }
        // 100 expected, standard deviation 10
        assert!((70..=130).contains(&small), "{small}");
        for _ in 0..20 {
            let counts = lengths(0.505, 300_000, &mut source);
            found +=
                usize::from(goodness(&counts, &law).unwrap().p < 1e-3 && log_e_value(&counts, &law) > 7.0);
        }
        assert!(found >= 18, "{found}");
    }

    #[test]
    fn the_e_value_may_be_looked_at_after_every_batch() {
        let (law, mut source, mut alarms) = (geometric(0.4, 20), Source(11), 0);
        const RUNS: usize = 1000;
        for _ in 0..RUNS {
            let (mut counts, mut largest) = (vec![0; 25], 0.0_f64);
            for _ in 0..100 {
                let batch = lengths(0.4, 20, &mut source);
                counts.iter_mut().zip(batch).for_each(|(sum, new)| *sum += new);
                largest = largest.max(log_e_value(&counts, &law));
            }
            alarms += usize::from(largest >= libm::log(10.0));
        }
        // at most 10 %; three standard deviations more
        assert!(alarms <= 128, "{alarms}");
    }

    #[test]
    fn the_mean_of_an_e_value_is_one() {
        // exactly, by enumeration of 6 trials in cells of 0.3, 0.2 and the rest
        let factorial = |n: u64| (1..=n).product::<u64>() as f64;
        let mut mean = 0.0;
        for a in 0..=6_u64 {
            for b in 0..=6 - a {
                let c = 6 - a - b;
                let ways = 720.0 / (factorial(a) * factorial(b) * factorial(c));
                let chance = ways * 0.3_f64.powi(a as i32) * 0.2_f64.powi(b as i32) * 0.5_f64.powi(c as i32);
                mean += chance * log_e_value(&[a, b, c], &[0.3, 0.2]).exp();
            }
        }
        assert!((mean - 1.0).abs() < 1e-7, "{mean}");
    }
}
