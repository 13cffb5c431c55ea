//! A mirror ring on the floor, lit from above one side: the far half throws a bright curve with a cusp on the floor that
//! it stands around, as a cup does on coffee.

use super::Source;
use super::props::{WHITE, camera, lit_by, matte, of, room};
use crate::scene::geometry::SpherePatch;
use crate::scene::{Bsdf, Rgb, Scene, Shape, Surface};
use glam::DVec3;

/// Beside the camera's left, so high that it shines over the near rim onto the far wall.
const LAMP: DVec3 = DVec3::new(-1.15, 0.95, 0.75);
/// A band of a sphere from its equator upwards: a ring of radius 0.6 m, 24 cm high, leaning in a little.
const RING: SpherePatch = SpherePatch {
    center: DVec3::new(0.0, 0.0, 0.0),
    radius: 0.6,
    axis: DVec3::Y,
    low: 0.0,
    high: 0.4,
    inward: true,
};

pub fn scene(source: Source, resolution: u32) -> Scene {
    let (floor, wall) = (Some(matte(WHITE)), Some(matte(Rgb::new(0.35, 0.4, 0.45))));
    let mut surfaces =
        room(DVec3::new(-1.3, 0.0, -1.3), DVec3::new(1.3, 2.0, 1.3), [wall, wall, floor, wall, wall, None]);
    let copper = of(Bsdf::Mirror { reflectance: Rgb::new(0.95, 0.8, 0.65) });
    surfaces.push(Surface::new(Shape::Sphere(RING), copper));
    // a mirror is black from behind: a coat of paint around it
    let coat = SpherePatch { radius: RING.radius + 0.01, inward: false, ..RING };
    surfaces.push(Surface::new(Shape::Sphere(coat), matte(Rgb::new(0.25, 0.15, 0.1))));
    let camera = camera(DVec3::new(0.2, 1.7, 2.3), DVec3::new(0.0, 0.1, 0.0), 36.0, resolution);
    lit_by(source, (LAMP, DVec3::new(0.1, 0.0, -0.1)), Rgb::new(1.0, 0.95, 0.9), surfaces, camera)
}
