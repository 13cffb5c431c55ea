//! A t that allows for skewness.
//!
//! Radiance is skewed to the right: rare bright paths make mean and standard error large together. Plain t tests then see
//! too many means that are too low, and too few that are too high. Johnson's (1978) correction undoes that; Hall's (1992)
//! adds the cubic term that makes it monotone, so that it inverts to limits.
//!
//! Rejections of a true mean at a nominal 1 % per side, in percent of 20 000 simulations:
//!
//! | law, n | corrected below | above | Student below | above |
//! |---|---|---|---|---|
//! | exponential, 100 | 1.05 | 0.87 | 2.52 | 0.37 |
//! | 40 hits expected in 400 | 0.58 | 0.91 | 2.29 | 0.35 |

use super::student;

/// The distance `t` of a mean from a value in standard errors, made symmetrical: with `g` the skewness of the mean's own
/// distribution (that of a sample by √n), t + g t²/3 + g² t³/27 + g/6, which grows with t everywhere [Hall 1992, J. R.
/// Statist. Soc. B 54, eq. 2.3].
pub fn symmetrical(t: f64, g: f64) -> f64 {
    if t.is_infinite() { t } else { t + g * t * t / 3.0 + g * g * t * t * t / 27.0 + g / 6.0 }
}

/// The distance in standard errors of which [`symmetrical`] makes `y`.
pub fn distance(y: f64, g: f64) -> f64 {
    // below, the series of the cube root is exact to rounding, and the quotient is not
    if g.abs() < 1e-9 { y } else { 3.0 / g * (libm::cbrt(1.0 + g * (y - g / 6.0)) - 1.0) }
}

/// Whether so many values of such a skewness suffice for a t test at the two-sided level `alpha`: `n >= 25 G1²` (Cochran
/// 1977, 2.15, for 5 %), times `(z / 1.96)²` with the normal quantile z of a smaller `alpha`. False if anything is NaN.
pub fn trustworthy(n: u64, skewness: f64, alpha: f64) -> bool {
    // rounding of z alone must not ask for one value more
    n as f64 >= enough(skewness, alpha) * (1.0 - 1e-12)
}

/// The number of values that [`trustworthy`] asks for.
pub fn enough(skewness: f64, alpha: f64) -> f64 {
    let z = student::upper_quantile(alpha / 2.0, f64::INFINITY) / 1.959963984540054;
    25.0 * skewness * skewness * if z < 1.0 { 1.0 } else { z * z }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Moments;
    use crate::stats::source::Source;

    /// Rejections in percent at 1 % per side, if the mean is 1: below, above, by the corrected t and by Student's.
    fn sizes(n: u64, law: impl Fn(&mut Source) -> f64) -> [f64; 4] {
        const RUNS: usize = 20_000;
        let mut source = Source(17);
        let mut counts = [0; 4];
        for _ in 0..RUNS {
            let mut m = Moments::default();
            (0..n).for_each(|_| m.push(law(&mut source)));
            let plain = (m.mean - 1.0) / m.std_error().unwrap();
            let corrected = symmetrical(plain, m.skewness().unwrap() / (n as f64).sqrt());
            let p = |t: f64| student::one_sided_p(t, n as f64 - 1.0);
            let all = [p(-corrected), p(corrected), p(-plain), p(plain)];
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
    fn it_grows_everywhere_and_inverts() {
        for g in [-0.7, -1e-3, 0.0, 1e-12, 0.02, 0.5] {
            let mut last = f64::NEG_INFINITY;
            for t in (-800..=800).map(|i| f64::from(i) / 10.0) {
                let y = symmetrical(t, g);
                assert!(y >= last, "{t} {g}");
                assert!((distance(y, g) - t).abs() <= 1e-5 * (1.0 + t.abs()), "{t} {g} {}", distance(y, g));
                last = y;
            }
        }
        assert_eq!(symmetrical(f64::INFINITY, 0.3), f64::INFINITY);
        // Johnson's statistic where t is small
        assert!((symmetrical(0.01, 0.3) - (0.01 + 0.3 / 6.0 + 0.3 * 1e-4 / 3.0)).abs() < 1e-8);
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
