//! Rays and shapes. Distances are in units of the ray's direction, which is a unit vector except for shadow rays.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A half line, or for visibility the segment from `o` to `o + d`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub o: DVec3,
    /// Where it goes.
    pub d: DVec3,
    /// The surface that `o` lies on, or [`NOWHERE`].
    pub from: u32,
}

/// The `from` of a ray that starts in free space.
pub const NOWHERE: u32 = u32::MAX;

/// Points center + a half_u + b half_v with a, b in [-1, 1]; front = half_u x half_v.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// Centre.
    #[schemars(with = "[f64; 3]")]
    pub center: DVec3,
    /// Half of one edge.
    #[schemars(with = "[f64; 3]")]
    pub half_u: DVec3,
    /// Half of the other edge, perpendicular to the first.
    #[schemars(with = "[f64; 3]")]
    pub half_v: DVec3,
}

/// Corners counter-clockwise as seen from the front.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// First corner.
    #[schemars(with = "[f64; 3]")]
    pub a: DVec3,
    /// Second corner.
    #[schemars(with = "[f64; 3]")]
    pub b: DVec3,
    /// Third corner.
    #[schemars(with = "[f64; 3]")]
    pub c: DVec3,
}

/// A flat circular plate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disk {
    /// Centre.
    #[schemars(with = "[f64; 3]")]
    pub center: DVec3,
    /// Unit normal of the front.
    #[schemars(with = "[f64; 3]")]
    pub normal: DVec3,
    /// Radius.
    pub radius: f64,
}

/// The band of a sphere where the cosine to `axis` lies in [low, high); whole sphere: low = -1, high = 1 (then closed).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpherePatch {
    /// Centre of the sphere.
    pub center: DVec3,
    /// Radius.
    pub radius: f64,
    /// Unit vector from which the band's cosines are measured.
    pub axis: DVec3,
    /// Lower limit of the cosine.
    pub low: f64,
    /// Upper limit of the cosine.
    pub high: f64,
    /// Whether the front is the inside.
    pub inward: bool,
}

/// Everything that can be hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A rectangle.
    Rectangle(Rectangle),
    /// A triangle.
    Triangle(Triangle),
    /// A disk.
    Disk(Disk),
    /// A sphere, or a band of it.
    Sphere(SpherePatch),
}

impl Rectangle {
    /// Unit normal of the front.
    pub fn normal(&self) -> DVec3 {
        self.half_u.cross(self.half_v).normalize()
    }
}

impl Shape {
    /// Distance to this flat shape along the ray, infinite if it is missed or is a sphere (see [`super::spheres`]).
    /// Rectangles have their own lanes, but answer here too.
    pub fn intersect_flat(&self, ray: &Ray) -> f64 {
        let (origin, n) = match self {
            Shape::Rectangle(r) => (r.center, r.half_u.cross(r.half_v)),
            Shape::Triangle(t) => (t.a, (t.b - t.a).cross(t.c - t.a)),
            Shape::Disk(d) => (d.center, d.normal),
            Shape::Sphere(_) => return f64::INFINITY,
        };
        let t = n.dot(origin - ray.o) / n.dot(ray.d);
        if t > 0.0 && self.flat_contains(ray.o + t * ray.d - origin) { t } else { f64::INFINITY }
    }

    /// Whether the in-plane offset `q` from the shape's origin lies inside its outline.
    fn flat_contains(&self, q: DVec3) -> bool {
        match self {
            Shape::Rectangle(r) => {
                q.dot(r.half_u).abs() <= r.half_u.length_squared()
                    && q.dot(r.half_v).abs() <= r.half_v.length_squared()
            }
            Shape::Triangle(t) => {
                let (e, f) = (t.b - t.a, t.c - t.a);
                let n = e.cross(f);
                let scale = n.length_squared();
                let (b, c) = (n.dot(q.cross(f)) / scale, n.dot(e.cross(q)) / scale);
                b >= 0.0 && c >= 0.0 && b + c <= 1.0
            }
            Shape::Disk(d) => q.length_squared() <= d.radius * d.radius,
            Shape::Sphere(_) => false,
        }
    }

    /// The centre, or the first corner.
    pub fn origin(&self) -> DVec3 {
        match self {
            Shape::Rectangle(r) => r.center,
            Shape::Triangle(t) => t.a,
            Shape::Disk(d) => d.center,
            Shape::Sphere(s) => s.center,
        }
    }

    /// Corners of a flat shape with straight edges, counter-clockwise as seen from its front; none of other shapes.
    pub fn corners(&self) -> Vec<DVec3> {
        match self {
            Shape::Rectangle(r) => {
                let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                signs.map(|(a, b)| r.center + a * r.half_u + b * r.half_v).to_vec()
            }
            Shape::Triangle(t) => vec![t.a, t.b, t.c],
            Shape::Disk(_) | Shape::Sphere(_) => Vec::new(),
        }
    }

    /// Lowest and highest coordinates of a box around it (not always the smallest).
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let around = |center: DVec3, reach: DVec3| (center - reach, center + reach);
        match self {
            Shape::Rectangle(r) => around(r.center, r.half_u.abs() + r.half_v.abs()),
            Shape::Triangle(t) => (t.a.min(t.b).min(t.c), t.a.max(t.b).max(t.c)),
            Shape::Disk(d) => around(d.center, DVec3::splat(d.radius)),
            Shape::Sphere(s) => around(s.center, DVec3::splat(s.radius)),
        }
    }

    /// Area of the surface (one side).
    pub fn area(&self) -> f64 {
        match self {
            Shape::Rectangle(r) => 4.0 * r.half_u.length() * r.half_v.length(),
            Shape::Triangle(t) => 0.5 * (t.b - t.a).cross(t.c - t.a).length(),
            Shape::Disk(d) => PI * d.radius * d.radius,
            Shape::Sphere(s) => 2.0 * PI * s.radius * s.radius * (s.high - s.low),
        }
    }

    /// The front's unit normal; for a sphere, its axis.
    pub fn direction(&self) -> DVec3 {
        match self {
            Shape::Rectangle(r) => r.normal(),
            Shape::Triangle(t) => (t.b - t.a).cross(t.c - t.a).normalize(),
            Shape::Disk(d) => d.normal,
            Shape::Sphere(s) => s.axis,
        }
    }
}
