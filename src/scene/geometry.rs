//! Rays and shapes. Distances are in units of the ray's direction, which is a unit vector except for shadow rays.

use super::Surface;
use glam::DVec3;
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// Centre.
    pub center: DVec3,
    /// Half of one edge.
    pub half_u: DVec3,
    /// Half of the other edge, perpendicular to the first.
    pub half_v: DVec3,
}

/// Corners counter-clockwise as seen from the front.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// First corner.
    pub a: DVec3,
    /// Second corner.
    pub b: DVec3,
    /// Third corner.
    pub c: DVec3,
}

/// A flat circular plate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disk {
    /// Centre.
    pub center: DVec3,
    /// Unit normal of the front.
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

impl SpherePatch {
    /// Whether the point of the sphere at `q` from its centre belongs to the band.
    /// Half-open, so that neighbouring bands share no point and leave no gap; a pole belongs to its band.
    #[inline]
    fn contains(&self, q: DVec3) -> bool {
        let z = q.dot(self.axis);
        (self.low <= -1.0 || z >= self.low * self.radius) && (self.high >= 1.0 || z < self.high * self.radius)
    }

    /// Parameters at which the line meets the whole sphere, in order, if it does; `a` = |d|².
    /// `on` says that `o` lies on this very sphere: then one root is 0 exactly, and the other needs no cancellation.
    #[inline]
    fn roots(&self, ray: &Ray, a: f64, on: bool) -> Option<(f64, f64)> {
        let oc = ray.o - self.center;
        let half_b = oc.dot(ray.d);
        if on {
            let other = -2.0 * half_b / a;
            return Some((other.min(0.0), other.max(0.0)));
        }
        let c = oc.length_squared() - self.radius * self.radius;
        let discriminant = half_b * half_b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        let far = -(half_b + discriminant.sqrt().copysign(half_b));
        let (r, s) = (far / a, c / far);
        Some((r.min(s), r.max(s)))
    }

    /// Whether `other` is a band of the same sphere.
    #[inline]
    fn same_sphere(&self, other: &Shape) -> bool {
        matches!(other, Shape::Sphere(o) if o.center == self.center && o.radius == self.radius)
    }

    #[inline]
    fn contains_at(&self, ray: &Ray, t: f64) -> bool {
        self.contains(ray.o + t * ray.d - self.center)
    }
}

impl Shape {
    /// Distance to this shape (number `id`) along a ray of unit direction, infinite if it is missed.
    #[inline]
    pub fn intersect(&self, ray: &Ray, id: u32, all: &[Surface]) -> f64 {
        match self {
            Shape::Sphere(s) => {
                let on = ray.from == id || is_on(s, ray.from, all);
                let Some((near, far)) = s.roots(ray, 1.0, on) else {
                    return f64::INFINITY;
                };
                if near > 0.0 && s.contains_at(ray, near) {
                    near
                } else if far > 0.0 && s.contains_at(ray, far) {
                    far
                } else {
                    f64::INFINITY
                }
            }
            flat if ray.from != id => flat.intersect_plane(ray),
            _ => f64::INFINITY,
        }
    }

    /// Whether this shape (number `id`) stands on the open segment between two surfaces.
    #[inline]
    pub fn blocks(&self, ray: &Ray, id: u32, to: u32, all: &[Surface]) -> bool {
        match self {
            Shape::Sphere(s) => {
                let on_from = ray.from == id || is_on(s, ray.from, all);
                if to == id || is_on(s, to, all) {
                    // one root is 1 exactly, and the product of the roots is c/a: the other root is c/a
                    let other = if on_from {
                        return false;
                    } else {
                        let c = (ray.o - s.center).length_squared() - s.radius * s.radius;
                        c / ray.d.length_squared()
                    };
                    return other > 0.0 && other < 1.0 && s.contains_at(ray, other);
                }
                let Some((near, far)) = s.roots(ray, ray.d.length_squared(), on_from) else {
                    return false;
                };
                let inside = |t: f64| t > 0.0 && t < 1.0 && s.contains_at(ray, t);
                inside(near) || inside(far)
            }
            flat => ray.from != id && to != id && flat.intersect_plane(ray) < 1.0,
        }
    }

    /// Distance to a triangle or disk (rectangles have their own lanes, but answer here too).
    fn intersect_plane(&self, ray: &Ray) -> f64 {
        let (origin, n) = match self {
            Shape::Rectangle(r) => (r.center, r.half_u.cross(r.half_v)),
            Shape::Triangle(t) => (t.a, (t.b - t.a).cross(t.c - t.a)),
            Shape::Disk(d) => (d.center, d.normal),
            Shape::Sphere(_) => unreachable!("a sphere is not flat"),
        };
        let t = n.dot(origin - ray.o) / n.dot(ray.d);
        if t > 0.0 && self.flat_contains(ray.o + t * ray.d - origin) {
            t
        } else {
            f64::INFINITY
        }
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
            Shape::Sphere(_) => unreachable!("a sphere is not flat"),
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

/// Whether surface `id` is a band of the same sphere as `s`.
#[inline]
fn is_on(s: &SpherePatch, id: u32, all: &[Surface]) -> bool {
    all.get(id as usize).is_some_and(|surface| s.same_sphere(&surface.shape))
}
