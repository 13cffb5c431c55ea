//! An image as its EXR file has it, and the bytes in which the page carries it.

use super::{difference, images};
use crate::scene::Rgb;
use crate::truth::layers::{Layers, rgb_names};
use crate::truth::{BadReference, Reference};

/// Codes of standard errors to one doubling: neighbours differ by 6 %, so that a code is right to 3 %.
pub const CODES: f64 = 12.0;

/// The code of a standard error of 1; smaller ones down to the smallest number of single precision have codes from 1 on.
const ONE: f64 = 1801.0;

/// The code of what is not finite.
const UNKNOWN: u16 = u16::MAX;

/// Means and standard errors of pixels: red, green, blue, each row by row from the top left [W m^-2 sr^-1].
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Pixels from left to right.
    pub width: usize,
    /// Pixels from top to bottom.
    pub height: usize,
    /// The mean of each pixel, bit by bit that of the file.
    pub mean: [Vec<f32>; 3],
    /// The standard error of each mean.
    pub std_error: [Vec<f32>; 3],
    /// Samples a pixel; 0 where the file does not say.
    pub samples: u64,
}

impl Raster {
    /// Reads what [`images::exr`] wrote of an image with `size` pixels across and down. Any value may be among them.
    pub fn read(bytes: &[u8], size: (usize, usize)) -> Result<Self, BadReference> {
        let layers = Layers::read_sized(bytes, size)?;
        let samples = layers.channel("samples")?;
        let error = |(&variance, &n): (&f32, &f32)| (f64::from(variance) / f64::from(n)).sqrt() as f32;
        let (mut mean, mut std_error) = ([const { Vec::new() }; 3], [const { Vec::new() }; 3]);
        for (c, (name, of)) in rgb_names("").iter().zip(rgb_names("variance.")).enumerate() {
            mean[c] = layers.channel(name)?.to_vec();
            std_error[c] = layers.channel(&of)?.iter().zip(samples).map(error).collect();
        }
        let samples = samples.first().map_or(0, |&n| n as u64);
        Ok(Raster { width: size.0, height: size.1, mean, std_error, samples })
    }

    /// A reference on the finest grid that it shares with an image; `None` beside an image that is not square.
    pub fn of_reference(reference: &Reference, (width, height): (usize, usize)) -> Option<Self> {
        let blocks = difference::common_blocks(width, height, reference)?;
        let stored: Vec<_> =
            (0..blocks * blocks).map(|i| reference.tile(blocks, i % blocks, i / blocks)).collect();
        let mean = [0, 1, 2].map(|c| stored.iter().map(|s| s.mean[c] as f32).collect());
        let std_error = [0, 1, 2].map(|c| stored.iter().map(|s| s.std_error[c] as f32).collect());
        Some(Raster { width: blocks, height: blocks, mean, std_error, samples: 0 })
    }

    /// The exposure that suits it, see [`images::exposure`].
    pub fn exposure(&self) -> f64 {
        let [r, g, b] = &self.mean;
        images::exposure(r.iter().zip(g).zip(b).map(|((&r, &g), &b)| f64::from(r.max(g).max(b))))
    }

    /// The means of squares of `edge` x `edge` pixels; pixels have independent errors. `edge` divides width and height.
    pub fn reduced(&self, edge: usize) -> Self {
        if edge == 1 {
            return self.clone(); // bit by bit, also what is not a number
        }
        let (width, height) = (self.width / edge, self.height / edge);
        let square = move |i: usize| {
            let corner = i / width * edge * self.width + i % width * edge;
            (0..edge * edge).map(move |k| corner + k / edge * self.width + k % edge)
        };
        let count = (edge * edge) as f64;
        let mean = |values: &Vec<f32>| {
            let one = |i| square(i).map(|at| f64::from(values[at])).sum::<f64>() / count;
            (0..width * height).map(|i| one(i) as f32).collect()
        };
        let error = |values: &Vec<f32>| {
            let one = |i| square(i).map(|at| f64::from(values[at]) * f64::from(values[at])).sum::<f64>();
            (0..width * height).map(|i| (one(i).sqrt() / count) as f32).collect()
        };
        Raster {
            width,
            height,
            mean: self.mean.each_ref().map(mean),
            std_error: self.std_error.each_ref().map(error),
            samples: self.samples,
        }
    }

