//! Direct light for sixteen paths at once: from a lone rectangle in lanes, from all else path by path.

use super::rays::Rays;
use super::stage::{Meeting, Stage};
use super::stream::Streams;
use super::vector::{F, M, U, V3, lanes, narrow};
use crate::scene::{LightSample, LightSampling, Points, Shape, geometry::Rectangle};
use fearless_simd::{Simd, prelude::*};
use glam::DVec3;
use std::f32::consts::FRAC_1_PI;

/// The only emitter of a scene, a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    center: [f32; 3],
    half_u: [f32; 3],
    half_v: [f32; 3],
    n: [f32; 3],
    area: f32,
    le: [f32; 3],
    id: u32,
}

/// Sampled points on emitters, as sixteen vertices see them.
#[derive(Clone, Copy)]
pub struct Ways<S: Simd> {
    /// Where light can come, if nothing stands between.
    pub open: M<S>,
    /// From the vertex to the point.
    pub to_light: V3<S>,
    /// The emitter.
    pub to: U<S>,
    /// Density of the direction [1/sr]; infinite for a light without extent.
    pub pdf: F<S>,
    /// What is reflected, visibility aside: f cos θ le / pdf [W m^-2 sr^-1].
    pub radiance: V3<S>,
}

impl Lamp {
    /// The lone rectangular emitter of a scene whose points are drawn over its area, if there is one.
    pub fn of(stage: &Stage<'_>, lights: LightSampling) -> Option<Self> {
        let id = stage.scene.only_emitter()?;
        let surface = &stage.scene.surfaces()[id as usize];
        let Shape::Rectangle(Rectangle { center, half_u, half_v }) = surface.shape else { return None };
        (lights.points == Points::Area).then(|| Lamp {
            center: narrow(center),
            half_u: narrow(half_u),
            half_v: narrow(half_v),
            n: narrow(surface.shape.direction()),
            area: surface.shape.area() as f32,
            le: narrow(surface.material.le),
            id,
        })
    }

    /// Next-event estimation [Veach 1997, eq. 8.2] towards the lamp, for the paths of a mask.
    #[inline(always)]
    pub fn sample<S: Simd>(&self, x: &Meeting<S>, alive: M<S>, streams: &mut Streams<S>) -> Ways<S> {
        let simd = alive.token();
        let (u, v) = streams.u2(alive);
        let across =
            V3::splat(simd, self.half_u) * (u * 2.0 - 1.0) + V3::splat(simd, self.half_v) * (v * 2.0 - 1.0);
        let to_light = V3::splat(simd, self.center) + across - x.p;
        let squared = to_light.dot(to_light);
        let inverse = F::splat(simd, 1.0) / squared.sqrt();
        let cos_light = -to_light.along(&self.n) * inverse;
        let cos = x.n.dot(to_light) * inverse;
        // what is flat does not light itself; rounding would now and then see a shadow ray off
        let elsewhere = x.id.simd_ne(self.id);
        let open = alive & elsewhere & cos_light.simd_gt(0.0) & cos.simd_gt(0.0);
        let area_pdf = F::splat(simd, 1.0 / self.area);
        let pdf = area_pdf * squared / cos_light;
        let radiance = x.albedo.times(V3::splat(simd, self.le)) * (cos * FRAC_1_PI / pdf);
        Ways { open, to_light, to: U::splat(simd, self.id), pdf, radiance }
    }
}

/// The same from whatever emits, path by path, by the code of the scene itself.
#[inline(always)]
pub fn sample<S: Simd>(
    stage: &Stage<'_>,
    lights: LightSampling,
    x: &Meeting<S>,
    alive: M<S>,
    streams: &mut Streams<S>,
) -> Ways<S> {
    let simd = alive.token();
    let zero = F::splat(simd, 0.0);
    let several = stage.scene.light_count() > 1;
    let pick = if several { streams.u1(alive) } else { zero };
    let (u, v) = streams.u2(alive);
    let nothing = V3::splat(simd, [0.0; 3]);
    let mut ways =
        Ways { open: alive, to_light: nothing, to: U::splat(simd, 0), pdf: zero, radiance: nothing };
    for lane in lanes(alive) {
        let (p, n) = (x.p.of(lane), x.n.of(lane));
        let point = (f64::from(u[lane]), f64::from(v[lane]));
        let light = sample_one(stage, lights, p, f64::from(pick[lane]), point);
        let light = light.map(|light| (light, n.dot(light.to_light / light.distance)));
        let itself = |surface| surface == x.id[lane] && stage.is_flat(surface);
        let Some((light, cos)) = light.filter(|(light, cos)| *cos > 0.0 && !itself(light.surface)) else {
            ways.open.set(lane, false);
            continue;
        };
        ways.to_light.set(lane, light.to_light);
        ways.to[lane] = light.surface;
        ways.pdf[lane] = light.pdf.map_or(f32::INFINITY, |pdf| pdf.0 as f32);
        let f = x.albedo.of(lane) * f64::from(FRAC_1_PI);
        ways.radiance.set(lane, f * light.le * (cos * light.weight));
    }
    ways
}

/// Once for all instruction sets: it is long.
#[inline(never)]
fn sample_one(
    stage: &Stage<'_>,
    lights: LightSampling,
    p: DVec3,
    pick: f64,
    point: (f64, f64),
) -> Option<LightSample> {
    stage.scene.sample_light(lights, (p, 0.0), pick, point)
}

impl<S: Simd> Ways<S> {
    /// The shadow rays.
    #[inline(always)]
    pub fn rays(&self, x: &Meeting<S>) -> Rays<S> {
        Rays { o: x.p, d: self.to_light, from: x.id }
    }
}
