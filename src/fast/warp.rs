//! The maps of `sampling::warp` for sixteen paths, in single precision.

use super::vector::{F, V3};
use crate::scene::Directions;
use fearless_simd::{Simd, i32x16, prelude::*};
use std::f32::consts::PI;

/// (sin 2πu, cos 2πu) for u in [0, 1): quarter turns and Taylor series to degree 9 and 8, absolute error below 2e-7.
#[inline(always)]
pub fn sin_cos_turn<S: Simd>(u: F<S>) -> (F<S>, F<S>) {
    let quarter: i32x16<S> = (u * 4.0 + 0.5).to_int();
    let turns: F<S> = quarter.to_float();
    let x = (u - turns * 0.25) * (2.0 * PI);
    let z = x * x;
    let sin = x * ((((z * (1.0 / 362_880.0) - 1.0 / 5_040.0) * z + 1.0 / 120.0) * z - 1.0 / 6.0) * z + 1.0);
    let cos = (((z * (1.0 / 40_320.0) - 1.0 / 720.0) * z + 1.0 / 24.0) * z - 0.5) * z + 1.0;
    let even = (quarter & 1).simd_eq(0);
    let (s, c) = (even.select(sin, cos), even.select(cos, sin));
    let s = (quarter & 2).simd_eq(0).select(s, -s);
    let c = ((quarter + 1) & 2).simd_eq(0).select(c, -c);
    (s, c)
}

/// A direction around the unit normal `n` and its local z = cos θ, from a point of the unit square.
#[inline(always)]
pub fn hemisphere<S: Simd>(directions: Directions, n: V3<S>, u: F<S>, v: F<S>) -> (V3<S>, F<S>) {
    let one = F::splat(u.token(), 1.0);
    let (r, z) = match directions {
        Directions::Cosine => (u.sqrt(), (one - u).sqrt()),
        Directions::Uniform => {
            let z = one - u;
            ((one - z * z).max(0.0).sqrt(), z)
        }
    };
    let (sin, cos) = sin_cos_turn(v);
    (to_world(n, r * cos, r * sin, z), z)
}

/// A vector given in the frame around `n` [Duff et al. 2017, JCGT 6(1), listing 3], in world coordinates.
#[inline(always)]
fn to_world<S: Simd>(n: V3<S>, x: F<S>, y: F<S>, z: F<S>) -> V3<S> {
    let one = F::splat(x.token(), 1.0);
    let sign = one.copysign(n.z);
    let a = -one / (sign + n.z);
    let b = n.x * n.y * a;
    let s = V3 { x: sign * n.x * n.x * a + 1.0, y: sign * b, z: -sign * n.x };
    let t = V3 { x: b, y: n.y * n.y * a + sign, z: -n.y };
    s * x + t * y + n * z
}
