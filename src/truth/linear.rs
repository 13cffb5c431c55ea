//! x = A x + b where A has no negative entries: what expectations over a finite Markov chain obey.

/// Rows of a square matrix without negative entries.
pub type Matrix = Vec<Vec<f64>>;

/// The limit of b + A b + A² b + ..., entry by entry; `None` where it diverges, which is where the rows that an entry
/// leads to form a matrix of spectral radius 1 or more.
pub fn solve(a: &Matrix, b: &[f64]) -> Vec<Option<f64>> {
    (0..b.len()).map(|i| eliminate(a, b, &reached(a, i))).collect()
}

/// Whether the powers of what row `from` leads to die out: its spectral radius is below 1.
pub fn dies_out(a: &Matrix, from: usize) -> bool {
    eliminate(a, &vec![0.0; a.len()], &reached(a, from)).is_some()
}

/// The rows that `from` leads to in any number of steps, itself last.
fn reached(a: &Matrix, from: usize) -> Vec<usize> {
    let mut rows = vec![from];
    let mut next = 0;
    while let Some(&row) = rows.get(next) {
        rows.extend((0..a.len()).filter(|j| a[row][*j] > 0.0 && !rows.contains(j)).collect::<Vec<_>>());
        next += 1;
    }
    rows.reverse();
    rows
}

/// The last entry of (I - A)⁻¹ b among some rows, by elimination without exchanges. The pivots are all positive exactly
/// if the spectral radius of A is below 1 [Berman & Plemmons 1979, theorem 6.2.3], and then no exchange is needed.
fn eliminate(a: &Matrix, b: &[f64], rows: &[usize]) -> Option<f64> {
    let identity = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let row =
        |&i: &usize| -> Vec<f64> { rows.iter().map(|&j| identity(i, j) - a[i][j]).chain([b[i]]).collect() };
    let mut left: Vec<Vec<f64>> = rows.iter().map(row).collect();
    for k in 0..rows.len() {
        let (done, below) = left.split_at_mut(k + 1);
        let pivot = &done[k];
        if pivot[k].is_nan() || pivot[k] <= 0.0 {
            return None;
        }
        for row in below.iter_mut().filter(|row| row[k] != 0.0) {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(pivot).skip(k).for_each(|(x, p)| *x -= factor * p);
        }
    }
    left.last().map(|row| row[rows.len()] / row[rows.len() - 1])
}
