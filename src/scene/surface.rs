//! A shape with its material and what is worth computing once.

use super::{Material, Ray, Shape};
use crate::sampling::warp::{self, Frame};
use glam::DVec3;

/// A shape and what it is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Where it is; its front is the side its normal points to.
    pub shape: Shape,
    /// What it is made of.
    pub material: Material,
    /// Way that it goes while the shutter is open, from time 0 to time 1; zero for a sphere.
    pub velocity: DVec3,
    /// Frame around the front's normal; for a sphere, around its axis.
    frame: Frame,
}

impl Surface {
    /// A surface at rest.
    pub fn new(shape: Shape, material: Material) -> Self {
        Surface::moving(shape, material, DVec3::ZERO)
    }

    /// A surface that goes this way while the shutter is open.
    pub fn moving(shape: Shape, material: Material, velocity: DVec3) -> Self {
        Surface { shape, material, velocity, frame: Frame::around(shape.direction()) }
    }

    /// Whether it moves.
    pub fn moves(&self) -> bool {
        self.velocity != DVec3::ZERO
    }

    /// Distance along the ray to this flat surface, where it is at `time`; see [`Shape::intersect_flat`].
    #[inline]
    pub fn intersect_flat(&self, ray: &Ray, time: f64) -> f64 {
        if self.moves() {
            return self.shape.intersect_flat(&Ray { o: ray.o - self.velocity * time, ..*ray });
        }
        self.shape.intersect_flat(ray)
    }

    /// The point of the surface nearest to `p`, which lies there up to rounding, and the frame of the front's normal.
    #[inline]
    pub fn at(&self, p: DVec3) -> (DVec3, Frame) {
        match &self.shape {
            Shape::Sphere(s) => on_sphere(s.center, s.radius, s.inward, p),
            _ => (p, self.frame),
        }
    }

    /// A point uniform over the area, and the frame of the front's normal there.
    #[inline(always)]
    pub fn sample_area(&self, u: (f64, f64)) -> (DVec3, Frame) {
        match &self.shape {
            Shape::Rectangle(r) => {
                let p = r.center + (2.0 * u.0 - 1.0) * r.half_u + (2.0 * u.1 - 1.0) * r.half_v;
                (p, self.frame)
            }
            Shape::Triangle(t) => {
                let (b, c) = warp::triangle(u);
                (t.a + b * (t.b - t.a) + c * (t.c - t.a), self.frame)
            }
            Shape::Disk(d) => {
                let (x, y) = warp::disk(u);
                (d.center + d.radius * self.frame.to_world(DVec3::new(x, y, 0.0)), self.frame)
            }
            Shape::Sphere(s) => {
                let out = self.frame.to_world(warp::sphere_band(s.low, s.high, u));
                (s.center + s.radius * out, Frame::around(if s.inward { -out } else { out }))
            }
        }
    }
}

/// The point of a sphere nearest to `p`, which lies there up to rounding, and the frame of the front's normal.
#[inline(always)]
pub(super) fn on_sphere(center: DVec3, radius: f64, inward: bool, p: DVec3) -> (DVec3, Frame) {
    // one step of Newton's method towards unit length; without it rounding grows from bounce to bounce
    let out = (p - center) * (1.0 / radius);
    let out = out * (1.5 - 0.5 * out.length_squared());
    (center + radius * out, Frame::around(if inward { -out } else { out }))
}
