//! What each cell's error costs: its relative mean squared error after any number of samples, and the rays of a sample.

use super::lookup::Lookup;
use crate::experiment::{Estimand, Row};

/// The price of a cell.
pub struct Cost {
    /// The cell.
    pub cell: usize,
    /// Realizations that were made.
    pub samples: u64,
    /// Rays of a realization.
    pub rays: f64,
    /// Red, green and blue; `None` for a channel without light.
    pub channels: [Option<Error>; 3],
}

/// The error in one channel: relative to the truth, its mean square after n samples is `noise / n + floor`.
pub struct Error {
    /// Variance of one realization (of a pixel's, averaged, for an image) over the squared truth; `None` where it may not
    /// be stated.
    pub noise: Option<f64>,
    /// Relative standard error of `noise`; `None` where it is not known.
    pub noise_error: Option<f64>,
    /// Squared relative bias that stays; 0 where all light is found.
    pub floor: f64,
}

/// The costs of all finished cells without a known mistake.
pub fn of(lookup: &Lookup<'_>) -> Vec<Cost> {
    let finished = (0..lookup.plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty());
    finished.filter(|&c| !lookup.is_faulty(c)).filter_map(|c| cost(lookup, c)).collect()
}

fn cost(lookup: &Lookup<'_>, cell: usize) -> Option<Cost> {
    Some(Cost {
        cell,
        samples: lookup.row(cell, Estimand::Mean, Some(0))?.samples,
        rays: lookup.row(cell, Estimand::Cost, None)?.mean,
        channels: [0, 1, 2].map(|channel| error(lookup, cell, channel)),
    })
}

fn error(lookup: &Lookup<'_>, cell: usize, channel: usize) -> Option<Error> {
    let mean = lookup.row(cell, Estimand::Mean, Some(channel))?;
    let right = Some(mean.truth.unwrap_or(mean.mean)).filter(|right| *right != 0.0)?;
    let square = right * right;
    let floor = if lookup.finds_all(cell) { 0.0 } else { remaining(mean) / square };
    if lookup.is_noise_free(cell) {
        return Some(Error { noise: Some(0.0), noise_error: Some(0.0), floor });
    }
    let spread = if lookup.is_image(cell) { Estimand::PixelVariance } else { Estimand::Mean };
    let row = lookup.row(cell, spread, Some(channel));
    let noise = row.and_then(|row| row.variance).map(|variance| variance / square);
    let noise_error = row.and_then(|row| Some(row.efficiency_error? / row.efficiency?));
    Some(Error { noise: noise.filter(|noise| *noise > 0.0), noise_error, floor })
}

/// The squared bias that theory expects, or else the measured one less what noise adds to it.
fn remaining(row: &Row) -> f64 {
    let measured = || {
        let (bias, error) = (row.bias.unwrap_or(0.0), row.std_error.unwrap_or(0.0));
        (bias * bias - error * error).max(0.0)
    };
    row.expected_bias.map_or_else(measured, |bias| bias * bias)
}
