//! Many questions, one error rate.

/// Level of each of `m` tests that together err with probability `alpha` at
/// most (Bonferroni 1936). An empty family counts as one test.
pub fn bonferroni(alpha: f64, m: usize) -> f64 {
    alpha / m.max(1) as f64
}

/// Which hypotheses the step-down test of Holm (1979) rejects, in the order of
/// `p`; the probability of any false rejection is `alpha` at most, whatever
/// the dependence between the tests.
///
/// A NaN counts as a member of the family but is never rejected. An `alpha`
/// that is NaN rejects nothing.
pub fn holm(p: &[f64], alpha: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p.len()).filter(|&i| !p[i].is_nan()).collect();
    order.sort_by(|&i, &j| p[i].total_cmp(&p[j]));
    let mut rejected = vec![false; p.len()];
    for (rank, &i) in order.iter().enumerate() {
        if p[i] <= bonferroni(alpha, p.len() - rank) {
            rejected[i] = true;
        } else {
            // step-down: what follows is not even tested
            break;
        }
    }
    rejected
}

/// Level of each of `m` independent tests that together err with probability
/// `alpha` (Šidák 1967); larger than that of [`bonferroni`] by at most 0.05 %
/// below `alpha` = 1e-3. An empty family counts as one test.
///
/// It holds under dependence, too, for two-sided tests of jointly normal
/// statistics; not for skewed ones. NaN if `alpha` is NaN or exceeds 1.
pub fn sidak(alpha: f64, m: usize) -> f64 {
    // 1 - (1 - alpha)^(1/m) without the loss of digits
    -libm::expm1(libm::log1p(-alpha) / m.max(1) as f64)
}

/// Which hypotheses with e-values `e` are rejected when each is compared with
/// `m / alpha`: the probability of any false rejection is `alpha` at most,
/// whatever the dependence (Vovk & Wang 2021).
///
/// An e-value is a variable >= 0 with mean 1 at most if the hypothesis is true.
/// A NaN counts as a member of the family but is never rejected; an `alpha` that
/// is NaN or negative rejects nothing. The same holds for [`e_holm`] and [`e_bh`].
pub fn e_bonferroni(e: &[f64], alpha: f64) -> Vec<bool> {
    let needed = e.len() as f64 / alpha;
    e.iter().map(|&e| alpha >= 0.0 && e >= needed).collect()
}

/// Which hypotheses with e-values `e` the step-down test of Holm (1979) rejects:
/// the i-th largest is compared with `(m - i + 1) / alpha`, up to the first that
/// fails. Guarantee as [`e_bonferroni`], of which it rejects all and maybe more.
pub fn e_holm(e: &[f64], alpha: f64) -> Vec<bool> {
    let order = descending(e);
    let passes = |rank: &usize| alpha >= 0.0 && e[order[*rank]] >= (e.len() - rank) as f64 / alpha;
    let count = (0..order.len()).take_while(passes).count();
    first(&order, count, e.len())
}

/// Which hypotheses with e-values `e` the e-BH procedure rejects (Wang & Ramdas
/// 2022): the k largest, for the largest k with `e_(k) >= m / (k q)`.
///
/// The expected share of false ones among the rejected is `q` times the share of
/// true hypotheses at most, whatever the dependence.
pub fn e_bh(e: &[f64], q: f64) -> Vec<bool> {
    let order = descending(e);
    let reaches = |&k: &usize| q >= 0.0 && e[order[k - 1]] >= e.len() as f64 / (k as f64 * q);
    let count = (1..=order.len()).rev().find(reaches).unwrap_or(0);
    first(&order, count, e.len())
}

