//! What the checks need and the library does not provide: random points, a quadrature, kernels in full, and limits.

use furnace::truth::density::Kernel;
use rand::Rng;
use rand_pcg::Pcg64Mcg;

pub const KERNELS: [Kernel; 4] =
    [Kernel::Box, Kernel::Cone { c: 1.0 }, Kernel::Cone { c: 1.7 }, Kernel::Epanechnikov];

/// The kernel on the unit disc, by its definition and with unit integral.
pub fn weight(kernel: Kernel, s: f64) -> f64 {
    use std::f64::consts::PI;
    if s > 1.0 {
        return 0.0;
    }
    match kernel {
        Kernel::Box => 1.0 / PI,
        Kernel::Cone { c } => (1.0 - s / c) / (PI - PI / c * 2.0 / 3.0),
        Kernel::Epanechnikov => 2.0 / PI * (1.0 - s * s),
    }
}

/// Random numbers and points.
pub struct Random(Pcg64Mcg);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(Pcg64Mcg::new(u128::from(seed) << 64 | 0xda3e_39cb_94b9_5bdb))
    }

    /// Uniform on (0, 1).
    pub fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) * 2f64.powi(-53)
    }

    /// Exponentially distributed with mean 1.
    pub fn exponential(&mut self) -> f64 {
        -self.uniform().ln()
    }

    /// Uniform on the unit sphere, by rejection from the cube.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [(); 3].map(|()| 2.0 * self.uniform() - 1.0);
            let square = dot(v, v);
            if square <= 1.0 && square > 1e-6 {
                return v.map(|x| x / square.sqrt());
            }
        }
    }

    /// Where a cosine-distributed photon that leaves a point of the unit sphere's inside hits it next.
    pub fn next_hit(&mut self, p: [f64; 3]) -> [f64; 3] {
        let u = self.direction();
        let w = [u[0] - p[0], u[1] - p[1], u[2] - p[2]];
        let way = -2.0 * dot(p, w) / dot(w, w);
        let hit = [p[0] + way * w[0], p[1] + way * w[1], p[2] + way * w[2]];
        let length = dot(hit, hit).sqrt();
        hit.map(|x| x / length)
    }
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dot(d, d).sqrt()
}

/// Tanh-sinh quadrature [Takahasi & Mori 1974]: good to about 1e-13 for functions that are analytic within the interval.
pub fn integrate(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let at = |i: i32| {
        let t = f64::from(i) / 16.0;
        let u = std::f64::consts::FRAC_PI_2 * t.sinh();
        let weight = std::f64::consts::FRAC_PI_2 * t.cosh() / u.cosh().powi(2);
        weight * f(middle + half * u.tanh())
    };
    half / 16.0 * (-56..=56).map(at).sum::<f64>()
}

/// Integral of f(x, y) over the part of the unit disc with x up to `right`; f may have a kink in the centre.
pub fn over_disc(right: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    let column = |x: f64| {
        let high = (1.0 - x * x).max(0.0).sqrt();
        integrate(-high, 0.0, |y| f(x, y)) + integrate(0.0, high, |y| f(x, y))
    };
    integrate(-1.0, right.min(0.0), column) + if right > 0.0 { integrate(0.0, right, column) } else { 0.0 }
}

/// Checks the mean of samples, which must be precise enough to see a relative deviation of `notices`.
#[track_caller]
pub fn has_mean(samples: &[f64], expected: f64, notices: f64) {
    let (mean, variance, _) = moments(samples);
    agrees(mean, (variance / samples.len() as f64).sqrt(), expected, notices);
}

/// The same of their variance.
#[track_caller]
pub fn has_variance(samples: &[f64], expected: f64, notices: f64) {
    let (_, variance, fourth) = moments(samples);
    let error = ((fourth - variance * variance) / samples.len() as f64).sqrt();
    agrees(variance, error, expected, notices);
}

/// Mean, variance and fourth central moment.
fn moments(samples: &[f64]) -> (f64, f64, f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let central = |n: i32| samples.iter().map(|x| (x - mean).powi(n)).sum::<f64>() / count;
    (mean, central(2), central(4))
}

#[track_caller]
pub fn agrees(sampled: f64, error: f64, expected: f64, notices: f64) {
    let limit = notices * expected.abs();
    assert!(6.0 * error <= limit, "too few samples: {sampled} ± {error} to see {limit}");
    assert!((sampled - expected).abs() <= 5.5 * error, "{sampled} ± {error}, not {expected}");
}

#[track_caller]
pub fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value}, not {expected}");
}
