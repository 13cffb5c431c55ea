//! Explicit path tracing: direct light is sampled on the emitters, indirect light by one continued direction.
//!
//! - estimates: radiance, L = Le + Ld + Lind, where Lind must not see Le again [Kajiya 1986; Veach 1997, sec. 8.2];
//!   what a mirror or glass shows is Le that no sampled light can reach, so there it counts
//! - property: unbiased; with a clamp, biased by the light of later bounces
//! - cost: a shadow ray and a continued ray a vertex
//! - fails when: an emitter touches what it lights (infinite variance when sampled over its area)

use super::{Ctx, Estimate, Property, Roulette, Technique};
use crate::sampling::PdfW;
use crate::scene::{Directions, LightSampling, Ray, Rgb};
use serde::{Deserialize, Serialize};

/// Next-event estimation at each vertex, alone or combined with what continued directions hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Explicit {
    /// Which technique finds direct light.
    pub technique: Technique,
    /// How points on emitters are drawn.
    pub lights: LightSampling,
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When the walk ends.
    pub roulette: Roulette,
}

impl Estimate for Explicit {
    type Pass = ();

    fn begin(&self, _: u64, _: &mut Ctx<'_>) {}

    #[inline]
    fn estimate(&self, (): &(), ray: Ray, cx: &mut Ctx<'_>) {
        self.walk(ray, Rgb::ONE, None, 0, cx);
    }

    fn property(&self) -> Property {
        Property::of(&self.roulette)
    }
}

impl Explicit {
    /// Follows a path of throughput `beta` whose last direction had the density `pdf`.
    pub(super) fn walk(
        &self,
        mut ray: Ray,
        mut beta: Rgb,
        mut pdf: Option<PdfW>,
        mut bounce: u32,
        cx: &mut Ctx<'_>,
    ) {
        loop {
            let Some(x) = cx.hit(&ray) else { return };
            let weight = self.technique.of_hit(pdf, || cx.light_pdf(&ray, &x, self.lights));
            if weight > 0.0 {
                cx.add(bounce, beta * x.le * weight);
            }
            bounce += 1;
            if !self.roulette.reaches(bounce) {
                return;
            }
            if self.technique.samples_lights()
                && let Some(light) = cx.direct(&x, self.lights)
            {
                let direction = || x.material.bsdf.pdf(self.directions, x.frame.n, x.wo, light.wi);
                cx.add(bounce, beta * light.radiance * self.technique.of_light(light.pdf, direction));
            }
            let sampled = self.technique == Technique::Light && !x.material.bsdf.is_dirac();
            if !self.roulette.reaches(bounce + u32::from(sampled)) {
                return;
            }
            let q = self.roulette.q(bounce - 1, beta, x.albedo());
            let copies = cx.copies(q);
            if copies == 0 {
                return;
            }
            beta *= 1.0 / q;
            for _ in 1..copies {
                let next = cx.scatter(&x, self.directions);
                self.walk(next.ray, beta * next.weight, next.pdf, bounce, cx);
            }
            let next = cx.scatter(&x, self.directions);
            (ray, beta, pdf) = (next.ray, beta * next.weight, next.pdf);
        }
    }
}
