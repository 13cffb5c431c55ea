//! Student's t for real degrees of freedom, from 1 to infinity.
//!
//! Only the upper tail of `statrs` is used, and up to 1000 degrees of freedom only:
//! its `inverse_cdf` (0.19.1) is off by 7 % at 1e7 degrees of freedom, does not
//! return at 2e7, and answers 0 for 1e-12 at one degree of freedom.

use statrs::distribution::{Continuous, ContinuousCDF, Normal, StudentsT};

/// Above it Hill's expansion is exact to rounding, below it `statrs` is good
/// to 1e-12 (both against mpmath with 40 digits).
const ASYMPTOTIC_DF: f64 = 1e3;

/// Above it Student's t is the normal distribution to the last bit.
const NORMAL_DF: f64 = 1e20;

/// P(T > t) of Student's t with `df` > 0 degrees of freedom, infinity included.
///
/// The relative error for t > 0 is below 1e-10 down to results of 1e-12, and
/// below 1e-9 down to 1e-290; the result is 0 where t² overflows. NaN if an
/// argument is NaN or `df` <= 0.
pub fn one_sided_p(t: f64, df: f64) -> f64 {
    if t.is_nan() || df.is_nan() || df <= 0.0 {
        return f64::NAN;
    }
    if t < 0.0 { 1.0 - upper_tail(-t, df) } else { upper_tail(t, df) }
}

/// P(|T| > |t|) of Student's t; precision and range as [`one_sided_p`].
pub fn two_sided_p(t: f64, df: f64) -> f64 {
    2.0 * one_sided_p(t.abs(), df)
}

/// The t that Student's t with `df` degrees of freedom does not exceed with
/// probability `p`.
///
/// For `p` next to 1 use [`upper_quantile`]: `1 - 1e-12` has four digits left.
/// NaN if `p` is outside 0..=1 or `df` is NaN or not positive.
pub fn quantile(p: f64, df: f64) -> f64 {
    if p < 0.5 { -upper_quantile(p, df) } else { upper_quantile(1.0 - p, df) }
}

/// The t that Student's t with `df` degrees of freedom exceeds with
/// probability `q`; range as [`quantile`], relative error below 1e-12, and
/// infinity where t² overflows or the tail vanishes.
pub fn upper_quantile(q: f64, df: f64) -> f64 {
    if !(0.0..=1.0).contains(&q) || df.is_nan() || df <= 0.0 {
        return f64::NAN;
    }
    if q > 0.5 {
        return -upper_quantile(1.0 - q, df);
    }
    let z = -Normal::standard().inverse_cdf(q);
    if q == 0.0 || q == 0.5 {
        z.abs()
    } else if df > ASYMPTOTIC_DF {
        from_normal(z, df)
    } else {
        newton(q, df, z)
    }
}

/// Degrees of freedom of `√(se1² + se2²)` by Welch (1947) and Satterthwaite
/// (1946): real, at least the smaller of the two, and at most their sum.
///
/// `se1` and `se2` are standard errors >= 0 in the same unit, with `df1` and
/// `df2` degrees of freedom, infinity included. An error of zero takes no part;
/// if both are zero, the smaller `df` is returned. NaN if an argument is NaN.
pub fn welch_df(se1: f64, df1: f64, se2: f64, df2: f64) -> f64 {
    if [se1, df1, se2, df2].iter().any(|x| x.is_nan()) {
        return f64::NAN;
    }
    let largest = se1.max(se2);
    if largest == 0.0 {
        return df1.min(df2);
    }
    if se1 == 0.0 || se2 == 0.0 {
        return if se1 == 0.0 { df2 } else { df1 };
    }
    // relative to the larger, so that fourth powers neither overflow nor vanish
    let (v1, v2) = ((se1 / largest).powi(2), (se2 / largest).powi(2));
    (v1 + v2).powi(2) / (v1 * v1 / df1 + v2 * v2 / df2)
}

