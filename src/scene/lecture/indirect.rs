//! A closed room whose lamp hangs behind a partition and shines into the corner there: what the camera sees has been
//! scattered in the corner, and then at least once more.

use super::props::{GREEN, RED, WHITE, board, camera, matte, plate, room};
use crate::scene::{Material, Rgb, Scene, Sensor};
use glam::DVec3;

/// Sides of the partition in x, and where it ends, 75 cm before the front wall.
const PARTITION: ([f64; 2], f64) = ([-0.55, -0.5], 0.75);

pub fn scene(resolution: u32) -> Scene {
    let walls = [WHITE, GREEN, WHITE, WHITE, RED, WHITE].map(|albedo| Some(matte(albedo)));
    let mut surfaces = room(DVec3::new(-1.5, 0.0, -1.5), DVec3::new(1.5, 2.2, 1.5), walls);
    let (sides, end) = PARTITION;
    surfaces.push(plate(0, sides[0], [0.0, 2.2], [-1.5, end], -1.0, matte(WHITE)));
    surfaces.push(plate(0, sides[1], [0.0, 2.2], [-1.5, end], 1.0, matte(WHITE)));
    surfaces.push(plate(2, end, sides, [0.0, 2.2], 1.0, matte(WHITE)));
    // a chest in the room, for shadows to show where light comes from
    surfaces.push(plate(1, 0.5, [-1.0, -0.2], [0.3, 1.1], 1.0, matte(WHITE)));
    surfaces.push(plate(2, -0.2, [0.3, 1.1], [0.0, 0.5], 1.0, matte(WHITE)));
    surfaces.push(plate(2, -1.0, [0.3, 1.1], [0.0, 0.5], -1.0, matte(WHITE)));
    surfaces.push(plate(0, 0.3, [0.0, 0.5], [-1.0, -0.2], -1.0, matte(WHITE)));
    surfaces.push(plate(0, 1.1, [0.0, 0.5], [-1.0, -0.2], 1.0, matte(WHITE)));
    let lamp = Material::lambert(Rgb::ZERO, Rgb::new(90.0, 80.0, 60.0));
    let (at, corner) = (DVec3::new(-0.75, 1.3, -0.9), DVec3::new(-1.5, 1.3, -1.35));
    surfaces.push(board(at, corner, (0.15, 0.15), lamp));
    let camera = camera(DVec3::new(1.3, 1.3, 1.4), DVec3::new(-0.3, 0.85, -0.3), 68.0, resolution);
    Scene::new(surfaces, Sensor::Camera(camera))
}
