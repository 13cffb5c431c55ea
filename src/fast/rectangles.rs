//! Rectangles, met by sixteen rays at once, without a branch.
//!
//! Rooms and boxes have few directions. Rectangles whose edges lie along the same three axes share them: rays are turned
//! to these axes once, and divided by once an axis; then each rectangle takes a dozen operations.

use super::rays::{Nearest, Rays};
use super::vector::{F, M, U, V3, narrow};
use crate::scene::geometry::Rectangle;
use crate::scene::{Shape, Surface};
use fearless_simd::{Simd, prelude::*};
use glam::DVec3;

/// A rectangle in the coordinates of its axes: normal to one of them, between limits along the two others.
#[derive(Clone, Copy, Debug)]
struct Flat {
    /// Where it lies along its normal.
    height: f32,
    /// Its middle and half of its length along the next axis and the one after.
    middle: [f32; 2],
    half: [f32; 2],
    id: u32,
}

/// Rectangles that have their axes in common.
#[derive(Clone, Debug)]
struct Group {
    exact: [DVec3; 3],
    axes: [[f32; 3]; 3],
    /// By the axis that is their normal.
    flats: [Vec<Flat>; 3],
}

/// The rectangles of a scene.
#[derive(Clone, Debug)]
pub struct Rectangles {
    groups: Vec<Group>,
}

/// Rays in the coordinates of a group.
struct Turned<S: Simd> {
    o: [F<S>; 3],
    d: [F<S>; 3],
    /// 1 / d
    inverse: [F<S>; 3],
}

impl Rectangles {
    /// Collects the rectangles.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut all = Rectangles { groups: Vec::new() };
        for (id, surface) in (0..).zip(surfaces) {
            if let Shape::Rectangle(r) = &surface.shape {
                all.add(r, id);
            }
        }
        all
    }

    fn add(&mut self, r: &Rectangle, id: u32) {
        let edges = [r.half_u, r.half_v];
        let own = [r.normal(), r.half_u.normalize(), r.half_v.normalize()];
        let shares = |group: &&mut Group| own.iter().all(|&axis| group.along(axis).is_some());
        let group = match self.groups.iter_mut().find(shares) {
            Some(group) => group,
            None => {
                let axes = own.map(narrow);
                self.groups.push(Group { exact: own, axes, flats: Default::default() });
                self.groups.last_mut().expect("one was just pushed")
            }
        };
        let normal = group.along(own[0]).expect("the group has this axis");
        let sides = [(normal + 1) % 3, (normal + 2) % 3].map(|k| group.exact[k]);
        let reach = |axis: DVec3| edges.iter().map(|edge| edge.dot(axis).abs()).sum::<f64>() as f32;
        group.flats[normal].push(Flat {
            height: r.center.dot(group.exact[normal]) as f32,
            middle: sides.map(|axis| r.center.dot(axis) as f32),
            half: sides.map(reach),
            id,
        });
    }

    /// Looks for what is nearer than what was met before.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, rays: &Rays<S>, mut met: Nearest<S>) -> Nearest<S> {
        for group in &self.groups {
            let turned = group.turn(rays);
            for normal in 0..3 {
                for flat in &group.flats[normal] {
                    let (t, inside) = flat.crossed(normal, &turned);
                    met.take(t, inside & t.simd_gt(0.0) & rays.from.simd_ne(flat.id), flat.id);
                }
            }
        }
        met
    }

    /// Where a rectangle other than those at both ends crosses the open segment.
    #[inline(always)]
    pub fn block<S: Simd>(&self, rays: &Rays<S>, to: U<S>) -> M<S> {
        let mut blocked = M::splat(to.token(), false);
        for group in &self.groups {
            let turned = group.turn(rays);
            for normal in 0..3 {
                for flat in &group.flats[normal] {
                    let (t, inside) = flat.crossed(normal, &turned);
                    blocked |= inside & rays.passes(t, to, flat.id);
                }
            }
        }
        blocked
    }
}

impl Group {
    /// The axis along which a unit vector lies, either way; rounding may turn it by 1e-7, squared here.
    fn along(&self, v: DVec3) -> Option<usize> {
        self.exact.iter().position(|axis| axis.dot(v).abs() > 1.0 - 1e-14)
    }

    #[inline(always)]
    fn coordinates<S: Simd>(&self, v: V3<S>) -> [F<S>; 3] {
        [v.along(&self.axes[0]), v.along(&self.axes[1]), v.along(&self.axes[2])]
    }

    #[inline(always)]
    fn turn<S: Simd>(&self, rays: &Rays<S>) -> Turned<S> {
        let one = F::splat(rays.from.token(), 1.0);
        let (o, d) = (self.coordinates(rays.o), self.coordinates(rays.d));
        Turned { o, d, inverse: [one / d[0], one / d[1], one / d[2]] }
    }
}

impl Flat {
    /// Where rays cross the plane, and whether they do so within the rectangle.
    #[inline(always)]
    fn crossed<S: Simd>(&self, normal: usize, ray: &Turned<S>) -> (F<S>, M<S>) {
        let t = (F::splat(ray.o[0].token(), self.height) - ray.o[normal]) * ray.inverse[normal];
        (t, self.within(0, (normal + 1) % 3, ray, t) & self.within(1, (normal + 2) % 3, ray, t))
    }

    #[inline(always)]
    fn within<S: Simd>(&self, side: usize, axis: usize, ray: &Turned<S>, t: F<S>) -> M<S> {
        let off = ray.o[axis] + ray.d[axis] * t - self.middle[side];
        off.abs().simd_le(self.half[side])
    }
}
