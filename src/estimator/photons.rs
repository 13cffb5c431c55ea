//! Stored photons, and how those near a point are found.

use super::kernel::{Gather, Last};
use super::particles::Particle;
use crate::scene::{Hit, Rgb};
use glam::{DVec3, Vec3};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use std::f64::consts::PI;
use std::num::NonZeroUsize;

/// A particle where it landed. Its numbers are kept in single precision, which takes half the memory: rounding to
/// nearest moves each by 6e-8 of itself at most, to both sides alike. What is summed is summed in double precision.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    power: Vec3,
    wi: Vec3,
    normal: Vec3,
    bounce: u16,
    diffuse: bool,
}

/// Cosine between two normals below which a photon lies on another surface than the point that is looked at: around a
/// corner or behind a thin wall.
const SAME_SURFACE: f64 = 0.1;

impl Photon {
    #[inline]
    fn landed(x: &Hit<'_>, particle: Particle) -> Self {
        Photon {
            power: particle.power.as_vec3(),
            wi: x.wo.as_vec3(),
            normal: x.frame.n.as_vec3(),
            bounce: particle.bounce.min(u32::from(u16::MAX)) as u16,
            diffuse: particle.diffuse,
        }
    }

    /// The power that it stands for, if it stands for all light alone, in watts.
    #[inline]
    pub fn power(&self) -> Rgb {
        self.power.as_dvec3()
    }

    /// Unit direction that it came from, turned with the normal from where it landed to `x`. Density estimation takes the
    /// surface for flat: on a curved one a photon that came in low would else come from below the horizon of `x`, and
    /// count for nothing.
    #[inline]
    pub fn wi(&self, x: &Hit<'_>) -> DVec3 {
        let (wi, from, to) = (self.wi.as_dvec3(), self.normal.as_dvec3(), x.frame.n);
        let both = from + to;
        wi - both * (both.dot(wi) / (1.0 + from.dot(to))) + to * (2.0 * from.dot(wi))
    }

    /// How often it was scattered before it landed.
    #[inline]
    pub fn bounce(&self) -> u32 {
        u32::from(self.bounce)
    }

    /// Whether it comes straight from an emitter.
    #[inline]
    pub fn is_direct(&self) -> bool {
        self.bounce == 0
    }

    /// Whether it was scattered by anything but mirrors and glass.
    #[inline]
    pub fn is_diffuse(&self) -> bool {
        self.diffuse
    }

    /// Whether it lies on the same surface as `x`, as far as normals tell.
    #[inline]
    pub fn lies_on(&self, x: &Hit<'_>) -> bool {
        self.normal.as_dvec3().dot(x.frame.n) > SAME_SURFACE
    }
}

/// A map of photons.
pub struct Photons {
    /// `None` if no photon landed anywhere, and until all have.
    tree: Option<ImmutableKdTree<f64, 3>>,
    /// Where photons landed, until the tree holds it.
    places: Vec<[f64; 3]>,
    photons: Vec<Photon>,
    sent: u64,
    gather: Gather,
    /// Radius of this map, if it has one.
    radius: Option<f64>,
}

/// The photons around a point.
pub struct Near<'a> {
    photons: &'a [Photon],
    /// Squared distance and number of each.
    found: Vec<(f64, u32)>,
    squared_radius: f64,
}

/// So many photons are looked at to guess the radius that holds k.
const PROBES: usize = 12;

impl Photons {
    /// The empty map of one realization, for which so many photons will be `sent`.
    pub fn new(sent: u64, gather: Gather, realization: u64) -> Self {
        let (places, photons) = (Vec::new(), Vec::new());
        Photons { tree: None, places, photons, sent, gather, radius: gather.radius(realization) }
    }

    /// Keeps the particle that met `x`, unless nothing is reflected there.
    #[inline]
    pub fn add(&mut self, x: &Hit<'_>, particle: Particle) {
        if x.albedo() == Rgb::ZERO {
            return;
        }
        if self.photons.len() == self.photons.capacity() {
            // by a half, not by as much again: maps are large
            let more = self.photons.len() / 2 + 1024;
            self.photons.reserve_exact(more);
            self.places.reserve_exact(more);
        }
        self.places.push(x.p.to_array());
        self.photons.push(Photon::landed(x, particle));
    }

