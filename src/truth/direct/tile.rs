//! Means of direct light over a polygonal receiver.

use super::convex::{Halfspace, subtract, vector_area};
use super::form_factor::TOUCH;
use super::visibility::{Blocker, visible_fraction};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The first mesh has sides of at most this fraction of the tile's longest.
const FIRST: f64 = 1.0 / 32.0;

/// Refinement ends here at the latest.
const MOST_TRIANGLES: usize = 50_000;

/// Error, relative to the mean without blockers, from bits of shadow that fall between the points of the first mesh and are nowhere looked for:
/// 4e-8 on the tiles of the Cornell box, as a first mesh twice as fine shows; 3e-7 along a straight shadow border
/// parallel to the mesh.
const UNSEEN: f64 = 1e-6;

/// Mean over `tile` of the visible fraction of `light`, and its error; irradiance = π Le times the mean.
///
/// The tile is a convex planar polygon, lit on the side from which its corners run counter-clockwise. Floor on which a
/// blocker stands counts as dark. The integrand jumps there, so the mesh is aligned to it; elsewhere it is continuous
/// with kinks at the borders of penumbrae, to which the mesh is refined: triangles with errors above average are
/// quartered until the sum of all errors is below `tolerance` times the mean. The error is that sum of absolute local
/// errors, likely too large, and 1e-6 of the mean without blockers more for bits of shadow or light much smaller than
/// the tile.
pub fn mean(tile: &[DVec3], light: &[DVec3], blockers: &[Blocker], tolerance: f64) -> (f64, f64) {
    let area = vector_area(tile);
    let normal = area.normalize();
    let value = |p| visible_fraction(p, normal, light, blockers);
    let step = longest_side(tile) * FIRST;
    let pieces = exposed(tile, blockers);
    let unhidden = unhidden(&pieces, normal, light, step);
    let first = pieces.iter().flat_map(|piece| fan(piece)).flat_map(|corners| refine(corners, step));
    let mut triangles: BinaryHeap<Triangle> = first.map(|corners| Triangle::new(corners, &value)).collect();
    loop {
        let (sum, error) =
            triangles.iter().fold((0.0, 0.0), |(sum, error), t| (sum + t.integral, error + t.error));
        if error <= tolerance * sum || triangles.len() > MOST_TRIANGLES {
            return (sum / area.length(), (error + UNSEEN * unhidden) / area.length());
        }
        let average = error / triangles.len() as f64;
        while triangles.peek().is_some_and(|worst| worst.error >= average) {
            let worst = triangles.pop().expect("just seen");
            triangles.extend(quarters(&worst.corners).map(|corners| Triangle::new(corners, &value)));
        }
    }
}

/// Integral over the pieces of what they would see without blockers, by the midpoint rule of the first mesh.
fn unhidden(pieces: &[Vec<DVec3>], normal: DVec3, light: &[DVec3], step: f64) -> f64 {
    let parts = pieces.iter().flat_map(|piece| fan(piece)).flat_map(|corners| refine(corners, step));
    let seen = |[a, b, c]: [DVec3; 3]| {
        let area = 0.5 * (b - a).cross(c - a).length();
        area * visible_fraction((a + b + c) / 3.0, normal, light, &[])
    };
    parts.map(seen).sum()
}

/// A part of the tile and what is known of the integral over it.
struct Triangle {
    corners: [DVec3; 3],
    integral: f64,
    error: f64,
}

impl Triangle {
    /// The midpoint rule on 1, 4, and 16 parts, extrapolated (Richardson 1911). The error is how far that moved, or the
    /// distance from the trapezoidal rule, which sees kinks outside the parts' midpoints.
    fn new(corners: [DVec3; 3], value: &impl Fn(DVec3) -> f64) -> Self {
        let [coarse, middle, fine] = [0, 1, 2].map(|halvings| midpoint(&corners, halvings, value));
        let (before, after) = (extrapolated(coarse, middle), extrapolated(middle, fine));
        let area = vector_area(&corners).length();
        let error = (after - before).abs().max((after - trapezoidal(&corners, value)).abs());
        Triangle { corners, integral: area * after, error: area * error }
    }
}

/// By error, so that a heap yields the worst.
impl Ord for Triangle {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error)
    }
}

impl PartialOrd for Triangle {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Triangle {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Triangle {}

/// What a second-order rule tends to, from its values at one step and at half the step.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    (4.0 * fine - coarse) / 3.0
}

/// Mean of `value` at the centroids of 4^halvings congruent parts of a triangle.
fn midpoint(triangle: &[DVec3; 3], halvings: u32, value: &impl Fn(DVec3) -> f64) -> f64 {
    if halvings == 0 {
        return value((triangle[0] + triangle[1] + triangle[2]) / 3.0);
    }
    quarters(triangle).iter().map(|part| midpoint(part, halvings - 1, value)).sum::<f64>() / 4.0
}

/// Mean of `value` by the trapezoidal rule on 4 and 16 parts of a triangle, extrapolated.
fn trapezoidal(&[a, b, c]: &[DVec3; 3], value: &impl Fn(DVec3) -> f64) -> f64 {
    let (mut four, mut sixteen) = (0.0, 0.0);
    for i in 0..=4_u32 {
        for j in 0..=4 - i {
            let at = a + (b - a) * (f64::from(i) / 4.0) + (c - a) * (f64::from(j) / 4.0);
            // 6 parts meet inside, 3 on a side, 1 at a corner
            let sides = [i, j, 4 - i - j].iter().filter(|&&k| k == 0).count();
            let sum = [6.0, 3.0, 1.0][sides] * value(at);
            sixteen += sum / 48.0;
            four += if i % 2 == 0 && j % 2 == 0 { sum / 12.0 } else { 0.0 };
        }
    }
    extrapolated(four, sixteen)
}

fn quarters(&[a, b, c]: &[DVec3; 3]) -> [[DVec3; 3]; 4] {
    let (ab, bc, ca) = ((a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0);
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]]
}

/// Parts of a triangle with sides of at most `step`.
fn refine(triangle: [DVec3; 3], step: f64) -> Vec<[DVec3; 3]> {
    if longest_side(&triangle) <= step {
        return vec![triangle];
    }
    quarters(&triangle).into_iter().flat_map(|part| refine(part, step)).collect()
}

/// Convex pieces of a tile outside the faces that stand on it.
fn exposed(tile: &[DVec3], blockers: &[Blocker]) -> Vec<Vec<DVec3>> {
    let normal = vector_area(tile).normalize();
    let tolerance = TOUCH * longest_side(tile);
    let plane = Halfspace::through(tile[0], normal);
    let coplanar = |face: &Vec<DVec3>| face.iter().all(|&corner| plane.depth(corner).abs() <= tolerance);
    let footprints = blockers.iter().flat_map(Blocker::faces).filter(coplanar);
    footprints.fold(vec![tile.to_vec()], |pieces, face| {
        let upward = vector_area(&face);
        let edges = face.iter().zip(face.iter().cycle().skip(1));
        let prism: Vec<Halfspace> =
            edges.map(|(&a, &b)| Halfspace::through(a, upward.cross(b - a).normalize())).collect();
        subtract(pieces, &prism)
    })
}

fn fan(polygon: &[DVec3]) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    polygon[1..].windows(2).map(|edge| [polygon[0], edge[0], edge[1]])
}

fn longest_side(polygon: &[DVec3]) -> f64 {
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    sides.map(|(&a, &b)| (b - a).length()).fold(0.0, f64::max)
}
