//! Where in an image a cell is wrong: the deviation of each of its 4 × 4 tiles, and which of them are told to be wrong.

use super::lookup::Lookup;
use super::number;
use crate::experiment::cell::TILES;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Row};
use crate::stats::multiplicity::bh;
use crate::stats::student;

/// Of the tiles that are marked, this share is expected to be right, at most.
pub const RATE: f64 = 0.05;

/// The tiles of one cell.
pub struct TileMap {
    /// One of each tile and channel, row by row from the top left, channels innermost.
    pub tiles: Vec<[Tile; 3]>,
    /// Whether the p-values are those of a claim; else they are of normal distributions.
    pub is_claimed: bool,
}

/// One tile in one channel.
#[derive(Clone, Copy)]
pub struct Tile {
    /// Deviation from what is right, in standard errors.
    pub z: f64,
    /// Whether it is told to be wrong.
    pub is_wrong: bool,
}

/// The map of a cell, if all of its tiles have a right value.
pub fn of(lookup: &Lookup<'_>, cell: usize) -> Option<TileMap> {
    let count = (TILES * TILES) as usize;
    let row = |i: usize| lookup.row(cell, Estimand::Tile(i / 3), Some(i % 3));
    let rows: Vec<&Row> = (0..3 * count).map(row).collect::<Option<_>>()?;
    let z: Vec<f64> = rows.iter().map(|row| deviation(row)).collect::<Option<_>>()?;
    let is_claimed = rows.iter().all(|row| row.p_value.is_some());
    let p = rows.iter().map(|row| if is_claimed { row.p_value } else { p_value(row) }.unwrap_or(f64::NAN));
    let wrong = bh(&p.collect::<Vec<f64>>(), RATE);
    let tile = |i: usize| Tile { z: z[i], is_wrong: wrong[i] };
    let tiles = (0..count).map(|t| [0, 1, 2].map(|c| tile(3 * t + c))).collect();
    Some(TileMap { tiles, is_claimed })
}

/// Measured less expected, and the standard error of that.
fn distance(row: &Row) -> Option<(f64, f64)> {
    let error = row.std_error?.hypot(row.truth_error?);
    Some((row.bias? - row.expected_bias?, error))
}

fn deviation(row: &Row) -> Option<f64> {
    let (difference, error) = distance(row)?;
    let z = if difference == 0.0 { 0.0 } else { difference / error };
    (!z.is_nan()).then_some(z)
}

/// Where nobody claims anything of tiles: by the normal distribution, the truth's bound set aside.
fn p_value(row: &Row) -> Option<f64> {
    let (difference, error) = distance(row)?;
    let beyond = (difference.abs() - row.truth_bound.unwrap_or(0.0)).max(0.0);
    Some(if beyond == 0.0 { 1.0 } else { student::two_sided_p(beyond / error, f64::INFINITY) })
}

impl TileMap {
    /// What the map shows, in words.
    pub fn words(&self) -> String {
        let of_channel = |channel: usize| {
            let marked =
                || self.tiles.iter().enumerate().map(move |(i, t)| (i, t[channel])).filter(|t| t.1.is_wrong);
            let strongest = marked().max_by(|a, b| a.1.z.abs().total_cmp(&b.1.z.abs()));
            let Some((at, tile)) = strongest else { return format!("{}: none", CHANNELS[channel]) };
            let bright = marked().filter(|t| t.1.z > 0.0).count();
            let dark = marked().count() - bright;
            let counts: Vec<String> = [(bright, "too bright"), (dark, "too dark")]
                .into_iter()
                .filter(|(count, _)| *count > 0)
                .map(|(count, what)| format!("{count} {what}"))
                .collect();
            let (row, column) = (at / TILES as usize + 1, at % TILES as usize + 1);
            let z = number::signed(tile.z);
            let (channel, counts) = (CHANNELS[channel], number::list(&counts, "and"));
            format!(
                "{channel}: {counts} of {}, most in row {row}, column {column} (z = {z})",
                self.tiles.len()
            )
        };
        format!("Wrong tiles. {}.", [0, 1, 2].map(of_channel).join("; "))
    }
}
