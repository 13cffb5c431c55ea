//! What the checks need and the library does not provide: a generator, a quadrature, and Fresnel's equations
//! in angles.
#![allow(dead_code)]

/// Steele, Lea & Flood 2014.
pub struct SplitMix(pub u64);

impl SplitMix {
    /// Uniform on (0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 2f64.powi(-53) + 2f64.powi(-54)
    }

    /// Uniform between two ends.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }
}

/// Adaptive Simpson rule; `tolerance` is absolute.
pub fn integrate(low: f64, high: f64, tolerance: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    let middle = 0.5 * (low + high);
    let values = [f(low), f(middle), f(high)];
    refine(low, high, values, tolerance, 40, f)
}

fn refine(low: f64, high: f64, v: [f64; 3], tolerance: f64, depth: u32, f: &dyn Fn(f64) -> f64) -> f64 {
    let width = high - low;
    let (left, right) = (f(low + 0.25 * width), f(low + 0.75 * width));
    let coarse = width / 6.0 * (v[0] + 4.0 * v[1] + v[2]);
    let fine = width / 12.0 * (v[0] + 4.0 * left + 2.0 * v[1] + 4.0 * right + v[2]);
    if depth == 0 || (depth < 36 && (fine - coarse).abs() < 15.0 * tolerance) {
        return fine + (fine - coarse) / 15.0;
    }
    let middle = low + 0.5 * width;
    refine(low, middle, [v[0], left, v[1]], 0.5 * tolerance, depth - 1, f)
        + refine(middle, high, [v[1], right, v[2]], 0.5 * tolerance, depth - 1, f)
}

/// Fresnel's equations in their form with sines and tangents of sum and difference of the angles.
pub fn fresnel_in_angles(cos: f64, n: f64) -> f64 {
    let incident = cos.min(1.0).acos();
    if incident.sin() >= n {
        return 1.0;
    }
    if incident < 1e-7 {
        return ((n - 1.0) / (n + 1.0)).powi(2);
    }
    let refracted = (incident.sin() / n).asin();
    let (difference, sum) = (incident - refracted, incident + refracted);
    0.5 * ((difference.sin() / sum.sin()).powi(2) + (difference.tan() / sum.tan()).powi(2))
}

/// Mean, its standard error, and second moment with its standard error.
pub struct Sampled {
    pub mean: f64,
    pub error: f64,
    pub square: f64,
    pub square_error: f64,
}

impl Sampled {
    pub fn variance(&self) -> f64 {
        self.square - self.mean * self.mean
    }
}

/// Samples a variable `count` times.
pub fn simulate(seed: u64, count: usize, mut sample: impl FnMut(&mut SplitMix) -> f64) -> Sampled {
    let mut random = SplitMix(seed);
    let mut sums = [0.0; 3];
    for _ in 0..count {
        let x = sample(&mut random);
        let square = x * x;
        sums[0] += x;
        sums[1] += square;
        sums[2] += square * square;
    }
    let [mean, square, fourth] = sums.map(|sum| sum / count as f64);
    let error = |variance: f64| (variance.max(0.0) / count as f64).sqrt();
    Sampled {
        mean,
        error: error(square - mean * mean),
        square,
        square_error: error(fourth - square * square),
    }
}

/// Five standard errors may not exceed 1.5 %, so that an error of 1 % is seen with some certainty; four is
/// the limit.
#[track_caller]
pub fn sees(sampled: f64, error: f64, expected: f64) {
    assert!(error * 5.0 <= 0.015 * expected.abs(), "too few samples: {error} of {expected}");
    assert!((sampled - expected).abs() <= 4.0 * error + 1e-13, "{sampled} ± {error}, not {expected}");
}

#[track_caller]
pub fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value}, not {expected}");
}
