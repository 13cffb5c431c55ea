//! What path tracing and particles have in common, for sixteen paths at once: the next vertex, survival, and the way on.

use super::paths::Paths;
use super::stage::{Meeting, Stage};
use super::vector::{F, M, U, V3, lanes};
use super::warp::hemisphere;
use crate::estimator::{MAX_RAYS, Roulette};
use crate::scene::Directions;
use fearless_simd::{Simd, prelude::*};
use std::f32::consts::FRAC_1_PI;

/// How walks go on in a scene.
#[derive(Clone)]
pub struct Steps<'a> {
    /// The scene.
    pub stage: Stage<'a>,
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When walks end.
    pub roulette: Roulette,
}

impl Steps<'_> {
    /// Whether light scattered so often is counted.
    #[inline(always)]
    pub fn reaches<S: Simd>(&self, bounce: U<S>) -> M<S> {
        let all = M::splat(bounce.token(), true);
        self.roulette.clamp.map_or(all, |clamp| bounce.simd_le(clamp))
    }

    /// What each path meets next; those that meet nothing, or run away, are alive no longer.
    #[inline(always)]
    pub fn meet<S: Simd>(&self, paths: &mut Paths<S>) -> Meeting<S> {
        paths.count(paths.alive);
        let runaway = paths.alive & paths.rays_traced.simd_gt(MAX_RAYS as u32);
        paths.runaway += u64::from(runaway.to_bitmask().count_ones());
        let x = self.stage.meet(&paths.rays);
        paths.alive &= x.seen & !runaway;
        x
    }

    /// Survival and splitting; see `Ctx::copies`.
    #[inline(always)]
    pub fn roulette<S: Simd>(&self, x: &Meeting<S>, paths: &mut Paths<S>) {
        let roulette = &self.roulette;
        let (beta, albedo) = (paths.beta.components(), x.albedo.components());
        let one = F::splat(x.id.token(), 1.0);
        let goes = paths.alive & largest(beta).simd_gt(0.0) & largest(albedo).simd_gt(0.0);
        let certain = paths.bounce.simd_le(roulette.from);
        let q = certain.select(one, roulette.rule.q(beta, albedo));
        let u = paths.streams.u1(goes & q.simd_ne(1.0));
        let copies = q.simd_eq(1.0).select(one, (q + u).trunc());
        paths.alive = goes & copies.simd_ge(1.0);
        paths.beta = paths.beta * (one / q);
        let split = paths.alive & copies.simd_ge(2.0);
        lanes(split).for_each(|lane| paths.wait(lane, x, copies[lane] as u32 - 1));
    }

    /// A continued direction for each path.
    #[inline(always)]
    pub fn scatter<S: Simd>(&self, x: &Meeting<S>, paths: &mut Paths<S>) {
        let (u, v) = paths.streams.u2(paths.alive);
        let (wi, cos) = hemisphere(self.directions, x.n, u, v);
        let pdf = F::splat(u.token(), FRAC_1_PI);
        let (weight, pdf): (V3<S>, _) = match self.directions {
            Directions::Cosine => (x.albedo, pdf * cos),
            Directions::Uniform => (x.albedo * (cos * 2.0), pdf * 0.5),
        };
        paths.beta = paths.beta.times(weight);
        paths.pdf = pdf;
        (paths.rays.o, paths.rays.d, paths.rays.from) = (x.p, wi, x.id);
    }
}

#[inline(always)]
fn largest<S: Simd>([r, g, b]: [F<S>; 3]) -> F<S> {
    r.max(g).max(b)
}
