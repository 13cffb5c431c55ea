//! What the scenes are built of.

use super::Source;
use crate::scene::camera::Camera;
use crate::scene::geometry::{Rectangle, SpherePatch};
use crate::scene::{Bsdf, Material, PointLight, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;
use std::f64::consts::PI;

pub const WHITE: Rgb = Rgb::new(0.7, 0.7, 0.7);
pub const RED: Rgb = Rgb::new(0.65, 0.12, 0.1);
pub const GREEN: Rgb = Rgb::new(0.15, 0.48, 0.18);
pub const BLUE: Rgb = Rgb::new(0.15, 0.25, 0.6);
pub const YELLOW: Rgb = Rgb::new(0.7, 0.5, 0.1);

/// A surface that reflects alike in all directions and does not emit.
pub fn matte(albedo: Rgb) -> Material {
    Material::lambert(albedo, Rgb::ZERO)
}

/// A surface that does not emit.
pub fn of(bsdf: Bsdf) -> Material {
    Material { bsdf, le: Rgb::ZERO }
}

/// A plane rectangle across a coordinate axis, at the coordinate `at`; `a` and `b` are its ranges along the two axes that
/// follow in cyclic order. Its front looks along the axis, or against it if `front` is negative.
pub fn plate(axis: usize, at: f64, a: [f64; 2], b: [f64; 2], front: f64, material: Material) -> Surface {
    let [along, first, second] = [0, 1, 2].map(|i| DVec3::AXES[(axis + i) % 3]);
    let middle = |r: [f64; 2]| 0.5 * (r[0] + r[1]);
    let center = at * along + middle(a) * first + middle(b) * second;
    let (u, v) = (0.5 * (a[1] - a[0]) * first, 0.5 * (b[1] - b[0]) * second);
    let (half_u, half_v) = if front > 0.0 { (u, v) } else { (v, u) };
    Surface::new(Shape::Rectangle(Rectangle { center, half_u, half_v }), material)
}

/// The inside of a box: its walls across x, y and z, the lower one of each first; where there is no material it is open.
pub fn room(low: DVec3, high: DVec3, walls: [Option<Material>; 6]) -> Vec<Surface> {
    let wall = |(i, material): (usize, Option<Material>)| {
        let (axis, front, ends) = (i / 2, [1.0, -1.0][i % 2], [low, high]);
        let range = |axis: usize| [low[axis % 3], high[axis % 3]];
        Some(plate(axis, ends[i % 2][axis], range(axis + 1), range(axis + 2), front, material?))
    };
    walls.into_iter().enumerate().filter_map(wall).collect()
}

/// A rectangle around `center` that faces `target`, with two edges as level as they can be; half of its level edge and of
/// the other.
pub fn board(center: DVec3, target: DVec3, halves: (f64, f64), material: Material) -> Surface {
    let n = (target - center).normalize();
    let level = if n.x == 0.0 && n.z == 0.0 { DVec3::X } else { DVec3::Y.cross(n).normalize() };
    let (half_u, half_v) = (level * halves.0, n.cross(level) * halves.1);
    Surface::new(Shape::Rectangle(Rectangle { center, half_u, half_v }), material)
}

/// A ball.
pub fn ball(center: DVec3, radius: f64, material: Material) -> Surface {
    let whole = SpherePatch { center, radius, axis: DVec3::Y, low: -1.0, high: 1.0, inward: false };
    Surface::new(Shape::Sphere(whole), material)
}

/// A camera with square images, upright.
pub fn camera(origin: DVec3, target: DVec3, fov_degrees: f64, resolution: u32) -> Camera {
    Camera::pinhole(origin, target - origin, DVec3::Y, fov_degrees, (resolution, resolution))
}

/// A scene lit by a small source at `position`; a square looks at `target`. `intensity` [W/sr] is that straight ahead.
pub fn lit_by(
    source: Source,
    (position, target): (DVec3, DVec3),
    intensity: Rgb,
    mut surfaces: Vec<Surface>,
    camera: Camera,
) -> Scene {
    let sensor = Sensor::Camera(camera);
    match source {
        Source::Square { half } => {
            let le = intensity / (4.0 * half * half);
            surfaces.push(board(position, target, (half, half), Material::lambert(Rgb::ZERO, le)));
            Scene::new(surfaces, sensor)
        }
        Source::Point => Scene::lit_by(surfaces, &[PointLight { position, intensity }], None, sensor),
    }
}

/// A light of the given radiant power [W] and radius, which shines to all sides.
pub fn bulb(center: DVec3, radius: f64, power: Rgb) -> Surface {
    ball(center, radius, Material::lambert(Rgb::ZERO, power / (4.0 * PI * PI * radius * radius)))
}
