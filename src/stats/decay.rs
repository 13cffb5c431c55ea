//! How the error of running means falls, and its exponents: several runs of one estimator, each looked at again and again
//! as its samples grow.

use super::Moments;

/// Running means of independent runs.
#[derive(Clone, Copy, Debug)]
pub struct Runs<'a> {
    /// Numbers of samples at which each run was looked at, above 0 and growing.
    pub marks: &'a [u64],
    /// The mean of each run so far, at each mark.
    pub means: &'a [Vec<f64>],
    /// The right value and its standard error.
    pub truth: Option<(f64, f64)>,
}

/// A number with its standard error, in the same unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error.
    pub std_error: f64,
}

/// The error after so many samples, by all runs. `bias` and `mse` need a right value to differ from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Error {
    /// Samples.
    pub n: u64,
    /// Mean over the runs less the right value; the latter's standard error is part of that.
    pub bias: Option<Estimate>,
    /// Variance of a run's mean.
    pub variance: Estimate,
    /// Mean squared difference from the right value.
    pub mse: Option<Estimate>,
}

/// What falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falling {
    /// The variance between runs.
    Variance,
    /// The mean squared error.
    Mse,
    /// The bias times this sign, 1 or -1, which it must have.
    Bias(f64),
}

/// Fewer runs give no interval.
pub const MIN_RUNS: usize = 8;

impl Runs<'_> {
    /// The errors at each mark; standard errors of variance and mean squared error from the runs' own moments.
    pub fn errors(&self) -> Vec<Error> {
        let at = |(i, &n): (usize, &u64)| {
            let (mut means, mut squares) = (Moments::default(), Moments::default());
            for run in self.means {
                means.push(run[i]);
                let off = run[i] - self.truth.map_or(0.0, |t| t.0);
                squares.push(off * off);
            }
            let error = |m: &Moments| m.std_error().unwrap_or(f64::NAN);
            let variance = Estimate {
                value: means.variance().unwrap_or(f64::NAN),
                std_error: means.variance_std_error().unwrap_or(f64::NAN),
            };
            let bias = self.truth.map(|(truth, truth_error)| Estimate {
                value: means.mean - truth,
                std_error: libm::hypot(error(&means), truth_error),
            });
            let mse = self.truth.zip(bias).map(|((_, truth_error), bias)| Estimate {
                value: squares.mean,
                std_error: libm::hypot(error(&squares), 2.0 * bias.value * truth_error),
            });
            Error { n, bias, variance, mse }
        };
        self.marks.iter().enumerate().map(at).collect()
    }

    /// The exponent of n with which it falls, about -1 for a variance: slope of the line of least squares through the
    /// logarithms, with the weights of the marks, which must not come from these runs; a mark of weight 0 does not count.
    ///
    /// Means of one run at several marks depend on each other, so that both the standard error and what the logarithm
    /// adds in expectation are found by leaving out each run in turn (jackknife, Quenouille 1956, Tukey 1958). The
    /// degrees of freedom are the runs less one. None for fewer than [`MIN_RUNS`], fewer than two marks that count, a
    /// missing right value, and what has no logarithm.
    pub fn exponent(&self, falling: Falling, weights: &[f64]) -> Option<Estimate> {
        let count = self.means.len();
        if count < MIN_RUNS || (falling != Falling::Variance && self.truth.is_none()) {
            return None;
        }
        let used: Vec<usize> = (0..self.marks.len()).filter(|&i| weights[i] > 0.0).collect();
        let levels: Vec<Level> = used.iter().map(|&i| self.level(i)).collect();
        let fit = |without: Option<usize>| {
            let point = |(level, &i): (&Level, &usize)| {
                let value = level.value(falling, without);
                let y = if value > 0.0 { libm::log(value) } else { f64::NAN };
                (libm::log(self.marks[i] as f64), y, weights[i])
            };
            slope(&levels.iter().zip(&used).map(point).collect::<Vec<_>>())
        };
        let whole = fit(None);
        let mut without = Moments::default();
        (0..count).for_each(|run| without.push(fit(Some(run))));
        let r = count as f64;
        let value = r * whole - (r - 1.0) * without.mean;
        let std_error = (without.m2 * (r - 1.0) / r).sqrt();
        (value.is_finite() && std_error.is_finite()).then_some(Estimate { value, std_error })
    }

    /// The runs' means at one mark, less the right value.
    fn level(&self, mark: usize) -> Level {
        let zero = self.truth.map_or_else(|| self.means[0][mark], |t| t.0);
        let off: Vec<f64> = self.means.iter().map(|run| run[mark] - zero).collect();
        Level { sum: off.iter().sum(), squares: off.iter().map(|x| x * x).sum(), off }
    }
}

/// Differences of all runs from one value, and their sums.
struct Level {
    off: Vec<f64>,
    sum: f64,
    squares: f64,
}

impl Level {
    /// What falls, by all runs or all but one.
    fn value(&self, falling: Falling, without: Option<usize>) -> f64 {
        let left_out = without.map_or(0.0, |run| self.off[run]);
        let r = (self.off.len() - usize::from(without.is_some())) as f64;
        let (sum, squares) = (self.sum - left_out, self.squares - left_out * left_out);
        match falling {
            Falling::Variance => (squares - sum * sum / r) / (r - 1.0),
            Falling::Mse => squares / r,
            Falling::Bias(sign) => sign * sum / r,
        }
    }
}

