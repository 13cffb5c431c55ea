//! What each cell's error costs: its relative mean squared error after any number of samples, and the rays of a sample.

use super::lookup::Lookup;
use super::metrics::Metrics;
use super::pictures::Picture;
use super::table::number;
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
    /// How far its picture, as it is, is from the reference; `None` without one.
    pub picture: Option<Metrics>,
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
pub fn of(lookup: &Lookup<'_>, pictures: &[Picture]) -> Vec<Cost> {
    let finished = (0..lookup.plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty());
    finished.filter(|&c| !lookup.is_faulty(c)).filter_map(|c| cost(lookup, c, pictures)).collect()
}

fn cost(lookup: &Lookup<'_>, cell: usize, pictures: &[Picture]) -> Option<Cost> {
    Some(Cost {
        cell,
        samples: lookup.row(cell, Estimand::Mean, Some(0))?.samples,
        rays: lookup.row(cell, Estimand::Cost, None)?.mean,
        channels: [0, 1, 2].map(|channel| error(lookup, cell, channel)),
        picture: pictures.iter().find(|picture| picture.cell == cell).and_then(|picture| picture.metrics),
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

/// The text of `pictures.csv`: how far each picture is from its reference; nothing where none is compared.
pub fn csv(lookup: &Lookup<'_>, costs: &[Cost]) -> Option<Vec<u8>> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(["experiment", "cell", "samples", "rel_mse", "rel_mse_error", "flip"])
        .expect("a Vec takes all");
    let mut is_empty = true;
    for (cost, metrics) in costs.iter().filter_map(|cost| Some((cost, cost.picture.as_ref()?))) {
        is_empty = false;
        let record = [
            lookup.plan.name.clone(),
            lookup.plan.label(&lookup.plan.cells[cost.cell]),
            cost.samples.to_string(),
            number(Some(metrics.rel_mse)),
            number(metrics.rel_mse_error),
            number(Some(metrics.flip)),
        ];
        csv.write_record(record).expect("a Vec takes all");
    }
    (!is_empty).then(|| csv.into_inner().expect("a Vec takes all"))
}