/// P(T > t) for t >= 0 and a valid `df`.
fn upper_tail(t: f64, df: f64) -> f64 {
    if (t * t).is_infinite() {
        0.0
    } else if df > ASYMPTOTIC_DF {
        Normal::standard().sf(to_normal(t, df))
    } else {
        students_t(df).sf(t)
    }
}

fn students_t(df: f64) -> StudentsT {
    StudentsT::new(0.0, 1.0, df).expect("df was checked to be positive")
}

/// The normal deviate with the upper tail that `t` has (Hill 1970, CACM 13,
/// algorithm 395): an expansion about √(a ln(1 + t²/df)), good in the far tail.
fn to_normal(t: f64, df: f64) -> f64 {
    if df > NORMAL_DF {
        return t;
    }
    let a = df - 0.5;
    let y = (a * (t * t / df).ln_1p()).sqrt();
    y + hill_correction(y, a)
}

/// Inverse of [`to_normal`], from the same expansion.
fn from_normal(z: f64, df: f64) -> f64 {
    if df > NORMAL_DF {
        return z;
    }
    let a = df - 0.5;
    // contracts by 1e-4 or better a round, at any z that an f64 tail can have
    let y = (0..5).fold(z, |y, _| z - hill_correction(y, a));
    (df * (y * y / a).exp_m1()).sqrt()
}

fn hill_correction(y: f64, a: f64) -> f64 {
    let y2 = y * y;
    let b = 48.0 * a * a;
    let third = ((4.0 * y2 + 33.0) * y2 + 240.0) * y2 + 855.0;
    y * ((y2 + 3.0) / b - third / (10.0 * b * (b + 0.8 * y2 * y2 + 100.0)))
}

