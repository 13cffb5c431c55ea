//! What is lit and what looks at it: surfaces, emitters and a sensor. Knows nothing of estimators.
//!
//! Every surface is one-sided, but for clear interfaces: it reflects and emits on its front and is black from behind.
//! There is no epsilon anywhere: a ray knows the surface that it leaves, and a flat surface cannot hit itself,
//! while a sphere's second intersection follows from the first.

pub mod bsdf;
pub mod camera;
pub mod connection;
mod cornell;
pub mod cornell_flush;
mod crowd;
pub mod fresnel;
pub mod geometry;
pub mod lanes;
pub mod lecture;
pub mod library;
pub mod light;
pub mod many_spheres;
pub mod microfacet;
pub mod sky;
pub mod solid_angle;
pub mod spheres;
mod surface;
mod tree;

pub use bsdf::{Bsdf, Carried, DirectionSample, Directions, Material};
pub use camera::Sensor;
pub use connection::Connection;
pub use geometry::{Ray, Shape};
pub use light::emission::Emission;
pub use light::{LightSample, LightSampling, Pick, PointLight, Points};
pub use sky::Sky;
pub use surface::Surface;

use crate::sampling::warp::Frame;
use crate::sampling::{PdfW, Stream};
use crowd::Crowd;
use glam::DVec3;
use lanes::RectangleLanes;
use light::Lights;
use sky::{BLACK, SKY};
use spheres::Spheres;

/// Red, green, blue: radiance [W m^-2 sr^-1], albedo or throughput, component by component.
pub type Rgb = DVec3;

/// A surface met by a ray: its front, either side of a clear interface, or the sky.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    /// The point [scene units].
    pub p: DVec3,
    /// Frame around the unit normal on the front side.
    pub frame: Frame,
    /// Unit direction back along the ray.
    pub wo: DVec3,
    /// What is there.
    pub material: &'a Material,
    /// Radiance emitted towards `wo` [W m^-2 sr^-1].
    pub le: Rgb,
    /// Which surface was hit.
    pub surface: u32,
}

impl Hit<'_> {
    /// The ray that leaves this point in the unit direction `wi`.
    #[inline]
    pub fn spawn(&self, wi: DVec3) -> Ray {
        Ray { o: self.p, d: wi, from: self.surface }
    }

    /// Whether it is the sky, where nothing scatters.
    #[inline]
    pub fn is_sky(&self) -> bool {
        self.surface == SKY
    }

    /// Fraction of the light that goes on towards `wo`, channel by channel.
    #[inline(always)]
    pub fn albedo(&self) -> Rgb {
        self.material.bsdf.albedo(self.frame.n.dot(self.wo).abs())
    }
}

/// An immutable scene with its sensor.
#[derive(Clone, Debug)]
pub struct Scene {
    surfaces: Vec<Surface>,
    rectangles: RectangleLanes,
    spheres: Spheres,
    /// Triangles, disks and what moves.
    others: Vec<u32>,
    /// Primitives that are too many for the three lists above, and not in them.
    crowd: Option<Crowd>,
    moves: bool,
    lights: Lights,
    /// What is measured.
    pub sensor: Sensor,
}

/// Where a path starts.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// The first ray.
    pub ray: Ray,
    /// Factor that turns its radiance into the measured quantity.
    pub response: f64,
    /// The moment at which all of the path happens, in [0, 1) of the exposure.
    pub time: f64,
    /// The pixel that it measures, row by row from the top left.
    pub pixel: u32,
}

impl Scene {
    /// A scene of the given surfaces, in the given order.
    pub fn new(surfaces: Vec<Surface>, sensor: Sensor) -> Self {
        Scene::lit_by(surfaces, &[], None, sensor)
    }

