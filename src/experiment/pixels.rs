//! What is kept of an image: each pixel's mean and spread.

use super::cell::{Measured, TILES};
use crate::scene::Rgb;

/// Moments of each pixel's samples, in structure-of-arrays form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pixels {
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from top to bottom.
    pub height: u32,
    /// Samples a pixel.
    pub n: u64,
    /// Mean of each pixel, row by row from the top left.
    pub mean: Vec<Rgb>,
    /// Sum of squared deviations of each pixel.
    pub m2: Vec<Rgb>,
}

impl Pixels {
    /// Adds the next samples.
    pub(super) fn merge(&mut self, other: &Pixels) {
        if self.n == 0 {
            *self = other.clone();
            return;
        }
        let n = (self.n + other.n) as f64;
        let (share, cross) = (other.n as f64 / n, self.n as f64 * other.n as f64 / n);
        for i in 0..self.mean.len() {
            let delta = other.mean[i] - self.mean[i];
            self.mean[i] += delta * share;
            self.m2[i] += other.m2[i] + delta * delta * cross;
        }
        self.n += other.n;
    }

    /// Unbiased variance of one sample of each pixel; needs two samples.
    pub fn variance(&self) -> Vec<Rgb> {
        self.m2.iter().map(|&m2| m2 / (self.n - 1) as f64).collect()
    }

    /// Whether there is an image.
    pub fn is_image(&self) -> bool {
        !self.mean.is_empty()
    }

    /// Mean over one tile; pixels are independent.
    pub(super) fn tile(&self, x: u32, y: u32) -> [Measured; 3] {
        let (w, h) = (self.width / TILES, self.height / TILES);
        let count = f64::from(w * h);
        let (mut mean, mut m2) = (Rgb::ZERO, Rgb::ZERO);
        for row in y * h..(y + 1) * h {
            for column in x * w..(x + 1) * w {
                let i = (row * self.width + column) as usize;
                mean += self.mean[i];
                m2 += self.m2[i];
            }
        }
        let samples = ((self.n - 1) * self.n) as f64;
        [0, 1, 2].map(|c| Measured { mean: mean[c] / count, std_error: (m2[c] / samples).sqrt() / count })
    }
}