/// The exponent of a curve without noise at these marks, by the same fit as [`Runs::exponent`]; None as there.
pub fn exponent_of(marks: &[u64], curve: &[f64], weights: &[f64]) -> Option<f64> {
    let points = (0..marks.len()).filter(|&i| weights[i] > 0.0);
    let logs = points.map(|i| (libm::log(marks[i] as f64), libm::log(curve[i]), weights[i]));
    Some(slope(&logs.collect::<Vec<_>>())).filter(|slope| slope.is_finite())
}

/// Slope of the line through (x, y) of some weight with the least squares in y; NaN for one x.
fn slope(points: &[(f64, f64, f64)]) -> f64 {
    let sum = |f: &dyn Fn(&(f64, f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
    let weight = sum(&|p| p.2);
    let (x, y) = (sum(&|p| p.2 * p.0) / weight, sum(&|p| p.2 * p.1) / weight);
    sum(&|p| p.2 * (p.0 - x) * (p.1 - y)) / sum(&|p| p.2 * (p.0 - x) * (p.0 - x))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARKS: [u64; 3] = [1, 4, 16];

    /// Eight runs around 5 + bias(n), whose deviations fall as n to the power -0.4.
    fn runs(bias: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let n = |mark: &u64| *mark as f64;
        let mean = |run: i32, n: f64| 5.0 + bias(n) + (f64::from(run) - 3.5) * libm::pow(n, -0.4);
        (0..8).map(|run| MARKS.iter().map(|mark| mean(run, n(mark))).collect()).collect()
    }

    #[test]
    fn straight_lines_are_found_exactly() {
        let means = runs(|n| -0.3 * libm::pow(n, -0.25));
        let runs = Runs { marks: &MARKS, means: &means, truth: Some((5.0, 0.0)) };
        let all = [1.0; 3];
        let variance = runs.exponent(Falling::Variance, &all).unwrap();
        assert!((variance.value + 0.8).abs() < 1e-9 && variance.std_error < 1e-9, "{variance:?}");
        // without noise the bias is a straight line, too; each run left out bends it
        assert_eq!(runs.exponent(Falling::Bias(1.0), &all), None, "of the other sign");
        let flat: Vec<Vec<f64>> =
            means.iter().map(|_| MARKS.map(|n| 5.0 - 0.3 / n as f64).to_vec()).collect();
        let flat = Runs { means: &flat, ..runs };
        for (falling, exponent) in [(Falling::Bias(-1.0), -1.0), (Falling::Mse, -2.0)] {
            let found = flat.exponent(falling, &[1.0, 0.5, 0.0]).unwrap();
            assert!((found.value - exponent).abs() < 1e-12 && found.std_error < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn errors_are_those_of_the_textbook() {
        let means: Vec<Vec<f64>> = [1.0, 2.0, 4.0, 5.0].map(|x| vec![x]).to_vec();
        let runs = Runs { marks: &[7], means: &means, truth: Some((2.5, 0.3)) };
        let [error] = runs.errors()[..] else { panic!("one mark") };
        let (bias, mse) = (error.bias.unwrap(), error.mse.unwrap());
        assert_eq!((error.n, bias.value, mse.value), (7, 0.5, 2.75));
        assert!((error.variance.value - 10.0 / 3.0).abs() < 1e-12);
        // (10/3)/4 and 0.3²; the squares 2.25, 0.25, 2.25, 6.25 vary by 19/3
        assert!((bias.std_error - (10.0 / 12.0 + 0.09_f64).sqrt()).abs() < 1e-12);
        assert!((mse.std_error - (19.0 / 12.0 + 0.09_f64).sqrt()).abs() < 1e-12, "{mse:?}");
        let unknown = Runs { truth: None, ..runs };
        assert_eq!((unknown.errors()[0].bias, unknown.errors()[0].mse), (None, None));
    }

    #[test]
    fn what_has_no_exponent() {
        let means = runs(|_| 0.0);
        let good = Runs { marks: &MARKS, means: &means, truth: None };
        assert!(good.exponent(Falling::Variance, &[1.0; 3]).is_some());
        assert_eq!(good.exponent(Falling::Mse, &[1.0; 3]), None);
        assert_eq!(good.exponent(Falling::Variance, &[0.0, 0.0, 1.0]), None);
        let few = Runs { means: &means[..7], ..good };
        assert_eq!(few.exponent(Falling::Variance, &[1.0; 3]), None);
        let steady = vec![vec![2.0; 3]; 8];
        assert_eq!(Runs { means: &steady, ..good }.exponent(Falling::Variance, &[1.0; 3]), None);
    }

    #[test]
    fn a_curve_has_the_exponent_of_its_line() {
        let curve = MARKS.map(|n| 3.0 * libm::pow(n as f64, -0.7));
        assert!((exponent_of(&MARKS, &curve, &[1.0, 2.0, 3.0]).unwrap() + 0.7).abs() < 1e-12);
        assert_eq!(exponent_of(&MARKS, &[1.0, 0.0, 1.0], &[1.0; 3]), None);
        // 0.1 + 1/n between 1 and 4 alone
        let bent = MARKS.map(|n| 0.1 + 1.0 / n as f64);
        let exponent = exponent_of(&MARKS, &bent, &[1.0, 1.0, 0.0]).unwrap();
        assert!((exponent - libm::log(0.35 / 1.1) / libm::log(4.0)).abs() < 1e-12);
    }
}