    /// Means and standard errors, pixel by pixel.
    pub fn rgb(&self) -> [Vec<Rgb>; 2] {
        [&self.mean, &self.std_error].map(|[r, g, b]| {
            let pixel = |((&r, &g), &b): ((&f32, &f32), &f32)| Rgb::new(r.into(), g.into(), b.into());
            r.iter().zip(g).zip(b).map(pixel).collect()
        })
    }

    /// The bytes that `viewer_data.js` reads, laid out to be compressed.
    ///
    /// First the means: red, green less red, blue less green, as whole numbers of 32 bits that wrap, each split into four
    /// planes from the lowest byte to the highest. Then the codes of the standard errors as whole numbers of 16 bits: red,
    /// each less the one before it, green less red, blue less green, folded so that small differences of either sign are
    /// small numbers (0, -1, 1, -2 become 0, 1, 2, 3); the lower bytes of all three, then the upper ones. A code c stands
    /// for 2^((c - 1801) / 12), 0 for 0, and 65535 for what is not finite.
    pub fn packed(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for c in 0..3 {
            let before = |i: usize| if c == 0 { 0 } else { self.mean[c - 1][i].to_bits() };
            let words = self.mean[c].iter().enumerate().map(|(i, v)| v.to_bits().wrapping_sub(before(i)));
            let words: Vec<[u8; 4]> = words.map(u32::to_le_bytes).collect();
            (0..4).for_each(|plane| bytes.extend(words.iter().map(|word| word[plane])));
        }
        let codes =
            [0, 1, 2].map(|c| self.std_error[c].iter().map(|&error| code(error)).collect::<Vec<u16>>());
        let mut folded = Vec::new();
        for c in 0..3 {
            let before = |i: usize| match (c, i) {
                (0, 0) => 0,
                (0, _) => codes[0][i - 1],
                _ => codes[c - 1][i],
            };
            folded.extend(codes[c].iter().enumerate().map(|(i, code)| fold(code.wrapping_sub(before(i)))));
        }
        (0..2).for_each(|plane| bytes.extend(folded.iter().map(|word: &u16| word.to_le_bytes()[plane])));
        bytes
    }
}

fn code(error: f32) -> u16 {
    match error {
        _ if !error.is_finite() => UNKNOWN,
        _ if error <= 0.0 => 0,
        _ => (ONE + CODES * libm::log2(f64::from(error))).round() as u16,
    }
}

/// Of a difference that wraps.
fn fold(difference: u16) -> u16 {
    let signed = difference as i16;
    ((signed << 1) ^ (signed >> 15)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_have_the_mean_of_their_pixels_and_its_error() {
        let mean: Vec<f32> = (0..24).map(|i| i as f32).collect();
        let raster = Raster {
            width: 6,
            height: 4,
            mean: [mean.clone(), mean.clone(), vec![f32::NAN; 24]],
            std_error: [vec![2.0; 24], vec![0.0; 24], mean.clone()],
            samples: 5,
        };
        let reduced = raster.reduced(2);
        assert_eq!((reduced.width, reduced.height, reduced.samples), (3, 2, 5));
        // 0, 1, 6, 7 and so on
        assert_eq!(reduced.mean[0], [3.5, 5.5, 7.5, 15.5, 17.5, 19.5]);
        assert!(reduced.mean[2].iter().all(|v| v.is_nan()));
        assert_eq!(reduced.std_error[0], [1.0; 6]);
        assert_eq!(reduced.std_error[1], [0.0; 6]);
        assert_eq!(reduced.std_error[2][0], (86.0_f32).sqrt() / 4.0);
    }
}
