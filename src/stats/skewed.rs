//! Tests of a mean that allow for skewness.
//!
//! Radiance is skewed to the right: rare bright paths make mean and standard error
//! large together. Plain t tests then see too many means that are too low, and too
//! few that are too high.
//!
//! Rejections of a true mean at a nominal 1 % per side, in percent of 20 000
//! simulations:
//!
//! | law, n | Johnson below | above | Student below | above |
//! |---|---|---|---|---|
//! | exponential, 100 | 1.05 | 0.87 | 2.52 | 0.37 |
//! | 40 hits expected in 400 | 0.58 | 0.91 | 2.29 | 0.35 |

use super::{Moments, student};

/// Johnson's (1978) modified t of the hypothesis that the mean is `mu` (in the
/// unit of the values); without unit, positive if the sample lies above.
///
/// `√n (u + g/(6n) + g u²/3)` with u = (mean - mu) / s and the sample's skewness g.
/// As a function of u it turns back at u = -3/(2g), far outside of what is
/// [`trustworthy`]; beyond, its value there is returned. NaN without
/// variation: such a sample has no t at all, which is not the same as a
/// certain difference.
pub fn johnson_t(moments: &Moments, mu: f64) -> f64 {
    let (Some(variance), Some(g)) = (moments.variance(), moments.skewness()) else {
        return f64::NAN;
    };
    let n = moments.n as f64;
    let u = (moments.mean - mu) / libm::sqrt(variance);
    let u = if g * u < -1.5 { -1.5 / g } else { u };
    libm::sqrt(n) * (u + g / (6.0 * n) + g * u * u / 3.0)
}

/// Probability of a sample mean as far above `mu` or farther, if `mu` is the mean:
/// small values speak for a larger one. In 0..=1, or NaN as [`johnson_t`].
pub fn p_above(moments: &Moments, mu: f64) -> f64 {
    student::one_sided_p(johnson_t(moments, mu), degrees(moments))
}

/// The same for a sample mean below `mu`: small values speak for a smaller mean.
pub fn p_below(moments: &Moments, mu: f64) -> f64 {
    student::one_sided_p(-johnson_t(moments, mu), degrees(moments))
}

/// Two-sided p-value of the hypothesis that differences `d` of pairs have mean 0.
pub fn paired(d: &Moments) -> f64 {
    student::two_sided_p(johnson_t(d, 0.0), degrees(d))
}

/// Limits of the mean, in the unit of the values: all `mu` that neither one-sided
/// test rejects at `(1 - confidence) / 2`. A limit that the turning point of
/// [`johnson_t`] puts out of reach is infinite. None without variation, or if
/// `confidence` is not between 0 and 1.
pub fn limits(moments: &Moments, confidence: f64) -> Option<(f64, f64)> {
    let (s, g) = (libm::sqrt(moments.variance()?), moments.skewness()?);
    if !(confidence > 0.0 && confidence < 1.0) {
        return None;
    }
    let n = moments.n as f64;
    let t = student::upper_quantile((1.0 - confidence) / 2.0, n - 1.0) / libm::sqrt(n);
    // the root of u + g u²/3 = c that tends to c as g vanishes
    let root = |c: f64| {
        let discriminant = 1.0 + 4.0 * g * c / 3.0;
        if discriminant < 0.0 {
            f64::INFINITY.copysign(c)
        } else {
            2.0 * c / (1.0 + libm::sqrt(discriminant))
        }
    };
    let shift = g / (6.0 * n);
    Some((moments.mean - s * root(t - shift), moments.mean - s * root(-t - shift)))
}

/// Whether so many values of such a skewness suffice for these tests at the
/// two-sided level `alpha`: `n >= 25 G1²` (Cochran 1977, 2.15, for 5 %), times
/// `(z / 1.96)²` with the normal quantile z of a smaller `alpha`. False if anything
/// is NaN.
pub fn trustworthy(n: u64, skewness: f64, alpha: f64) -> bool {
    let z = student::upper_quantile(alpha / 2.0, f64::INFINITY) / 1.959963984540054;
    // rounding of z alone must not ask for one value more
    n as f64 >= 25.0 * skewness * skewness * if z < 1.0 { 1.0 } else { z * z } * (1.0 - 1e-12)
}

