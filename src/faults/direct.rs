//! Mistakes in next-event estimation.

use super::slip::Slip;
use super::walk::{Path, Walk};
use crate::estimator::Ctx;
use crate::sampling::warp::Frame;
use crate::sampling::{PdfA, PdfW};
use crate::scene::geometry::NOWHERE;
use crate::scene::light::Pick;
use crate::scene::sky::{FAR, SKY};
use crate::scene::{Hit, LightSample, Points, Rgb, Scene, Shape, Sky};
use glam::DVec3;
use std::f64::consts::PI;

/// Mistakes in the light of a sampled point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// The cosine at the surface is forgotten.
    NoCosine,
    /// The cosine at the light is forgotten.
    NoCosineAtLight,
    /// 1 / d² is forgotten.
    NoDistance,
    /// The BRDF of a matte surface is its albedo, without 1 / π.
    NoPi,
    /// f takes the two directions in the wrong order.
    Swapped,
    /// The material of the previous vertex reflects.
    Stale,
    /// The probability of the light's choice is forgotten.
    NoChoice,
    /// Whatever the probability of the choice was, 1 / n is divided by.
    UniformChoice,
    /// The radius of a point on a disk is uniform, and its density is not.
    DiskRadius,
    /// Radiance of the direction away from `x`.
    Outward,
    /// Light comes from a direction beside the one whose radiance it has.
    SkyTurned,
    /// A sky drawn with one exponent has the density of another.
    SkyExponent,
    /// Moving lights are where they were when the shutter opened.
    ShutterOpens,
}

/// Mistakes in which side of a surface counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Lights shine backwards too: |cos| at the light.
    LightBehind,
    /// Lights shine backwards with negative radiance: cos at the light, whatever its sign.
    LightNegative,
    /// What is below the horizon lights from below: |cos| at the surface.
    BelowHorizon,
}

/// Mistakes in the shadow ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadow {
    /// Everything is visible.
    None,
    /// It goes a little too far, and the light shadows itself.
    MeetsLight,
    /// It does not end at the light.
    NoEnd,
}

/// Light that reaches a vertex from a sampled point.
pub struct DirectLight {
    /// What the vertex reflects of it [W m^-2 sr^-1].
    pub radiance: Rgb,
    /// Weight against the other technique.
    pub weight: f64,
    /// Cosine at the light; 1 where there is none.
    pub cos_at_light: f64,
}

/// Added by [`Light::SkyExponent`]. Added 1, the mean under a plane sky would be right by accident: it depends on the
/// wrong exponent m by (m + 1)(2n - m + 2), which is the same for n and n + 1.
pub const EXPONENT: f64 = 2.0;
/// Sine and cosine by which [`Light::SkyTurned`] turns.
const TURN: (f64, f64) = (20.0 / 101.0, 99.0 / 101.0);

impl Walk {
    /// One sampled point on an emitter.
    pub fn sample_direct(&self, path: &Path<'_>, x: &Hit<'_>, cx: &mut Ctx<'_>) -> Option<DirectLight> {
        if x.material.bsdf.is_dirac() || x.is_sky() {
            return None;
        }
        let pick = if cx.scene().light_count() > 1 { cx.u1() } else { 0.0 };
        let point = cx.u2();
        let light = self.light(x, cx, pick, point)?;
        let wi = light.to_light / light.distance;
        let cos_at_light = cos_at_light(cx.scene(), x, &light);
        let n = x.frame.n;
        // where the light is taken to be
        let seen = match self.slip {
            Slip::Facing(Facing::BelowHorizon) if n.dot(wi) < 0.0 => wi - n * (2.0 * n.dot(wi)),
            _ => wi,
        };
        let cos = n.dot(seen);
        if cos <= 0.0 || !self.unshadowed(x, &light, wi, cx) {
            return None;
        }
        let bsdf = match self.slip {
            Slip::Light(Light::Stale) => path.last.unwrap_or(x.material).bsdf,
            _ => x.material.bsdf,
        };
        let wo = x.wo;
        let f = match self.slip {
            Slip::Light(Light::Swapped) => bsdf.f(n, seen, wo),
            Slip::Light(Light::NoPi) => bsdf.f(n, wo, seen) * PI,
            _ => bsdf.f(n, wo, seen),
        };
        let factor = match self.slip {
            Slip::Light(Light::NoCosine) => light.weight,
            _ => cos * light.weight,
        };
        let weight = self.light_weight(x, &light, seen, cos_at_light);
        Some(DirectLight { radiance: f * light.le * factor, weight, cos_at_light })
    }

    /// A point on an emitter and what it sends, mistakes included.
    fn light(&self, x: &Hit<'_>, cx: &Ctx<'_>, pick: f64, point: (f64, f64)) -> Option<LightSample> {
        let scene = cx.scene();
        let time = if self.slip == Slip::Light(Light::ShutterOpens) { 0.0 } else { cx.time() };
        let sample = |point| scene.sample_light(self.lights, (x.p, time), pick, point);
        if let Slip::Facing(Facing::LightBehind | Facing::LightNegative) = self.slip {
            return sample(point).or_else(|| self.behind(x, scene, pick, point));
        }
        let light = sample(point)?;
        let Slip::Light(slip) = self.slip else { return Some(light) };
        let scaled = |factor: f64| LightSample { weight: light.weight * factor, ..light };
        let squared = light.distance * light.distance;
        Some(match slip {
            Light::NoCosineAtLight if self.is_by_area(scene, &light) => {
                scaled(1.0 / cos_at_light(scene, x, &light))
            }
            Light::NoDistance if light.surface == NOWHERE || self.is_by_area(scene, &light) => {
                scaled(squared)
            }
            Light::NoChoice => scaled(light.pmf),
            Light::UniformChoice => scaled(light.pmf * scene.light_count() as f64),
            Light::DiskRadius if matches!(shape(scene, &light), Some(Shape::Disk(_))) => {
                sample((point.0 * point.0, point.1))?
            }
            Light::Outward => outward(scene, light)?,
            Light::SkyTurned | Light::SkyExponent => mistaken_sky(slip, scene, light),
            _ => light,
        })
    }

