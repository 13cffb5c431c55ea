//! Pearson's test of counts against probabilities, for the tests beside this folder.

use statrs::distribution::{ChiSquared, ContinuousCDF, DiscreteCDF, Poisson};

/// Cells that expect fewer than this are taken together: there a count is not yet normal.
const FEWEST: f64 = 10.0;

/// Fails if `counts` are too unlikely, under the given false alarm probability, to come from the distribution
/// `probability` (one value a cell), or if one fell into `lost`, which is where samples go that have no cell: below the
/// horizon, not finite. `lost` expects what the cells leave of 1, and is tested on its own if that is little.
pub fn assert_follows(name: &str, counts: &[u64], lost: u64, probability: &[f64], false_alarm: f64) {
    let total: f64 = probability.iter().sum();
    assert!(total < 1.0 + 1e-9, "{name}: probabilities add up to {total}");
    // an integral that is 1 up to rounding leaves nothing
    let rest = if total > 1.0 - 1e-9 { 0.0 } else { 1.0 - total };
    let n = (counts.iter().sum::<u64>() + lost) as f64;
    let cells = counts.iter().zip(probability).map(|(&count, &p)| (count as f64, n * p));
    let (mut pool, mut chi2, mut used) = ((0.0, 0.0), 0.0, 0);
    let mut add = |(count, expected): (f64, f64)| {
        chi2 += (count - expected).powi(2) / expected;
        used += 1;
    };
    for cell in cells.chain([(lost as f64, n * rest)]) {
        if cell.1 >= FEWEST {
            add(cell);
        } else if cell.1 > 0.0 {
            pool = (pool.0 + cell.0, pool.1 + cell.1);
        } else {
            assert_eq!(cell.0, 0.0, "{name}: samples where none can be");
        }
    }
    if pool.1 >= FEWEST {
        add(pool);
    } else if pool.0 > 0.0 {
        let p = Poisson::new(pool.1).unwrap().sf(pool.0 as u64 - 1);
        assert!(p > 0.5 * false_alarm, "{name}: {} where {} are expected, p = {p}", pool.0, pool.1);
    }
    let p = ChiSquared::new(f64::from(used - 1)).unwrap().sf(chi2);
    assert!(p > 0.5 * false_alarm, "{name}: chi-square {chi2} of {used} cells, p = {p}");
}
