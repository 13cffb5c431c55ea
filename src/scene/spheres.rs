//! Spheres: the bands of one sphere are met together, by one pair of roots.
//!
//! Where a ray starts or ends on the sphere, one root is known exactly and the other follows from it without
//! cancellation; so nothing here needs an epsilon.

use super::geometry::SpherePatch;
use super::{Ray, Shape, Surface};
use glam::DVec3;

/// The bands of one sphere.
#[derive(Clone, Debug)]
struct Sphere {
    center: DVec3,
    radius: f64,
    bands: Vec<(SpherePatch, u32)>,
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
        for (id, surface) in surfaces.iter().enumerate() {
            let Shape::Sphere(patch) = surface.shape else { continue };
            let same = |s: &Sphere| s.center == patch.center && s.radius == patch.radius;
            let sphere = all.spheres.iter().position(same).unwrap_or_else(|| {
                let (center, radius) = (patch.center, patch.radius);
                all.spheres.push(Sphere { center, radius, bands: Vec::new() });
                all.spheres.len() - 1
            });
            all.spheres[sphere].bands.push((patch, id as u32));
            all.sphere_of[id] = sphere as u32;
        }
        all
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
            let Some(roots) = sphere.roots(ray, 1.0, from == i as u32) else { continue };
            for t in roots {
                if t > 0.0
                    && t < best.0
                    && let Some(id) = sphere.band_at(ray.o + t * ray.d)
                {
                    best = (t, id);
                }
            }
        }
        best
    }

    /// Whether a sphere stands on the open segment between two surfaces.
    #[inline]
    pub fn blocks(&self, ray: &Ray, to: u32) -> bool {
        let (from, to) = (self.sphere_of(ray.from), self.sphere_of(to));
        let a = ray.d.length_squared();
        let inside =
            |sphere: &Sphere, t: f64| t > 0.0 && t < 1.0 && sphere.band_at(ray.o + t * ray.d).is_some();
        self.spheres.iter().enumerate().any(|(i, sphere)| {
            match (from == i as u32, to == i as u32) {
                (true, true) => false, // a chord meets its sphere at its ends only
                // one root is 1, and the product of the roots is c/a: the other root is c/a
                (false, true) => inside(sphere, sphere.c(ray) / a),
                (on, false) => {
                    sphere.roots(ray, a, on).is_some_and(|roots| roots.iter().any(|&t| inside(sphere, t)))
                }
            }
        })
    }

    #[inline]
    fn sphere_of(&self, surface: u32) -> u32 {
        self.sphere_of.get(surface as usize).copied().unwrap_or(ABSENT - 1)
    }
}

impl Sphere {
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

    /// The band that a point of the sphere belongs to, if there is one there. Bands are half-open, so that neighbours
    /// share no point and leave no gap; a pole belongs to its band.
    #[inline]
    fn band_at(&self, p: DVec3) -> Option<u32> {
        let contains = |b: &SpherePatch| {
            let z = (p - self.center).dot(b.axis);
            (b.low <= -1.0 || z >= b.low * self.radius) && (b.high >= 1.0 || z < b.high * self.radius)
        };
        self.bands.iter().find(|(band, _)| contains(band)).map(|&(_, id)| id)
    }
}
