//! All rectangles of a scene as a structure of arrays, eight to a group, met without a branch inside a group:
//! for some dozens of primitives this beats a tree several times over, because there is nothing to mispredict.

use super::{Ray, Shape, Surface};
use glam::DVec3;
use multiversion::multiversion;

const WIDTH: usize = 8;
type Lane = [f64; WIDTH];

/// Eight rectangles as plane equations. Unused lanes hold a rectangle that nothing hits.
#[derive(Clone, Debug)]
struct Group {
    /// Unit normal, by coordinate.
    n: [Lane; 3],
    /// n · center
    n0: Lane,
    /// half_u / |half_u|²: maps a point to a in [-1, 1] on the rectangle.
    u: [Lane; 3],
    u0: Lane,
    v: [Lane; 3],
    v0: Lane,
    /// Numbers of the rectangles in the scene.
    id: [u32; WIDTH],
}

/// The rectangles of a scene.
#[derive(Clone, Debug)]
pub struct RectangleLanes {
    groups: Vec<Group>,
    /// Where surface i sits: group * WIDTH + lane, or `ABSENT`.
    slot: Vec<u32>,
}

const ABSENT: u32 = u32::MAX;

impl RectangleLanes {
    /// Collects the rectangles among `surfaces`.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut lanes = RectangleLanes {
            groups: Vec::new(),
            slot: vec![ABSENT; surfaces.len()],
        };
        let mut count = 0;
        for (id, surface) in surfaces.iter().enumerate() {
            let Shape::Rectangle(r) = &surface.shape else {
                continue;
            };
            if count % WIDTH == 0 {
                lanes.groups.push(Group::empty());
            }
            let (group, lane) = (count / WIDTH, count % WIDTH);
            lanes.groups[group].set(lane, id as u32, r.normal(), r.center, r.half_u, r.half_v);
            lanes.slot[id] = count as u32;
            count += 1;
        }
        lanes
    }

    /// Distance and number of the nearest rectangle; infinity if there is none.
    #[inline]
    pub fn nearest(&self, ray: &Ray) -> (f64, u32) {
        if self.groups.is_empty() {
            return (f64::INFINITY, 0);
        }
        nearest(&self.groups, ray, self.slot_of(ray.from))
    }

    /// Whether a rectangle other than those of `ray.from` and `to` crosses the open segment.
    #[inline]
    pub fn blocks(&self, ray: &Ray, to: u32) -> bool {
        !self.groups.is_empty() && blocks(&self.groups, ray, [self.slot_of(ray.from), self.slot_of(to)])
    }

    #[inline]
    fn slot_of(&self, surface: u32) -> usize {
        self.slot.get(surface as usize).map_or(usize::MAX, |&s| {
            if s == ABSENT { usize::MAX } else { s as usize }
        })
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn nearest(groups: &[Group], ray: &Ray, own: usize) -> (f64, u32) {
    let mut best = [f64::INFINITY; WIDTH];
    let mut best_group = [0u64; WIDTH];
    for (g, group) in groups.iter().enumerate() {
        let mut t = group.distances(ray);
        if own / WIDTH == g {
            t[own % WIDTH] = f64::INFINITY;
        }
        for k in 0..WIDTH {
            let closer = t[k] < best[k];
            best[k] = if closer { t[k] } else { best[k] };
            best_group[k] = if closer { g as u64 } else { best_group[k] };
        }
    }
    let mut lane = 0;
    for k in 1..WIDTH {
        lane = if best[k] < best[lane] { k } else { lane };
    }
    (best[lane], groups[best_group[lane] as usize].id[lane])
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn blocks(groups: &[Group], ray: &Ray, ends: [usize; 2]) -> bool {
    groups.iter().enumerate().any(|(g, group)| {
        let mut t = group.distances(ray);
        for own in ends {
            if own / WIDTH == g {
                t[own % WIDTH] = f64::INFINITY;
            }
        }
        t.iter().fold(false, |blocked, &t| blocked | (t < 1.0))
    })
}

impl Group {
    fn empty() -> Self {
        Group {
            n: [[0.0; WIDTH]; 3],
            n0: [-1.0; WIDTH], // 0 · p = -1 has no solution: t is infinite
            u: [[0.0; WIDTH]; 3],
            u0: [0.0; WIDTH],
            v: [[0.0; WIDTH]; 3],
            v0: [0.0; WIDTH],
            id: [0; WIDTH],
        }
    }

    fn set(&mut self, lane: usize, id: u32, n: DVec3, center: DVec3, half_u: DVec3, half_v: DVec3) {
        let (u, v) = (half_u / half_u.length_squared(), half_v / half_v.length_squared());
        for axis in 0..3 {
            self.n[axis][lane] = n[axis];
            self.u[axis][lane] = u[axis];
            self.v[axis][lane] = v[axis];
        }
        self.n0[lane] = n.dot(center);
        self.u0[lane] = u.dot(center);
        self.v0[lane] = v.dot(center);
        self.id[lane] = id;
    }

    /// Distances along the ray, infinite where a rectangle is missed.
    #[inline(always)] // compiled anew for each instruction set
    fn distances(&self, ray: &Ray) -> Lane {
        let (o, d) = (ray.o, ray.d);
        let mut t = [0.0; WIDTH];
        for k in 0..WIDTH {
            let dot = |m: &[Lane; 3], w: DVec3| m[0][k] * w.x + m[1][k] * w.y + m[2][k] * w.z;
            let s = (self.n0[k] - dot(&self.n, o)) / dot(&self.n, d);
            let p = o + s * d;
            let a = (dot(&self.u, p) - self.u0[k]).abs();
            let b = (dot(&self.v, p) - self.v0[k]).abs();
            let inside = (s > 0.0) & (a <= 1.0) & (b <= 1.0);
            t[k] = if inside { s } else { f64::INFINITY };
        }
        t
    }
}
