//! A scene in single precision, for sixteen paths at once.

use super::plates::Plates;
use super::rays::{Nearest, Rays};
use super::rectangles::Rectangles;
use super::spheres::Spheres;
use super::vector::{F, M, U, V3, WIDTH, narrow};
use crate::sampling::warp::Frame;
use crate::scene::{Bsdf, Hit, Rgb, Scene, Shape};
use fearless_simd::{Simd, prelude::*};
use glam::DVec3;

/// As many surfaces cost about as much here, where each is asked, as one path after the other with a tree.
const MOST: usize = 128;

/// The surfaces of a scene, in structures of arrays.
#[derive(Clone)]
pub struct Stage<'a> {
    /// The scene itself, for all that is not worth lanes.
    pub scene: &'a Scene,
    rectangles: Rectangles,
    plates: Plates,
    spheres: Spheres,
    skins: Vec<Skin>,
    has_spheres: bool,
}

/// What is to be known of a surface that was met.
#[derive(Clone, Copy, Debug)]
struct Skin {
    /// Unit normal of the front; of a sphere its centre.
    n: [f32; 3],
    /// Radius of a sphere, negative if its front is the inside; 0 for what is flat.
    radius: f32,
    albedo: [f32; 3],
    emits: bool,
    le: Rgb,
}

/// Where sixteen rays have met Lambert surfaces.
#[derive(Clone, Copy)]
pub struct Meeting<S: Simd> {
    /// Whether they did, on the front.
    pub seen: M<S>,
    /// The points.
    pub p: V3<S>,
    /// Unit normals of the fronts.
    pub n: V3<S>,
    /// What is reflected of the light there.
    pub albedo: V3<S>,
    /// Which surfaces.
    pub id: U<S>,
    /// Those that emit light.
    pub emit: M<S>,
}

impl<'a> Stage<'a> {
    /// The scene in lanes; why not, where there are things that lanes do not know.
    pub fn of(scene: &'a Scene) -> Result<Self, &'static str> {
        let surfaces = scene.surfaces();
        if scene.moves() {
            return Err("something moves");
        }
        if surfaces.len() > MOST {
            return Err("so many surfaces are found sooner through a tree");
        }
        if scene.sky().is_some() {
            return Err("there is a sky");
        }
        if surfaces.iter().any(|s| !matches!(s.material.bsdf, Bsdf::Lambert { .. })) {
            return Err("not all surfaces are matt");
        }
        let skin = |s: &crate::scene::Surface| {
            let (n, radius) = match &s.shape {
                Shape::Sphere(sphere) if sphere.inward => (sphere.center, -sphere.radius),
                Shape::Sphere(sphere) => (sphere.center, sphere.radius),
                flat => (flat.direction(), 0.0),
            };
            let albedo = narrow(s.material.bsdf.albedo(1.0));
            let le = s.material.le;
            Skin { n: narrow(n), radius: radius as f32, albedo, emits: le != Rgb::ZERO, le }
        };
        Ok(Stage {
            scene,
            rectangles: Rectangles::new(surfaces),
            plates: Plates::new(surfaces),
            spheres: Spheres::new(surfaces),
            skins: surfaces.iter().map(skin).collect(),
            has_spheres: surfaces.iter().any(|s| matches!(s.shape, Shape::Sphere(_))),
        })
    }

    /// What rays of unit direction meet first.
    #[inline(always)]
    pub fn meet<S: Simd>(&self, rays: &Rays<S>) -> Meeting<S> {
        let simd = rays.from.token();
        let nothing = Nearest { t: F::splat(simd, f32::INFINITY), id: U::splat(simd, 0) };
        let met = self.plates.nearest(rays, self.rectangles.nearest(rays, nothing));
        let met = self.spheres.nearest(rays, met);
        let (mut n, mut albedo) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        let (mut radius, mut emit) = ([0.0; WIDTH], 0);
        for lane in 0..WIDTH {
            let skin = &self.skins[met.id[lane] as usize];
            for c in 0..3 {
                (n[c][lane], albedo[c][lane]) = (skin.n[c], skin.albedo[c]);
            }
            radius[lane] = skin.radius;
            emit |= u64::from(skin.emits) << lane;
        }
        let (mut p, mut n) = (rays.o + rays.d * met.t, V3::gathered(simd, &n));
        if self.has_spheres {
            (p, n) = on_spheres(p, n, F::simd_from(simd, radius));
        }
        let seen = met.t.simd_lt(f32::INFINITY) & n.dot(rays.d).simd_lt(0.0);
        let emit = seen & M::from_bitmask(simd, emit);
        Meeting { seen, p, n, albedo: V3::gathered(simd, &albedo), id: met.id, emit }
    }

    /// Where nothing stands between `rays.o` and `rays.o + rays.d` on the surfaces `to`.
    #[inline(always)]
    pub fn visible<S: Simd>(&self, rays: &Rays<S>, to: U<S>) -> M<S> {
        !(self.rectangles.block(rays, to) | self.plates.block(rays, to) | self.spheres.block(rays, to))
    }

    /// Radiance that a surface emits [W m^-2 sr^-1].
    #[inline(always)]
    pub fn le(&self, surface: u32) -> Rgb {
        self.skins[surface as usize].le
    }

    /// Whether a surface is flat, and so cannot be seen from itself.
    #[inline(always)]
    pub fn is_flat(&self, surface: u32) -> bool {
        self.skins[surface as usize].radius == 0.0
    }

    /// What one path has met, in double precision.
    pub fn hit(&self, x: &Meeting<impl Simd>, lane: usize, d: DVec3) -> Hit<'a> {
        let (surface, n) = (x.id[lane], x.n.of(lane));
        let material = &self.scene.surfaces()[surface as usize].material;
        let frame = Frame::around(n.normalize());
        Hit { p: x.p.of(lane), frame, wo: -d, material, le: material.le, surface }
    }
}

/// Where radius is not 0: the point on the sphere around `n` that is nearest to `p`, and the normal of the front there.
#[inline(always)]
fn on_spheres<S: Simd>(p: V3<S>, n: V3<S>, radius: F<S>) -> (V3<S>, V3<S>) {
    let curved = radius.simd_ne(0.0);
    let out = (p - n) * (F::splat(radius.token(), 1.0) / radius);
    // one step of Newton's method towards unit length
    let out = out * (out.dot(out) * -0.5 + 1.5);
    ((n + out * radius).or(curved, p), out.or(curved, n))
}
