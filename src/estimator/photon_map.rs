//! Photon mapping: particles are stored where they land, and radiance is estimated from their density.
//!
//! - estimates: radiance, L = Le + sum f Φ / ΔA over the photons near the point that the eye sees [Jensen 1996]; there is
//!   no cosine, which the density of photons has already
//! - property: consistent: biased by the blur over ΔA, which vanishes as photons grow in number and ΔA shrinks
//! - cost: a ray a vertex of each photon, one ray for each pixel, and looking for photons, which no ray counts
//! - fails when: ΔA reaches over an edge, or light changes within it

use super::kernel::{Gather, Kernel};
use super::particles::{Particle, Particles};
use super::photons::{Photon, Photons};
use super::{BINS, Ctx, Estimate, Property, Roulette};
use crate::scene::{Directions, Hit, LightSampling, Ray, Rgb};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A map of photons, and what is gathered from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhotonMap {
    /// Photons that are sent for one map.
    pub photons: u64,
    /// Which of them are gathered.
    pub gather: Gather,
    /// How they count.
    pub kernel: Kernel,
    /// How light that comes straight from an emitter is found.
    pub direct: DirectLight,
    /// Rays by which indirect light is gathered where the eye looks, each from photons where it ends; 0 for none.
    pub final_gather: u32,
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When walks end.
    pub roulette: Roulette,
}

/// How direct light is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DirectLight {
    /// By its photons.
    #[default]
    Photons,
    /// By next-event estimation.
    Sampled,
}

impl Estimate for PhotonMap {
    type Pass = Photons;

    fn begin(&self, realization: u64, cx: &mut Ctx<'_>) -> Photons {
        let particles = Particles { directions: self.directions, roulette: self.roulette };
        let mut map = self.empty(realization);
        for _ in 0..self.photons {
            particles.send(cx, &mut |_, x, particle| self.keep(&mut map, x, particle));
        }
        map.grown()
    }

    #[inline]
    fn estimate(&self, map: &Photons, ray: Ray, cx: &mut Ctx<'_>) {
        self.look(map, ray, Rgb::ONE, 0, self.final_gather, cx);
    }

    fn property(&self) -> Property {
        Property::Consistent { rates: self.gather.rates() }
    }
}

impl PhotonMap {
    /// The map of a realization before any photon is sent.
    pub fn empty(&self, realization: u64) -> Photons {
        Photons::new(self.photons, self.gather, realization)
    }

    /// Stores a photon that met `x`, if it will be gathered.
    #[inline]
    pub fn keep(&self, map: &mut Photons, x: &Hit<'_>, photon: Particle) {
        if photon.bounce > 0 || !self.leaves_out_direct() {
            map.add(x, photon);
        }
    }

    /// Whether photons that come straight from a light need not be stored: nobody gathers them, and they do not decide how
    /// far the others are gathered.
    fn leaves_out_direct(&self) -> bool {
        self.direct == DirectLight::Sampled && !matches!(self.gather, Gather::Nearest { .. })
    }

    /// Follows a path from the eye to where photons lie; `rays` are sent on from there.
    fn look(&self, map: &Photons, mut ray: Ray, mut beta: Rgb, mut bounce: u32, rays: u32, cx: &mut Ctx<'_>) {
        let is_first = bounce == 0; // later on, emission was found before as direct light or a caustic
        let x = loop {
            let Some(x) = cx.hit(&ray) else { return };
            if is_first {
                cx.add(bounce, beta * x.le);
            }
            if x.is_sky() || !self.roulette.reaches(bounce + 1) {
                return;
            }
            if !x.material.bsdf.is_dirac() {
                break x;
            }
            let q = self.roulette.q(bounce, beta, x.albedo()).min(1.0);
            if cx.copies(q) == 0 {
                return;
            }
            let next = cx.scatter(&x, self.directions);
            (ray, beta, bounce) = (next.ray, beta * next.weight / q, bounce + 1);
        };
        if self.direct == DirectLight::Sampled
            && let Some(light) = cx.direct(&x, LightSampling::AREA)
        {
            cx.add(bounce + 1, beta * light.radiance);
        }
        let sampled = |photon: &Photon| self.direct == DirectLight::Sampled && photon.is_direct();
        let by_rays = |photon: &Photon| rays > 0 && photon.is_diffuse();
        self.gather(map, &x, (beta, bounce), |photon| !sampled(photon) && !by_rays(photon), cx);
        for _ in 0..rays {
            let next = cx.scatter(&x, self.directions);
            self.look(map, next.ray, beta * next.weight / f64::from(rays), bounce + 1, 0, cx);
        }
    }

    /// Radiance from the density of photons around `x`, as far as they are `wanted`.
    fn gather(
        &self,
        map: &Photons,
        x: &Hit<'_>,
        (beta, bounce): (Rgb, u32),
        wanted: impl Fn(&Photon) -> bool,
        cx: &mut Ctx<'_>,
    ) {
        let Some(near) = map.near(x.p) else { return cx.starve() };
        let mut bins = [Rgb::ZERO; BINS];
        for (t, photon) in near.photons() {
            let scattered = bounce + photon.bounce() + 1;
            if wanted(photon) && photon.lies_on(x) && self.roulette.reaches(scattered) {
                let f = x.material.bsdf.f(x.frame.n, x.wo, photon.wi(x));
                bins[(scattered as usize).min(BINS - 1)] += f * photon.power() * self.kernel.weight(t);
            }
        }
        let scale = beta / (near.area() * map.sent());
        (0..).zip(bins).filter(|(_, sum)| *sum != Rgb::ZERO).for_each(|(bin, sum)| cx.add(bin, scale * sum));
    }
}
