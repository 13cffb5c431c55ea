//! Scenes that have a closed form, one a file: what there is, and what light does there.
//!
//! A new one is a file here and its line in [`EXHIBITS`]. None is symmetrical without need, of unit size or at the
//! origin: symmetry hides mistakes.

mod clear_slab;
mod concentric_spheres;
mod disk_light;
mod dome;
mod glass_ball;
mod hidden_light;
mod lens_edge;
mod metal_light;
mod mirror_furnace;
mod mirror_light;
mod moving_edge;
mod parallel_plates;
mod pixel_edge;
mod point_in_sphere;
pub mod point_near_wall;
mod point_over_plane;
mod polygon_light;
mod pool_caustic;
mod props;
mod rising_light;
mod sky_over_plane;
mod sphere_light;
mod turned_light;
mod unequal_lights;
mod uniform_sky;
mod water_floor;

use super::{Counted, Enclosure};
use crate::estimator::{Estimator, Explicit, Roulette, Rule, Technique};
use crate::scene::library::{Primitive, SceneKind, Setting};
use crate::scene::{Directions, Rgb};
use std::ops::RangeInclusive;

/// All of them.
pub const EXHIBITS: [&Exhibit; 25] = [
    &disk_light::EXHIBIT,
    &polygon_light::EXHIBIT,
    &sphere_light::EXHIBIT,
    &unequal_lights::EXHIBIT,
    &hidden_light::EXHIBIT,
    &turned_light::EXHIBIT,
    &point_over_plane::EXHIBIT,
    &point_in_sphere::EXHIBIT,
    &point_near_wall::EXHIBIT,
    &uniform_sky::EXHIBIT,
    &sky_over_plane::EXHIBIT,
    &concentric_spheres::EXHIBIT,
    &parallel_plates::EXHIBIT,
    &dome::EXHIBIT,
    &mirror_light::EXHIBIT,
    &metal_light::EXHIBIT,
    &mirror_furnace::EXHIBIT,
    &glass_ball::EXHIBIT,
    &clear_slab::EXHIBIT,
    &water_floor::EXHIBIT,
    &pool_caustic::EXHIBIT,
    &pixel_edge::EXHIBIT,
    &lens_edge::EXHIBIT,
    &moving_edge::EXHIBIT,
    &rising_light::EXHIBIT,
];

/// A scene with a closed form.
pub struct Exhibit {
    /// What files call it.
    pub name: &'static str,
    /// What it shows, in a sentence.
    pub about: &'static str,
    /// What can be swept.
    pub parameter: Parameter,
    /// What there is.
    pub setting: fn(f64) -> Setting,
    /// What light does there.
    pub theory: Theory,
}

/// How light is known, as functions of the parameter.
pub enum Theory {
    /// Bounce by bounce.
    Series {
        /// The measured quantity.
        mean: fn(f64) -> Series,
        /// The part of it that an estimator has no way to find.
        missed: fn(f64, &Estimator) -> Option<Series>,
        /// Variance of one sample, where it is known; it may be infinite.
        variance: fn(f64, &Estimator) -> Option<Rgb>,
    },
    /// As a Markov chain of patches.
    Chain {
        /// The patches and what they see.
        enclosure: fn(f64) -> Enclosure,
        /// The patch that the probe looks at.
        looks_at: usize,
        /// How sampled lights scatter.
        tail: Tail,
    },
}

/// Whether light sampled on emitters has a power-law tail, and its index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tail {
    /// It has none.
    None,
    /// Where points are uniform over area; by solid angle there is none.
    ByArea(f64),
    /// Always: the emitters' shapes have no map by solid angle.
    Always(f64),
}

/// A number that a scene depends on.
pub struct Parameter {
    /// What it is called.
    pub name: &'static str,
    /// Its value unless a file says otherwise.
    pub usual: f64,
    /// Where the closed form holds.
    pub range: RangeInclusive<f64>,
}

/// The measured quantity by the number of scattering events.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Light scattered 0, 1, 2, ... times.
    pub first: Vec<Rgb>,
    /// What each later bounce is to the one before.
    pub ratio: Rgb,
}

impl Series {
    /// Light that is scattered at most `first.len() - 1` times.
    pub fn finite(first: Vec<Rgb>) -> Self {
        Series { first, ratio: Rgb::ZERO }
    }

