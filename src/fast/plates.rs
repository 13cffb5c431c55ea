//! Triangles and disks, met by sixteen rays at once: one after the other, without a branch.

use super::rays::{Nearest, Rays};
use super::vector::{F, M, U, narrow};
use crate::scene::{Shape, Surface};
use fearless_simd::{Simd, prelude::*};
use glam::DVec3;

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

/// The triangles (a, b >= 0, a + b <= 1) and disks (a² + b² <= 1) of a scene.
#[derive(Clone, Debug, Default)]
pub struct Plates {
    triangles: Vec<Plane>,
    disks: Vec<Plane>,
}

impl Plates {
    /// Collects triangles and disks.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut plates = Plates::default();
        for (id, surface) in (0..).zip(surfaces) {
            let (list, origin, u, v) = match &surface.shape {
                Shape::Triangle(t) => {
                    // the vectors in the plane whose products with the edges are 1 and 0
                    let (e, f) = (t.b - t.a, t.c - t.a);
                    let n = e.cross(f);
                    let scale = n.length_squared();
                    (&mut plates.triangles, t.a, f.cross(n) / scale, n.cross(e) / scale)
                }
                Shape::Disk(d) => {
                    let u = d.normal.any_orthonormal_vector();
                    (&mut plates.disks, d.center, u / d.radius, d.normal.cross(u) / d.radius)
                }
                Shape::Rectangle(_) | Shape::Sphere(_) => continue,
            };
            let n = surface.shape.direction();
            let at = |w: DVec3| w.dot(origin) as f32;
            let (n0, u0, v0) = (at(n), at(u), at(v));
            list.push(Plane { n: narrow(n), n0, u: narrow(u), u0, v: narrow(v), v0, id });
        }
        plates
    }

    /// Looks for what is nearer than what was met before.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, rays: &Rays<S>, mut met: Nearest<S>) -> Nearest<S> {
        self.triangles.iter().for_each(|plane| plane.meet(rays, in_triangle, &mut met));
        self.disks.iter().for_each(|plane| plane.meet(rays, in_disk, &mut met));
        met
    }

    /// Where a surface other than those at both ends crosses the open segment.
    #[inline(always)]
    pub fn block<S: Simd>(&self, rays: &Rays<S>, to: U<S>) -> M<S> {
        let mut blocked = M::splat(to.token(), false);
        self.triangles.iter().for_each(|plane| blocked |= plane.blocks(rays, to, in_triangle));
        self.disks.iter().for_each(|plane| blocked |= plane.blocks(rays, to, in_disk));
        blocked
    }
}

#[inline(always)]
fn in_triangle<S: Simd>(a: F<S>, b: F<S>) -> M<S> {
    a.simd_ge(0.0) & b.simd_ge(0.0) & (a + b).simd_le(1.0)
}

#[inline(always)]
fn in_disk<S: Simd>(a: F<S>, b: F<S>) -> M<S> {
    (a * a + b * b).simd_le(1.0)
}

impl Plane {
    #[inline(always)]
    fn meet<S: Simd>(&self, rays: &Rays<S>, inside: impl Fn(F<S>, F<S>) -> M<S>, met: &mut Nearest<S>) {
        let (t, a, b) = self.crossed(rays);
        met.take(t, inside(a, b) & t.simd_gt(0.0) & rays.from.simd_ne(self.id), self.id);
    }

    #[inline(always)]
    fn blocks<S: Simd>(&self, rays: &Rays<S>, to: U<S>, inside: impl Fn(F<S>, F<S>) -> M<S>) -> M<S> {
        let (t, a, b) = self.crossed(rays);
        inside(a, b) & rays.passes(t, to, self.id)
    }

    /// Where rays cross the plane: the distance, and the two coordinates.
    #[inline(always)]
    fn crossed<S: Simd>(&self, rays: &Rays<S>) -> (F<S>, F<S>, F<S>) {
        let Rays { o, d, .. } = *rays;
        let t = (F::splat(o.x.token(), self.n0) - o.along(&self.n)) / d.along(&self.n);
        let p = o + d * t;
        (t, p.along(&self.u) - self.u0, p.along(&self.v) - self.v0)
    }
}
