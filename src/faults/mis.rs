//! Mistakes in how sampled lights and hit lights are weighted against each other.

use super::walk::{Path, Walk};
use crate::estimator::Ctx;
use crate::sampling::PdfW;
use crate::scene::sky::SKY;
use crate::scene::{Hit, LightSample};
use glam::DVec3;

/// Mistakes in how two techniques are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// At sampled lights the density of directions is 0.93 of what it is.
    Scaled,
    /// A light without extent is weighted as if a direction could find it.
    PointShared,
    /// At sampled lights the light's density is taken per area; the sky has none.
    PerAreaOnce,
    /// It is taken per area in both places.
    PerArea,
    /// At hit lights the density of directions is multiplied by the probability of survival.
    RouletteOnce,
}

/// What [`Weighting::Scaled`] scales with.
pub const SCALE: f64 = 0.93;

impl Walk {
    /// Weight of an emitter that was hit.
    pub fn hit_weight(&self, path: &Path<'_>, x: &Hit<'_>, cx: &Ctx<'_>) -> f64 {
        let direction = match self.weighting() {
            Some(Weighting::RouletteOnce) => path.pdf.map(|pdf| PdfW(pdf.0 * path.q)),
            _ => path.pdf,
        };
        self.technique.of_hit(direction, || {
            let pdf = cx.light_pdf(&path.ray, x, self.lights);
            match self.weighting() {
                Some(Weighting::PerArea) if !x.is_sky() => {
                    let to_light = x.p - path.ray.o;
                    PdfW(pdf.per_area(to_light.length_squared(), x.frame.n.dot(x.wo)).0)
                }
                _ => pdf,
            }
        })
    }

    /// Weight of a sampled point on an emitter, which is taken to lie in the direction `wi`.
    pub fn light_weight(&self, x: &Hit<'_>, light: &LightSample, wi: DVec3, cos_at_light: f64) -> f64 {
        let pdf = match self.weighting() {
            Some(Weighting::PointShared) => light.pdf.or(Some(PdfW(light.pmf))),
            Some(Weighting::PerArea | Weighting::PerAreaOnce) if light.surface != SKY => {
                let squared = light.distance * light.distance;
                light.pdf.map(|pdf| PdfW(pdf.per_area(squared, cos_at_light).0))
            }
            _ => light.pdf,
        };
        self.technique.of_light(pdf, || {
            let pdf = x.material.bsdf.pdf(self.directions, x.frame.n, x.wo, wi);
            match self.weighting() {
                Some(Weighting::Scaled) => pdf.map(|pdf| PdfW(SCALE * pdf.0)),
                _ => pdf,
            }
        })
    }
}
