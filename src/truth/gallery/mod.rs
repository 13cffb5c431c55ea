//! Scenes that have a closed form, one a file: what there is, and what light does there.
//!
//! A new one is a file here and its line in [`EXHIBITS`]. None is symmetrical without need, of unit size or at the
//! origin: symmetry hides mistakes.

mod disk_light;

use crate::estimator::Estimator;
use crate::scene::Rgb;
use crate::scene::library::{SceneKind, Setting};
use crate::truth::Counted;
use std::ops::RangeInclusive;

/// All of them.
pub const EXHIBITS: [&Exhibit; 1] = [&disk_light::EXHIBIT];

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
    pub theory: fn(f64) -> Series,
    /// Variance of one sample, where it is known.
    pub variance: fn(f64, &Estimator) -> Option<Rgb>,
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
