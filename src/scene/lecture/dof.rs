//! Five balls in a row that runs away from a camera with a thin lens; the middle one is in focus.

use super::props::{BLUE, GREEN, RED, WHITE, YELLOW, ball, board, camera, matte, plate};
use crate::scene::camera::{Camera, Lens};
use crate::scene::{Material, Rgb, Scene, Sensor};
use glam::DVec3;

const EYE: DVec3 = DVec3::new(0.0, 1.2, 4.0);
const RADIUS: f64 = 0.26;
/// Where they stand, in x and z, nearest first.
const BALLS: [(f64, f64); 5] = [(-0.62, 1.7), (-0.25, 0.9), (0.28, 0.0), (0.99, -1.2), (1.96, -3.0)];
/// Which one is in focus.
const SHARP: usize = 2;

pub fn scene(aperture: f64, resolution: u32) -> Scene {
    let albedos = [RED, YELLOW, Rgb::new(0.45, 0.2, 0.5), GREEN, BLUE];
    let place = |i: usize| DVec3::new(BALLS[i].0, RADIUS, BALLS[i].1);
    let mut surfaces = vec![
        plate(1, 0.0, [-5.0, 4.5], [-5.0, 5.0], 1.0, matte(WHITE)),
        plate(2, -5.0, [-5.0, 5.0], [0.0, 5.0], 1.0, matte(Rgb::new(0.45, 0.5, 0.6))),
    ];
    surfaces.extend(albedos.iter().enumerate().map(|(i, &albedo)| ball(place(i), RADIUS, matte(albedo))));
    let lamp = Material::lambert(Rgb::ZERO, Rgb::new(24.0, 22.0, 18.0));
    surfaces.push(board(DVec3::new(-1.5, 4.5, 1.5), DVec3::new(0.0, 0.0, -1.0), (0.6, 0.6), lamp));
    let camera = camera(EYE, DVec3::new(0.0, 0.35, 0.0), 42.0, resolution);
    let focus = (place(SHARP) - EYE).dot(camera.forward);
    let lens = Some(Lens { radius: aperture, focus });
    Scene::new(surfaces, Sensor::Camera(Camera { lens, ..camera }))
}
