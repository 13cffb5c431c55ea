//! Filters that are a product of one along rows and one along columns; beyond its edge a picture goes on as at the edge.

/// Values of `f` at whole numbers from -radius to radius.
pub fn taps(radius: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=2 * radius).map(|i| f(i as f64 - radius as f64)).collect()
}

/// Scaled so that positive weights add up to 1, and negative ones to -1.
pub fn normalised(mut taps: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| taps.iter().filter(|&&tap| tap * sign > 0.0).sum::<f64>().abs();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    for tap in &mut taps {
        *tap /= if *tap > 0.0 { positive } else { negative.max(f64::MIN_POSITIVE) };
    }
    taps
}

/// A plane, filtered along its rows and along its columns.
pub fn filter(plane: &[f64], width: usize, along_rows: &[f64], along_columns: &[f64]) -> Vec<f64> {
    let height = plane.len() / width;
    rows(&rows(plane, width, along_rows), height, along_columns)
}

/// Filters along rows and gives the result with rows and columns exchanged.
fn rows(plane: &[f64], width: usize, taps: &[f64]) -> Vec<f64> {
    let (height, radius) = (plane.len() / width, taps.len() / 2);
    let mut exchanged = vec![0.0; plane.len()];
    let mut sums = vec![0.0; width];
    for (y, row) in plane.chunks_exact(width).enumerate() {
        let before = std::iter::repeat_n(row[0], radius);
        let after = std::iter::repeat_n(row[width - 1], radius);
        let longer: Vec<f64> = before.chain(row.iter().copied()).chain(after).collect();
        sums.fill(0.0);
        // tap by tap: sums side by side are independent, and so vectors
        for (j, &tap) in taps.iter().enumerate() {
            for (sum, &value) in sums.iter_mut().zip(&longer[j..]) {
                *sum += tap * value;
            }
        }
        for (x, &sum) in sums.iter().enumerate() {
            exchanged[x * height + y] = sum;
        }
    }
    exchanged
}