    /// Whether the shadow ray finds nothing.
    fn unshadowed(&self, x: &Hit<'_>, light: &LightSample, wi: DVec3, cx: &mut Ctx<'_>) -> bool {
        match self.slip {
            Slip::Shadow(Shadow::None) => {
                cx.visible(x, light.to_light, light.surface); // it is traced, and costs as much
                true
            }
            Slip::Shadow(Shadow::MeetsLight) => cx.visible(x, light.to_light * 1.0001, NOWHERE),
            Slip::Shadow(Shadow::NoEnd) => cx.visible(x, wi * FAR, NOWHERE),
            _ => cx.visible(x, light.to_light, light.surface),
        }
    }

    /// Whether the sampled point is uniform over an area, so that a density per area was converted.
    fn is_by_area(&self, scene: &Scene, light: &LightSample) -> bool {
        shape(scene, light).is_some_and(|shape| match shape {
            Shape::Rectangle(_) | Shape::Triangle(_) => self.lights.points == Points::Area,
            Shape::Disk(_) => true,
            Shape::Sphere(s) => {
                self.lights.points == Points::Area || s.inward || s.low > -1.0 || s.high < 1.0
            }
        })
    }

    /// A point on an emitter that shows `x` its back. Only where all emitters are surfaces at rest.
    fn behind(&self, x: &Hit<'_>, scene: &Scene, pick: f64, point: (f64, f64)) -> Option<LightSample> {
        let emits = |id: &usize| scene.surfaces()[*id].material.le != Rgb::ZERO;
        let ids: Vec<usize> = (0..scene.surfaces().len()).filter(emits).collect();
        if ids.len() != scene.light_count() {
            return None;
        }
        let share = |id: usize| match self.lights.pick {
            Pick::Power => scene.surfaces()[id].shape.area() * scene.surfaces()[id].material.le.element_sum(),
            Pick::Uniform => 1.0,
        };
        let total: f64 = ids.iter().map(|&id| share(id)).sum();
        let mut below = 0.0;
        let id = *ids.iter().find(|&&id| {
            below += share(id);
            pick * total < below
        })?;
        let surface = &scene.surfaces()[id];
        let (p, frame) = surface.sample_area(point);
        let to_light = p - x.p;
        let (distance, pmf) = (to_light.length(), share(id) / total);
        let cos = frame.n.dot(to_light) / distance; // of the back
        let pdf = PdfA(1.0 / surface.shape.area()).per_solid_angle(distance * distance, cos);
        let pdf = PdfW(pmf * pdf.0);
        let sign = if self.slip == Slip::Facing(Facing::LightNegative) { -1.0 } else { 1.0 };
        let le = surface.material.le * sign;
        let surface = id as u32;
        let sample =
            LightSample { to_light, distance, le, weight: 1.0 / pdf.0, pdf: Some(pdf), pmf, surface };
        (cos > 0.0).then_some(sample)
    }
}

fn shape(scene: &Scene, light: &LightSample) -> Option<Shape> {
    scene.surfaces().get(light.surface as usize).map(|surface| surface.shape)
}

/// Cosine at the sampled point; 1 for lights that are no surfaces.
fn cos_at_light(scene: &Scene, x: &Hit<'_>, light: &LightSample) -> f64 {
    let Some(surface) = scene.surfaces().get(light.surface as usize) else { return 1.0 };
    let (_, frame) = surface.at(x.p + light.to_light);
    -frame.n.dot(light.to_light) / light.distance
}

/// The radiance that the sampled point sends away from `x`: none from the back of a surface.
fn outward(scene: &Scene, light: LightSample) -> Option<LightSample> {
    match light.surface {
        NOWHERE => Some(light),
        SKY => {
            let le = scene.sky()?.radiance(-light.to_light / light.distance);
            Some(LightSample { le, ..light })
        }
        _ => None,
    }
}

fn mistaken_sky(slip: Light, scene: &Scene, light: LightSample) -> LightSample {
    let Some(&Sky::Cosine { radiance, exponent, up }) = scene.sky() else { return light };
    if light.surface != SKY {
        return light;
    }
    if slip == Light::SkyExponent {
        let believed = Sky::Cosine { radiance, exponent: exponent + EXPONENT, up };
        let pdf = PdfW(light.pmf * believed.pdf(light.to_light / light.distance).0);
        return LightSample { weight: 1.0 / pdf.0, pdf: Some(pdf), ..light };
    }
    // about a horizontal axis
    let axis = Frame::around(up).to_world(DVec3::X);
    let (along, across) = (axis * axis.dot(light.to_light), axis.cross(light.to_light));
    let to_light = along + (light.to_light - along) * TURN.1 + across * TURN.0;
    LightSample { to_light, ..light }
}