/// Which hypotheses with p-values `p` the step-up procedure of Benjamini & Hochberg (1995) rejects: the k smallest, for
/// the largest k with `p_(k) <= k q / m`.
///
/// The expected share of false ones among the rejected is `q` times the share of true hypotheses at most, if the tests
/// are independent or positively dependent (Benjamini & Yekutieli 2001); [`e_bh`] needs no such condition. A NaN counts
/// as a member but is never rejected; a `q` that is NaN or negative rejects nothing.
pub fn bh(p: &[f64], q: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p.len()).filter(|&i| !p[i].is_nan()).collect();
    order.sort_by(|&i, &j| p[i].total_cmp(&p[j]));
    let reaches = |&k: &usize| p[order[k - 1]] <= k as f64 * q / p.len() as f64;
    let count = (1..=order.len()).rev().find(reaches).unwrap_or(0);
    first(&order, count, p.len())
}

/// Indices of all but the NaN, largest value first.
fn descending(e: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..e.len()).filter(|&i| !e[i].is_nan()).collect();
    order.sort_by(|&i, &j| e[j].total_cmp(&e[i]));
    order
}

/// `len` answers, true for the first `count` of `order`.
fn first(order: &[usize], count: usize, len: usize) -> Vec<bool> {
    let mut rejected = vec![false; len];
    order[..count].iter().for_each(|&i| rejected[i] = true);
    rejected
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::source::Source;

    #[test]
    fn steps_down_and_stops() {
        // 0.05/4, 0.05/3, 0.05/2, 0.05: statsmodels' multipletests(method="holm")
        let p = [0.04, 0.012, 0.016, 0.03];
        assert_eq!(holm(&p, 0.05), [false, true, true, false]);
        // 0.04 passes its own threshold, but 0.026 before it did not
        assert_eq!(holm(&[0.04, 0.026], 0.05), [false, false]);
        assert_eq!(holm(&[0.04, 0.025], 0.05), [true, true]);
    }

    #[test]
    fn nan_counts_but_is_never_rejected() {
        assert_eq!(holm(&[f64::NAN, 0.025], 0.05), [false, true]);
        assert_eq!(holm(&[-f64::NAN, 0.025], 0.05), [false, true]);
        assert_eq!(holm(&[f64::NAN, 0.026], 0.05), [false, false]);
        assert_eq!(holm(&[0.0], f64::NAN), [false]);
    }

    #[test]
    fn empty_and_single_families() {
        assert!(holm(&[], 0.05).is_empty());
        assert_eq!(holm(&[0.05], 0.05), [true]);
        assert_eq!(bonferroni(0.05, 0), 0.05);
        assert_eq!(bonferroni(0.05, 5), 0.01);
    }

    #[test]
    fn e_values_by_hand() {
        // 4 / 0.1 = 40; 30, 20, 10
        let e = [35.0, 45.0, f64::NAN, 21.0];
        assert_eq!(e_bonferroni(&e, 0.1), [false, true, false, false]);
        assert_eq!(e_holm(&e, 0.1), [true, true, false, true]);
        // the first that fails ends it
        assert_eq!(e_holm(&[39.0, 39.0, 39.0, 39.0], 0.1), [false; 4]);
        // 40, 20, 13.3, 10: the third decides for all three
        assert_eq!(e_bh(&[14.0, 1.0, 14.0, 14.0], 0.1), [true, false, true, true]);
        assert_eq!(e_bh(&[13.0, f64::NAN, 13.0, 13.0], 0.1), [false; 4]);
        assert_eq!(e_bh(&[f64::INFINITY, f64::NAN], 0.0), [true, false]);
    }

    #[test]
    fn the_largest_that_passes_decides_for_all_below() {
        // 0.0125, 0.025, 0.0375, 0.05: statsmodels' multipletests(method="fdr_bh")
        assert_eq!(bh(&[0.036, 0.03, 0.9, 0.028], 0.05), [true, true, false, true]);
        assert_eq!(bh(&[0.038, 0.03, 0.9, 0.028], 0.05), [false; 4]);
        assert_eq!(bh(&[f64::NAN, 0.02, -f64::NAN, 0.02], 0.05), [false, true, false, true]);
        assert_eq!(bh(&[f64::NAN, 0.026, -f64::NAN, 0.026], 0.05), [false; 4]);
        assert_eq!(bh(&[0.0, 1.0], 0.0), [true, false]);
        assert!(bh(&[], 0.05).is_empty() && bh(&[0.0], f64::NAN) == [false] && bh(&[0.0], -0.1) == [false]);
    }

    #[test]
    fn bh_keeps_the_rate_of_false_discoveries_of_independent_tests() {
        const RUNS: usize = 4000;
        let rate = |scale: f64| {
            let (mut source, mut wrong, mut found) = (Source(7), 0.0, 0);
            for _ in 0..RUNS {
                let p =
                    (0..50).map(|i| scale * if i < 10 { 1e-3 * source.uniform() } else { source.uniform() });
                let rejected = bh(&p.collect::<Vec<f64>>(), 0.1);
                let [right, false_ones] =
                    [&rejected[..10], &rejected[10..]].map(|part| part.iter().filter(|&&r| r).count());
                wrong += false_ones as f64 / (right + false_ones).max(1) as f64;
                found += right;
            }
            (wrong / RUNS as f64, found as f64 / (10 * RUNS) as f64)
        };
        // 40 of 50 are true
        let (wrong, found) = rate(1.0);
        assert!((0.07..0.09).contains(&wrong) && found > 0.9, "{wrong} {found}");
        // what is no p-value is noticed
        assert!(rate(0.1).0 > 0.2);
    }

    #[test]
    fn nothing_is_rejected_without_a_level() {
        for rule in [e_bonferroni, e_holm, e_bh] {
            for alpha in [f64::NAN, -0.1] {
                assert_eq!(rule(&[1e9, f64::INFINITY], alpha), [false; 2]);
            }
            assert!(rule(&[], 0.1).is_empty());
            assert_eq!(rule(&[-f64::NAN, 20.0], 0.1), [false, true]);
        }
    }

    #[test]
    fn sidak_keeps_its_digits() {
        assert_eq!(sidak(0.05, 1), 0.05);
        assert_eq!(sidak(0.05, 0), 0.05);
        // mpmath with 40 digits
        for (alpha, m, expected) in
            [(0.01, 4096, 2.4536922664259569e-6), (1e-12, 1_000_000, 1.0000000000005e-18)]
        {
            let relative = sidak(alpha, m) / expected - 1.0;
            assert!(relative.abs() < 1e-14, "{relative:e}");
        }
        assert!(sidak(-0.1, 0) < 0.0 && sidak(1.1, 3).is_nan());
    }

    /// Share of false discoveries of e-BH at 10 %, and of discoveries, among 40
    /// true and 10 false hypotheses with a common cause.
    fn discoveries(correlation: f64, scale: f64) -> (f64, f64) {
        const RUNS: usize = 4000;
        let (mut source, mut wrong, mut found) = (Source(3), 0.0, 0);
        for _ in 0..RUNS {
            let common = source.normal() * correlation.sqrt();
            let mut e_value = |i| {
                let z =
                    common + source.normal() * (1.0 - correlation).sqrt() + if i < 10 { 4.0 } else { 0.0 };
                // likelihood ratio of a normal mean of 3
                scale * libm::exp(3.0 * z - 4.5)
            };
            let rejected = e_bh(&(0..50).map(&mut e_value).collect::<Vec<f64>>(), 0.1);
            let true_ones = rejected[10..].iter().filter(|&&r| r).count();
            let all = rejected.iter().filter(|&&r| r).count();
            wrong += true_ones as f64 / all.max(1) as f64;
            found += all - true_ones;
        }
        (wrong / RUNS as f64, found as f64 / (10 * RUNS) as f64)
    }

    #[test]
    fn e_bh_keeps_the_rate_of_false_discoveries_under_dependence() {
        for correlation in [0.0, 0.5, 0.9] {
            let (wrong, found) = discoveries(correlation, 1.0);
            assert!(wrong < 0.1 && found > 0.5, "{correlation}: {wrong} {found}");
        }
        // what is no e-value, its mean being 1000, is noticed
        assert!(discoveries(0.5, 1000.0).0 > 0.1);
    }
}
