//! Stored images of the Cornell scenes from an independent renderer, with standard errors (`references/README.md`).

use crate::scene::Rgb;
use crate::scene::library::SceneKind;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::io::Cursor;

/// Pixel means and their standard errors, row by row from the top left.
pub struct Reference {
    /// Pixels along each edge.
    pub size: usize,
    /// Mean radiance of each pixel [W m^-2 sr^-1].
    pub mean: Vec<Rgb>,
    /// Standard error of each mean.
    pub std_error: Vec<Rgb>,
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
    /// The stored image of a scene, if there is one.
    pub fn of(scene: &SceneKind) -> Option<Self> {
        let bytes: &[u8] = match scene {
            SceneKind::CornellBox { .. } => include_bytes!("../../references/cornell_box_32x32.exr"),
            SceneKind::CornellEmpty { .. } => include_bytes!("../../references/cornell_empty_32x32.exr"),
            _ => return None,
        };
        Some(decode(bytes).expect("the stored references are part of the program"))
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
        let std_error = Rgb::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt()) / count;
        Stored { mean, std_error, systematic: mean * TILE_SYSTEMATIC }
    }
}

fn decode(bytes: &[u8]) -> Option<Reference> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .ok()?;
    let layer = image.layer_data;
    let channel = |name: &str| -> Option<Vec<f64>> {
        let found = layer.channel_data.list.iter().find(|c| c.name.to_string() == name)?;
        match &found.sample_data {
            FlatSamples::F32(values) => Some(values.iter().map(|&v| f64::from(v)).collect()),
            _ => None,
        }
    };
    let rgb = |prefix: &str| -> Option<Vec<Rgb>> {
        let [r, g, b] = ["R", "G", "B"].map(|c| channel(&format!("{prefix}{c}")));
        Some(r?.into_iter().zip(g?).zip(b?).map(|((r, g), b)| Rgb::new(r, g, b)).collect())
    };
    let size = layer.size.width();
    Some(Reference { size, mean: rgb("")?, std_error: rgb("std_error.")? })
}
