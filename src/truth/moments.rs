//! Mean and central moments to the fourth order of sums, mixtures and products of independent variables, some of them
//! infinite. Central throughout: raw moments would cancel where a variance is small against the squared mean.

/// Moments of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Central {
    /// E X.
    pub mean: f64,
    /// E (X - E X)^n for n = 2, 3, 4, up to `finite`; later entries have no meaning.
    pub central: [f64; 3],
    /// The highest order whose moment is finite.
    pub finite: usize,
}

/// x to the n-th by repeated multiplication: the same bits everywhere, which `powi` does not promise.
pub fn power(x: f64, n: u32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

/// What a sum of probabilities lacks to 1 is rounding if it is less than this.
pub const LOST: f64 = 1e-12;

/// Variances below this fraction of the squared mean are rounding: mixtures of equal constants do not come out at zero.
const ROUNDING: f64 = 1e-26;

impl Central {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Central { mean: value, central: [0.0; 3], finite: 4 }
    }

    /// A variable whose moments are all finite.
    pub fn new(mean: f64, central: [f64; 3]) -> Self {
        Central { mean, central, finite: 4 }
    }

    /// The moments of `factor` X.
    pub fn scaled(self, factor: f64) -> Self {
        let [m2, m3, m4] = self.central;
        let square = factor * factor;
        let central = [m2 * square, m3 * square * factor, m4 * square * square];
        Central { mean: self.mean * factor, central, ..self }
    }

    /// The moment of an order from 1 (the mean) to 4, whether finite or not.
    pub fn get(&self, order: usize) -> f64 {
        if order == 1 { self.mean } else { self.central[order - 2] }
    }

    /// The same with one moment replaced.
    pub fn with(mut self, order: usize, value: f64) -> Self {
        if order == 1 {
            self.mean = value;
        } else {
            self.central[order - 2] = value;
        }
        self
    }

    /// The same with all moments from `order` on infinite.
    pub fn finite_below(self, order: usize) -> Self {
        Central { finite: self.finite.min(order - 1), ..self }
    }

    /// The sum with an independent variable.
    pub fn plus(&self, other: &Central) -> Self {
        let ([a2, a3, a4], [b2, b3, b4]) = (self.central, other.central);
        Central {
            mean: self.mean + other.mean,
            central: [a2 + b2, a3 + b3, a4 + 6.0 * a2 * b2 + b4],
            finite: self.finite.min(other.finite),
        }
    }

    /// The product with an independent variable. With U = u + E and X = m + D, UX - um = uD + mE + DE, whose powers are
    /// polynomials in the independent deviations D and E.
    pub fn times(&self, other: &Central) -> Self {
        let (x, u) = (self, other);
        let deviation = |v: &Central, order: usize| match order {
            0 => 1.0,
            1 => 0.0,
            n => v.central[n - 2],
        };
        // coefficients of D^i E^j
        let mut powers = [[0.0; 5]; 5];
        powers[0][0] = 1.0;
        let mut central = [0.0; 3];
        for order in 1..=4 {
            let mut next = [[0.0; 5]; 5];
            for i in 0..4 {
                for j in 0..4 {
                    next[i + 1][j] += u.mean * powers[i][j];
                    next[i][j + 1] += x.mean * powers[i][j];
                    next[i + 1][j + 1] += powers[i][j];
                }
            }
            powers = next;
            if order >= 2 {
                let pairs = (0..5).flat_map(|i| (0..5).map(move |j| (i, j)));
                central[order - 2] =
                    pairs.map(|(i, j)| powers[i][j] * deviation(x, i) * deviation(u, j)).sum();
            }
        }
        Central { mean: x.mean * u.mean, central, finite: x.finite.min(u.finite) }
    }

    /// One of several variables, each chosen with its probability; zero with what these lack to 1.
    pub fn mixture(parts: impl Iterator<Item = (f64, Central)> + Clone) -> Self {
        let left: f64 = parts.clone().fold(1.0, |left, (p, _)| left - p);
        let zero = (left > LOST).then_some((left, Central::constant(0.0)));
        let parts = parts.filter(|(p, _)| *p > 0.0).chain(zero);
        let mean = parts.clone().map(|(p, part)| p * part.mean).sum();
        let mut mixed = Central::constant(mean);
        for (p, part) in parts {
            let d = part.mean - mean;
            let [m2, m3, m4] = part.central;
            mixed.finite = mixed.finite.min(part.finite);
            mixed.central[0] += p * (m2 + d * d);
            mixed.central[1] += p * (m3 + 3.0 * d * m2 + d * d * d);
            mixed.central[2] += p * (m4 + 4.0 * d * m3 + 6.0 * d * d * m2 + d * d * d * d);
        }
        mixed
    }

    /// The central moment of order 2, 3 or 4; `None` where infinite, exactly zero where nothing varies.
    pub fn finite_moment(&self, order: usize) -> Option<f64> {
        let varies = self.central[0] > ROUNDING * self.mean * self.mean;
        (order <= self.finite).then(|| if varies { self.get(order) } else { 0.0 })
    }
}

/// Moments of the sum of `count` independent copies.
pub fn fixed_sum(count: u32, x: &Central) -> Central {
    let m = f64::from(count);
    let [m2, m3, m4] = x.central;
    let central = [m * m2, m * m3, m * m4 + 3.0 * m * (m - 1.0) * m2 * m2];
    Central { mean: m * x.mean, central, finite: x.finite }
}

/// Moments of the sum of floor(q + u) independent copies, u uniform: roulette and splitting.
pub fn random_sum(q: f64, x: &Central) -> Central {
    let (whole, part) = (q.floor(), q - q.floor());
    let (fewer, more) = (fixed_sum(whole as u32, x), fixed_sum(whole as u32 + 1, x));
    if part == 0.0 { fewer } else { Central::mixture([(1.0 - part, fewer), (part, more)].into_iter()) }
}
