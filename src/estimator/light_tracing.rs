//! Light tracing: particles from the lights, connected to the sensor wherever they land.
//!
//! - estimates: radiance by its adjoint, the sensor's importance carried backwards [Dutré et al. 1993; Veach 1997,
//!   sec. 4.7]; what the eye sees directly, itself or in a mirror, no particle can hit: there a path from the eye goes on
//! - property: unbiased; with a clamp, biased by the light of later bounces
//! - cost: a ray and a shadow ray a vertex of each particle, and one ray for each pixel
//! - fails when: the eye sees little of the scene, or sees it in mirrors and through glass

use super::film::Film;
use super::particles::Particles;
use super::{Ctx, Estimate, Explicit, Property, Roulette, Technique};
use crate::scene::{Directions, Hit, LightSampling, Ray, Rgb};
use serde::{Deserialize, Serialize};

/// Particles connected to the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightTracing {
    /// Particles of one realization.
    pub particles: u64,
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When walks end.
    pub roulette: Roulette,
}

impl Estimate for LightTracing {
    type Pass = Film;

    fn begin(&self, _: u64, cx: &mut Ctx<'_>) -> Film {
        let particles = Particles { directions: self.directions, roulette: self.roulette };
        let share = self.share();
        let mut film = Film::default();
        for _ in 0..self.particles {
            particles.send(cx, &mut |cx, x, particle| {
                if let Some((pixel, seen)) = cx.connect(x) {
                    film.add(pixel, particle.bounce + 1, seen * particle.power * share);
                }
            });
        }
        film.developed()
    }

    #[inline]
    fn estimate(&self, film: &Film, ray: Ray, cx: &mut Ctx<'_>) {
        film.at(cx.pixel()).for_each(|(bounce, radiance)| cx.add(bounce, radiance));
        let Some(x) = cx.hit(&ray) else { return };
        cx.add(0, x.le);
        if x.material.bsdf.is_dirac() {
            self.behind(&x, cx);
        }
    }

    fn property(&self) -> Property {
        Property::of(&self.roulette)
    }
}

impl LightTracing {
    /// What each particle counts of all light.
    pub fn share(&self) -> f64 {
        1.0 / self.particles as f64
    }

    /// What the mirror or glass `x` shows.
    fn behind(&self, x: &Hit<'_>, cx: &mut Ctx<'_>) {
        let LightTracing { directions, roulette, .. } = *self;
        let eye = Explicit { technique: Technique::Light, lights: LightSampling::AREA, directions, roulette };
        let q = if roulette.reaches(1) { roulette.q(0, Rgb::ONE, x.albedo()) } else { 0.0 };
        for _ in 0..cx.copies(q) {
            let next = cx.scatter(x, directions);
            eye.walk(next.ray, next.weight / q, next.pdf, 1, cx);
        }
    }
}
