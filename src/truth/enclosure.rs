//! Enclosures in which light moves as a finite Markov chain: their surfaces fall into patches, and a cosine-distributed
//! ray from patch i meets patch j with a probability P_ij that is the same from every point of i.
//!
//! On a sphere, seen from inside, that probability is the area fraction of j wherever the ray starts: all rows are equal
//! and a path is an i.i.d. sequence of patches. Each constructor is an enclosure whose P_ij are known exactly.

use super::linear::{self, Matrix};
use super::moments::LOST;
use crate::scene::Rgb;
use crate::scene::library::Patch;

/// What a patch reflects, by Lambert's law, and emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Fraction of the arriving light that is reflected, each channel in [0, 1].
    pub albedo: Rgb,
    /// Emitted radiance [W m^-2 sr^-1].
    pub le: Rgb,
}

/// Patches and what they see of each other.
#[derive(Clone, Debug)]
pub struct Enclosure {
    patches: Vec<Wall>,
    /// P; what a row lacks to 1 escapes into the black.
    sees: Matrix,
    /// Whether cos cos' / d² is the same between any two points, so that the rows are area fractions.
    spherical: bool,
}

/// Which bounces count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// All.
    All,
    /// One.
    Only(u32),
    /// This one and all later ones.
    From(u32),
}

impl Counted {
    /// Whether light scattered so many times counts.
    pub fn contains(self, bounce: u32) -> bool {
        match self {
            Counted::All => true,
            Counted::Only(b) => bounce == b,
            Counted::From(b) => bounce >= b,
        }
    }

    /// From here on, all bounces are treated alike.
    pub fn settled(self) -> u32 {
        match self {
            Counted::All => 0,
            Counted::Only(b) => b + 1,
            Counted::From(b) => b,
        }
    }
}

impl Enclosure {
    /// Any chain: a cosine-distributed ray from patch i meets patch j with probability `sees[i][j]`, and nothing with
    /// what the row lacks to 1.
    ///
    /// # Panics
    ///
    /// If `sees` is not square, has a negative entry, or a row whose sum exceeds 1.
    pub fn new(patches: Vec<Wall>, sees: Vec<Vec<f64>>) -> Self {
        let is_row = |row: &Vec<f64>| {
            let sum: f64 = row.iter().sum();
            row.len() == patches.len() && row.iter().all(|&p| p >= 0.0) && sum <= 1.0 + LOST
        };
        assert!(sees.len() == patches.len() && sees.iter().all(is_row), "not a chain: {sees:?}");
        Enclosure { patches, sees, spherical: false }
    }

    /// A closed enclosure of one material, of any shape.
    pub fn furnace(material: Wall) -> Self {
        Enclosure::new(vec![material], vec![vec![1.0]])
    }

    /// A sphere seen from inside; P_ij is the area fraction of j.
    pub fn sphere(patches: &[Patch]) -> Self {
        let material = |p: &Patch| Wall { albedo: p.albedo, le: p.emission };
        let fractions: Vec<f64> = patches.iter().map(|p| p.fraction).collect();
        let sees = vec![fractions; patches.len()];
        Enclosure { spherical: true, ..Enclosure::new(patches.iter().map(material).collect(), sees) }
    }

    /// Concentric spheres, patch 0 the outside of the inner one and patch 1 the inside of the outer one;
    /// `k` = (inner radius / outer radius)², in (0, 1), is by reciprocity what the outer one sees of the inner one.
    pub fn concentric(inner: Wall, outer: Wall, k: f64) -> Self {
        Enclosure::new(vec![inner, outer], vec![vec![0.0, 1.0], vec![k, 1.0 - k]])
    }

    /// Infinite parallel plates that face each other, patches 0 and 1.
    pub fn plates(lower: Wall, upper: Wall) -> Self {
        Enclosure::new(vec![lower, upper], vec![vec![0.0, 1.0], vec![1.0, 0.0]])
    }

