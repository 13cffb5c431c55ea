//! Sample moments in one pass and constant memory.

use serde::{Deserialize, Serialize};

/// Sample size, mean and central power sums `m_k = Σ (x - mean)^k`, k = 2, 3, 4.
///
/// Updated and merged by the stable formulas of Pébay (2008, SAND2008-6212).
/// Values in the unit u give `mean` in u and `m_k` in u^k. A value that is not
/// finite poisons every field but `n`, so that it can not go unnoticed; above
/// about 1e77 the fourth power overflows, which poisons `m4`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Default)]
pub struct Moments {
    /// Number of values.
    pub n: u64,
    /// Arithmetic mean; 0 if there are no values.
    pub mean: f64,
    /// Sum of squared deviations from the mean, exactly 0 for identical values.
    pub m2: f64,
    /// Sum of cubed deviations from the mean.
    pub m3: f64,
    /// Sum of fourth powers of deviations from the mean.
    pub m4: f64,
}

impl Moments {
    /// Adds one value.
    #[inline]
    pub fn push(&mut self, x: f64) {
        let before = self.n as f64;
        self.n += 1;
        let n = before + 1.0;
        let delta = x - self.mean;
        // the only division
        let step = delta / n;
        let step2 = step * step;
        // in this order, a huge first value does not become infinity * 0
        let square = delta * (step * before);
        self.mean += step;
        self.m4 += square * step2 * (n * n - 3.0 * n + 3.0) + 6.0 * step2 * self.m2 - 4.0 * step * self.m3;
        self.m3 += square * step * (n - 2.0) - 3.0 * step * self.m2;
        self.m2 += square;
    }

    /// Adds all values that `other` has seen; an empty side changes no bit.
    pub fn merge(&mut self, other: &Moments) {
        if other.n == 0 {
            return;
        }
        if self.n == 0 {
            *self = *other;
            return;
        }
        let (a, b) = (self.n as f64, other.n as f64);
        let n = a + b;
        let delta = other.mean - self.mean;
        let (wa, wb) = (a / n, b / n);
        let square = delta * delta * a * wb;
        self.m4 += other.m4
            + square * delta * delta * (wa * wa - wa * wb + wb * wb)
            + 6.0 * delta * delta * (wa * wa * other.m2 + wb * wb * self.m2)
            + 4.0 * delta * (wa * other.m3 - wb * self.m3);
        self.m3 += other.m3 + square * delta * (wa - wb) + 3.0 * delta * (wa * other.m2 - wb * self.m2);
        self.m2 += other.m2 + square;
        self.mean += delta * wb;
        self.n += other.n;
    }

    /// Unbiased sample variance, unit u²; none below two values.
    pub fn variance(&self) -> Option<f64> {
        (self.n >= 2).then(|| self.m2 / (self.n - 1) as f64)
    }

    /// Standard error of the mean, unit u; none below two values.
    pub fn std_error(&self) -> Option<f64> {
        self.variance().map(|v| (v / self.n as f64).sqrt())
    }

    /// Skewness of the sample, `g1 = √n m3 / m2^(3/2)`, without unit; none if
    /// there is no variation.
    pub fn skewness(&self) -> Option<f64> {
        let varies = self.n >= 2 && self.m2 != 0.0;
        varies.then(|| (self.n as f64).sqrt() * self.m3 / (self.m2 * self.m2.sqrt()))
    }

