//! Rough surfaces as heaps of tiny mirrors, whose normals m follow the GGX distribution [Trowbridge & Reitz 1975; Walter
//! et al. 2007]: the same at all azimuths, masked and shadowed after Smith, each on its own ("separable").
//!
//! Written with the projected area σ of the facets that face a direction, hidden ones included: the share of them that is
//! seen is Smith's G1 = cos θ / σ [Heitz 2014, eqs. 14 and 36], so that no quotient 0/0 is left at grazing angles.
//! Light that meets a second facet is lost; no term makes up for it.

use crate::sampling::PdfW;
use crate::sampling::warp::{Frame, sin_cos_turn};
use glam::DVec3;
use std::f64::consts::PI;

/// Density D of facet normals [1/sr], per solid angle of `m` and area of the surface [Walter et al. 2007, eq. 33];
/// `alpha` in (0, 1] is the roughness. Zero where a facet's normal `m` points below the surface of normal `n`.
#[inline]
pub fn density(alpha: f64, n: DVec3, m: DVec3) -> f64 {
    let cos = n.dot(m);
    if cos <= 0.0 {
        return 0.0;
    }
    let squared = alpha * alpha;
    // 1 - cos² would be lost to rounding on smooth surfaces, where the sine matters most
    let spread = n.cross(m).length_squared() + squared * cos * cos;
    squared / (PI * spread * spread)
}

/// σ, the projected area of the facets that face a direction at `cos` = cos θ > 0 to the normal, for a unit of surface:
/// cos θ / G1, from cos θ (nothing hides anything) up [Walter et al. 2007, eq. 34].
#[inline]
pub fn facing(alpha: f64, cos: f64) -> f64 {
    let sin2 = (1.0 - cos * cos).max(0.0);
    0.5 * (cos + (cos * cos + alpha * alpha * sin2).sqrt())
}

/// Smith's share G1 in (0, 1] of the facets facing a direction that are seen from there; `cos` > 0.
#[inline]
pub fn seen(alpha: f64, cos: f64) -> f64 {
    cos / facing(alpha, cos)
}

/// What a heap of perfect mirrors reflects from `wi` to `wo`, D G / (4 cos θ_o cos θ_i) [1/sr], reciprocal to the last bit
/// [Walter et al. 2007, eq. 20]; zero unless both leave the front.
#[inline]
pub fn f(alpha: f64, n: DVec3, wo: DVec3, wi: DVec3) -> f64 {
    let (cos_o, cos_i) = (n.dot(wo), n.dot(wi));
    if cos_o <= 0.0 || cos_i <= 0.0 {
        return 0.0;
    }
    let m = (wo + wi).normalize();
    density(alpha, n, m) / (4.0 * (facing(alpha, cos_o) * facing(alpha, cos_i)))
}

/// Density [1/sr] of the direction that a facet of normal `m`, drawn by [`visible_normal`], mirrors `wo` to:
/// G1 D (wo·m) / cos θ_o of the facet [Heitz 2014, eq. 3], over the 4 (wo·m) by which mirroring spreads directions
/// [Walter et al. 2007, eq. 14]; `cos_o` = n·wo > 0.
#[inline]
pub fn reflected_pdf(alpha: f64, n: DVec3, m: DVec3, cos_o: f64) -> PdfW {
    PdfW(density(alpha, n, m) / (4.0 * facing(alpha, cos_o)))
}

/// The normal of a facet as it is seen from `wo` (n·wo > 0): density G1 D (wo·m) / cos θ_o.
///
/// On the stretched surface, whose facets are those of a hemisphere, `wo` plus a direction uniform over the cap of the
/// sphere above -cos θ_o is the normal up to its length [Dupuy & Benyoub 2023, listing 3].
#[inline]
pub fn visible_normal(alpha: f64, frame: &Frame, wo: DVec3, u: (f64, f64)) -> DVec3 {
    let n = frame.n;
    let cos = n.dot(wo);
    let along = (wo - n * cos) * alpha;
    let length = (along.length_squared() + cos * cos).sqrt();
    let (along, cos) = (along / length, cos / length);
    let above = (1.0 - u.0) * (1.0 + cos);
    let z = above - cos;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin_turn, cos_turn) = sin_cos_turn(u.1);
    let across = frame.to_world(DVec3::new(r * cos_turn, r * sin_turn, 0.0)) + along;
    (across * alpha + n * above).normalize()
}