fn degrees(moments: &Moments) -> f64 {
    moments.n.saturating_sub(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::source::Source;

    fn sample(n: u64, source: &mut Source, mut law: impl FnMut(&mut Source) -> f64) -> Moments {
        let mut moments = Moments::default();
        (0..n).for_each(|_| moments.push(law(source)));
        moments
    }

    /// Rejections in percent at 1 % per side, if the mean is 1: below, above, by
    /// Johnson's t and by Student's.
    fn sizes(n: u64, law: impl Fn(&mut Source) -> f64) -> [f64; 4] {
        const RUNS: usize = 20_000;
        let mut source = Source(17);
        let mut counts = [0; 4];
        for _ in 0..RUNS {
            let m = sample(n, &mut source, &law);
            let plain = (m.mean - 1.0) / m.std_error().unwrap();
            let p = |t: f64| student::one_sided_p(t, n as f64 - 1.0);
            let all = [p_below(&m, 1.0), p_above(&m, 1.0), p(-plain), p(plain)];
            (0..4).for_each(|i| counts[i] += usize::from(all[i] < 0.01));
        }
        counts.map(|count| count as f64 * 100.0 / RUNS as f64)
    }

    #[test]
    fn both_sides_are_nearer_to_their_level_than_with_plain_t() {
        let exponential = sizes(100, Source::exponential);
        // about 40 hits
        let rare = sizes(400, |s| s.rare(0.1));
        for [below, above, plain_below, plain_above] in [exponential, rare] {
            assert!((below - 1.0).abs() < (plain_below - 1.0).abs(), "{below} {plain_below}");
            assert!((above - 1.0).abs() < (plain_above - 1.0).abs(), "{above} {plain_above}");
        }
    }

    #[test]
    fn known_values() {
        let mut m = Moments::default();
        [1.0, 2.0, 4.0, 8.0, 16.0, 0.5, 3.25].iter().for_each(|&x| m.push(x));
        // by the formula, with the moments that numpy gives (see moments.rs)
        let (u, g) = ((4.964285714285714 - 3.0) / 29.88392857142857_f64.sqrt(), 1.3099289849281504);
        let t = 7_f64.sqrt() * (u + g / 42.0 + g * u * u / 3.0);
        assert!((johnson_t(&m, 3.0) - t).abs() < 1e-13);
        assert!((p_above(&m, 3.0) + p_below(&m, 3.0) - 1.0).abs() < 1e-12);
        assert!(p_above(&m, 3.0) < 0.5);
        let centred = Moments { mean: m.mean - 3.0, ..m };
        assert!((paired(&centred) - 2.0 * p_above(&m, 3.0)).abs() < 1e-12);
    }

    #[test]
    fn limits_are_where_the_test_rejects() {
        let mut source = Source(9);
        for law in [Source::exponential, |s: &mut Source| -s.exponential(), Source::normal] {
            let m = sample(300, &mut source, law);
            let (low, high) = limits(&m, 0.98).unwrap();
            assert!(low < m.mean && m.mean < high);
            assert!((p_above(&m, low) - 0.01).abs() < 1e-10, "{}", p_above(&m, low));
            assert!((p_below(&m, high) - 0.01).abs() < 1e-10, "{}", p_below(&m, high));
        }
    }

    #[test]
    fn far_beyond_the_turning_point_nothing_turns() {
        let m = sample(30, &mut Source(1), Source::exponential);
        let far = johnson_t(&m, 1e6);
        assert!(far < 0.0 && far == johnson_t(&m, 1e9) && johnson_t(&m, -1e9) > 1e9);
        // one hit of 30: the upper limit is out of reach
        let mut hit = Moments::default();
        (0..30).for_each(|i| hit.push(f64::from(u8::from(i == 0))));
        assert_eq!(limits(&hit, 0.999).unwrap().1, f64::INFINITY);
    }

    #[test]
    fn no_variation_is_no_evidence() {
        let mut m = Moments::default();
        assert!(p_above(&m, 1.0).is_nan() && paired(&m).is_nan());
        (0..100).for_each(|_| m.push(0.0));
        assert!(johnson_t(&m, 1.0).is_nan() && p_below(&m, 1.0).is_nan());
        assert_eq!(limits(&m, 0.9), None);
        let varied = sample(30, &mut Source(1), Source::normal);
        assert_eq!(limits(&varied, 1.0).or(limits(&varied, f64::NAN)), None);
    }

    #[test]
    fn cochran() {
        assert!(trustworthy(100, 2.0, 0.05) && !trustworthy(99, 2.0, 0.05));
        assert!(trustworthy(100, -2.0, 0.5));
        // (3.2905 / 1.96)² = 2.8186
        assert!(trustworthy(282, 2.0, 1e-3) && !trustworthy(281, 2.0, 1e-3));
        assert!(!trustworthy(9, f64::NAN, 0.05) && !trustworthy(1_000_000, 2.0, f64::NAN));
        assert!(trustworthy(0, 0.0, 0.05));
    }
}
