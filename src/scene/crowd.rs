//! Primitives at rest that are too many to be asked one after the other: a [`Tree`] tells which of them to ask.
//!
//! Each is asked as it would be on its own, by the same arithmetic, and of those met at the same distance that one
//! answers which would have been asked first: the result has the same bits with and without the tree.

use super::geometry::NOWHERE;
use super::lanes;
use super::spheres::{Ball, Spheres};
use super::surface::on_sphere;
use super::tree::Tree;
use super::{Material, Ray, Shape, Surface};
use crate::sampling::warp::Frame;
use glam::DVec3;
use std::ops::Range;

/// So many spheres, triangles and disks are met one after the other about as fast as through a tree.
const FEW: usize = 32;
/// And so many rectangles, of which eight are met at once.
const FEW_RECTANGLES: usize = 256;
/// Triangles longer than this times their height stay out: rounding tilts their planes, and hits may lie off their boxes.
const THINNEST: f64 = 1e6;

/// Many primitives, in the order of the tree's leaves.
#[derive(Clone, Debug)]
pub(super) struct Crowd {
    tree: Tree,
    members: Vec<Member>,
    planes: Vec<Plane>,
    flats: Vec<(Shape, u32)>,
    spheres: Spheres,
    /// Of spheres, few of them more than once.
    materials: Vec<Material>,
}

/// A sphere with all that there is to know of it where it is met: surfaces are large and lie far apart.
#[derive(Clone, Copy, Debug)]
struct Round {
    ball: Ball,
    /// Place among all spheres.
    number: u32,
    /// Its surface if that is all of it, or [`NOWHERE`]; then the rest holds for this surface.
    whole: u32,
    material: u32,
    inward: bool,
}

/// What is met of a sphere of one surface.
#[derive(Clone, Copy)]
pub(super) struct Skin<'a> {
    round: &'a Round,
    /// What it is made of.
    pub material: &'a Material,
}

/// A primitive; planes and flats by their places.
#[derive(Clone, Copy, Debug)]
enum Member {
    /// A sphere.
    Sphere(Round),
    /// A rectangle.
    Plane(u32),
    /// A triangle or a disk.
    Flat(u32),
}

/// A rectangle by the equations of [`super::lanes`], with its surface and its rank.
#[derive(Clone, Copy, Debug)]
struct Plane {
    n: DVec3,
    n0: f64,
    u: DVec3,
    u0: f64,
    v: DVec3,
    v0: f64,
    id: u32,
    rank: u32,
}

/// What is nearest so far. Among equals the lowest rank counts, which is the order of being asked without a tree:
/// rectangles, spheres, all others; and the order within each of these.
struct Nearest<'a> {
    t: f64,
    id: u32,
    rank: (u8, u32),
    round: Option<&'a Round>,
}

impl Crowd {
    /// Those of `surfaces` for which a tree pays, if there are any.
    pub fn new(surfaces: &[Surface]) -> Option<Self> {
        let which = |holds: fn(&Surface) -> bool| -> Vec<u32> {
            (0u32..).zip(surfaces).filter(|(_, s)| holds(s)).map(|(id, _)| id).collect()
        };
        let (mut rectangles, flats, spheres) = (which(is_rectangle), which(is_flat), Spheres::new(surfaces));
        if rectangles.len() <= FEW_RECTANGLES {
            rectangles.clear();
        }
        if rectangles.is_empty() && flats.len() + spheres.all().len() <= FEW {
            return None;
        }
        let first_bands = spheres.all().iter().map(|sphere| sphere.bands[0].1);
        let entrants: Vec<u32> = first_bands.chain(rectangles.iter().copied()).chain(flats).collect();
        let bounds = |id: &u32| surfaces[*id as usize].shape.bounds();
        let (tree, order) = Tree::new(&entrants.iter().map(bounds).collect::<Vec<_>>());
        let (members, planes, flats, materials) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut crowd = Crowd { tree, members, planes, flats, spheres, materials };
        for entrant in order {
            let id = entrants[entrant as usize];
            let member = crowd.member(id, &surfaces[id as usize], &rectangles);
            crowd.members.push(member);
        }
        Some(crowd)
    }

    /// The primitive of surface `id`, stored behind all others of its kind; `rectangles` are those that take part.
    fn member(&mut self, id: u32, surface: &Surface, rectangles: &[u32]) -> Member {
        match &surface.shape {
            Shape::Sphere(first) => {
                let number = self.spheres.sphere_of(id);
                let whole = if first.low <= -1.0 && first.high >= 1.0 { id } else { NOWHERE };
                let material = self.material(&surface.material);
                let ball = self.spheres.all()[number as usize].ball;
                Member::Sphere(Round { ball, number, whole, material, inward: first.inward })
            }
            Shape::Rectangle(r) => {
                let (n, u, v) =
                    (r.normal(), r.half_u / r.half_u.length_squared(), r.half_v / r.half_v.length_squared());
                let [n0, u0, v0] = [n, u, v].map(|axis| axis.dot(r.center));
                let rank = lanes::rank(rectangles.partition_point(|&other| other < id) as u32);
                self.planes.push(Plane { n, n0, u, u0, v, v0, id, rank });
                Member::Plane(self.planes.len() as u32 - 1)
            }
            Shape::Triangle(_) | Shape::Disk(_) => {
                self.flats.push((surface.shape, id));
                Member::Flat(self.flats.len() as u32 - 1)
            }
        }
    }

