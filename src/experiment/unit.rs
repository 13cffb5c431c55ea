//! What is journalled as one: a block of a probe, or a few blocks of an image with their pixels together, which are large.

use super::block::Block;
use super::pixels::Pixels;
use super::plan::CellPlan;
use crate::scene::Rgb;
use std::ops::Range;

/// Consecutive blocks, whose pixels are merged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unit {
    /// The blocks, without pixels.
    pub blocks: Vec<Block>,
    /// The pixels of all of them; empty for a probe.
    pub pixels: Pixels,
}

/// Paths of a unit of an image, at most: so many that keeping its pixels costs little beside them.
const PATHS: u64 = 1 << 21;

/// Rays of a unit of an image, at most, by the plan, which may foresee several times those that there are: about a second's
/// work.
const RAYS: f64 = 5e7;

/// Blocks of a unit, at most.
const BLOCKS: u64 = 16;

/// How many blocks of a cell make a unit.
pub(super) fn blocks(cell: &CellPlan) -> u64 {
    if cell.pixels == 1 {
        return 1;
    }
    let by_rays = RAYS / (cell.rays * cell.block as f64).max(1.0);
    (PATHS / (cell.block * cell.pixels)).min(by_rays as u64).clamp(1, BLOCKS)
}

impl Unit {
    /// Adds the next block.
    pub fn push(&mut self, mut block: Block) {
        let pixels = std::mem::take(&mut block.pixels);
        if pixels.is_image() {
            self.pixels.merge(&pixels);
        }
        self.blocks.push(block);
    }

    /// Rays traced by all of it.
    pub fn rays(&self) -> f64 {
        self.blocks.iter().map(|block| block.tally.rays as f64).sum()
    }

    /// The blocks `numbers` of a cell, from their records and the bytes of their pixels; `None` where they are not what the
    /// cell has.
    pub fn read(cell: &CellPlan, numbers: &Range<u64>, bytes: &[u8]) -> Option<Self> {
        let (mut blocks, mut rest) = (Vec::new(), bytes);
        for _ in numbers.clone() {
            let (block, left) = postcard::take_from_bytes::<Block>(rest).ok()?;
            if !block.fits(cell.block, &cell.streams) {
                return None;
            }
            blocks.push(block);
            rest = left;
        }
        let samples = (numbers.end - numbers.start) * cell.block;
        let pixels = match cell.pixels {
            1 => Pixels::default(),
            pixels => read_pixels(rest, pixels, samples)?,
        };
        (cell.pixels > 1 || rest.is_empty()).then_some(Unit { blocks, pixels })
    }

    /// Appends the bytes of its pixels.
    pub fn write_pixels(&self, bytes: &mut Vec<u8>) {
        let Pixels { width, height, mean, m2, .. } = &self.pixels;
        if !self.pixels.is_image() {
            return;
        }
        bytes.extend(width.to_le_bytes());
        bytes.extend(height.to_le_bytes());
        for values in [mean, m2] {
            let start = bytes.len();
            bytes.resize(start + size_of_val(values.as_slice()), 0);
            // fixed sizes: a copy, not a loop over bytes
            for (to, value) in bytes[start..].as_chunks_mut::<24>().0.iter_mut().zip(values) {
                let [x, y, z] = value.to_array().map(f64::to_le_bytes);
                to[..8].copy_from_slice(&x);
                to[8..16].copy_from_slice(&y);
                to[16..].copy_from_slice(&z);
            }
        }
    }
}

/// The record of a block.
pub fn record(block: &Block) -> Vec<u8> {
    postcard::to_allocvec(block).expect("numbers have a form")
}

/// So many pixels of so many samples each.
fn read_pixels(bytes: &[u8], pixels: u64, n: u64) -> Option<Pixels> {
    let (width, rest) = bytes.split_first_chunk()?;
    let (height, rest) = rest.split_first_chunk()?;
    let (width, height) = (u32::from_le_bytes(*width), u32::from_le_bytes(*height));
    let expected = usize::try_from(pixels).ok()?.checked_mul(2 * size_of::<Rgb>())?;
    if u64::from(width) * u64::from(height) != pixels || rest.len() != expected {
        return None;
    }
    let (values, _) = rest.as_chunks::<8>();
    let mut values = values.iter().map(|x| f64::from_le_bytes(*x));
    let mut next = || Some(Rgb::new(values.next()?, values.next()?, values.next()?));
    let mut all = |_| next();
    let mean = (0..pixels).map_while(&mut all).collect();
    let m2 = (0..pixels).map_while(&mut all).collect();
    Some(Pixels { width, height, n, mean, m2 })
}