/// Solves P(T > t) = q, 0 < q < 1/2, by Newton's method from a start > 0.
///
/// In ln t the logarithm of the tail falls ever faster, to a straight line, so
/// the first step overshoots and all others come back without crossing.
fn newton(q: f64, df: f64, start: f64) -> f64 {
    let law = students_t(df);
    let mut t = start;
    for _ in 0..100 {
        let tail = law.sf(t);
        // beyond the range of f64
        if tail == 0.0 {
            return f64::INFINITY;
        }
        // t pdf / tail, by logarithms because the density underflows first
        let slope = (t.ln() + law.ln_pdf(t) - tail.ln()).exp();
        let step = (tail / q).ln() / slope;
        t *= step.exp();
        if step.abs() < 1e-9 {
            break;
        }
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    const INF: f64 = f64::INFINITY;

    #[track_caller]
    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a:e} is not {b:e} to {tolerance:e}");
    }

    /// scipy.stats.t.ppf of SciPy 1.17.1; norm.ppf at infinity.
    #[rustfmt::skip]
    const SCIPY: [(f64, [f64; 4]); 7] = [
        (2.0, [1.8856180831641272, 4.302652729749462, 31.599054576445365, 2236.067642678063]),
        (10.0, [1.372183641110336, 2.228138851986274, 4.586893858702708, 12.492209688254745]),
        (1e2, [1.290074761346516, 1.9839715185235518, 3.390491311164263, 5.586900474706954]),
        (1e4, [1.2816362297304775, 1.960201239890626, 3.2914999659416355, 5.202983638365324]),
        (1e5, [1.2815600314493614, 1.9599877075346095, 3.2906240314119137, 5.199701988462917]),
        (1e8, [1.2815515740104482, 1.9599640082627663, 3.290526828789235, 5.1993379466747065]),
        (INF, [1.2815515655446004, 1.959963984540054, 3.2905267314919255, 5.199337582290661]),
    ];

    #[test]
    fn quantiles_are_those_of_scipy() {
        for (df, expected) in SCIPY {
            for (p, t) in [0.9, 0.975, 0.9995, 1.0 - 1e-7].into_iter().zip(expected) {
                close(quantile(p, df), t, 1e-12);
                close(quantile(1.0 - p, df), -t, 1e-12);
                close(one_sided_p(t, df), 1.0 - p, 1e-10);
                close(two_sided_p(-t, df), 2.0 * (1.0 - p), 1e-10);
                close(1.0 - one_sided_p(-t, df), 1.0 - p, 1e-8);
            }
        }
    }

    #[test]
    fn small_tails_keep_their_relative_precision() {
        // P(T > t) = 1e-12, from mpmath with 40 digits
        for (df, t) in [
            (1.0, 318309886183.79065),
            (1.5, 52194694.27344635),
            (10.0, 40.5320961786626),
            (100.0, 8.025825594493254),
            (1000.0, 7.1242289253144095),
            (3000.0, 7.064184308953649),
            (100000.0, 7.035371742393576),
            (10000000.0, 7.03449270352616),
            (INF, 7.034483825301132),
        ] {
            close(one_sided_p(t, df), 1e-12, 1e-10);
            close(upper_quantile(1e-12, df), t, 1e-13);
        }
    }

    #[test]
    fn tail_and_quantile_are_inverse_on_both_sides_of_the_seam() {
        for df in [1.0, 1.3, 7.7, 63.0, 999.9, 1000.0, 1000.1, 2e7, 1e19, 1e21, INF] {
            for q in [1e-300, 1e-30, 1e-9, 0.01, 0.3, 0.4999, 0.7] {
                let t = upper_quantile(q, df);
                // Cauchy has 1e-300 at 3e299, the square of which overflows
                if (t * t).is_finite() {
                    close(one_sided_p(t, df), q, 1e-9);
                }
            }
        }
        let (below, above) = (upper_quantile(1e-6, 1e3), upper_quantile(1e-6, 1e3 + 1e-9));
        close(above, below, 1e-13);
    }

    #[test]
    fn edges_and_nonsense() {
        assert_eq!(quantile(0.5, 3.0), 0.0);
        assert_eq!((quantile(0.0, 3.0), quantile(1.0, 1e9)), (-INF, INF));
        assert_eq!((one_sided_p(INF, 5.0), one_sided_p(-INF, INF)), (0.0, 1.0));
        assert_eq!((two_sided_p(0.0, 3.0), two_sided_p(0.0, INF)), (1.0, 1.0));
        for df in [0.0, -1.0, f64::NAN] {
            assert!(one_sided_p(1.0, df).is_nan() && quantile(0.9, df).is_nan());
        }
        for p in [-0.1, 1.1, f64::NAN] {
            assert!(quantile(p, 5.0).is_nan());
        }
        assert!(one_sided_p(f64::NAN, 5.0).is_nan());
        // at the end of the range of f64: large, but no panic
        for df in [1.0, 1.5, 31.0, 999.0, 1e4, INF] {
            assert!(upper_quantile(1e-321, df) > 37.0);
        }
    }

    #[test]
    fn welch() {
        close(welch_df(1.0, 10.0, 1.0, 10.0), 20.0, 1e-15);
        // (4 + 9)² / (16/5 + 81/12)
        close(welch_df(2.0, 5.0, 3.0, 12.0), 169.0 / 9.95, 1e-14);
        close(welch_df(2e-200, 5.0, 3e-200, 12.0), 169.0 / 9.95, 1e-14);
        close(welch_df(3.0, 7.0, 4.0, INF), 625.0 / (81.0 / 7.0), 1e-14);
        assert_eq!(welch_df(0.3, 1.0, 0.0, INF), 1.0);
        assert_eq!(welch_df(0.0, 4.0, 0.3, 31.0), 31.0);
        assert_eq!(welch_df(1e-200, 4.0, 0.3, 31.0), 31.0);
        assert_eq!(welch_df(1.0, INF, 2.0, INF), INF);
        assert_eq!(welch_df(0.0, 4.0, 0.0, INF), 4.0);
        assert!(welch_df(f64::NAN, 4.0, 1.0, INF).is_nan());
    }
}
