//! Matte balls in a room, from ten of them to a hundred thousand. The more there are, the smaller they are: they always
//! fill the same part of the same cube, and a ray between them goes past about as many before it meets one.
//!
//! They stand in a cubic lattice, each moved within its cell by what a hash of its number says. No two touch.

use super::lecture::props::{BLUE, GREEN, RED, WHITE, YELLOW, ball, camera, matte, plate, room};
use super::{Material, Rgb, Scene, Sensor, Surface};
use glam::DVec3;

/// How many balls there may be.
pub const COUNTS: std::ops::RangeInclusive<u32> = 10..=100_000;

/// Half the edge of the cube that they fill, and its middle.
const HALF: f64 = 1.0;
const MIDDLE: DVec3 = DVec3::new(0.0, 1.1, 0.0);
/// A ball's radius in units of the edge of a cube of its share of the volume; above 1/3 ten balls would not fit into a
/// lattice of three by three by three cells.
const RADIUS: f64 = 1.0 / 3.0;

/// The scene; lengths are in metres, y points up.
pub fn scene(count: u32, resolution: u32) -> Scene {
    let (low, high) = (DVec3::new(-1.5, 0.0, -1.4), DVec3::new(1.5, 2.6, 4.2));
    let mut surfaces = room(low, high, [Some(matte(WHITE)); 6]);
    let lamp = Material::lambert(Rgb::ZERO, Rgb::new(14.0, 13.0, 11.5));
    surfaces.push(plate(1, 2.59, [-0.6, 2.0], [-1.0, 1.0], -1.0, lamp));
    surfaces.extend(balls(count));
    let camera = camera(DVec3::new(0.9, 1.9, 4.0), DVec3::new(0.0, 1.05, 0.0), 44.0, resolution);
    Scene::new(surfaces, Sensor::Camera(camera))
}

fn balls(count: u32) -> impl Iterator<Item = Surface> {
    let (count, albedos) = (u64::from(count), [WHITE, RED, YELLOW, GREEN, BLUE]);
    let cells = (1..).find(|n| n * n * n >= count).unwrap_or(1);
    let edge = 2.0 * HALF / cells as f64;
    let radius = RADIUS * 2.0 * HALF / libm::cbrt(count as f64);
    let spare = 0.5 * edge - radius;
    (0..count).map(move |i| {
        // where there are more cells than balls, the empty ones are spread evenly
        let cell = i * cells * cells * cells / count;
        let at = |axis: u32| {
            let place = cell / cells.pow(axis) % cells;
            let moved = (2.0 * hashed(3 * i + u64::from(axis)) - 1.0) * spare;
            (place as f64 + 0.5) * edge - HALF + moved
        };
        let albedo = albedos[hashed_bits(i) as usize % albedos.len()];
        ball(MIDDLE + DVec3::new(at(0), at(1), at(2)), radius, matte(albedo))
    })
}

/// A number in [0, 1) that looks random.
fn hashed(i: u64) -> f64 {
    (hashed_bits(i) >> 11) as f64 / (1u64 << 53) as f64
}

/// The output function of SplitMix64 [Steele, Lea and Flood 2014, fig. 14], a bijection.
fn hashed_bits(i: u64) -> u64 {
    let z = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
