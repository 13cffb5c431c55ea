//! Planar polygons cut by half-spaces (Sutherland, Hodgman 1974) and freed of convex bodies.

use glam::DVec3;

/// The points q with `normal · q >= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halfspace {
    /// Points into the half-space; of any length.
    pub normal: DVec3,
    /// In units of `normal` times length.
    pub offset: f64,
}

impl Halfspace {
    /// The half-space whose border holds `point`.
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        Halfspace { normal, offset: normal.dot(point) }
    }

    /// How deep `q` lies inside, in units of |normal|; negative outside.
    pub fn depth(&self, q: DVec3) -> f64 {
        self.normal.dot(q) - self.offset
    }

    /// The other side of the border.
    pub fn complement(&self) -> Self {
        Halfspace { normal: -self.normal, offset: -self.offset }
    }

    /// The part of a polygon inside, its sense of rotation kept; empty if nothing but a corner or an edge is.
    ///
    /// Cutting by `self` and by `complement()` gives cuts of the same bits, so that sums over the parts cancel there.
    pub fn clip(&self, polygon: &[DVec3]) -> Vec<DVec3> {
        let mut kept = Vec::with_capacity(polygon.len() + 2);
        for (&a, &b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            let (at_a, at_b) = (self.depth(a), self.depth(b));
            if at_a >= 0.0 {
                kept.push(a);
            }
            if (at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0) {
                kept.push(a + (b - a) * (at_a / (at_a - at_b)));
            }
        }
        if kept.len() < 3 { Vec::new() } else { kept }
    }

    fn misses(&self, polygon: &[DVec3]) -> bool {
        polygon.iter().all(|&q| self.depth(q) <= 0.0)
    }
}

/// Convex pieces of what is left of convex polygons outside the body in which all the half-spaces meet; without
/// half-spaces the body is all of space.
pub fn subtract(polygons: Vec<Vec<DVec3>>, body: &[Halfspace]) -> Vec<Vec<DVec3>> {
    let mut left = Vec::with_capacity(polygons.len() + body.len());
    for mut rest in polygons {
        if body.iter().any(|side| side.misses(&rest)) {
            left.push(rest);
            continue;
        }
        // outside the first side; inside the first and outside the second; ...
        for side in body {
            let outside = side.complement().clip(&rest);
            if !outside.is_empty() {
                left.push(outside);
            }
            rest = side.clip(&rest);
        }
    }
    left
}

/// Area times unit normal; seen from its tip, the corners run counter-clockwise.
pub fn vector_area(corners: &[DVec3]) -> DVec3 {
    let Some(&first) = corners.first() else { return DVec3::ZERO };
    corners.windows(2).map(|edge| (edge[0] - first).cross(edge[1] - first)).sum::<DVec3>() * 0.5
}