    /// Light that was scattered so many times.
    pub fn sum(&self, counted: Counted) -> Rgb {
        let last = *self.first.last().expect("a series starts with emission");
        let len = self.first.len() as u32;
        let bounce = |k: u32| match self.first.get(k as usize) {
            Some(&value) => value,
            None => (len..=k).fold(last, |value, _| value * self.ratio),
        };
        match counted {
            Counted::Only(k) => bounce(k),
            Counted::All => self.sum(Counted::From(0)),
            Counted::From(k) if k >= len => bounce(k) / (Rgb::ONE - self.ratio),
            Counted::From(k) => {
                let listed: Rgb = self.first[k as usize..].iter().sum();
                listed + last * self.ratio / (Rgb::ONE - self.ratio)
            }
        }
    }
}

impl Exhibit {
    /// The scene at a parameter.
    pub fn scene(&self, parameter: f64) -> SceneKind {
        SceneKind::Exhibit { name: self.name.to_owned(), parameter, setting: (self.setting)(parameter) }
    }
}

/// Every path tracer finds all of it.
fn nothing_missed(_: f64, _: &Estimator) -> Option<Series> {
    None
}

/// Whether the first continuation is one sample, certain and unweighted.
fn one_sample(roulette: &Roulette) -> bool {
    roulette.rule == Rule::None && roulette.reaches(1)
}

/// Whether light is found by one cosine-weighted direction without roulette, and in no other way.
fn cosine_without_roulette(estimator: &Estimator) -> bool {
    match estimator {
        Estimator::Implicit(e) => e.directions == Directions::Cosine && one_sample(&e.roulette),
        Estimator::Explicit(e) => {
            e.technique == Technique::Direction
                && e.directions == Directions::Cosine
                && one_sample(&e.roulette)
        }
        Estimator::Recursive(_) | Estimator::LightTracing(_) | Estimator::PhotonMap(_) => false,
    }
}

/// Variance of a picture that shows `le` with probability `p`.
fn covered(le: Rgb, p: f64) -> Rgb {
    le * le * (p * (1.0 - p))
}

/// Whether direct light is sampled on emitters alone, and directions by the cosine.
fn sampled_by_cosine(e: &Explicit) -> bool {
    e.technique == Technique::Light && e.directions == Directions::Cosine
}

/// Variance of light found by cosine-weighted directions alone, where it fills the fraction `form_factor` of the
/// hemisphere weighted by the cosine, and nothing else shines: (albedo Le)² (F / (N q) + F² (1 - 1/N) - F²), for N
/// samples that each survive with probability q.
fn by_chance(estimator: &Estimator, form_factor: f64, albedo: Rgb, le: Rgb) -> Option<Rgb> {
    let (samples, directions, roulette) = match estimator {
        Estimator::Recursive(e) => (f64::from(e.samples), e.directions, e.roulette),
        Estimator::Implicit(e) => (1.0, e.directions, e.roulette),
        Estimator::Explicit(e) if e.technique == Technique::Direction => (1.0, e.directions, e.roulette),
        Estimator::Explicit(_) | Estimator::LightTracing(_) | Estimator::PhotonMap(_) => return None,
    };
    let q = roulette.q(0, Rgb::ONE, albedo);
    if directions != Directions::Cosine || !(q > 0.0 && q <= 1.0) || !roulette.reaches(1) {
        return None;
    }
    let scale = albedo * le;
    Some(scale * scale * (form_factor * (1.0 / q - form_factor) / samples))
}

/// The exhibit of this name.
pub fn find(name: &str) -> Option<&'static Exhibit> {
    EXHIBITS.into_iter().find(|exhibit| exhibit.name == name)
}

/// What to say where there is none of this name.
pub fn unknown(name: &str) -> String {
    let distance = |known: &&str| strsim::damerau_levenshtein(name, known);
    let known: Vec<&str> = EXHIBITS.iter().map(|exhibit| exhibit.name).collect();
    let near =
        known.iter().copied().min_by_key(distance).filter(|known| distance(known) <= 1 + name.len() / 4);
    match near {
        Some(near) => format!("the gallery has no `{name}`; did you mean `{near}`?"),
        None => format!("the gallery has no `{name}`; there are: {}", known.join(", ")),
    }
}
