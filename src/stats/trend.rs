//! Whether values in their order rise or fall.

/// p-value, two-sided and exact, of Kendall's (1938) test that the order of `values`
/// does not matter: few of the pairs rise, or few fall. Larger than exact where values
/// are equal. None if one is not finite; 1 for fewer than two.
pub fn kendall(values: &[f64]) -> Option<f64> {
    let pairs = || (0..values.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let rising = pairs().filter(|&(i, j)| values[i] < values[j]).count();
    let falling = pairs().filter(|&(i, j)| values[i] > values[j]).count();
    values.iter().all(|value| value.is_finite()).then(|| tail(values.len(), rising.abs_diff(falling)))
}

/// P(|rising pairs - falling pairs| >= `difference`) if all orders of n different values are
/// equally probable: the number of falling pairs is a sum of independent uniform
/// integers from 0..=i, i < n.
fn tail(n: usize, difference: usize) -> f64 {
    let mut law = vec![1.0];
    for i in 1..n {
        let sum = |k: usize| law[k.saturating_sub(i)..law.len().min(k + 1)].iter().sum::<f64>();
        law = (0..law.len() + i).map(|k| sum(k) / (i + 1) as f64).collect();
    }
    let pairs = law.len() - 1;
    let extreme = |falling: &usize| (2 * falling).abs_diff(pairs) >= difference;
    let sum: f64 = (0..law.len()).filter(extreme).map(|falling| law[falling]).sum();
    sum.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn p_is_exact() {
        // all 24 orders of 4: |difference| is 6 in 2, 4 or more in 8
        for (difference, orders) in [(6, 2.0), (4, 8.0), (0, 24.0)] {
            assert!((tail(4, difference) - orders / 24.0).abs() < 1e-15);
        }
        // scipy.stats.kendalltau(range(8), values, method="exact")
        let p = kendall(&[1.0, 0.0, 2.0, 3.0, 4.0, 5.0, 7.0, 6.0]).unwrap();
        assert!((p - 0.001736111111111111).abs() < 1e-15, "{p}");
        assert_eq!(kendall(&[7.0, 6.0, 5.0, 4.0, 3.0]), kendall(&[1.0, 2.0, 3.0, 4.0, 5.0]));
    }

    #[test]
    fn equal_few_and_broken_values() {
        assert!((kendall(&[2.0; 9]).unwrap() - 1.0).abs() < 1e-15);
        assert_eq!((kendall(&[]), kendall(&[1.0])), (Some(1.0), Some(1.0)));
        assert_eq!(kendall(&[1.0, f64::NAN, 2.0]).or(kendall(&[f64::INFINITY])), None);
    }
}
