//! The narrow streams of sixteen paths: number for number those of [`crate::sampling::Stream`].

use super::vector::{F, M, U, exact};
use fearless_simd::{Simd, prelude::*};

/// Sixteen generators.
#[derive(Clone, Copy)]
pub struct Streams<S: Simd> {
    state: [U<S>; 4],
}

impl<S: Simd> Streams<S> {
    /// Before any path has come.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        Streams { state: [U::splat(simd, 0); 4] }
    }

    /// The stream of one path.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, state: [u32; 4]) {
        for (ours, word) in self.state.iter_mut().zip(state) {
            ours[lane] = word;
        }
    }

    /// A uniform number for each path that `draws`, a multiple of 2^-24 in [0, 1); the others keep their place in their
    /// streams: xoshiro128++ [Blackman & Vigna 2021].
    #[inline(always)]
    pub fn u1(&mut self, draws: M<S>) -> F<S> {
        let [a, b, c, d] = self.state;
        let number = rotl::<S, 7, 25>(a + d) + a;
        let (e, f) = (c ^ a, d ^ b);
        let after = [a ^ f, b ^ e, e ^ (b << 9), rotl::<S, 11, 21>(f)];
        for (word, after) in self.state.iter_mut().zip(after) {
            *word = draws.select(after, *word);
        }
        exact(number >> 8) * (1.0 / (1 << 24) as f32)
    }

    /// A point of the unit square for each path that `draws`.
    #[inline(always)]
    pub fn u2(&mut self, draws: M<S>) -> (F<S>, F<S>) {
        (self.u1(draws), self.u1(draws))
    }
}

#[inline(always)]
fn rotl<S: Simd, const LEFT: u32, const RIGHT: u32>(x: U<S>) -> U<S> {
    (x << LEFT) | (x >> RIGHT)
}
