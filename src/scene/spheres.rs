//! Spheres: the bands of one sphere are met together, by one pair of roots.
//!
//! Where a ray starts or ends on the sphere, one root is known exactly and the other follows from it without
//! cancellation; so nothing here needs an epsilon.

use super::geometry::SpherePatch;
use super::{Ray, Shape, Surface};
use glam::DVec3;
use std::collections::HashMap;

/// A sphere without its bands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub center: DVec3,
    pub radius: f64,
}

/// The bands of one sphere.
#[derive(Clone, Debug)]
pub(super) struct Sphere {
    pub ball: Ball,
    pub bands: Vec<(SpherePatch, u32)>,
}

/// All spheres of a scene.
#[derive(Clone, Debug)]
pub struct Spheres {
    spheres: Vec<Sphere>,
    /// Which sphere surface i is a band of, or `ABSENT`.
    sphere_of: Vec<u32>,
}

const ABSENT: u32 = u32::MAX;

impl Spheres {
    /// Collects the spheres among `surfaces`.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut all = Spheres { spheres: Vec::new(), sphere_of: vec![ABSENT; surfaces.len()] };
        let mut found = HashMap::new();
        for (id, surface) in surfaces.iter().enumerate() {
            let Shape::Sphere(patch) = surface.shape else { continue };
            let ball = Ball { center: patch.center, radius: patch.radius };
            let sphere = *found.entry(ball.key()).or_insert_with(|| {
                all.spheres.push(Sphere { ball, bands: Vec::new() });
                all.spheres.len() - 1
            });
            all.spheres[sphere].bands.push((patch, id as u32));
            all.sphere_of[id] = sphere as u32;
        }
        all
    }

    /// The spheres in the order of their first bands.
    pub(super) fn all(&self) -> &[Sphere] {
        &self.spheres
    }

    /// Distance and number of the nearest band along a ray of unit direction; infinity if there is none.
    #[inline]
    pub fn nearest(&self, ray: &Ray) -> (f64, u32) {
        if self.spheres.is_empty() {
            return (f64::INFINITY, 0);
        }
        self.nearest_of_some(ray)
    }

    fn nearest_of_some(&self, ray: &Ray) -> (f64, u32) {
        let from = self.sphere_of(ray.from);
        let mut best = (f64::INFINITY, 0);
        for (i, sphere) in self.spheres.iter().enumerate() {
            sphere.ball.nearer(ray, from == i as u32, &mut best, |p| sphere.band_at(p));
        }
        best
    }

    /// Whether a sphere stands on the open segment between two surfaces.
    #[inline]
    pub fn blocks(&self, ray: &Ray, to: u32) -> bool {
        let (from, to) = (self.sphere_of(ray.from), self.sphere_of(to));
        let a = ray.d.length_squared();
        self.spheres.iter().enumerate().any(|(i, sphere)| {
            let ends = (from == i as u32, to == i as u32);
            sphere.ball.blocks(ray, a, ends, |p| sphere.band_at(p).is_some())
        })
    }

    /// The sphere that a surface is a band of; a number that no sphere has for anything else.
    #[inline]
    pub(super) fn sphere_of(&self, surface: u32) -> u32 {
        self.sphere_of.get(surface as usize).copied().unwrap_or(ABSENT - 1)
    }
}

impl Sphere {
    /// The band that a point of the sphere belongs to, if there is one there. Bands are half-open, so that neighbours
    /// share no point and leave no gap; a pole belongs to its band.
    #[inline]
    pub fn band_at(&self, p: DVec3) -> Option<u32> {
        let Ball { center, radius } = self.ball;
        let contains = |b: &SpherePatch| {
            let z = (p - center).dot(b.axis);
            (b.low <= -1.0 || z >= b.low * radius) && (b.high >= 1.0 || z < b.high * radius)
        };
        self.bands.iter().find(|(band, _)| contains(band)).map(|&(_, id)| id)
    }
}

impl Ball {
    /// Puts what the ray meets of this sphere in the place of `best`, distance and number, if it is nearer. `on` says
    /// that the ray starts on the sphere; `band_at` tells which band a point of it belongs to.
    #[inline]
    pub fn nearer(&self, ray: &Ray, on: bool, best: &mut (f64, u32), band_at: impl Fn(DVec3) -> Option<u32>) {
        let Some(roots) = self.roots(ray, 1.0, on) else { return };
        for t in roots {
            if t > 0.0
                && t < best.0
                && let Some(id) = band_at(ray.o + t * ray.d)
            {
                *best = (t, id);
            }
        }
    }

    /// Whether the sphere crosses the open segment; `a` = |d|², `on` and `to` say that its ends lie on the sphere, and
    /// `covers` whether there is a band at a point.
    #[inline]
    pub fn blocks(&self, ray: &Ray, a: f64, (on, to): (bool, bool), covers: impl Fn(DVec3) -> bool) -> bool {
        let inside = |t: f64| t > 0.0 && t < 1.0 && covers(ray.o + t * ray.d);
        match (on, to) {
            (true, true) => false, // a chord meets its sphere at its ends only
            // one root is 1, and the product of the roots is c/a: the other root is c/a
            (false, true) => inside(self.c(ray) / a),
            (on, false) => self.roots(ray, a, on).is_some_and(|roots| roots.iter().any(|&t| inside(t))),
        }
    }

    /// The same for equal spheres only; coordinates of either zero are equal.
    fn key(&self) -> [u64; 4] {
        let DVec3 { x, y, z } = self.center;
        [x, y, z, self.radius].map(|v| (v + 0.0).to_bits())
    }

    /// |o - center|² - radius²
    #[inline]
    fn c(&self, ray: &Ray) -> f64 {
        (ray.o - self.center).length_squared() - self.radius * self.radius
    }

    /// Parameters at which the line meets the sphere, if it does; `a` = |d|²; `on` says that `o` lies on the sphere.
    #[inline]
    fn roots(&self, ray: &Ray, a: f64, on: bool) -> Option<[f64; 2]> {
        let half_b = (ray.o - self.center).dot(ray.d);
        if on {
            return Some([0.0, -2.0 * half_b / a]);
        }
        let c = self.c(ray);
        let discriminant = half_b * half_b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        let far = -(half_b + discriminant.sqrt().copysign(half_b));
        Some([far / a, c / far])
    }
}
