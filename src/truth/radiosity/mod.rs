//! Deterministic radiance of the empty Cornell box by radiosity: no random numbers, hence a truth that shares no code and
//! no source of error with the estimators under test.
//!
//! The room is the unit cube, all surfaces are Lambertian. Radiance is projected on piecewise constants (Galerkin;
//! Goral, Torrance, Greenberg & Battaile 1984) with exact exchange areas, and summed as a Neumann series, one term per
//! bounce. Emission and once-scattered light are exact; errors of later bounces have an expansion in powers of the mesh
//! width, which extrapolation from several meshes removes term by term (Richardson 1911).

mod exchange;
mod kernel;
mod mesh;
mod series;
mod solution;
#[cfg(test)]
mod tests;

pub use mesh::{Rect, WALLS, Wall};
pub use solution::{Solution, Value};

use crate::scene::{Rgb, cornell_flush};
use series::Discrete;
use std::ops::Range;

/// Bounces 0..=BOUNCES are given one by one, later ones as a sum.
pub const BOUNCES: usize = 16;

/// Refinements of the meshes from which values are extrapolated, ascending.
const MESHES: [usize; 5] = [2, 3, 4, 5, 6];

/// To be raised whenever results change without a change of the numbers in [`key`].
const VERSION: u32 = 1;

/// The rectangle of a wall where one coordinate is constant.
fn rect(axis: usize, at: f64, a: &Range<f64>, b: &Range<f64>) -> Rect {
    let wall = match (axis, at > 0.5) {
        (1, false) => 0,
        (1, true) => 1,
        (0, false) => 2,
        (0, true) => 3,
        (_, true) => 4,
        (_, false) => 5,
    };
    Rect { wall, range: [[a.start, a.end], [b.start, b.end]] }
}

/// The tiles over which radiance is averaged.
fn tiles() -> [Rect; 6] {
    cornell_flush::TILES.map(|(axis, at, a, b)| rect(axis, at, &a, &b))
}

/// A Lambertian surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Per channel, 0..1.
    pub albedo: [f64; 3],
    /// Emitted radiance per channel [W m^-2 sr^-1].
    pub emission: [f64; 3],
}

/// A unit cube, its walls in the order of [`WALLS`], with one rectangular panel that replaces its wall there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Surfaces of the walls.
    pub walls: [Surface; 6],
    /// Place of the panel; the error expansion holds if it touches no edge of the cube, or does so along a tile's lines.
    pub panel: Rect,
    /// Surface of the panel.
    pub panel_surface: Surface,
}

impl Room {
    /// The flush Cornell box without blocks.
    pub fn cornell_flush() -> Self {
        use cornell_flush::{GREEN, LIGHT, RED, WHITE};
        let dark = |albedo: Rgb| Surface { albedo: albedo.to_array(), emission: [0.0; 3] };
        let [x, z] = &LIGHT;
        Room {
            walls: [WHITE, WHITE, GREEN, RED, WHITE, Rgb::ZERO].map(dark),
            panel: rect(1, 1.0, x, z),
            panel_surface: Surface { albedo: [0.0; 3], emission: [1.0; 3] },
        }
    }

    /// Whether any light comes from the wall.
    fn is_active(&self, wall: usize) -> bool {
        let lit = |surface: &Surface| surface.albedo != [0.0; 3] || surface.emission != [0.0; 3];
        lit(&self.walls[wall]) || (self.panel.wall == wall && lit(&self.panel_surface))
    }
}

/// Mean radiance of the tiles of [`Room::cornell_flush`]. Takes seconds and about 0.5 GB; the result has the same bits on
/// every machine and for any number of threads.
pub fn solve() -> Solution {
    extrapolate(&Room::cornell_flush(), &MESHES).expect("albedos below 1 make the series converge")
}

/// Everything [`solve`]'s result depends on, as text.
pub fn key() -> String {
    let room = Room::cornell_flush();
    let (spacing, tiles) = (mesh::SPACING, tiles());
    format!("radiosity {VERSION}; {room:?}; {tiles:?}; bounces {BOUNCES}; meshes {MESHES:?} of {spacing:?}")
}

/// Values extrapolated from `meshes`, ascending, two or more. `None` if the series does not converge.
fn extrapolate(room: &Room, meshes: &[usize]) -> Option<Solution> {
    let levels: Option<Vec<Vec<f64>>> = meshes.iter().map(|&m| Discrete::new(room, m).solve()).collect();
    Some(Solution::new(meshes, &levels?))
}
