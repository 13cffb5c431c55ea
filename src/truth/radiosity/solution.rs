//! Extrapolation to the mesh width 0, and the result.

use super::BOUNCES;
use serde::{Deserialize, Serialize};

/// Entries per tile and channel.
const ENTRIES: usize = 2 * (BOUNCES + 1);

/// Relative error that rounding and the truncated series may leave at most.
const ROUNDING: f64 = 1e-11;

/// A mean radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// Best value [W m^-2 sr^-1].
    pub value: f64,
    /// Bound of its absolute error [W m^-2 sr^-1].
    pub error: f64,
}

/// Mean radiance by tile, channel and bounce.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Solution {
    /// Per tile and channel: all bounces 0..=BOUNCES, then the sums from bounce 0..=BOUNCES on [W m^-2 sr^-1].
    pub values: Vec<f64>,
    /// Error bounds in the same order [W m^-2 sr^-1].
    pub errors: Vec<f64>,
}

impl Solution {
    /// Extrapolates `levels`, one per mesh and in the order of `values`.
    ///
    /// The error bound is the change made by the finest mesh, hence the error of the extrapolation that does without it.
    /// As such a change may vanish by chance, it is taken relative to the value, and the largest of all tiles and
    /// channels holds for this bounce and all later ones. Against extrapolation from finer meshes, errors are at
    /// most about half of it.
    pub(crate) fn new(meshes: &[usize], levels: &[Vec<f64>]) -> Self {
        let coarse = meshes.len() - 1;
        let values = limit(meshes, levels);
        let change = limit(&meshes[..coarse], &levels[..coarse]);
        let mut relative = [ROUNDING; ENTRIES];
        for (i, (value, change)) in values.iter().zip(change).enumerate() {
            if *value > 0.0 {
                let largest = &mut relative[i % ENTRIES];
                *largest = largest.max((value - change).abs() / value);
            }
        }
        for bounces in relative.chunks_mut(BOUNCES + 1) {
            (1..=BOUNCES).for_each(|k| bounces[k] = bounces[k].max(bounces[k - 1]));
        }
        let errors = values.iter().enumerate().map(|(i, value)| value * relative[i % ENTRIES]).collect();
        Solution { values, errors }
    }

    /// Light scattered exactly `k` <= [`BOUNCES`] times; 0 is the tile's own emission.
    pub fn bounce(&self, tile: usize, channel: usize, k: usize) -> Value {
        assert!(k <= BOUNCES, "bounce {k} is not stored");
        self.at(tile, channel, k)
    }

    /// Light scattered `k` <= [`BOUNCES`] times or more.
    pub fn from_bounce(&self, tile: usize, channel: usize, k: usize) -> Value {
        assert!(k <= BOUNCES, "bounce {k} is not stored");
        self.at(tile, channel, BOUNCES + 1 + k)
    }

    /// All light.
    pub fn total(&self, tile: usize, channel: usize) -> Value {
        self.from_bounce(tile, channel, 0)
    }

    fn at(&self, tile: usize, channel: usize, entry: usize) -> Value {
        let index = (tile * 3 + channel) * ENTRIES + entry;
        Value { value: self.values[index], error: self.errors[index] }
    }
}

/// Values at mesh width 0, where a value at width h = 1/m is a + b h^2 + c h^3 + d h^4 + ... with as many terms as meshes.
///
/// The cubic term comes from tiles that touch an edge of the cube: what they see of the adjacent wall has a jump there,
/// whose surroundings the mesh never resolves. There is no linear term; the polynomial with this slope 0 at h = 0 has
/// Lagrange's coefficients times m over the sum of all m.
fn limit(meshes: &[usize], levels: &[Vec<f64>]) -> Vec<f64> {
    let sum: usize = meshes.iter().sum();
    let mut values = vec![0.0; levels[0].len()];
    for (&m, level) in meshes.iter().zip(levels) {
        let others = meshes.iter().filter(|&&other| other != m);
        let lagrange: f64 = others.map(|&other| m as f64 / (m as f64 - other as f64)).product();
        let weight = lagrange * m as f64 / sum as f64;
        values.iter_mut().zip(level).for_each(|(value, part)| *value += weight * part);
    }
    values
}
