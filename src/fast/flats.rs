//! Flat surfaces, met by sixteen rays at once: one surface after the other, without a branch.

use super::vector::{F, M, U, V3, narrow};
use crate::scene::{Shape, Surface};
use fearless_simd::{Simd, prelude::*};

/// A plane with two coordinates on it: a = u · p - u0, b = v · p - v0.
#[derive(Clone, Copy, Debug)]
struct Plane {
    n: [f32; 3],
    n0: f32,
    u: [f32; 3],
    u0: f32,
    v: [f32; 3],
    v0: f32,
    id: u32,
}

/// What of a plane belongs to the surface.
#[derive(Clone, Copy, Debug)]
enum Outline {
    /// |a| <= 1, |b| <= 1
    Rectangle,
    /// a >= 0, b >= 0, a + b <= 1
    Triangle,
    /// a² + b² <= 1
    Disk,
}

/// The flat surfaces of a scene, by outline.
#[derive(Clone, Debug)]
pub struct Flats {
    planes: [(Outline, Vec<Plane>); 3],
}

/// Sixteen rays, or segments, and the surfaces that they leave.
#[derive(Clone, Copy)]
pub struct Rays<S: Simd> {
    /// Where they start.
    pub o: V3<S>,
    /// Where they go.
    pub d: V3<S>,
    /// The surface of each `o`.
    pub from: U<S>,
}

/// What sixteen rays have met so far: distance and surface; infinite where nothing.
#[derive(Clone, Copy)]
pub struct Nearest<S: Simd> {
    /// Distance, in units of the ray's direction.
    pub t: F<S>,
    /// Which surface.
    pub id: U<S>,
}

impl Flats {
    /// Collects the flat surfaces.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut planes = [Outline::Rectangle, Outline::Triangle, Outline::Disk].map(|o| (o, Vec::new()));
        for (id, surface) in (0..).zip(surfaces) {
            let (list, origin, u, v) = match &surface.shape {
                Shape::Rectangle(r) => {
                    let (u, v) = (r.half_u, r.half_v);
                    (0, r.center, u / u.length_squared(), v / v.length_squared())
                }
                Shape::Triangle(t) => {
                    // the vectors whose products with the edges are 1 and 0 [dual basis]
                    let (e, f) = (t.b - t.a, t.c - t.a);
                    let n = e.cross(f);
                    (1, t.a, f.cross(n) / n.length_squared(), n.cross(e) / n.length_squared())
                }
                Shape::Disk(d) => {
                    let u = d.normal.any_orthonormal_vector();
                    (2, d.center, u / d.radius, d.normal.cross(u) / d.radius)
                }
                Shape::Sphere(_) => continue,
            };
            let n = surface.shape.direction();
            let at = |w: glam::DVec3| w.dot(origin) as f32;
            let (n0, u0, v0) = (at(n), at(u), at(v));
            let (n, u, v) = (narrow(n), narrow(u), narrow(v));
            planes[list].1.push(Plane { n, n0, u, u0, v, v0, id });
        }
        Flats { planes }
    }

    /// Looks for what is nearer than what was met before.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, rays: &Rays<S>, mut met: Nearest<S>) -> Nearest<S> {
        for (outline, planes) in &self.planes {
            for plane in planes {
                let (t, inside) = plane.crossed(*outline, rays);
                let nearer = inside & t.simd_lt(met.t) & rays.from.simd_ne(plane.id);
                met.t = nearer.select(t, met.t);
                met.id = nearer.select(U::splat(t.token(), plane.id), met.id);
            }
        }
        met
    }

    /// Where a surface other than those at both ends crosses the open segment.
    #[inline(always)]
    pub fn block<S: Simd>(&self, rays: &Rays<S>, to: U<S>) -> M<S> {
        let mut blocked = M::splat(to.token(), false);
        for (outline, planes) in &self.planes {
            for plane in planes {
                let (t, inside) = plane.crossed(*outline, rays);
                let between = rays.from.simd_ne(plane.id) & to.simd_ne(plane.id);
                blocked |= inside & t.simd_lt(1.0) & between;
            }
        }
        blocked
    }
}

impl Plane {
    /// Where rays cross the plane, and whether that is ahead and inside the outline.
    #[inline(always)]
    fn crossed<S: Simd>(&self, outline: Outline, rays: &Rays<S>) -> (F<S>, M<S>) {
        let Rays { o, d, .. } = *rays;
        let t = (F::splat(o.x.token(), self.n0) - o.along(&self.n)) / d.along(&self.n);
        let p = o + d * t;
        let (a, b) = (p.along(&self.u) - self.u0, p.along(&self.v) - self.v0);
        let inside = match outline {
            Outline::Rectangle => a.abs().simd_le(1.0) & b.abs().simd_le(1.0),
            Outline::Triangle => a.simd_ge(0.0) & b.simd_ge(0.0) & (a + b).simd_le(1.0),
            Outline::Disk => (a * a + b * b).simd_le(1.0),
        };
        (t, inside & t.simd_gt(0.0))
    }
}
