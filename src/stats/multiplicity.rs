//! Many questions, one error rate.

/// Level of each of `m` tests that together err with probability `alpha` at
/// most (Bonferroni 1936). An empty family counts as one test.
pub fn bonferroni(alpha: f64, m: usize) -> f64 {
    alpha / m.max(1) as f64
}

/// Which hypotheses the step-down test of Holm (1979) rejects, in the order of
/// `p`; the probability of any false rejection is `alpha` at most, whatever
/// the dependence between the tests.
///
/// A NaN counts as a member of the family but is never rejected. An `alpha`
/// that is NaN rejects nothing.
pub fn holm(p: &[f64], alpha: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p.len()).filter(|&i| !p[i].is_nan()).collect();
    order.sort_by(|&i, &j| p[i].total_cmp(&p[j]));
    let mut rejected = vec![false; p.len()];
    for (rank, &i) in order.iter().enumerate() {
        if p[i] <= bonferroni(alpha, p.len() - rank) {
            rejected[i] = true;
        } else {
            // step-down: what follows is not even tested
            break;
        }
    }
    rejected
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_down_and_stops() {
        // 0.05/4, 0.05/3, 0.05/2, 0.05: statsmodels' multipletests(method="holm")
        let p = [0.04, 0.012, 0.016, 0.03];
        assert_eq!(holm(&p, 0.05), [false, true, true, false]);
        // 0.04 passes its own threshold, but 0.026 before it did not
        assert_eq!(holm(&[0.04, 0.026], 0.05), [false, false]);
        assert_eq!(holm(&[0.04, 0.025], 0.05), [true, true]);
    }

    #[test]
    fn nan_counts_but_is_never_rejected() {
        assert_eq!(holm(&[f64::NAN, 0.025], 0.05), [false, true]);
        assert_eq!(holm(&[-f64::NAN, 0.025], 0.05), [false, true]);
        assert_eq!(holm(&[f64::NAN, 0.026], 0.05), [false, false]);
        assert_eq!(holm(&[0.0], f64::NAN), [false]);
    }

    #[test]
    fn empty_and_single_families() {
        assert!(holm(&[], 0.05).is_empty());
        assert_eq!(holm(&[0.05], 0.05), [true]);
        assert_eq!(bonferroni(0.05, 0), 0.05);
        assert_eq!(bonferroni(0.05, 5), 0.01);
    }
}