    /// The inside of a spherical cap closed by a flat lid, patches 0 (lid) and 1 (cap); `fraction` in (0, 1) is the
    /// cap's share of its whole sphere, which is also what the cap sees of itself: the rest of the sphere, seen through
    /// the lid, would take up the rest.
    pub fn cap(lid: Wall, cap: Wall, fraction: f64) -> Self {
        Enclosure::new(vec![lid, cap], vec![vec![0.0, 1.0], vec![1.0 - fraction, fraction]])
    }

    /// A hemispherical dome over its floor, patches 0 (floor) and 1 (dome).
    pub fn dome(floor: Wall, dome: Wall) -> Self {
        Enclosure::cap(floor, dome, 0.5)
    }

    /// What the patches are made of.
    pub fn patches(&self) -> &[Wall] {
        &self.patches
    }

    /// With which probability a cosine-distributed ray from a patch meets each of them.
    pub fn seen_from(&self, patch: usize) -> &[f64] {
        &self.sees[patch]
    }

    /// Whether cos cos' / d² is the same between any two points [m^-2], as on a sphere only.
    pub fn is_spherical(&self) -> bool {
        self.spherical
    }

    /// Whether light goes on from everywhere: no patch is black, and none sees the void.
    pub fn never_absorbs(&self) -> bool {
        self.patches.iter().all(|p| p.albedo != Rgb::ZERO) && self.sees.iter().all(|row| is_closed(row))
    }

    /// Whether all patches have the same albedo.
    pub fn has_one_albedo(&self) -> bool {
        self.patches.iter().all(|p| p.albedo == self.patches[0].albedo)
    }

    /// Whether all rays meet the same material.
    pub fn is_furnace(&self) -> bool {
        self.patches.iter().all(|p| *p == self.patches[0]) && self.sees.iter().all(|row| is_closed(row))
    }

    /// Whether no ray escapes.
    pub fn is_closed(&self) -> bool {
        self.sees.iter().all(|row| is_closed(row))
    }

    /// P_ij, each times a weight for going from a patch to number j.
    pub fn weighted(&self, weight: impl Fn(&Wall, usize) -> f64) -> Matrix {
        let entry =
            |i: usize, (j, &p): (usize, &f64)| if p == 0.0 { 0.0 } else { p * weight(&self.patches[i], j) };
        let row = |(i, row): (usize, &Vec<f64>)| row.iter().enumerate().map(|to| entry(i, to)).collect();
        self.sees.iter().enumerate().map(row).collect()
    }

    /// Radiance [W m^-2 sr^-1] leaving a patch that was scattered so many times, without any simulation: with
    /// T = diag(rho) P, T^k Le, and its sum over k, (I - T)⁻¹ T^k Le.
    pub fn radiance(&self, patch: usize, channel: usize, counted: Counted) -> f64 {
        let scattering = self.weighted(|p, _| p.albedo[channel]);
        let scatter = |l: Vec<f64>, _| scattering.iter().map(|row| average(row, &l)).collect();
        let after = |bounces| {
            let emitted = self.patches.iter().map(|p| p.le[channel]).collect();
            (0..bounces).fold(emitted, scatter)
        };
        let from = |k| linear::solve(&scattering, &after(k))[patch].unwrap_or(f64::INFINITY);
        match counted {
            Counted::Only(k) => after(k)[patch],
            Counted::All | Counted::From(0) => self.patches[patch].le[channel] + from(1),
            Counted::From(k) => from(k),
        }
    }
}

/// The sum of values weighted by probabilities; what has probability 0 may be infinite.
pub fn average(probabilities: &[f64], values: &[f64]) -> f64 {
    probabilities.iter().zip(values).filter(|(p, _)| **p > 0.0).map(|(p, v)| p * v).sum()
}

/// Whether a row of the chain sees nothing but patches.
fn is_closed(row: &[f64]) -> bool {
    row.iter().sum::<f64>() >= 1.0 - LOST
}