    /// The map once all photons have landed, ready to be looked at.
    pub fn grown(mut self) -> Self {
        let places = std::mem::take(&mut self.places);
        let grow = || ImmutableKdTree::new_from_slice(&places).expect("all photons are at finite places");
        self.tree = (!places.is_empty()).then(grow);
        self
    }

    /// How many photons landed.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// Whether none did.
    pub fn is_empty(&self) -> bool {
        self.photons.is_empty()
    }

    /// How many were sent.
    #[inline]
    pub fn sent(&self) -> f64 {
        self.sent as f64
    }

    /// The photons around a point; `None` where fewer landed than are to be gathered.
    pub fn near(&self, p: DVec3) -> Option<Near<'_>> {
        let photons = &self.photons;
        match self.gather {
            Gather::Nearest { k, last } => {
                let (mut found, squared_radius) = self.nearest(p, k as usize)?;
                if last == Last::LeftOut {
                    let farthest = found.iter().position(|&(d, _)| d == squared_radius)?;
                    found.remove(farthest);
                }
                Some(Near { photons, found, squared_radius })
            }
            Gather::Within { .. } | Gather::Shrinking { .. } => {
                let radius = self.radius?;
                let squared_radius = radius * radius;
                Some(Near { photons, found: self.within(p, squared_radius), squared_radius })
            }
        }
    }

    fn within(&self, p: DVec3, squared_radius: f64) -> Vec<(f64, u32)> {
        let mut found = Vec::new();
        if let Some(tree) = &self.tree {
            let place = p.to_array();
            let all = tree.query(&place).within::<SquaredEuclidean<f64>>(squared_radius);
            all.unsorted().visit(|near| found.push((near.distance, near.item)));
        }
        found
    }

    fn heap(&self, p: DVec3, k: usize) -> Vec<(f64, u32)> {
        let (Some(tree), Some(k)) = (&self.tree, NonZeroUsize::new(k)) else { return Vec::new() };
        let place = p.to_array();
        let nearest = tree.query(&place).nearest_n::<SquaredEuclidean<f64>>(k).unsorted().execute();
        nearest.iter().map(|near| (near.distance, near.item)).collect()
    }

    /// The k nearest photons, in no order, and the largest squared distance. All within a guessed radius are looked at,
    /// and the k-th among them is found by selection, which takes a third of the time of a heap of k.
    fn nearest(&self, p: DVec3, k: usize) -> Option<(Vec<(f64, u32)>, f64)> {
        if self.len() < k {
            return None;
        }
        let farthest = |found: &[(f64, u32)]| found.iter().map(|near| near.0).fold(0.0, f64::max);
        let probed = self.heap(p, k.min(PROBES));
        let mut guess = 1.5 * farthest(&probed) * k as f64 / PROBES as f64;
        while k > PROBES && guess > 0.0 && guess.is_finite() {
            let found = self.within(p, guess);
            if found.len() >= k {
                return Some(cut(found, k));
            }
            guess *= (1.4 * k as f64 / (found.len() as f64 + 1.0)).clamp(1.5, 4.0);
        }
        // few photons, or many at one place
        let found = self.heap(p, k);
        let largest = farthest(&found);
        Some((found, largest))
    }
}

/// The k nearest of those found, in their order; of several at the same distance, those of lower number.
fn cut(mut found: Vec<(f64, u32)>, k: usize) -> (Vec<(f64, u32)>, f64) {
    let mut sorted = found.clone();
    let order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    let last = *sorted.select_nth_unstable_by(k - 1, order).1;
    found.retain(|near| order(near, &last).is_le());
    (found, last.0)
}

impl Near<'_> {
    /// Each photon, with the square of its distance over the radius.
    #[inline]
    pub fn photons(&self) -> impl Iterator<Item = (f64, &Photon)> {
        let scale = if self.squared_radius > 0.0 { 1.0 / self.squared_radius } else { 0.0 };
        self.found.iter().map(move |&(d, i)| (d * scale, &self.photons[i as usize]))
    }

    /// Area of the disk within the radius [scene units²].
    #[inline]
    pub fn area(&self) -> f64 {
        PI * self.squared_radius
    }
}
