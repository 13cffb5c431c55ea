//! Tables of exchange areas between the meshes of two walls, and their products with radiances.

use super::kernel::Pair;
use super::mesh::{Grid, WALLS};
use rayon::prelude::*;

/// One value per element and channel; the outer index is the channel.
pub(crate) type Field = [Vec<f64>; 3];

/// Rows that one task multiplies; a constant, so that the order of summation does not depend on the number of threads.
const ROWS: usize = 32;

/// A_i F_ij = A_j F_ji between all elements i of one mesh and j of another [m^2].
///
/// Each value carries a rounding error of about 1e-16 m^2, for the smallest elements much of its own size. Sums over
/// neighbours are differences of the same corner values, hence as exact as single values: averages do not suffer.
pub(crate) struct Exchange {
    columns: usize,
    /// Row by row.
    areas: Vec<f64>,
}

impl Exchange {
    /// Four successive differences of the corner function over all mesh lines.
    pub fn new(a: &Grid, b: &Grid) -> Self {
        let ([rows, stride], columns) = (a.shape(), b.len());
        let slab = stride * columns;
        let mut areas = vec![0.0; (rows + 1) * slab];
        areas.par_chunks_mut(slab).enumerate().for_each(|(i, slab)| mesh_line(a, b, i, slab));
        for i in 0..rows {
            let (here, next) = areas[i * slab..].split_at_mut(slab);
            here.par_iter_mut().zip(&next[..slab]).for_each(|(here, next)| *here = next - *here);
        }
        areas.truncate(rows * slab);
        Exchange { columns, areas }
    }

    /// Sums over the other mesh of exchange areas times radiances `a`, `b` [W m^-2 sr^-1]: what arrives at each element of
    /// the first mesh, and at each of the second [W sr^-1, power over pi]. One pass over the table does both.
    pub fn products(&self, a: [&[f64]; 3], b: [&[f64]; 3]) -> (Field, Field) {
        let block = |(task, table): (usize, &[f64])| {
            let mut to_a = [const { Vec::new() }; 3];
            let mut to_b = [(); 3].map(|()| vec![0.0; self.columns]);
            for (row, line) in table.chunks_exact(self.columns).enumerate() {
                for channel in 0..3 {
                    to_a[channel].push(dot(line, b[channel]));
                    accumulate(&mut to_b[channel], a[channel][task * ROWS + row], line);
                }
            }
            (to_a, to_b)
        };
        let tables = self.areas.par_chunks(ROWS * self.columns).enumerate();
        let blocks: Vec<(Field, Field)> = tables.map(block).collect();
        let mut to_a = [const { Vec::new() }; 3];
        let mut to_b = [(); 3].map(|()| vec![0.0; self.columns]);
        for (rows, sums) in &blocks {
            for channel in 0..3 {
                to_a[channel].extend_from_slice(&rows[channel]);
                accumulate(&mut to_b[channel], 1.0, &sums[channel]);
            }
        }
        (to_a, to_b)
    }
}

/// Differences by three of the four coordinates, for mesh line `i` of the first: a value for every element along this
/// line and every element of `b`.
fn mesh_line(a: &Grid, b: &Grid, i: usize, slab: &mut [f64]) {
    let pair = Pair::new(a.wall, b.wall);
    let [rows, columns] = b.shape();
    let s = a.nodes[0][i];
    for (k, &u) in b.nodes[0].iter().enumerate() {
        let corner = |t: f64, v: f64| pair.corner(WALLS[a.wall].point(s, t), WALLS[b.wall].point(u, v));
        let line = |t: f64| b.nodes[1].iter().map(move |&v| corner(t, v));
        let mut below: Vec<f64> = line(a.nodes[1][0]).collect();
        for (j, &t) in a.nodes[1][1..].iter().enumerate() {
            let above: Vec<f64> = line(t).collect();
            for l in 0..columns {
                let value = (above[l + 1] - below[l + 1]) - (above[l] - below[l]);
                let at = (j * rows + k) * columns + l;
                // the element before this line ends here, the one after starts
                if k > 0 {
                    slab[at - columns] += value;
                }
                if k < rows {
                    slab[at] = -value;
                }
            }
            below = above;
        }
    }
}

/// Sum of products in a fixed order: eight partial sums, which the compiler can keep in vector registers.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (x_blocks, x_rest) = x.as_chunks::<8>();
    let (y_blocks, y_rest) = y.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, y) in x_blocks.iter().zip(y_blocks) {
        for lane in 0..8 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

fn accumulate(sums: &mut [f64], factor: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
