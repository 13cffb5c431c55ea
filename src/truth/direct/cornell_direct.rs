//! Direct light in the flush Cornell box with its two blocks, averaged over its tiles, by exact visibility.

use super::tile::mean;
use super::visibility::Blocker;
use crate::scene::Shape;
use crate::scene::cornell_flush::{BLOCKS, Block, LIGHT, TILES, plate};
use glam::DVec3;

/// Mean over a tile of the visible fraction F of the light's cosine-weighted solid angle, and its error: direct
/// radiance = albedo · Le · F. Floor under a block counts as dark. `tolerance` is relative: see [`mean`].
pub fn direct(tile: usize, tolerance: f64) -> (f64, f64) {
    mean(&corners(tile), &light(), &blocks(), tolerance)
}

/// Corners of a tile, counter-clockwise as seen from inside the box.
pub fn corners(tile: usize) -> Vec<DVec3> {
    let (axis, at, a, b) = &TILES[tile];
    Shape::Rectangle(plate(*axis, *at, a, b)).corners()
}

/// Corners of the light, counter-clockwise as seen from below.
pub fn light() -> Vec<DVec3> {
    let [x, z] = &LIGHT;
    Shape::Rectangle(plate(1, 1.0, x, z)).corners()
}

/// The short and the tall block; both stand on the floor.
pub fn blocks() -> [Blocker; 2] {
    BLOCKS.map(|Block { corner, u, v, height }| {
        let flat = |[x, z]: [f64; 2]| DVec3::new(x, 0.0, z) / 555.0;
        Blocker::parallelepiped(flat(corner), flat(u), flat(v), DVec3::Y * (height / 555.0))
    })
}
