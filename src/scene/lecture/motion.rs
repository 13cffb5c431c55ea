//! A board that moves to the right while the shutter is open, beside one at rest, and the shadows of both on the floor.

use super::props::{BLUE, GREEN, RED, WHITE, board, camera, matte, plate};
use crate::scene::{Material, Rgb, Scene, Sensor, Surface};
use glam::DVec3;

pub fn scene(travel: f64, resolution: u32) -> Scene {
    let lamp = Material::lambert(Rgb::ZERO, Rgb::new(80.0, 76.0, 68.0));
    let upright =
        |x: f64, z: f64, albedo| plate(2, z, [x - 0.22, x + 0.22], [0.25, 0.95], 1.0, matte(albedo));
    let moving = upright(-0.9, -0.25, RED);
    let surfaces = vec![
        plate(1, 0.0, [-2.0, 4.0], [-3.0, 3.0], 1.0, matte(WHITE)),
        plate(2, -2.0, [-3.0, 3.0], [0.0, 4.0], 1.0, matte(Rgb::new(0.45, 0.5, 0.6))),
        upright(-0.2, -0.75, BLUE),
        Surface::moving(moving.shape, moving.material, DVec3::X * travel),
        // a shelf below the lamp that moves towards the camera, and throws a shadow that does
        Surface::moving(
            board(DVec3::new(0.95, 0.5, -0.3), DVec3::new(0.95, 2.0, -0.3), (0.25, 0.15), matte(GREEN)).shape,
            matte(GREEN),
            DVec3::Z * (0.5 * travel),
        ),
        board(DVec3::new(0.6, 3.0, 1.6), DVec3::new(0.0, 0.0, -0.3), (0.15, 0.15), lamp),
    ];
    let camera = camera(DVec3::new(0.1, 1.5, 3.6), DVec3::new(0.1, 0.35, -0.3), 40.0, resolution);
    Scene::new(surfaces, Sensor::Camera(camera))
}
