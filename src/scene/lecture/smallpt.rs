//! The scene of smallpt, a path tracer in 99 lines [Beason 2008]: a room whose walls are spheres of radius 1e5, a mirror
//! ball, a glass ball and a lamp, which is the cap of a sphere of radius 600 that comes through the ceiling.
//!
//! Of the lamp's sphere only the cap is here: the rest is hidden by the ceiling, and sampled light would nearly always
//! come from it. Glass reflects after Fresnel here, where smallpt has Schlick's approximation, and is clear, where smallpt
//! lets 0.999 through an interface. smallpt filters its pixels by tents, which reach into the neighbours.

use super::props::{ball, matte, of};
use crate::scene::camera::Camera;
use crate::scene::geometry::SpherePatch;
use crate::scene::{Bsdf, Material, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;

/// Half the image's height at unit distance.
const HALF_HEIGHT: f64 = 0.5135 / 2.0;
/// The front wall stands between the eye and the room, so rays start behind it. In smallpt they start at 140, the highest
/// four of 768 rows above the ceiling; from here on all start in the room, and nothing stands in between.
const NEAR: f64 = 130.0;
const WALL: f64 = 1e5;

pub fn scene(resolution: u32) -> Scene {
    let wall = |x, y, z, albedo| {
        let center = DVec3::new(x, y, z);
        let inside = SpherePatch { center, radius: WALL, axis: DVec3::Y, low: -1.0, high: 1.0, inward: true };
        Surface::new(Shape::Sphere(inside), matte(albedo))
    };
    let (red, blue) = (Rgb::new(0.75, 0.25, 0.25), Rgb::new(0.25, 0.25, 0.75));
    let grey = Rgb::splat(0.75);
    // the highest 0.37 of 600: where it meets the ceiling, 0.27 are below
    let (radius, low) = (600.0, 1.0 - 0.37 / 600.0);
    let center = DVec3::new(50.0, 681.6 - 0.27, 81.6);
    let cap = SpherePatch { center, radius, axis: DVec3::NEG_Y, low, high: 1.0, inward: false };
    let surfaces = vec![
        wall(WALL + 1.0, 40.8, 81.6, red),
        wall(-WALL + 99.0, 40.8, 81.6, blue),
        wall(50.0, 40.8, WALL, grey),
        wall(50.0, 40.8, -WALL + 170.0, Rgb::ZERO),
        wall(50.0, WALL, 81.6, grey),
        wall(50.0, -WALL + 81.6, 81.6, grey),
        ball(DVec3::new(27.0, 16.5, 47.0), 16.5, of(Bsdf::Mirror { reflectance: Rgb::splat(0.999) })),
        ball(DVec3::new(73.0, 16.5, 78.0), 16.5, of(Bsdf::Dielectric { ior: 1.5 })),
        Surface::new(Shape::Sphere(cap), Material::lambert(Rgb::ZERO, Rgb::splat(12.0))),
    ];
    Scene::new(surfaces, Sensor::Camera(camera(resolution)))
}

/// 1024 x 768 pixels in the original; square pixels at any height.
fn camera(height: u32) -> Camera {
    let width = (4 * height + 1) / 3;
    let forward = DVec3::new(0.0, -0.042612, -1.0).normalize();
    let right = DVec3::X * (HALF_HEIGHT * f64::from(width) / f64::from(height));
    let up = DVec3::X.cross(forward).normalize() * HALF_HEIGHT;
    let origin = DVec3::new(50.0, 52.0, 295.6);
    Camera { origin, forward, right, up, width, height, lens: None, near: NEAR }
}