    /// Where the material is stored; one of those stored last, if it is among them.
    fn material(&mut self, material: &Material) -> u32 {
        let last = self.materials.iter().rev().take(64).position(|other| other == material);
        let place = last.map_or(self.materials.len(), |back| self.materials.len() - 1 - back);
        if place == self.materials.len() {
            self.materials.push(*material);
        }
        place as u32
    }

    /// Whether rectangles at rest are among them.
    pub fn has_rectangles(&self) -> bool {
        !self.planes.is_empty()
    }

    /// Whether it is a triangle or a disk that is among them.
    pub fn takes(surface: &Surface) -> bool {
        is_flat(surface)
    }

    /// The nearer of `best`, distance and surface, and of what the ray meets first here; with its skin, if it has one. A
    /// call of its own, for scenes without a crowd to be met as fast as if there were none.
    #[inline(never)]
    pub fn nearer(&self, ray: &Ray, best: (f64, u32)) -> (f64, u32, Option<Skin<'_>>) {
        let from = self.spheres.sphere_of(ray.from);
        let mut nearest = Nearest { t: best.0, id: best.1, rank: (0, 0), round: None };
        self.tree.nearest(ray, best.0, |leaf| {
            for member in &self.members[leaf] {
                self.meet(member, ray, from, &mut nearest);
            }
            nearest.t
        });
        let whole = nearest.round.filter(|round| round.whole != NOWHERE);
        let skin = whole.map(|round| Skin { round, material: &self.materials[round.material as usize] });
        (nearest.t, nearest.id, skin)
    }

    #[inline]
    fn meet<'a>(&'a self, member: &'a Member, ray: &Ray, from: u32, nearest: &mut Nearest<'a>) {
        match member {
            Member::Sphere(round) => {
                // up to and including the nearest distance so far
                let mut met = (nearest.t.next_up(), NOWHERE);
                round.ball.nearer(ray, from == round.number, &mut met, |p| self.surface_at(round, p));
                if met.1 != NOWHERE {
                    nearest.offer(met.0, met.1, (1, round.number), Some(round));
                }
            }
            Member::Plane(i) => {
                let plane = &self.planes[*i as usize];
                if plane.id != ray.from {
                    nearest.offer(plane.distance(ray), plane.id, (0, plane.rank), None);
                }
            }
            Member::Flat(i) => {
                let (shape, id) = &self.flats[*i as usize];
                if *id != ray.from {
                    nearest.offer(shape.intersect_flat(ray), *id, (2, *id), None);
                }
            }
        }
    }

    /// Whether any of them but the surfaces at its ends crosses the segment.
    #[inline(never)]
    pub fn blocks(&self, segment: &Ray, to: u32) -> bool {
        let ends = (self.spheres.sphere_of(segment.from), self.spheres.sphere_of(to));
        let a = segment.d.length_squared();
        let is_end = |id: u32| id == segment.from || id == to;
        let blocks = |member: &Member| match member {
            Member::Sphere(round) => {
                let at_ends = (ends.0 == round.number, ends.1 == round.number);
                round.ball.blocks(segment, a, at_ends, |p| self.surface_at(round, p).is_some())
            }
            Member::Plane(i) => {
                let plane = &self.planes[*i as usize];
                !is_end(plane.id) && plane.distance(segment) < 1.0
            }
            Member::Flat(i) => {
                let (shape, id) = &self.flats[*i as usize];
                !is_end(*id) && shape.intersect_flat(segment) < 1.0
            }
        };
        self.tree.any(segment, |leaf: Range<usize>| self.members[leaf].iter().any(blocks))
    }

    /// The surface at a point of a sphere, if there is one.
    #[inline]
    fn surface_at(&self, round: &Round, p: DVec3) -> Option<u32> {
        if round.whole != NOWHERE {
            return Some(round.whole);
        }
        self.spheres.all()[round.number as usize].band_at(p)
    }
}

impl Skin<'_> {
    /// See [`Surface::at`].
    #[inline]
    pub fn at(&self, p: DVec3) -> (DVec3, Frame) {
        on_sphere(self.round.ball.center, self.round.ball.radius, self.round.inward, p)
    }
}

impl<'a> Nearest<'a> {
    #[inline]
    fn offer(&mut self, t: f64, id: u32, rank: (u8, u32), round: Option<&'a Round>) {
        if t < self.t || t == self.t && t < f64::INFINITY && rank < self.rank {
            *self = Nearest { t, id, rank, round };
        }
    }
}

impl Plane {
    /// Distance along the ray, infinite if it is missed.
    #[inline]
    fn distance(&self, ray: &Ray) -> f64 {
        let t = (self.n0 - self.n.dot(ray.o)) / self.n.dot(ray.d);
        let p = ray.o + t * ray.d;
        let inside = |axis: DVec3, middle: f64| (axis.dot(p) - middle).abs() <= 1.0;
        if t > 0.0 && inside(self.u, self.u0) && inside(self.v, self.v0) { t } else { f64::INFINITY }
    }
}

fn is_rectangle(surface: &Surface) -> bool {
    !surface.moves() && matches!(surface.shape, Shape::Rectangle(_))
}

/// A triangle or a disk that can be found by its box.
fn is_flat(surface: &Surface) -> bool {
    let has_box = match &surface.shape {
        Shape::Triangle(t) => {
            let (e, f) = (t.b - t.a, t.c - t.a);
            e.length() * f.length() <= THINNEST * e.cross(f).length()
        }
        Shape::Disk(_) => true,
        Shape::Rectangle(_) | Shape::Sphere(_) => false,
    };
    has_box && !surface.moves()
}