    /// Standard error of [`variance`](Self::variance), unit u²; none below two
    /// values.
    ///
    /// `√((μ4 - s⁴ (n-3)/(n-1)) / n)` (Cramér 1946, 27.4) with the sample's own
    /// moments. It is itself unreliable, and as a rule too small, where rare
    /// large values have not yet been seen.
    pub fn variance_std_error(&self) -> Option<f64> {
        let n = self.n as f64;
        self.variance().map(|s2| {
            let squared = (self.m4 / n - s2 * s2 * (n - 3.0) / (n - 1.0)) / n;
            // mathematically never negative: a two-point law rounds below zero;
            // `f64::max` would hide a NaN
            if squared < 0.0 { 0.0 } else { squared.sqrt() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pushed(values: &[f64]) -> Moments {
        let mut moments = Moments::default();
        values.iter().for_each(|&x| moments.push(x));
        moments
    }

    /// Skewed, positive values from a linear congruential generator.
    fn values(count: usize, offset: f64) -> Vec<f64> {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| offset - next().ln_1p() + next().powi(4)).collect()
    }

    #[track_caller]
    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b} to {tolerance}");
    }

    #[track_caller]
    fn same(a: &Moments, b: &Moments, tolerance: f64) {
        assert_eq!(a.n, b.n);
        close(a.mean, b.mean, 1e-12);
        close(a.m2, b.m2, tolerance);
        close(a.m3, b.m3, tolerance);
        close(a.m4, b.m4, tolerance);
    }

    fn merged(values: &[f64], block: usize) -> Moments {
        values.chunks(block).fold(Moments::default(), |mut sum, part| {
            sum.merge(&pushed(part));
            sum
        })
    }

    #[test]
    fn merging_blocks_equals_pushing_all() {
        let all = values(100_000, 0.0);
        for block in [1, 2, 3, 7, 1000, 99_999] {
            same(&merged(&all, block), &pushed(&all), 1e-12);
        }
    }

    #[test]
    fn an_offset_costs_no_more_than_its_condition_number() {
        // 1e8 + x is rounded to 1.5e-8, so take the values as stored
        let all = values(100_000, 1e8);
        let centred: Vec<f64> = all.iter().map(|x| x - 1e8).collect();
        let truth = pushed(&centred);
        // machine epsilon * offset / standard deviation = 1e-7 is what one
        // difference x - mean can lose; the naive Σx² loses its square, all
        let condition = f64::EPSILON * 1e8 / truth.variance().unwrap().sqrt();
        for moments in [pushed(&all), merged(&all, 1), merged(&all, 64)] {
            close(moments.mean, 1e8 + truth.mean, 1e-12);
            close(moments.m2, truth.m2, condition);
            close(moments.m3, truth.m3, 3.0 * condition);
            close(moments.m4, truth.m4, 3.0 * condition);
        }
    }

    #[test]
    fn known_moments() {
        // numpy.var(ddof=1), scipy.stats.sem, skew, and the formula in numpy
        let moments = pushed(&[1.0, 2.0, 4.0, 8.0, 16.0, 0.5, 3.25]);
        close(moments.mean, 4.964285714285714, 1e-14);
        close(moments.variance().unwrap(), 29.88392857142857, 1e-14);
        close(moments.std_error().unwrap(), 2.0661879520172466, 1e-14);
        close(moments.skewness().unwrap(), 1.3099289849281504, 1e-14);
        close(moments.variance_std_error().unwrap(), 15.306610850241519, 1e-14);
    }

    #[test]
    fn identical_values_have_exactly_no_variance() {
        for x in [0.1, 1.0 / 3.0, 1e200, -7e-30, 0.0] {
            let mut sum = pushed(&[x; 1000]);
            (1..100).for_each(|n| sum.merge(&pushed(&vec![x; n])));
            assert_eq!((sum.mean, sum.m2), (x, 0.0));
            assert_eq!(sum.variance(), Some(0.0));
            assert_eq!(sum.skewness(), None);
        }
    }

    #[test]
    fn empty_is_the_identity_and_too_few_values_have_no_variance() {
        let empty = Moments::default();
        // the square of the last would overflow
        for some in [pushed(&[0.1, 0.7, 0.3]), Moments { n: 1, mean: 1e200, ..empty }] {
            let (mut left, mut right) = (empty, some);
            left.merge(&some);
            right.merge(&empty);
            assert_eq!((left, right), (some, some));
        }
        for few in [empty, pushed(&[2.0])] {
            assert_eq!(few.variance().or(few.std_error()), None);
            assert_eq!(few.skewness().or(few.variance_std_error()), None);
        }
    }

    #[test]
    fn what_is_not_finite_poisons() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for order in [[bad, 1.0, 2.0, 3.0], [1.0, 2.0, bad, 3.0]] {
                let moments = pushed(&order);
                assert!(!moments.mean.is_finite() && !moments.variance().unwrap().is_finite());
                assert!(!moments.variance_std_error().unwrap().is_finite());
                let mut sum = pushed(&[1.0, 5.0]);
                sum.merge(&moments);
                assert!(!sum.std_error().unwrap().is_finite());
                assert!(!sum.skewness().unwrap().is_finite());
            }
        }
    }

    #[test]
    fn rounding_can_not_make_the_error_of_the_variance_imaginary() {
        let coin = Moments { n: 1 << 40, mean: 0.0, m2: 1e12, m3: 0.0, m4: 0.909e12 };
        assert_eq!(coin.variance_std_error(), Some(0.0));
    }
}
