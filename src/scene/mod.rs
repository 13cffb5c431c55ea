//! What is lit and what looks at it: surfaces, emitters and a sensor. Knows nothing of estimators.
//!
//! Every surface is one-sided: it reflects and emits on its front and is black from behind.
//! There is no epsilon anywhere: a ray knows the surface that it leaves, and a flat surface cannot hit itself,
//! while a sphere's second intersection follows from the first.

pub mod bsdf;
pub mod camera;
mod cornell;
pub mod geometry;
pub mod lanes;
pub mod library;
pub mod light;
pub mod solid_angle;
pub mod spheres;
mod surface;

pub use bsdf::{Directions, Material};
pub use camera::Sensor;
pub use geometry::{Ray, Shape};
pub use light::{LightSample, LightSampling};
pub use surface::Surface;

use crate::sampling::warp::Frame;
use glam::DVec3;
use lanes::RectangleLanes;
use light::Lights;
use spheres::Spheres;

/// Red, green, blue: radiance [W m^-2 sr^-1], albedo or throughput, component by component.
pub type Rgb = DVec3;

/// The front of a surface, met by a ray.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    /// The point [scene units].
    pub p: DVec3,
    /// Frame around the unit normal on the front side.
    pub frame: Frame,
    /// Albedo and emission at the point.
    pub material: &'a Material,
    /// Which surface was hit.
    pub surface: u32,
}

impl Hit<'_> {
    /// The ray that leaves this point in the unit direction `wi`.
    #[inline]
    pub fn spawn(&self, wi: DVec3) -> Ray {
        Ray { o: self.p, d: wi, from: self.surface }
    }
}

/// An immutable scene with its sensor.
#[derive(Clone, Debug)]
pub struct Scene {
    surfaces: Vec<Surface>,
    rectangles: RectangleLanes,
    spheres: Spheres,
    /// Triangles and disks.
    others: Vec<u32>,
    lights: Lights,
    /// What is measured.
    pub sensor: Sensor,
}

impl Scene {
    /// A scene of the given surfaces, in the given order.
    pub fn new(surfaces: Vec<Surface>, sensor: Sensor) -> Self {
        let lights = Lights::new(&surfaces);
        let rectangles = RectangleLanes::new(&surfaces);
        let spheres = Spheres::new(&surfaces);
        let is_other = |s: &Surface| matches!(s.shape, Shape::Triangle(_) | Shape::Disk(_));
        let others = (0u32..).zip(&surfaces).filter(|(_, s)| is_other(s)).map(|(id, _)| id).collect();
        Scene { surfaces, rectangles, spheres, others, lights, sensor }
    }

    /// The nearest surface along the ray, if it shows its front: a back is black, as is the void around an open scene.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit<'_>> {
        let (mut t, mut id) = self.rectangles.nearest(ray);
        let (t_sphere, sphere) = self.spheres.nearest(ray);
        if t_sphere < t {
            (t, id) = (t_sphere, sphere);
        }
        for &other in self.others.iter().filter(|&&other| other != ray.from) {
            let candidate = self.surfaces[other as usize].shape.intersect_flat(ray);
            if candidate < t {
                (t, id) = (candidate, other);
            }
        }
        if t == f64::INFINITY {
            return None;
        }
        let surface = &self.surfaces[id as usize];
        let (p, frame) = surface.at(ray.o + t * ray.d);
        let front = frame.n.dot(ray.d) < 0.0;
        front.then_some(Hit { p, frame, material: &surface.material, surface: id })
    }

    /// Whether nothing stands between the point `ray.o` on surface `ray.from` and `ray.o + ray.d` on surface `to`.
    #[inline]
    pub fn visible(&self, ray: &Ray, to: u32) -> bool {
        let blocks = |&other: &u32| {
            other != ray.from && other != to && self.surfaces[other as usize].shape.intersect_flat(ray) < 1.0
        };
        !self.rectangles.blocks(ray, to) && !self.spheres.blocks(ray, to) && !self.others.iter().any(blocks)
    }

    /// A point on an emitter as seen from `p`, the emitter picked in proportion to its power.
    /// `u` picks the light, `v` the point. `None` where the sampled point cannot send light to `p` (visibility aside).
    #[inline]
    pub fn sample_light(&self, how: LightSampling, p: DVec3, u: f64, v: (f64, f64)) -> Option<LightSample> {
        self.lights.sample(&self.surfaces, how, p, u, v)
    }

    /// The surfaces in their order.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// How many emitters there are; with one there is nothing to pick.
    #[inline]
    pub fn light_count(&self) -> usize {
        self.lights.count()
    }

    /// The largest albedo of any surface and channel: bounds how slowly throughput can fall.
    pub fn max_albedo(&self) -> f64 {
        self.surfaces.iter().map(|s| s.material.albedo.max_element()).fold(0.0, f64::max)
    }
}
