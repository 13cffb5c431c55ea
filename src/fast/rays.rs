//! Sixteen rays, and what they have met.

use super::vector::{F, M, U, V3};
use fearless_simd::{Simd, prelude::*};

/// Sixteen rays, or segments, and the surfaces that they leave.
#[derive(Clone, Copy)]
pub struct Rays<S: Simd> {
    /// Where they start.
    pub o: V3<S>,
    /// Where they go.
    pub d: V3<S>,
    /// The surface of each `o`.
    pub from: U<S>,
}

/// What sixteen rays have met so far: distance and surface; infinite where nothing.
#[derive(Clone, Copy)]
pub struct Nearest<S: Simd> {
    /// Distance, in units of the ray's direction.
    pub t: F<S>,
    /// Which surface.
    pub id: U<S>,
}

impl<S: Simd> Nearest<S> {
    /// Takes a surface that some rays meet, where it is nearer.
    #[inline(always)]
    pub fn take(&mut self, t: F<S>, meets: M<S>, id: u32) {
        let nearer = meets & t.simd_lt(self.t);
        self.t = nearer.select(t, self.t);
        self.id = nearer.select(U::splat(t.token(), id), self.id);
    }
}

impl<S: Simd> Rays<S> {
    /// Where segments to the surfaces `to` would be blocked by surface `id` at `t`: inside of them, and at neither end.
    #[inline(always)]
    pub fn passes(&self, t: F<S>, to: U<S>, id: u32) -> M<S> {
        t.simd_gt(0.0) & t.simd_lt(1.0) & self.from.simd_ne(id) & to.simd_ne(id)
    }
}
