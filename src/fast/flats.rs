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

/// The flat surfaces of a scene, by outline.
#[derive(Clone, Debug)]
pub struct Flats {
    rectangles: Vec<Plane>,
    triangles: Vec<Plane>,
    disks: Vec<Plane>,
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
        let mut flats = Flats { rectangles: Vec::new(), triangles: Vec::new(), disks: Vec::new() };
        for (id, surface) in (0..).zip(surfaces) {
            let (list, origin, u, v) = match &surface.shape {
                Shape::Rectangle(r) => {
                    let (u, v) = (r.half_u, r.half_v);
                    (&mut flats.rectangles, r.center, u / u.length_squared(), v / v.length_squared())
                }
                Shape::Triangle(t) => {
                    // the vectors whose products with the edges are 1 and 0 [dual basis]
                    let (e, f) = (t.b - t.a, t.c - t.a);
                    let n = e.cross(f);
                    (
                        &mut flats.triangles,
                        t.a,
                        f.cross(n) / n.length_squared(),
                        n.cross(e) / n.length_squared(),
                    )
                }
                Shape::Disk(d) => {
                    let u = d.normal.any_orthonormal_vector();
                    (&mut flats.disks, d.center, u / d.radius, d.normal.cross(u) / d.radius)
                }
                Shape::Sphere(_) => continue,
            };
            let n = surface.shape.direction();
            let at = |w: glam::DVec3| w.dot(origin) as f32;
            let (n0, u0, v0) = (at(n), at(u), at(v));
            let (n, u, v) = (narrow(n), narrow(u), narrow(v));
            list.push(Plane { n, n0, u, u0, v, v0, id });
        }
        flats
    }

    /// Looks for what is nearer than what was met before.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, rays: &Rays<S>, mut met: Nearest<S>) -> Nearest<S> {
        self.rectangles.iter().for_each(|plane| plane.meet(rays, in_rectangle, &mut met));
        self.triangles.iter().for_each(|plane| plane.meet(rays, in_triangle, &mut met));
        self.disks.iter().for_each(|plane| plane.meet(rays, in_disk, &mut met));
        met
    }

    /// Where a surface other than those at both ends crosses the open segment.
    #[inline(always)]
    pub fn block<S: Simd>(&self, rays: &Rays<S>, to: U<S>) -> M<S> {
        let mut blocked = M::splat(to.token(), false);
        self.rectangles.iter().for_each(|plane| blocked |= plane.blocks(rays, to, in_rectangle));
        self.triangles.iter().for_each(|plane| blocked |= plane.blocks(rays, to, in_triangle));
        self.disks.iter().for_each(|plane| blocked |= plane.blocks(rays, to, in_disk));
        blocked
    }
}

#[inline(always)]
fn in_rectangle<S: Simd>(a: F<S>, b: F<S>) -> M<S> {
    a.abs().simd_le(1.0) & b.abs().simd_le(1.0)
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
        let nearer = inside(a, b) & t.simd_gt(0.0) & t.simd_lt(met.t) & rays.from.simd_ne(self.id);
        met.t = nearer.select(t, met.t);
        met.id = nearer.select(U::splat(t.token(), self.id), met.id);
    }

    #[inline(always)]
    fn blocks<S: Simd>(&self, rays: &Rays<S>, to: U<S>, inside: impl Fn(F<S>, F<S>) -> M<S>) -> M<S> {
        let (t, a, b) = self.crossed(rays);
        let between = rays.from.simd_ne(self.id) & to.simd_ne(self.id);
        inside(a, b) & t.simd_gt(0.0) & t.simd_lt(1.0) & between
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