    /// A scene that is lit by its surfaces, by points and by the sky.
    pub fn lit_by(surfaces: Vec<Surface>, points: &[PointLight], sky: Option<Sky>, sensor: Sensor) -> Self {
        let (low, high) = surfaces
            .iter()
            .map(|s| s.shape.bounds())
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)));
        let around = (0.5 * (low + high), 0.5 * (high - low).length());
        let lights = Lights::new(&surfaces, points, sky, around);
        Scene::of(Crowd::new(&surfaces), surfaces, lights, sensor)
    }

    /// The same scene without a tree: each of its primitives is asked in turn, for the tree to be held to.
    pub fn without_tree(&self) -> Self {
        Scene::of(None, self.surfaces.clone(), self.lights.clone(), self.sensor)
    }

    fn of(crowd: Option<Crowd>, surfaces: Vec<Surface>, lights: Lights, sensor: Sensor) -> Self {
        let listed = |is_crowded: bool| if is_crowded { &[] } else { &surfaces[..] };
        let rectangles = RectangleLanes::new(listed(crowd.as_ref().is_some_and(Crowd::has_rectangles)));
        let spheres = Spheres::new(listed(crowd.is_some()));
        let is_other = |s: &Surface| {
            let is_crowded = crowd.is_some() && Crowd::takes(s);
            s.moves() || matches!(s.shape, Shape::Triangle(_) | Shape::Disk(_)) && !is_crowded
        };
        let others = (0u32..).zip(&surfaces).filter(|(_, s)| is_other(s)).map(|(id, _)| id).collect();
        let moves = surfaces.iter().any(Surface::moves);
        Scene { surfaces, rectangles, spheres, others, crowd, moves, lights, sensor }
    }

    /// Draws the start of a path that measures pixel `(x, y)`, from the top left.
    #[inline]
    pub fn start(&self, pixel: (u32, u32), stream: &mut Stream) -> Start {
        let (ray, response) = self.sensor.ray(pixel, stream);
        let time = if self.moves { stream.u1() } else { 0.0 };
        Start { ray, response, time, pixel: pixel.1 * self.sensor.resolution().0 + pixel.0 }
    }

    /// What the ray meets first at `time`: `None` for the void around an open scene and for a back, which is black.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, time: f64) -> Option<Hit<'_>> {
        let (mut t, mut id) = self.rectangles.nearest(ray);
        let (t_sphere, sphere) = self.spheres.nearest(ray);
        if t_sphere < t {
            (t, id) = (t_sphere, sphere);
        }
        let mut skin = None;
        if let Some(crowd) = &self.crowd {
            (t, id, skin) = crowd.nearer(ray, (t, id));
        }
        for &other in self.others.iter().filter(|&&other| other != ray.from) {
            let candidate = self.surfaces[other as usize].intersect_flat(ray, time);
            if candidate < t {
                (t, id, skin) = (candidate, other, None);
            }
        }
        if t == f64::INFINITY {
            return self.lights.sky().map(|sky| sky_hit(sky, ray));
        }
        let p = ray.o + t * ray.d;
        let ((p, frame), material) = match skin {
            None => {
                let surface = &self.surfaces[id as usize];
                (surface.at(p), &surface.material)
            }
            Some(skin) => (skin.at(p), skin.material),
        };
        let front = frame.n.dot(ray.d) < 0.0;
        let le = if front { material.le } else { Rgb::ZERO };
        let seen = front || material.bsdf.is_clear();
        seen.then_some(Hit { p, frame, wo: -ray.d, material, le, surface: id })
    }

    /// Whether nothing stands between the point `ray.o` on surface `ray.from` and `ray.o + ray.d` on surface `to`.
    #[inline(always)]
    pub fn visible(&self, ray: &Ray, time: f64, to: u32) -> bool {
        let blocks = |&other: &u32| {
            other != ray.from && other != to && self.surfaces[other as usize].intersect_flat(ray, time) < 1.0
        };
        !self.rectangles.blocks(ray, to)
            && !self.spheres.blocks(ray, to)
            && !self.crowd.as_ref().is_some_and(|crowd| crowd.blocks(ray, to))
            && !self.others.iter().any(blocks)
    }

    /// A point on an emitter as seen from `p` at `time`. `u` picks the light, `v` the point.
    /// `None` where the sampled point cannot send light to `p` (visibility aside).
    #[inline(always)]
    pub fn sample_light(
        &self,
        how: LightSampling,
        at: (DVec3, f64),
        u: f64,
        v: (f64, f64),
    ) -> Option<LightSample> {
        self.lights.sample(&self.surfaces, how, at, u, v)
    }

    /// Density [1/sr] with which [`Scene::sample_light`] at `ray.o` would have drawn the way to what `ray` hit.
    #[inline]
    pub fn light_pdf(&self, how: LightSampling, ray: &Ray, hit: &Hit<'_>, time: f64) -> PdfW {
        self.lights.pdf(&self.surfaces, how, ray, hit, time)
    }

    /// A particle that leaves a light at `time`; `None` in the dark. See [`Emission`].
    #[inline]
    pub fn emit(&self, time: f64, u: f64, v: (f64, f64), w: (f64, f64)) -> Option<Emission> {
        self.lights.emit(&self.surfaces, time, u, v, w)
    }

    /// Whether anything moves while the shutter is open.
    #[inline]
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// The surfaces in their order.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The lights without extent, but for those that are dark.
    pub fn points(&self) -> impl Iterator<Item = &PointLight> {
        self.lights.points()
    }

    /// The surface that emits all light, if there is just one emitter.
    pub fn only_emitter(&self) -> Option<u32> {
        self.lights.only_surface()
    }

    /// The environment, if there is one.
    pub fn sky(&self) -> Option<&Sky> {
        self.lights.sky()
    }

    /// How many emitters there are; with one there is nothing to pick.
    #[inline]
    pub fn light_count(&self) -> usize {
        self.lights.count()
    }

    /// The largest albedo of any surface and channel: bounds how slowly throughput can fall. Clear interfaces do not
    /// count, because walks leave them by geometry; metals do as they reflect what falls on them straight.
    pub fn max_albedo(&self) -> f64 {
        let opaque = self.surfaces.iter().map(|s| s.material.bsdf).filter(|bsdf| !bsdf.is_clear());
        opaque.map(|bsdf| bsdf.albedo(1.0).max_element()).fold(0.0, f64::max)
    }
}

#[inline(always)]
fn sky_hit<'a>(sky: &Sky, ray: &Ray) -> Hit<'a> {
    let (p, frame) = (ray.o + ray.d * sky::FAR, Frame::around(-ray.d));
    Hit { p, frame, wo: -ray.d, material: &BLACK, le: sky.radiance(ray.d), surface: SKY }
}
