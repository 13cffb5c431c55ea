//! Exact intervals of a detection rate.
//!
//! The inverse of the incomplete beta function in `statrs` (0.19.1) stops after 140
//! terms of a series that needs about √n, so both are written out here.

/// Interval that contains the rate of `k` hits in `n` trials with probability
/// `confidence` at least, whatever the rate (Clopper & Pearson 1934): each limit
/// errs with probability `(1 - confidence) / 2` at most.
///
/// Relative error below 1e-9 up to n = 10^6, and 1e-6 up to 10^9. No trials say
/// nothing, (0, 1); NaN if k > n or `confidence` is not between 0 and 1.
pub fn clopper_pearson(k: u64, n: u64, confidence: f64) -> (f64, f64) {
    if k > n || !(confidence > 0.0 && confidence < 1.0) {
        return (f64::NAN, f64::NAN);
    }
    let side = (1.0 - confidence) / 2.0;
    let (hits, misses) = (k as f64, (n - k) as f64);
    // P(at least k) = side, and P(at most k) = side
    let low = if k == 0 { 0.0 } else { smallest(|x| beta_tails(hits, misses + 1.0, x).0 >= side) };
    let high = if k == n { 1.0 } else { smallest(|x| beta_tails(hits + 1.0, misses, x).1 <= side) };
    (low, high)
}

/// The smallest number in 0..=1 for which a monotone condition holds, by bisection
/// on the bits: as many digits for 1e-300 as for 1/2.
fn smallest(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut fails, mut works) = (0_u64, 1_f64.to_bits());
    while works - fails > 1 {
        let middle = fails + (works - fails) / 2;
        if holds(f64::from_bits(middle)) {
            works = middle;
        } else {
            fails = middle;
        }
    }
    f64::from_bits(works)
}

/// P(X <= x) and P(X > x) of the beta distribution with `a`, `b` > 0, 0 < x <= 1;
/// the smaller of the two with full relative precision.
fn beta_tails(a: f64, b: f64, x: f64) -> (f64, f64) {
    let (ln_x, ln_rest) = (libm::log(x), libm::log1p(-x));
    let ln_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let front = libm::exp(a * ln_x + b * ln_rest - ln_beta);
    if x < (a + 1.0) / (a + b + 2.0) {
        let lower = front / (a * fraction(a, b, x));
        (lower, 1.0 - lower)
    } else {
        let upper = front / (b * fraction(b, a, 1.0 - x));
        (1.0 - upper, upper)
    }
}

/// The continued fraction of the incomplete beta function (Abramowitz & Stegun
/// 1964, 26.5.8), by the method of Lentz (1976); about √max(a, b) terms.
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let away = |y: f64| if y.abs() < TINY { TINY } else { y };
    let (mut value, mut c, mut d) = (1.0, 1.0, 0.0);
    for term in 1..1_000_000_u64 {
        let m = (term / 2) as f64;
        let step = if term % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        d = 1.0 / away(1.0 + step * d);
        c = away(1.0 + step / c);
        value *= c * d;
        // an even step can be small long before the end
        if term % 2 == 1 && term > 1 && (c * d - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// k, n, confidence, and the limits by scipy.stats.beta of SciPy 1.17.1; those of
    /// 999 hits by bisection of binom.cdf, as its beta.isf is 0.3 % too small there.
    const SCIPY: [(u64, u64, f64, f64, f64); 9] = [
        (0, 10, 0.95, 0.0, 0.3084971078187607),
        (10, 10, 0.95, 0.6915028921812392, 1.0),
        (3, 10, 0.95, 0.0667395111777345, 0.6524528500599973),
        (37, 40, 0.999, 0.6959332157928699, 0.996167927835746),
        (1, 1_000_000, 0.99, 5.012541810981499e-9, 7.430105611978525e-6),
        (500_000, 1_000_000, 0.999, 0.498354241502883, 0.501645758497117),
        (5, 64, 0.9, 0.03128767967271283, 0.15727012750712221),
        (999, 1_000_000_000, 0.95, 9.380040466999966e-7, 1.0629211172533082e-6),
        (300_000_000, 1_000_000_000, 0.95, 0.2999715975023966, 0.30002840365535277),
    ];

    #[test]
    fn limits_are_those_of_scipy() {
        for (k, n, confidence, low, high) in SCIPY {
            let tolerance = if n > 1_000_000 { 1e-6 } else { 1e-9 };
            let (a, b) = clopper_pearson(k, n, confidence);
            assert!((a - low).abs() <= tolerance * low, "{k} of {n}: {a:e}, not {low:e}");
            assert!((b - high).abs() <= tolerance * high, "{k} of {n}: {b:e}, not {high:e}");
        }
    }

    #[test]
    fn hits_and_misses_are_alike() {
        for (k, n) in [(0, 1), (2, 7), (40, 40), (999, 5000)] {
            let (low, high) = clopper_pearson(k, n, 0.99);
            let (other_low, other_high) = clopper_pearson(n - k, n, 0.99);
            assert!((low + other_high - 1.0).abs() < 1e-12 && (high + other_low - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn it_covers_any_rate() {
        use statrs::distribution::{Binomial, Discrete};
        for rate in [0.001, 0.03, 0.3, 0.5, 0.99] {
            let law = Binomial::new(rate, 50).unwrap();
            let covers = |k: &u64| {
                let (low, high) = clopper_pearson(*k, 50, 0.9);
                low <= rate && rate <= high
            };
            let covered: f64 = (0..=50).filter(covers).map(|k| law.pmf(k)).sum();
            assert!(covered >= 0.9, "{covered} at {rate}");
        }
    }

    #[test]
    fn nonsense_and_nothing() {
        assert_eq!(clopper_pearson(0, 0, 0.95), (0.0, 1.0));
        for (k, n, confidence) in [(2, 1, 0.9), (1, 2, 0.0), (1, 2, 1.0), (1, 2, f64::NAN)] {
            assert!(clopper_pearson(k, n, confidence).0.is_nan());
        }
    }
}
