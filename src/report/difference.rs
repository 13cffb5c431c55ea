//! Where an image is wrong: signed differences from a stored image, block by block, and a map of them.

use super::figure::{Colour, font};
use super::images;
use crate::experiment::pixels::Pixels;
use crate::scene::Rgb;
use crate::truth::Reference;

/// A block's colour is full from so many standard errors on.
pub const FULL: f64 = 4.0;

/// A map shows no more blocks than this along an edge: smaller ones would neither be seen nor reach one standard error.
const MOST_BLOCKS: usize = 64;

/// Edge of a map and of one of its four fields, three channels and the legend, in pixels.
const EDGE: usize = 264;
const FIELD: usize = 128;

/// Measured less right, in equal squares that both pictures have.
pub struct Difference {
    /// Squares along each edge.
    pub blocks: usize,
    /// The difference in each, row by row from the top left [W m^-2 sr^-1].
    pub bias: Vec<Rgb>,
    /// Its standard error: that of the picture and that of the reference together.
    pub std_error: Vec<Rgb>,
}

impl Difference {
    /// On the finest grid that both have; `None` for a picture that is not square.
    pub fn of(pixels: &Pixels, reference: &Reference) -> Option<Self> {
        let (width, height) = (pixels.width as usize, pixels.height as usize);
        common_blocks(width, height, reference).map(|blocks| Self::on(blocks, pixels, reference))
    }

    fn on(blocks: usize, pixels: &Pixels, reference: &Reference) -> Self {
        let width = pixels.width as usize;
        let edge = width / blocks;
        let count = (edge * edge) as f64;
        let samples = ((pixels.n - 1) * pixels.n) as f64;
        let one = |block: usize| {
            let (x, y) = (block % blocks, block / blocks);
            let (mut mean, mut m2) = (Rgb::ZERO, Rgb::ZERO);
            for row in y * edge..(y + 1) * edge {
                for i in row * width + x * edge..row * width + (x + 1) * edge {
                    mean += pixels.mean[i];
                    m2 += pixels.m2[i];
                }
            }
            let right = reference.tile(blocks, x, y);
            let squared = m2 / (samples * count * count) + right.std_error * right.std_error;
            (mean / count - right.mean, Rgb::from_array(squared.to_array().map(f64::sqrt)))
        };
        let (bias, std_error) = (0..blocks * blocks).map(one).unzip();
        Difference { blocks, bias, std_error }
    }

    /// One of its lists spread over the pixels of a picture of so many along each edge.
    pub fn spread(&self, values: &[Rgb], width: usize) -> Vec<Rgb> {
        let edge = width / self.blocks;
        let block = |i: usize| i / width / edge * self.blocks + i % width / edge;
        (0..width * width).map(|i| values[block(i)]).collect()
    }

    /// The difference in standard errors; 0 where nothing differs and nothing varies.
    fn in_errors(&self, block: usize, channel: usize) -> f64 {
        let (bias, error) = (self.bias[block][channel], self.std_error[block][channel]);
        if bias == 0.0 { 0.0 } else { bias / error }
    }
}

/// Blocks along an edge of the finest grid that a picture and a reference both have; `None` for a picture that is not
/// square.
pub fn common_blocks(width: usize, height: usize, reference: &Reference) -> Option<usize> {
    (width == height).then(|| gcd(width, reference.size))
}

/// Blocks along an edge of the map of a picture of `width` pixels.
pub fn map_blocks(width: usize, reference: &Reference) -> usize {
    let common = gcd(width, reference.size);
    (1..=common.min(MOST_BLOCKS)).rev().find(|&n| common.is_multiple_of(n)).unwrap_or(1)
}

/// A PNG of four fields: the signed difference in standard errors in red, green and blue, and the legend.
pub fn map(pixels: &Pixels, reference: &Reference) -> Vec<u8> {
    let difference = Difference::on(map_blocks(pixels.width as usize, reference), pixels, reference);
    let mut picture = vec![[0xFF_u8; 3]; EDGE * EDGE];
    let zoom = FIELD / difference.blocks;
    let shown = zoom * difference.blocks;
    let origin = |field: usize| (field % 2 * (EDGE - FIELD), field / 2 * (EDGE - FIELD));
    for channel in 0..3 {
        let (x0, y0) = origin(channel);
        for (x, y) in (0..shown * shown).map(|i| (i % shown, i / shown)) {
            let errors = difference.in_errors(y / zoom * difference.blocks + x / zoom, channel);
            picture[(y0 + y) * EDGE + x0 + x] = colour(errors / FULL);
        }
    }
    let (x0, y0) = origin(3);
    for (x, y) in (0..FIELD * 16).map(|i| (i % FIELD, i / FIELD)) {
        picture[(y0 + 56 + y) * EDGE + x0 + x] = colour(2.0 * x as f64 / (FIELD - 1) as f64 - 1.0);
    }
    let mut bytes = picture.concat();
    let mut write = |text: &str, centre: usize, top: usize| {
        let left = x0 as f64 + centre as f64 - font::width(text, 12.0) / 2.0;
        font::write(&mut bytes, (EDGE, EDGE), (left, (y0 + top) as f64), text);
    };
    write("R, G, below: B", FIELD / 2, 4);
    write("bias / standard error", FIELD / 2, 34);
    write(&format!("≤ −{FULL}"), 16, 76);
    write("0", FIELD / 2, 76);
    write(&format!("≥ {FULL}"), FIELD - 14, 76);
    images::encode(EDGE as u32, EDGE as u32, &bytes)
}

/// From blue at -1 over white to vermilion at 1: two colours that differ for every colour vision.
pub(super) fn colour(signed: f64) -> [u8; 3] {
    let full = if signed < 0.0 { Colour::Blue.rgb() } else { Colour::Vermilion.rgb() };
    let strength = signed.abs().min(1.0);
    [full.0, full.1, full.2].map(|c| (255.0 + (f64::from(c) - 255.0) * strength + 0.5) as u8)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
