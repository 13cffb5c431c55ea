//! Direct light with exact visibility. Of a polygonal light, a point sees what is left outside the shadow volumes of
//! the convex blockers (Crow 1977); each of these is an intersection of half-spaces, so that convex pieces are left,
//! and Lambert's formula holds for each.

use super::convex::{Halfspace, subtract, vector_area};
use super::form_factor::{TOUCH, above_horizon, lambert};
use glam::DVec3;

/// A convex opaque polyhedron, or a plate without thickness.
#[derive(Clone, Debug)]
pub struct Blocker {
    corners: Vec<DVec3>,
    faces: Vec<Face>,
    edges: Vec<Edge>,
    /// Largest distance between the first and another corner.
    size: f64,
}

#[derive(Clone, Debug)]
struct Face {
    ring: Vec<usize>,
    /// The side of its plane where the body is, with a unit normal.
    inside: Halfspace,
}

/// Between two faces; runs counter-clockwise around `left`.
#[derive(Clone, Debug)]
struct Edge {
    from: usize,
    to: usize,
    left: usize,
    right: usize,
}

impl Blocker {
    /// A convex solid: each face lists its corners counter-clockwise as seen from outside.
    ///
    /// # Panics
    /// If the faces do not close.
    pub fn solid(corners: Vec<DVec3>, faces: &[&[usize]]) -> Self {
        let face = |ring: &&[usize]| {
            let ring = ring.to_vec();
            let polygon: Vec<DVec3> = ring.iter().map(|&i| corners[i]).collect();
            Face { ring, inside: Halfspace::through(polygon[0], -vector_area(&polygon).normalize()) }
        };
        let faces: Vec<Face> = faces.iter().map(face).collect();
        let edges = edges(&faces);
        let size = corners.iter().map(|&c| (c - corners[0]).length()).fold(0.0, f64::max);
        Blocker { corners, faces, edges, size }
    }

    /// A convex planar polygon, opaque from both sides.
    pub fn plate(corners: &[DVec3]) -> Self {
        let front: Vec<usize> = (0..corners.len()).collect();
        let back: Vec<usize> = front.iter().rev().copied().collect();
        Blocker::solid(corners.to_vec(), &[&front, &back])
    }

    /// The parallelepiped with a corner at `corner` and edges `u`, `v`, `w`, a right-handed system.
    pub fn parallelepiped(corner: DVec3, u: DVec3, v: DVec3, w: DVec3) -> Self {
        let base = [corner, corner + u, corner + u + v, corner + v];
        let corners = base.into_iter().chain(base.map(|c| c + w)).collect();
        let sides: [&[usize]; 6] =
            [&[3, 2, 1, 0], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
        Blocker::solid(corners, &sides)
    }

    /// Corners of each face, counter-clockwise as seen from outside.
    pub fn faces(&self) -> impl Iterator<Item = Vec<DVec3>> + '_ {
        self.faces.iter().map(|face| face.ring.iter().map(|&i| self.corners[i]).collect())
    }

    /// What the body hides from `p`, itself included, as half-spaces relative to `p`: within the planes through `p` and
    /// the silhouette, and behind every face turned to `p`. A point on the body is in front of no face, and what lies
    /// inwards is hidden from it; inside the body, everything is.
    pub fn shadow(&self, p: DVec3) -> Vec<Halfspace> {
        let touch = TOUCH * (self.size + (p - self.corners[0]).length());
        let heights: Vec<f64> = self.faces.iter().map(|face| -face.inside.depth(p)).collect();
        // An edge that points at p has no plane with p, but lies between two faces seen edge-on, neither a front.
        let front = |face: usize| heights[face] > touch;
        let silhouette = self.edges.iter().filter(|e| front(e.left) != front(e.right)).map(|e| {
            let (a, b) = (self.corners[e.from] - p, self.corners[e.to] - p);
            let normal = if front(e.left) { b.cross(a) } else { a.cross(b) };
            Halfspace { normal, offset: 0.0 }
        });
        let fronts = self.faces.iter().zip(&heights).filter(|&(_, &height)| height >= -touch);
        let behind = fronts.map(|(face, &height)| Halfspace { normal: face.inside.normal, offset: height });
        silhouette.chain(behind).collect()
    }
}

fn edges(faces: &[Face]) -> Vec<Edge> {
    let directed = |ring: &[usize]| -> Vec<(usize, usize)> {
        ring.iter().copied().zip(ring.iter().copied().cycle().skip(1)).collect()
    };
    let mut edges = Vec::new();
    for (left, face) in faces.iter().enumerate() {
        for (from, to) in directed(&face.ring) {
            let right = faces.iter().position(|other| directed(&other.ring).contains(&(to, from)));
            let right = right.expect("every edge of a closed body adjoins two faces");
            if left < right {
                edges.push(Edge { from, to, left, right });
            }
        }
    }
    edges
}

/// The fraction F of the cosine-weighted hemisphere over the element at `p` with unit normal `n` that the unhidden part
/// of a convex polygonal light covers: irradiance = π Le F. In [0, 1], to 1e-14 or so.
///
/// The light is one-sided as in [`polygon`](super::form_factor::polygon). Blockers may lie anywhere, also behind the
/// light, across its plane, or into each other.
pub fn visible_fraction(p: DVec3, n: DVec3, light: &[DVec3], blockers: &[Blocker]) -> f64 {
    let seen = above_horizon(p, n, light);
    if seen.is_empty() {
        return 0.0;
    }
    let lit = blockers.iter().fold(vec![seen], |pieces, blocker| subtract(pieces, &blocker.shadow(p)));
    lit.iter().map(|piece| lambert(n, piece)).sum::<f64>().clamp(0.0, 1.0)
}
