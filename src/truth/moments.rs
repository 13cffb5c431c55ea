//! Raw moments E X^n, n = 0..4, of sums and products of independent variables, some of them infinite.

/// Raw moments of a nonnegative variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RawMoments {
    /// E X^n for n = 0..=`finite`; later entries have no meaning.
    pub raw: [f64; 5],
    /// The highest order whose moment is finite.
    pub finite: usize,
}

const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// x to the n-th by repeated multiplication: the same bits everywhere, which `powi` does not promise.
pub fn power(x: f64, n: u32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

impl RawMoments {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        RawMoments { raw: [0, 1, 2, 3, 4].map(|n| power(value, n)), finite: 4 }
    }

    /// The moments of `factor` X.
    pub fn scaled(self, factor: f64) -> Self {
        self.weighted(|order| power(factor, order))
    }

    /// Each moment times a number that depends on its order: the product with an independent variable.
    pub fn weighted(mut self, factor: impl Fn(u32) -> f64) -> Self {
        for (order, moment) in self.raw.iter_mut().enumerate() {
            *moment *= factor(order as u32);
        }
        self
    }

    /// The same with one moment replaced.
    pub fn with(mut self, order: usize, value: f64) -> Self {
        self.raw[order] = value;
        self
    }

    /// The same with all moments from `order` on infinite.
    pub fn finite_below(self, order: usize) -> Self {
        RawMoments { finite: order - 1, ..self }
    }

    /// The sum with an independent variable.
    pub fn plus(&self, other: &RawMoments) -> Self {
        let sum = |n: usize| (0..=n).map(|i| BINOMIAL[n][i] * self.raw[n - i] * other.raw[i]).sum();
        RawMoments { raw: [0, 1, 2, 3, 4].map(sum), finite: self.finite.min(other.finite) }
    }

    /// One of several variables, each chosen with its probability.
    pub fn mixture(parts: impl Iterator<Item = (f64, RawMoments)>) -> Self {
        let mut mixed = RawMoments { raw: [0.0; 5], finite: 4 };
        for (probability, part) in parts {
            mixed.finite = mixed.finite.min(part.finite);
            for (sum, moment) in mixed.raw.iter_mut().zip(part.raw) {
                *sum += probability * moment;
            }
        }
        mixed
    }

    /// E X.
    pub fn mean(&self) -> f64 {
        self.raw[1]
    }

    /// E (X - E X)^n for n = 2, 3, 4; `None` where infinite.
    /// Differences below what rounding of the raw moments can resolve are zero.
    pub fn central(&self, order: usize) -> Option<f64> {
        if order > self.finite {
            return None;
        }
        let m = self.mean();
        let term = |i: usize| BINOMIAL[order][i] * self.raw[i] * power(-m, (order - i) as u32);
        let sum: f64 = (0..=order).map(term).sum();
        let rounding = 1e-13 * (0..=order).map(|i| term(i).abs()).sum::<f64>();
        Some(if sum.abs() <= rounding { 0.0 } else { sum })
    }
}

/// Moments of the sum of `count` independent copies.
pub fn fixed_sum(count: u32, x: &RawMoments) -> RawMoments {
    let (m, y) = (f64::from(count), &x.raw);
    let (m2, m3, m4) = (m * (m - 1.0), m * (m - 1.0) * (m - 2.0), m * (m - 1.0) * (m - 2.0) * (m - 3.0));
    RawMoments {
        raw: [
            1.0,
            m * y[1],
            m * y[2] + m2 * y[1] * y[1],
            m * y[3] + 3.0 * m2 * y[2] * y[1] + m3 * power(y[1], 3),
            m * y[4]
                + m2 * (4.0 * y[3] * y[1] + 3.0 * y[2] * y[2])
                + 6.0 * m3 * y[2] * y[1] * y[1]
                + m4 * power(y[1], 4),
        ],
        finite: x.finite,
    }
}

/// Moments of the sum of floor(q + u) independent copies, u uniform: roulette and splitting.
pub fn random_sum(q: f64, x: &RawMoments) -> RawMoments {
    let (whole, part) = (q.floor(), q - q.floor());
    let (fewer, more) = (fixed_sum(whole as u32, x), fixed_sum(whole as u32 + 1, x));
    RawMoments::mixture([(1.0 - part, fewer), (part, more)].into_iter())
}
