//! All rectangles of a scene as a structure of arrays, eight to a group, met without a branch inside a group:
//! for some dozens of primitives this beats a tree several times over, because there is nothing to mispredict.

use super::{Ray, Shape, Surface};
use glam::DVec3;
use multiversion::multiversion;

const WIDTH: usize = 8;
/// Groups whose distances are held at once.
const CHUNK: usize = 4;
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
    /// Place among all lanes, as a number that vectors compare.
    slot: Lane,
    /// Numbers of the rectangles in the scene.
    id: [u32; WIDTH],
}

/// The rectangles of a scene.
#[derive(Clone, Debug)]
pub struct RectangleLanes {
    groups: Vec<Group>,
    /// Where surface i sits: group * WIDTH + lane, or -1.
    slot: Vec<f64>,
}

impl RectangleLanes {
    /// Collects the rectangles at rest among `surfaces`.
    pub fn new(surfaces: &[Surface]) -> Self {
        let mut lanes = RectangleLanes { groups: Vec::new(), slot: vec![-1.0; surfaces.len()] };
        let mut count = 0;
        for (id, surface) in surfaces.iter().enumerate() {
            let Shape::Rectangle(r) = &surface.shape else { continue };
            if surface.moves() {
                continue;
            }
            if count % WIDTH == 0 {
                lanes.groups.push(Group::empty());
            }
            let (group, lane) = (count / WIDTH, count % WIDTH);
            lanes.groups[group].set(lane, id as u32, r.normal(), r.center, r.half_u, r.half_v);
            lanes.slot[id] = count as f64;
            lanes.groups[group].slot[lane] = count as f64;
            count += 1;
        }
        lanes
    }

    /// Distance and number of the nearest rectangle; infinity if there is none.
    #[inline]
    pub fn nearest(&self, ray: &Ray) -> (f64, u32) {
        let own = self.slot_of(ray.from);
        let closer = |a: (f64, u32), b: (f64, u32)| if b.0 < a.0 { b } else { a };
        let nearest = self.groups.chunks(CHUNK).map(|chunk| nearest(chunk, ray, own));
        nearest.fold((f64::INFINITY, 0), closer)
    }

    /// Whether a rectangle other than those of `ray.from` and `to` crosses the open segment.
    #[inline]
    pub fn blocks(&self, ray: &Ray, to: u32) -> bool {
        !self.groups.is_empty() && blocks(&self.groups, ray, self.slot_of(ray.from), self.slot_of(to))
    }

    /// Where a surface sits among the lanes, as a number that lanes compare with; -1 if it is no rectangle.
    #[inline]
    fn slot_of(&self, surface: u32) -> f64 {
        self.slot.get(surface as usize).copied().unwrap_or(-1.0)
    }
}

/// Place of the i-th rectangle in the order in which they are preferred among equals: by what is held at once, by lane,
/// by group.
pub(super) fn rank(i: u32) -> u32 {
    let (width, chunk) = (WIDTH as u32, CHUNK as u32);
    i / (width * chunk) * (width * chunk) + i % width * chunk + i / width % chunk
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn nearest(groups: &[Group], ray: &Ray, own: f64) -> (f64, u32) {
    let mut t = [[f64::INFINITY; WIDTH]; CHUNK];
    let mut best = [f64::INFINITY; WIDTH];
    for (t, group) in t.iter_mut().zip(groups) {
        *t = group.distances(ray, own, -1.0);
        for k in 0..WIDTH {
            best[k] = if t[k] < best[k] { t[k] } else { best[k] };
        }
    }
    let (least, lane) = least(&best);
    let first = |found, g: usize| if t[g][lane] == least { g } else { found };
    let group = (0..groups.len().min(CHUNK)).rev().fold(0, first);
    (least, groups[group].id[lane])
}

/// The lane of the smallest value. A call of its own, or the compiler takes the loop before it to pieces.
#[inline(never)]
fn least(t: &Lane) -> (f64, usize) {
    let lane = |k: usize| (t[k], k);
    let closer = |a: (f64, usize), b: (f64, usize)| {
        let near = b.0 < a.0;
        (if near { b.0 } else { a.0 }, if near { b.1 } else { a.1 })
    };
    let half = |k: usize| closer(closer(lane(k), lane(k + 1)), closer(lane(k + 2), lane(k + 3)));
    closer(half(0), half(4))
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn blocks(groups: &[Group], ray: &Ray, own: f64, to: f64) -> bool {
    groups.iter().any(|group| {
        let t = group.distances(ray, own, to);
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
            slot: [f64::MAX; WIDTH],
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

    /// Distances along the ray, infinite where a rectangle is missed or sits at one of the two slots.
    #[inline(always)] // compiled anew for each instruction set
    fn distances(&self, ray: &Ray, own: f64, to: f64) -> Lane {
        let (o, d) = (ray.o, ray.d);
        let mut t = [0.0; WIDTH];
        for k in 0..WIDTH {
            let dot = |m: &[Lane; 3], w: DVec3| m[0][k] * w.x + m[1][k] * w.y + m[2][k] * w.z;
            let s = (self.n0[k] - dot(&self.n, o)) / dot(&self.n, d);
            let p = o + s * d;
            let a = (dot(&self.u, p) - self.u0[k]).abs();
            let b = (dot(&self.v, p) - self.v0[k]).abs();
            let other = (self.slot[k] != own) & (self.slot[k] != to);
            let inside = (s > 0.0) & (a <= 1.0) & (b <= 1.0) & other;
            t[k] = if inside { s } else { f64::INFINITY };
        }
        t
    }
}
