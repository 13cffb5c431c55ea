//! Stored images with standard errors: those of an independent renderer (`references/README.md`), a user's, our own.

use super::layers::{BadReference, Layers, rgb_names};
use super::own::{Own, Provenance};
use crate::scene::Rgb;
use crate::scene::library::SceneKind;

/// Pixel means and their standard errors, row by row from the top left.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Pixels along each edge.
    pub size: usize,
    /// Mean radiance of each pixel [W m^-2 sr^-1].
    pub mean: Vec<Rgb>,
    /// Standard error of each mean.
    pub std_error: Vec<Rgb>,
    /// Degrees of freedom of the standard errors.
    pub df: f64,
    /// Bound on the relative systematic error of a tile; image means are taken to have none.
    pub systematic: f64,
    /// How we made it ourselves; `None` for an independent renderer.
    pub provenance: Option<Provenance>,
}

/// Degrees of freedom of the stored standard errors: 32 independent renderings.
pub const DF: f64 = 31.0;

/// Relative systematic error of a tile: the independent renderer works in single precision and offsets its rays, which
/// alone moves values near contacts and in penumbrae by up to this much; image means are not affected.
pub const TILE_SYSTEMATIC: f64 = 1e-3;

/// A mean over pixels with its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// Mean radiance.
    pub mean: Rgb,
    /// Its standard error; pixels are independent.
    pub std_error: Rgb,
    /// Absolute bound on its systematic error.
    pub systematic: Rgb,
}

impl Reference {
    /// The independent renderer's image of a scene that came with the program, if there is one.
    pub fn of(scene: &SceneKind) -> Option<Self> {
        let bytes: &[u8] = match scene {
            SceneKind::CornellBox { .. } => include_bytes!("../../references/cornell_box_32x32.exr"),
            SceneKind::CornellEmpty { .. } => include_bytes!("../../references/cornell_empty_32x32.exr"),
            _ => return None,
        };
        let reference = Self::read(bytes).expect("the stored references are part of the program");
        Some(Reference { systematic: TILE_SYSTEMATIC, ..reference })
    }

    /// Reads an EXR file: `R G B` with `std_error.*`, or with `variance.*` of one sample and `samples`, in single
    /// precision; or a reference of our own, whose state is exact. No tile is taken to have a systematic error.
    pub fn read(bytes: &[u8]) -> Result<Self, BadReference> {
        let layers = Layers::read(bytes)?;
        if layers.provenance.is_some() {
            return Own::from_layers(&layers)?.reference();
        }
        let known = ["", "std_error.", "variance.", "bias.", "bias_std_error."].map(rgb_names);
        layers.only(&[&known.concat()[..], &["samples".to_owned()]].concat())?;
        let mean = layers.rgb("")?;
        let (std_error, df) = if layers.any(&rgb_names("std_error.")) {
            (layers.rgb("std_error.")?, DF)
        } else if layers.any(&rgb_names("variance.")) {
            let variance = layers.rgb("variance.")?;
            let enough = |n: f64| n.is_finite() && n >= 2.0;
            let samples = layers.checked("samples", "at least 2 samples, or there is no error", enough)?;
            let std_error = variance.iter().zip(&samples).map(|(&v, &n)| root(v / n)).collect();
            (std_error, samples.iter().fold(f64::INFINITY, |least, n| least.min(n - 1.0)))
        } else {
            return Err(BadReference::NoVariance);
        };
        if std_error.iter().all(|&error| error == Rgb::ZERO) {
            return Err(BadReference::NoVariance);
        }
        Ok(Reference { size: layers.width, mean, std_error, df, systematic: 0.0, provenance: None })
    }

    /// Refuses a reference that cannot stand beside an image of `image` x `image` pixels, which is divided into
    /// `tiles` x `tiles`; a probe's image is one pixel and has none.
    pub fn fits(&self, image: usize, tiles: usize) -> Result<(), BadReference> {
        let size = self.size;
        let tiles = if image == 1 { 1 } else { tiles };
        let fits = size.is_multiple_of(tiles) && (image > 1 || size == 1);
        if fits { Ok(()) } else { Err(BadReference::Tiles { size, tiles, image }) }
    }

    /// Mean over the whole image.
    pub fn image(&self) -> Stored {
        Stored { systematic: Rgb::ZERO, ..self.over(0..self.size, 0..self.size) }
    }

    /// Mean over one of `tiles` x `tiles` equal squares; `tiles` divides [`Reference::size`].
    pub fn tile(&self, tiles: usize, x: usize, y: usize) -> Stored {
        let edge = self.size / tiles;
        self.over(x * edge..(x + 1) * edge, y * edge..(y + 1) * edge)
    }

    fn over(&self, xs: std::ops::Range<usize>, ys: std::ops::Range<usize>) -> Stored {
        let count = (xs.len() * ys.len()) as f64;
        let (mut sum, mut variance) = (Rgb::ZERO, Rgb::ZERO);
        for y in ys {
            for x in xs.clone() {
                sum += self.mean[y * self.size + x];
                let std_error = self.std_error[y * self.size + x];
                variance += std_error * std_error;
            }
        }
        let mean = sum / count;
        Stored { mean, std_error: root(variance) / count, systematic: mean * self.systematic }
    }
}

/// Square root of each channel.
pub(super) fn root(v: Rgb) -> Rgb {
    Rgb::new(v.x.sqrt(), v.y.sqrt(), v.z.sqrt())
}
