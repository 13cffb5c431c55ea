//! Spheres and their bands, met by sixteen rays at once. As in `scene::spheres`: where a ray starts or ends on the sphere,
//! one root is known exactly and the other follows from it without cancellation.

use super::rays::{Nearest, Rays};
use super::vector::{F, M, U, V3, narrow};
use crate::scene::{Shape, Surface};
use fearless_simd::{Simd, prelude::*};

#[derive(Clone, Debug)]
struct Sphere {
    center: [f32; 3],
    radius: f32,
    bands: Vec<Band>,
}

#[derive(Clone, Copy, Debug)]
struct Band {
    axis: [f32; 3],
    /// Limits of the height above the centre along the axis; infinite at a pole.
    low: f32,
    high: f32,
    id: u32,
}

/// All spheres of a scene.
#[derive(Clone, Debug)]
pub struct Spheres {
    spheres: Vec<Sphere>,
}

impl Spheres {
    /// Collects the spheres among `surfaces`, with the bands of one together.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut spheres: Vec<(glam::DVec3, f64, Sphere)> = Vec::new();
        for (id, surface) in (0..).zip(surfaces) {
            let Shape::Sphere(s) = surface.shape else { continue };
            let low = if s.low <= -1.0 { f32::NEG_INFINITY } else { (s.low * s.radius) as f32 };
            let high = if s.high >= 1.0 { f32::INFINITY } else { (s.high * s.radius) as f32 };
            let band = Band { axis: narrow(s.axis), low, high, id };
            match spheres.iter_mut().find(|(center, radius, _)| *center == s.center && *radius == s.radius) {
                Some((_, _, sphere)) => sphere.bands.push(band),
                None => {
                    let sphere =
                        Sphere { center: narrow(s.center), radius: s.radius as f32, bands: vec![band] };
                    spheres.push((s.center, s.radius, sphere));
                }
            }
        }
        Spheres { spheres: spheres.into_iter().map(|(_, _, sphere)| sphere).collect() }
    }

    /// Looks for what is nearer than what was met before; the rays' directions are unit vectors.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, rays: &Rays<S>, mut met: Nearest<S>) -> Nearest<S> {
        let one = F::splat(met.t.token(), 1.0);
        for sphere in &self.spheres {
            let (roots, real) = sphere.roots(rays, one);
            for t in roots {
                let nearer = real & t.simd_gt(0.0) & t.simd_lt(met.t);
                let p = sphere.seen_from_center(rays.o + rays.d * t);
                for band in &sphere.bands {
                    let here = nearer & band.contains(p);
                    met.t = here.select(t, met.t);
                    met.id = here.select(U::splat(t.token(), band.id), met.id);
                }
            }
        }
        met
    }

    /// Where a sphere stands on the open segment between two surfaces.
    #[inline(always)]
    pub fn block<S: Simd>(&self, rays: &Rays<S>, to: U<S>) -> M<S> {
        let mut blocked = M::splat(to.token(), false);
        let a = rays.d.dot(rays.d);
        for sphere in &self.spheres {
            let (from, to) = (sphere.has(rays.from), sphere.has(to));
            let ([first, second], real) = sphere.roots(rays, a);
            // where the segment ends on the sphere one root is 1, and the product of both is c / a
            let other = sphere.c(rays) / a;
            let (first, second) = (to.select(other, first), to.select(other, second));
            for t in [first, second] {
                let between = (real | to) & t.simd_gt(0.0) & t.simd_lt(1.0);
                let p = sphere.seen_from_center(rays.o + rays.d * t);
                for band in &sphere.bands {
                    // a chord meets its sphere at its ends only
                    blocked |= between & band.contains(p) & !(from & to);
                }
            }
        }
        blocked
    }
}

impl Sphere {
    #[inline(always)]
    fn seen_from_center<S: Simd>(&self, p: V3<S>) -> V3<S> {
        p - V3::splat(p.x.token(), self.center)
    }

    /// Which of these surfaces are bands of this sphere.
    #[inline(always)]
    fn has<S: Simd>(&self, ids: U<S>) -> M<S> {
        let none = M::splat(ids.token(), false);
        self.bands.iter().fold(none, |any, band| any | ids.simd_eq(band.id))
    }

    /// |o - center|² - radius²
    #[inline(always)]
    fn c<S: Simd>(&self, rays: &Rays<S>) -> F<S> {
        let o = self.seen_from_center(rays.o);
        o.dot(o) - self.radius * self.radius
    }

    /// Parameters at which lines meet the sphere, and whether they do; `a` = |d|².
    #[inline(always)]
    fn roots<S: Simd>(&self, rays: &Rays<S>, a: F<S>) -> ([F<S>; 2], M<S>) {
        let on = self.has(rays.from);
        let half_b = self.seen_from_center(rays.o).dot(rays.d);
        let c = self.c(rays);
        let discriminant = half_b * half_b - a * c;
        let far = -(half_b + discriminant.max(0.0).sqrt().copysign(half_b));
        let chord = half_b * -2.0 / a;
        let zero = F::splat(a.token(), 0.0);
        let roots = [on.select(zero, far / a), on.select(chord, c / far)];
        (roots, on | discriminant.simd_ge(0.0))
    }
}

impl Band {
    /// Whether points of the sphere, given from its centre, belong to the band; see `scene::spheres`.
    #[inline(always)]
    fn contains<S: Simd>(&self, p: V3<S>) -> M<S> {
        let z = p.along(&self.axis);
        z.simd_ge(self.low) & z.simd_lt(self.high)
    }
}
