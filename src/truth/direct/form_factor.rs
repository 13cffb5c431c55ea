//! Form factors from a point: the fraction F of the cosine-weighted hemisphere over a surface element that a light
//! covers. A light of uniform radiance Le gives irradiance π Le F and, on a Lambert surface, radiance albedo · Le · F.
//!
//! All are dimensionless, in [0, 1], and take one unit of length throughout. Errors are a few 1e-16 absolute, of
//! spheres and disks also relative; of polygons up to 1e-12 within a millionth of their size from an edge.

use super::convex::{Halfspace, vector_area};
use glam::DVec3;
use std::f64::consts::PI;

/// A point nearer to a plane than this fraction of the lengths involved lies in it.
pub(super) const TOUCH: f64 = 1e-12;

/// A planar simple polygon over the element at `p` with unit normal `n` (Lambert, Photometria, 1760).
///
/// It shines to the side from which its corners run counter-clockwise: 0 if `p` is behind it or in its plane.
pub fn polygon(p: DVec3, n: DVec3, corners: &[DVec3]) -> f64 {
    let seen = above_horizon(p, n, corners);
    lambert(n, &seen).clamp(0.0, 1.0)
}

/// The part of a one-sided polygon above the horizon, relative to `p`; empty if `p` is not in front of it.
pub(super) fn above_horizon(p: DVec3, n: DVec3, corners: &[DVec3]) -> Vec<DVec3> {
    let seen: Vec<DVec3> = corners.iter().map(|&corner| corner - p).collect();
    let front = vector_area(&seen);
    let size = seen.iter().map(|corner| corner.length()).fold(0.0, f64::max);
    if seen.is_empty() || -front.dot(seen[0]) <= TOUCH * size * front.length() {
        return Vec::new();
    }
    Halfspace::through(DVec3::ZERO, n).clip(&seen)
}

/// Lambert's sum over the edges of a polygon above the horizon, seen from the origin: each edge gives the angle it
/// subtends times the cosine of its plane. Positive where corners run counter-clockwise as seen from the origin.
pub(super) fn lambert(n: DVec3, corners: &[DVec3]) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let sum: f64 = edges
        .map(|(&a, &b)| {
            let normal = b.cross(a);
            let sine = normal.length();
            // an edge that points at the origin subtends nothing
            if sine == 0.0 { 0.0 } else { libm::atan2(sine, a.dot(b)) * n.dot(normal) / sine }
        })
        .sum();
    sum / (2.0 * PI)
}

/// A sphere anywhere: above the horizon, cut by it, or below it; 1 if `p` is inside (Snyder 1969; Howell, A Catalog
/// of Radiation Heat Transfer Configuration Factors, B-43).
pub fn sphere(p: DVec3, n: DVec3, centre: DVec3, radius: f64) -> f64 {
    let to_centre = centre - p;
    let distance = to_centre.length();
    if distance < radius {
        return 1.0;
    }
    let direction = to_centre / distance;
    let (cosine, sine) = (n.dot(direction), n.cross(direction).length());
    let sin_sigma = radius / distance;
    if cosine >= sin_sigma {
        return cosine * sin_sigma * sin_sigma;
    }
    if cosine <= -sin_sigma {
        return 0.0;
    }
    let x = ((distance - radius) * (distance + radius)).sqrt() / radius;
    let y = (-x * cosine / sine).clamp(-1.0, 1.0);
    let chord = sine * ((1.0 - y) * (1.0 + y)).sqrt();
    let cap = (cosine * libm::acos(y) - x * chord) * sin_sigma * sin_sigma;
    ((cap + libm::atan2(chord, x)) / PI).clamp(0.0, 1.0)
}

/// A disk parallel to the element, its centre straight above at `height` (Howell, B-12).
pub fn disk_coaxial(height: f64, radius: f64) -> f64 {
    radius * radius / (height * height + radius * radius)
}

/// A disk parallel to the element, `height` above it and its axis `offset` away (Howell, B-13).
pub fn disk_parallel(offset: f64, height: f64, radius: f64) -> f64 {
    let b = offset * offset + (height - radius) * (height + radius);
    let product = 2.0 * height * radius;
    let root = libm::hypot(b, product);
    // (root - b) / (2 root), without the cancellation
    if b > 0.0 { 0.5 * product / root * (product / (root + b)) } else { 0.5 * (root - b) / root }
}

/// A horizontal disk, `height` above an element whose normal is horizontal and points at the disk's axis, `offset`
/// away; `radius` at most `offset`, so that the horizon does not cut it (Howell, B-15). 0 for a disk at no height.
pub fn disk_perpendicular(offset: f64, height: f64, radius: f64) -> f64 {
    assert!(radius <= offset, "the horizon cuts a disk of radius {radius} whose axis is {offset} away");
    if height == 0.0 {
        return 0.0;
    }
    let (h, r) = (height / offset, radius / offset);
    let z = 1.0 + h * h + r * r;
    let root = ((h * h + (1.0 - r) * (1.0 - r)) * (h * h + (1.0 + r) * (1.0 + r))).sqrt();
    2.0 * h * r * r / (root * (z + root))
}

/// A sky of radiance cos^n of the zenith angle over an unoccluded plane, relative to the zenith: radiance of the
/// plane = albedo · this. A uniform sky has n = 0 and gives 1.
pub fn cosine_sky(exponent: f64) -> f64 {
    2.0 / (exponent + 2.0)
}

/// Variance of one cosine-weighted sample (per solid angle cos θ / π) of [`cosine_sky`]:
/// 2/(2n + 2) - (2/(n + 2))².
pub fn cosine_sky_variance(exponent: f64) -> f64 {
    let ratio = exponent / (exponent + 2.0);
    ratio * ratio / (exponent + 1.0)
}
