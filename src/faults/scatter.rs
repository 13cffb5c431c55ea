//! Mistakes in continued directions.
//!
//! Where a weight has a factor 1 / cos it grows by e^(1/2) a bounce in the typical case. Roulette by throughput then lets
//! go on for ever what walks among albedos above 0.6: such a walk runs away, and takes seconds to be cut.

use super::slip::Slip;
use super::walk::{Path, Walk};
use crate::estimator::{Ctx, Step};
use crate::sampling::PdfW;
use crate::sampling::warp::{cosine_hemisphere, sin_cos_turn, uniform_hemisphere};
use crate::scene::{Bsdf, Carried, Directions, Hit, fresnel};
use glam::DVec3;

/// Mistakes in continued directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scattering {
    /// The cosine of the integrand is forgotten: f / pdf.
    WithoutCosine,
    /// Drawn by the cosine, divided by the uniform density.
    CosineAsUniform,
    /// Drawn uniformly, divided by the density of the cosine.
    UniformAsCosine,
    /// Drawn uniformly in the polar angle, divided by the density of the cosine.
    AngleAsCosine,
    /// Drawn uniformly in the polar angle, divided by the uniform density.
    AngleAsUniform,
    /// The cosine at the sampled light stands where the cosine at `x` should.
    LightsCosine,
    /// A clear interface reflects every other time, and is weighted as if by its reflectance.
    EveryOther,
    /// Random numbers have 256 levels from 0 to 1, both included, and f cos / pdf is computed as it stands.
    Coarse,
    /// The same, and what is not a number is dropped.
    CoarseDropped,
}

impl Walk {
    /// The path that continues from `x`.
    pub fn scatter<'a>(
        &self,
        path: &Path<'a>,
        x: &Hit<'a>,
        cos_at_light: Option<f64>,
        cx: &mut Ctx<'_>,
    ) -> Path<'a> {
        let step = match (self.slip, x.material.bsdf) {
            (Slip::Scattering(Scattering::EveryOther), Bsdf::Dielectric { ior }) => every_other(ior, x, cx),
            (Slip::Scattering(slip), Bsdf::Lambert { .. }) => self.matte(slip, x, cos_at_light, cx),
            _ => cx.scatter(x, self.directions),
        };
        Path { ray: step.ray, beta: path.beta * step.weight, pdf: step.pdf, ..*path }
    }

    fn matte(&self, slip: Scattering, x: &Hit<'_>, cos_at_light: Option<f64>, cx: &mut Ctx<'_>) -> Step {
        let drawn = |map: fn((f64, f64)) -> DVec3, u| self.step(x, map(u));
        match slip {
            Scattering::EveryOther => cx.scatter(x, self.directions),
            Scattering::WithoutCosine => {
                let step = cx.scatter(x, self.directions);
                Step { weight: step.weight / x.frame.n.dot(step.ray.d), ..step }
            }
            Scattering::LightsCosine => {
                let step = cx.scatter(x, self.directions);
                let mistaken = cos_at_light.map_or(1.0, |cos| cos / x.frame.n.dot(step.ray.d));
                Step { weight: step.weight * mistaken, ..step }
            }
            Scattering::CosineAsUniform => drawn(cosine_hemisphere, cx.u2()),
            Scattering::UniformAsCosine => drawn(uniform_hemisphere, cx.u2()),
            Scattering::AngleAsCosine | Scattering::AngleAsUniform => drawn(uniform_angle, cx.u2()),
            Scattering::Coarse | Scattering::CoarseDropped => {
                let (u, v) = cx.u2();
                let map = match self.directions {
                    Directions::Cosine => cosine_hemisphere,
                    Directions::Uniform => uniform_hemisphere,
                };
                self.quotient(x, map((coarse(u), coarse(v))))
            }
        }
    }

    /// A step in the direction `local`, whose weight follows from the believed density.
    fn step(&self, x: &Hit<'_>, local: DVec3) -> Step {
        let ratio = match self.directions {
            Directions::Cosine => 1.0,
            Directions::Uniform => 2.0 * local.z,
        };
        let wi = x.frame.to_world(local);
        let pdf = x.material.bsdf.pdf(self.directions, x.frame.n, x.wo, wi);
        Step { ray: x.spawn(wi), weight: x.albedo() * ratio, pdf }
    }

    /// The same by f cos / pdf, which is 0/0 in the plane of the surface.
    fn quotient(&self, x: &Hit<'_>, local: DVec3) -> Step {
        // in the surface's own coordinates, where such a direction lies in the plane exactly
        let n = DVec3::Z;
        let pdf = x.material.bsdf.pdf(self.directions, n, n, local);
        let PdfW(density) = pdf.unwrap_or(PdfW(1.0));
        let weight = x.material.bsdf.f(n, n, local) * local.z / density;
        Step { ray: x.spawn(x.frame.to_world(local)), weight, pdf }
    }
}

/// A multiple of 1/255 in [0, 1], both included.
fn coarse(u: f64) -> f64 {
    (u * 256.0).floor() / 255.0
}

/// A direction whose polar angle is uniform in [0, π/2): density 1 / (π² sin θ).
fn uniform_angle((u, v): (f64, f64)) -> DVec3 {
    let ((r, z), (sin, cos)) = (sin_cos_turn(0.25 * u), sin_cos_turn(v));
    DVec3::new(r * cos, r * sin, z)
}

/// Reflection or refraction with the same probability, wherever both can happen.
fn every_other(ior: f64, x: &Hit<'_>, cx: &mut Ctx<'_>) -> Step {
    let cos = x.frame.n.dot(x.wo);
    let (reflectance, _) = fresnel::dielectric(cos.abs(), if cos > 0.0 { ior } else { 1.0 / ior });
    let (u, v) = cx.u2();
    // below the reflectance a ray is reflected
    let u = if u < 0.5 || reflectance >= 1.0 { 0.0 } else { reflectance };
    let s = x.material.bsdf.sample(Carried::Radiance, Directions::Cosine, &x.frame, x.wo, (u, v));
    Step { ray: x.spawn(s.wi), weight: s.weight, pdf: s.pdf }
}
