//! The smallest photon map: one photon, and the light that it leaves near the point that is looked at.
//!
//! Inside a sphere the part within chord distance r of a point has the area π r² exactly, and irradiance is uniform; so
//! there, and only there, the estimate is unbiased whatever r is.

use crate::estimator::{Ctx, Roulette};
use crate::sampling::warp::cosine_hemisphere;
use crate::scene::{Hit, Ray, Rgb, Scene, Shape};
use std::f64::consts::PI;

/// A photon density estimate, with or without a mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Density {
    /// Without.
    Sound,
    /// A cosine that the density of photons has already.
    Cosine,
    /// What the point emits is left out.
    NoEmission,
    /// Divided by the number of photons that were stored, not sent.
    ByStored,
    /// Several photons, each with the power of all.
    Undivided,
}

/// Photons that [`Density::Undivided`] sends.
pub const SENT: u32 = 4;

/// Radius of the density estimate over the sphere's.
const REACH: f64 = 0.35;

/// Draws one sample. Photons survive by the albedo, whatever rule is claimed; its limit holds.
pub fn estimate(density: Density, roulette: &Roulette, ray: &Ray, cx: &mut Ctx<'_>) {
    let Some(x) = cx.hit(ray) else { return };
    if density != Density::NoEmission {
        cx.add(0, x.le);
    }
    let sent = if density == Density::Undivided { SENT } else { 1 };
    (0..sent).for_each(|_| photon(density, roulette, &x, cx));
}

/// Sends one photon and adds the light that it leaves near `x`.
fn photon(density: Density, roulette: &Roulette, x: &Hit<'_>, cx: &mut Ctx<'_>) {
    let Some((mut ray, mut power)) = send(cx) else { return };
    let reach = REACH * radius(cx.scene());
    let scale = x.albedo() / (PI * PI * reach * reach);
    let (mut bounce, mut found) = (0u32, Vec::new());
    while let Some(y) = cx.hit(&ray) {
        bounce += 1;
        if !roulette.reaches(bounce) {
            break;
        }
        let near = |y: &Hit<'_>| (y.p - x.p).length() < reach && y.frame.n.dot(x.frame.n) > 0.0;
        if near(&y) {
            let extra = if density == Density::Cosine { y.frame.n.dot(y.wo) } else { 1.0 };
            found.push((bounce, scale * power * extra));
        }
        let q = y.albedo().max_element();
        if cx.u1() >= q {
            break;
        }
        let wi = y.frame.to_world(cosine_hemisphere(cx.u2()));
        (ray, power) = (y.spawn(wi), power * y.albedo() / q);
    }
    let stored = if density == Density::ByStored { f64::from(bounce) } else { 1.0 };
    found.into_iter().for_each(|(bounce, radiance)| cx.add(bounce, radiance / stored));
}

/// A photon from a point uniform over an emitter that is picked by power, and the power that it stands for [W].
fn send(cx: &mut Ctx<'_>) -> Option<(Ray, Rgb)> {
    let surfaces = cx.scene().surfaces();
    let power = |id: usize| surfaces[id].material.le * (PI * surfaces[id].shape.area());
    let total: f64 = (0..surfaces.len()).map(|id| power(id).element_sum()).sum();
    let (mut left, point, direction) = (cx.u1() * total, cx.u2(), cx.u2());
    let id = (0..surfaces.len()).find(|&id| {
        left -= power(id).element_sum();
        left < 0.0
    })?;
    let (o, frame) = surfaces[id].sample_area(point);
    let ray = Ray { o, d: frame.to_world(cosine_hemisphere(direction)), from: id as u32 };
    Some((ray, power(id) * (total / power(id).element_sum())))
}

/// Radius of the scene's first sphere; 1 without one.
fn radius(scene: &Scene) -> f64 {
    let sphere = |shape: &Shape| if let Shape::Sphere(s) = shape { Some(s.radius) } else { None };
    scene.surfaces().iter().find_map(|s| sphere(&s.shape)).unwrap_or(1.0)
}
