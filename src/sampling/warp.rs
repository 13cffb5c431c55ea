//! Maps from the unit square to directions and points, each beside its density.

use super::PdfW;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// (sin 2πu, cos 2πu) for u in [0, 1], with the same bits on every machine.
///
/// The angle is reduced to [-π/4, π/4] by quarter turns and the two Taylor series are summed to degree 15 and 16;
/// absolute error below 4e-16 (tested against `libm`; the worst found in 2e8 arguments is 3.05e-16).
#[inline]
pub fn sin_cos_turn(u: f64) -> (f64, f64) {
    let quarter = (4.0 * u + 0.5) as i64; // u >= 0: the cast rounds down, and needs no call to `floor`
    let x = (u - 0.25 * quarter as f64) * (2.0 * PI);
    let z = x * x;
    let (z2, z4) = (z * z, (z * z) * (z * z));
    let sin = x * polynomial(z, z2, z4, &SIN);
    let cos = polynomial(z, z2, z4, &COS) + z4 * z4 * (1.0 / 20_922_789_888_000.0);
    let (s, c) = if quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let sign_s = if quarter & 2 == 0 { 1.0 } else { -1.0 };
    let sign_c = if (quarter + 1) & 2 == 0 { 1.0 } else { -1.0 };
    (sign_s * s, sign_c * c)
}

/// (-1)^k / (2k+1)!
const SIN: [f64; 8] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];

/// (-1)^k / (2k)!
const COS: [f64; 8] = [
    1.0,
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
];

/// Estrin's scheme, whose terms do not wait for each other; no fused multiply-add, which some targets lack.
#[inline]
fn polynomial(z: f64, z2: f64, z4: f64, c: &[f64; 8]) -> f64 {
    let low = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2;
    let high = (c[4] + c[5] * z) + (c[6] + c[7] * z) * z2;
    low + high * z4
}

/// A direction of the upper hemisphere (z up) with density cos θ / π.
#[inline]
pub fn cosine_hemisphere((u, v): (f64, f64)) -> DVec3 {
    let r = u.sqrt();
    let (sin, cos) = sin_cos_turn(v);
    DVec3::new(r * cos, r * sin, (1.0 - u).sqrt())
}

/// Density of [`cosine_hemisphere`]; `cos` = cos θ in [0, 1].
#[inline]
pub fn cosine_hemisphere_pdf(cos: f64) -> PdfW {
    PdfW(cos * FRAC_1_PI)
}

/// A direction of the upper hemisphere (z up) with density 1 / 2π.
#[inline]
pub fn uniform_hemisphere((u, v): (f64, f64)) -> DVec3 {
    let z = 1.0 - u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turn(v);
    DVec3::new(r * cos, r * sin, z)
}

/// Density of [`uniform_hemisphere`].
#[inline]
pub fn uniform_hemisphere_pdf() -> PdfW {
    PdfW(0.5 * FRAC_1_PI)
}

/// A point of the unit disk, uniform over its area (density 1/π).
#[inline]
pub fn disk((u, v): (f64, f64)) -> (f64, f64) {
    let r = u.sqrt();
    let (sin, cos) = sin_cos_turn(v);
    (r * cos, r * sin)
}

/// Barycentric coordinates (b, c) of a point uniform over a triangle's area (density 2 in these coordinates).
#[inline]
pub fn triangle((u, v): (f64, f64)) -> (f64, f64) {
    let root = u.sqrt();
    (root * (1.0 - v), root * v)
}

/// A unit vector whose z lies in [low, high], uniform over that band's area (density 1 / 2π(high - low)):
/// equal heights of a sphere have equal areas (Archimedes).
#[inline]
pub fn sphere_band(low: f64, high: f64, (u, v): (f64, f64)) -> DVec3 {
    let z = low + (high - low) * u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turn(v);
    DVec3::new(r * cos, r * sin, z)
}

/// An orthonormal frame around a unit vector [Duff et al. 2017, JCGT 6(1), listing 3].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    s: DVec3,
    t: DVec3,
    /// The vector that the frame was built around.
    pub n: DVec3,
}

impl Frame {
    /// The frame whose third axis is `n` (unit).
    #[inline]
    pub fn around(n: DVec3) -> Self {
        let sign = 1f64.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Frame {
            s: DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: DVec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// A vector given in this frame, in world coordinates.
    #[inline]
    pub fn to_world(&self, local: DVec3) -> DVec3 {
        self.s * local.x + self.t * local.y + self.n * local.z
    }
}
