//! Path tracing for sixteen paths at once: vertex by vertex what `estimator::explicit` does for one. Implicit path tracing
//! is the same walk without samples on emitters.
//!
//! Whatever is the same text for one path and for sixteen is shared: termination rules, the weights of techniques, the
//! sampling of emitters. What a path adds is summed in double precision.

use super::light::{self, Lamp};
use super::outcome::Outcomes;
use super::paths::Paths;
use super::stage::{Meeting, Stage};
use super::vector::{F, M, U, V3, lanes};
use super::warp::hemisphere;
use crate::estimator::{Explicit, MAX_RAYS, Technique};
use crate::sampling::PdfW;
use crate::scene::{Directions, Ray};
use fearless_simd::{Simd, prelude::*};
use std::f32::consts::FRAC_1_PI;

/// A path tracer in a scene.
#[derive(Clone)]
pub struct Walk<'a> {
    /// The scene.
    pub stage: Stage<'a>,
    /// What is done at each vertex.
    pub tracer: Explicit,
    /// Its lamp, if the scene has but one.
    pub lamp: Option<Lamp>,
}

impl Walk<'_> {
    /// Follows each path to its next vertex and on from there; those that end are alive no longer.
    #[inline(always)]
    pub fn vertex<S: Simd>(&self, paths: &mut Paths<S>, out: &mut Outcomes) {
        let mut x = self.meet(paths, out);
        self.emission(&x, paths, out);
        paths.bounce += 1;
        paths.alive &= self.reaches(paths.bounce);
        if self.tracer.technique.samples_lights() {
            self.direct(&x, paths, out);
        }
        let sampled = self.tracer.technique == Technique::Light;
        paths.alive &= self.reaches(paths.bounce + u32::from(sampled));
        self.roulette(&x, paths);
        paths.resume(&mut x);
        self.scatter(&x, paths);
    }

    /// Whether light scattered so often is counted.
    #[inline(always)]
    fn reaches<S: Simd>(&self, bounce: U<S>) -> M<S> {
        let all = M::splat(bounce.token(), true);
        self.tracer.roulette.clamp.map_or(all, |clamp| bounce.simd_le(clamp))
    }

    #[inline(always)]
    fn meet<S: Simd>(&self, paths: &mut Paths<S>, out: &mut Outcomes) -> Meeting<S> {
        paths.count(paths.alive);
        let runaway = paths.alive & paths.rays_traced.simd_gt(MAX_RAYS as u32);
        lanes(runaway).for_each(|_| out.run_away());
        let x = self.stage.meet(&paths.rays);
        paths.alive &= x.seen & !runaway;
        x
    }

    /// Le, where no sampled point could have found it too, or weighted.
    #[inline(always)]
    fn emission<S: Simd>(&self, x: &Meeting<S>, paths: &Paths<S>, out: &mut Outcomes) {
        let from_eye = paths.pdf.simd_eq(f32::INFINITY);
        let all = M::splat(from_eye.token(), true);
        let counts = if self.tracer.technique == Technique::Light { from_eye } else { all };
        for lane in lanes(paths.alive & x.emit & counts) {
            let pdf = paths.pdf[lane];
            let pdf = (pdf != f32::INFINITY).then_some(PdfW(f64::from(pdf)));
            let weight = self.tracer.technique.of_hit(pdf, || {
                let d = paths.rays.d.of(lane);
                let ray = Ray { o: paths.rays.o.of(lane), d, from: paths.rays.from[lane] };
                self.stage.scene.light_pdf(self.tracer.lights, &ray, &self.stage.hit(x, lane, d), 0.0)
            });
            let le = self.stage.le(x.id[lane]);
            out.add(lane, paths.bounce[lane], paths.beta.of(lane) * le * weight);
        }
    }

    /// Light from points sampled on emitters.
    #[inline(always)]
    fn direct<S: Simd>(&self, x: &Meeting<S>, paths: &mut Paths<S>, out: &mut Outcomes) {
        let Explicit { technique, lights, directions, .. } = self.tracer;
        let streams = &mut paths.streams;
        let ways = match &self.lamp {
            Some(lamp) => lamp.sample(x, paths.alive, streams),
            None => light::sample(&self.stage, lights, x, paths.alive, streams),
        };
        paths.count(ways.open);
        let lit = ways.open & self.stage.visible(&ways.rays(x), ways.to);
        let radiance = paths.beta.times(ways.radiance);
        for lane in lanes(lit) {
            let pdf = ways.pdf[lane];
            let pdf = (pdf != f32::INFINITY).then_some(PdfW(f64::from(pdf)));
            let weight = technique.of_light(pdf, || {
                let hit = self.stage.hit(x, lane, -x.n.of(lane));
                hit.material.bsdf.pdf(directions, hit.frame.n, hit.wo, ways.to_light.of(lane).normalize())
            });
            out.add(lane, paths.bounce[lane], radiance.of(lane) * weight);
        }
    }

    /// Survival and splitting; see `Ctx::copies`.
    #[inline(always)]
    fn roulette<S: Simd>(&self, x: &Meeting<S>, paths: &mut Paths<S>) {
        let roulette = &self.tracer.roulette;
        let (beta, albedo) = (paths.beta.components(), x.albedo.components());
        let largest = |[r, g, b]: [F<S>; 3]| r.max(g).max(b);
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

    #[inline(always)]
    fn scatter<S: Simd>(&self, x: &Meeting<S>, paths: &mut Paths<S>) {
        let (u, v) = paths.streams.u2(paths.alive);
        let (wi, cos) = hemisphere(self.tracer.directions, x.n, u, v);
        let pdf = F::splat(u.token(), FRAC_1_PI);
        let (weight, pdf): (V3<S>, _) = match self.tracer.directions {
            Directions::Cosine => (x.albedo, pdf * cos),
            Directions::Uniform => (x.albedo * (cos * 2.0), pdf * 0.5),
        };
        paths.beta = paths.beta.times(weight);
        paths.pdf = pdf;
        (paths.rays.o, paths.rays.d, paths.rays.from) = (x.p, wi, x.id);
    }
}
