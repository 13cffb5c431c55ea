//! Path tracing for sixteen paths at once: vertex by vertex what `estimator::explicit` does for one. Implicit path tracing
//! is the same walk without samples on emitters.
//!
//! Whatever is the same text for one path and for sixteen is shared: termination rules, the weights of techniques, the
//! sampling of emitters. What a path adds is summed in double precision.

use super::light::{self, Lamp};
use super::outcome::Outcomes;
use super::paths::Paths;
use super::stage::{Meeting, Stage};
use super::steps::Steps;
use super::vector::{M, lanes};
use crate::estimator::{Explicit, Technique};
use crate::sampling::PdfW;
use crate::scene::Ray;
use fearless_simd::{Simd, prelude::*};

/// A path tracer in a scene.
#[derive(Clone)]
pub struct Walk<'a> {
    steps: Steps<'a>,
    /// What is done at each vertex.
    tracer: Explicit,
    /// The lamp, if the scene has but one.
    lamp: Option<Lamp>,
}

impl<'a> Walk<'a> {
    /// This path tracer in this scene.
    pub fn new(stage: Stage<'a>, tracer: Explicit) -> Self {
        let lamp = Lamp::of(&stage, tracer.lights);
        let steps = Steps { stage, directions: tracer.directions, roulette: tracer.roulette };
        Walk { steps, tracer, lamp }
    }

    /// Follows each path to its next vertex and on from there; those that end are alive no longer.
    #[inline(always)]
    pub fn vertex<S: Simd>(&self, paths: &mut Paths<S>, out: &mut Outcomes) {
        let (steps, technique) = (&self.steps, self.tracer.technique);
        let mut x = steps.meet(paths);
        self.emission(&x, paths, out);
        paths.bounce += 1;
        paths.alive &= steps.reaches(paths.bounce);
        if technique.samples_lights() {
            self.direct(&x, paths, out);
        }
        paths.alive &= steps.reaches(paths.bounce + u32::from(technique == Technique::Light));
        steps.roulette(&x, paths);
        paths.resume(&mut x);
        steps.scatter(&x, paths);
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
                self.steps.stage.scene.light_pdf(
                    self.tracer.lights,
                    &ray,
                    &self.steps.stage.hit(x, lane, d),
                    0.0,
                )
            });
            let le = self.steps.stage.le(x.id[lane]);
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
            None => light::sample(&self.steps.stage, lights, x, paths.alive, streams),
        };
        paths.count(ways.open);
        let lit = ways.open & self.steps.stage.visible(&ways.rays(x), ways.to);
        let radiance = paths.beta.times(ways.radiance);
        for lane in lanes(lit) {
            let pdf = ways.pdf[lane];
            let pdf = (pdf != f32::INFINITY).then_some(PdfW(f64::from(pdf)));
            let weight = technique.of_light(pdf, || {
                let hit = self.steps.stage.hit(x, lane, -x.n.of(lane));
                hit.material.bsdf.pdf(directions, hit.frame.n, hit.wo, ways.to_light.of(lane).normalize())
            });
            out.add(lane, paths.bounce[lane], radiance.of(lane) * weight);
        }
    }
}
