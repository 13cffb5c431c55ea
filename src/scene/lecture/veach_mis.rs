//! Four metal plates, each rougher than the one behind, turned so that each mirrors a row of four lamps to the camera. The
//! lamps have the same power and different sizes: on the smooth plates the large ones are found by continued directions,
//! on the rough ones the small ones by points on the lamps [in the spirit of Veach 1997, fig. 9.2].

use super::props::{board, bulb, camera, matte, plate};
use crate::scene::{Bsdf, Material, Rgb, Scene, Sensor};
use glam::DVec3;

/// Radius and place along the row.
const LAMPS: [(f64, f64); 4] = [(0.9, 3.9), (0.3, 1.3), (0.1, -1.3), (0.0333, -3.9)];
/// Roughness, and where the plate's middle is in y and z: the smoothest is farthest from the camera.
const PLATES: [(f64, f64, f64); 4] =
    [(0.005, -2.8, 0.3), (0.02, -3.5, 1.6), (0.06, -4.05, 3.1), (0.15, -4.4, 4.8)];
const EYE: DVec3 = DVec3::new(0.0, 2.0, 15.0);

pub fn scene(resolution: u32) -> Scene {
    let middle = DVec3::new(0.0, 0.0, 0.0);
    let mut surfaces = vec![
        plate(1, -5.2, [-10.0, 14.0], [-12.0, 12.0], 1.0, matte(Rgb::splat(0.25))),
        plate(2, -3.5, [-12.0, 12.0], [-5.2, 8.0], 1.0, matte(Rgb::splat(0.25))),
    ];
    // of each colour another part, so that reflections can be told apart
    let tints = [
        Rgb::new(1.0, 0.75, 0.5),
        Rgb::new(0.7, 1.0, 0.6),
        Rgb::new(0.6, 0.75, 1.0),
        Rgb::new(1.0, 0.7, 0.9),
    ];
    for ((radius, x), tint) in LAMPS.into_iter().zip(tints) {
        surfaces.push(bulb(DVec3::new(x, middle.y, middle.z), radius, 120.0 * tint));
    }
    for (alpha, y, z) in PLATES {
        let center = DVec3::new(0.0, y, z);
        // silver, about
        let metal = Bsdf::Glossy { alpha, eta: Rgb::new(0.16, 0.14, 0.13), k: Rgb::new(4.0, 3.1, 2.3) };
        let material = Material { bsdf: metal, le: Rgb::ZERO };
        let bisector = (middle - center).normalize() + (EYE - center).normalize();
        surfaces.push(board(center, center + bisector, (4.6, 0.55), material));
    }
    let camera = camera(EYE, DVec3::new(0.0, -1.9, 1.5), 40.0, resolution);
    Scene::new(surfaces, Sensor::Camera(camera))
}
