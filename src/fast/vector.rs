//! Numbers and vectors of sixteen paths side by side. Every operation is one that IEEE 754 fixes to the last bit, so that
//! all instruction sets agree.

use crate::estimator::Number;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16, prelude::*, u32x16};
use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

/// Paths side by side: what one AVX-512 register holds, two of AVX2, four of NEON and SSE2.
pub const WIDTH: usize = 16;

/// A number a path.
pub type F<S> = f32x16<S>;
/// A count or an index a path.
pub type U<S> = u32x16<S>;
/// A yes or no a path.
pub type M<S> = mask32x16<S>;

/// A vector, or a colour, a path.
#[derive(Clone, Copy)]
pub struct V3<S: Simd> {
    /// First component.
    pub x: F<S>,
    /// Second component.
    pub y: F<S>,
    /// Third component.
    pub z: F<S>,
}

/// The same vector in single precision.
pub fn narrow(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

impl<S: Simd> V3<S> {
    /// The same vector for all paths.
    #[inline(always)]
    pub fn splat(simd: S, v: [f32; 3]) -> Self {
        V3 { x: F::splat(simd, v[0]), y: F::splat(simd, v[1]), z: F::splat(simd, v[2]) }
    }

    /// From the components of each path.
    #[inline(always)]
    pub fn gathered(simd: S, [x, y, z]: &[[f32; WIDTH]; 3]) -> Self {
        V3 { x: F::simd_from(simd, *x), y: F::simd_from(simd, *y), z: F::simd_from(simd, *z) }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> F<S> {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Scalar product with the same vector for all paths.
    #[inline(always)]
    pub fn along(self, v: &[f32; 3]) -> F<S> {
        self.x * v[0] + self.y * v[1] + self.z * v[2]
    }

    /// Component by component.
    #[inline(always)]
    pub fn times(self, o: Self) -> Self {
        V3 { x: self.x * o.x, y: self.y * o.y, z: self.z * o.z }
    }

    /// This where `mask` says so, the other elsewhere.
    #[inline(always)]
    pub fn or(self, mask: M<S>, other: Self) -> Self {
        V3 {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            z: mask.select(self.z, other.z),
        }
    }

    /// Its components.
    #[inline(always)]
    pub fn components(self) -> [F<S>; 3] {
        [self.x, self.y, self.z]
    }

    /// The vector of one path.
    #[inline(always)]
    pub fn of(&self, lane: usize) -> DVec3 {
        DVec3::new(f64::from(self.x[lane]), f64::from(self.y[lane]), f64::from(self.z[lane]))
    }

    /// Replaces the vector of one path.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: DVec3) {
        (self.x[lane], self.y[lane], self.z[lane]) = (v.x as f32, v.y as f32, v.z as f32);
    }
}

impl<S: Simd> Add for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        V3 { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<S: Simd> Sub for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        V3 { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<S: Simd> Mul<F<S>> for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: F<S>) -> Self {
        V3 { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}

impl<S: Simd> Neg for V3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        V3 { x: -self.x, y: -self.y, z: -self.z }
    }
}

/// Whole numbers below 2^24, exactly.
#[inline(always)]
pub fn exact<S: Simd>(u: U<S>) -> F<S> {
    let signed: i32x16<S> = u.bitcast();
    signed.to_float()
}

/// The paths of a mask, by their number.
#[inline(always)]
pub fn lanes<S: Simd>(mask: M<S>) -> impl Iterator<Item = usize> {
    let mut bits = mask.to_bitmask();
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < WIDTH).then_some(lane)
    })
}

impl<S: Simd> Number for F<S> {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        F::splat(self.token(), x as f32)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        SimdBase::max(self, other)
    }

    #[inline(always)]
    fn clamp(self, low: f64, high: f64) -> Self {
        SimdBase::min(SimdBase::max(self, low as f32), high as f32)
    }
}
