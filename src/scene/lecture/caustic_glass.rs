//! A ball of glass under a small lamp, which it images onto the floor, a little out of focus.

use super::Source;
use super::props::{BLUE, RED, WHITE, ball, camera, lit_by, matte, of, room};
use crate::scene::{Bsdf, Rgb, Scene};
use glam::DVec3;

/// Right under the ceiling.
const LAMP: DVec3 = DVec3::new(0.35, 1.98, -0.15);
/// A lens of this index and radius images the lamp 2.3 radii below its middle; the floor lies a bit nearer.
const BALL: (DVec3, f64) = (DVec3::new(0.05, 0.62, 0.1), 0.3);

pub fn scene(source: Source, resolution: u32) -> Scene {
    let walls = [RED, BLUE, WHITE, WHITE, WHITE].map(|albedo| Some(matte(albedo)));
    let [left, right, floor, ceiling, back] = walls;
    let mut surfaces = room(
        DVec3::new(-1.0, 0.0, -1.0),
        DVec3::new(1.0, 2.0, 1.0),
        [left, right, floor, ceiling, back, None],
    );
    surfaces.push(ball(BALL.0, BALL.1, of(Bsdf::Dielectric { ior: 1.5 })));
    let camera = camera(DVec3::new(0.0, 1.15, 4.0), DVec3::new(0.0, 0.9, 0.0), 36.0, resolution);
    lit_by(source, (LAMP, LAMP - DVec3::Y), Rgb::new(1.0, 0.95, 0.85), surfaces, camera)
}
