//! How much something has changed between two runs that do not depend on each other.

use super::student;

/// A measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// The value.
    pub value: f64,
    /// Its standard error, in the same unit.
    pub std_error: f64,
    /// Degrees of freedom of the standard error, infinity included.
    pub df: f64,
}

/// What has changed, with an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// The estimate: a difference, or a ratio.
    pub estimate: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Change {
    /// The same in another unit.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let ends = (self.low * factor, self.high * factor);
        Change { estimate: self.estimate * factor, low: ends.0.min(ends.1), high: ends.0.max(ends.1) }
    }

    /// Whether the whole interval lies above `high` or below `low`.
    pub fn is_beyond(self, low: f64, high: f64) -> bool {
        self.low > high || self.high < low
    }
}

/// The difference `now - before` with its two-sided interval of Welch (1947), which misses the true one with probability
/// `level`. `slack`: what both may be wrong by beyond their noise, for instance by rounding; it widens the interval.
pub fn difference(before: Measure, now: Measure, level: f64, slack: f64) -> Change {
    let estimate = now.value - before.value;
    let df = student::welch_df(before.std_error, before.df, now.std_error, now.df);
    let error = before.std_error.hypot(now.std_error);
    // no quantile times no error is no number
    let reach = if error > 0.0 { student::upper_quantile(level / 2.0, df) * error } else { 0.0 } + slack;
    Change { estimate, low: estimate - reach, high: estimate + reach }
}

/// The ratio `now / before` of positive values, with the interval of its logarithm by the delta method; misses and `slack`,
/// which is relative, as [`difference`]. None if a value is not positive.
pub fn ratio(before: Measure, now: Measure, level: f64, slack: f64) -> Option<Change> {
    let logarithm = |measure: Measure| Measure {
        value: measure.value.ln(),
        std_error: measure.std_error / measure.value,
        df: measure.df,
    };
    let usable = |measure: Measure| measure.value > 0.0 && measure.value.is_finite();
    if !usable(before) || !usable(now) {
        return None;
    }
    let change = difference(logarithm(before), logarithm(now), level, slack);
    // the estimate without a logarithm, so that what is the same has the ratio 1
    Some(Change { estimate: now.value / before.value, low: change.low.exp(), high: change.high.exp() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Moments;
    use crate::stats::binomial::clopper_pearson;
    use crate::stats::source::Source;

    /// Mean and variance of `n` values of a law; degrees of freedom of `blocks`.
    fn measured(n: u64, source: &mut Source, law: impl Fn(&mut Source) -> f64) -> [Measure; 2] {
        let mut moments = Moments::default();
        (0..n).for_each(|_| moments.push(law(source)));
        let df = (n - 1) as f64;
        let mean = Measure { value: moments.mean, std_error: moments.std_error().unwrap(), df };
        let (variance, error) = (moments.variance().unwrap(), moments.variance_std_error().unwrap());
        [mean, Measure { value: variance, std_error: error, df: df / 64.0 }]
    }

    /// In how many of 2000 families of ten pairs without a change any interval of a mean, or of a variance, misses.
    fn false_alarms(counts: (u64, u64), law: impl Fn(&mut Source) -> f64 + Copy) -> [u64; 2] {
        let mut source = Source(7);
        let mut alarms = [0, 0];
        for _ in 0..2000 {
            let mut missed = [false, false];
            for _ in 0..10 {
                let before = measured(counts.0, &mut source, law);
                let now = measured(counts.1, &mut source, law);
                missed[0] |= difference(before[0], now[0], 0.005, 0.0).is_beyond(0.0, 0.0);
                missed[1] |= ratio(before[1], now[1], 0.005, 0.0).unwrap().is_beyond(1.0, 1.0);
            }
            alarms.iter_mut().zip(missed).for_each(|(count, missed)| *count += u64::from(missed));
        }
        alarms
    }

    /// A family of ten questions at 0.005 each errs with a probability of at most 0.05. Measured with exponential values: means
    /// in 4.5 to 4.8 % of the families, 5.4 % where one run is four times as long; variances in 1.8 to 2.2 %, and 3.6 %.
    #[test]
    fn nothing_changes_where_nothing_has_changed() {
        let exponential = |s: &mut Source| s.exponential();
        for counts in [(640, 640), (640, 2560)] {
            for count in false_alarms(counts, exponential) {
                let (least, _) = clopper_pearson(count, 2000, 0.999);
                assert!(least <= 0.05, "{count} of 2000 families err: {counts:?}");
            }
        }
    }

    /// The intervals are not so wide that they find nothing: of normal values, whose skewness is none, about 5 % err.
    #[test]
    fn intervals_are_not_too_wide() {
        let [means, _] = false_alarms((640, 640), |s| s.normal());
        let (least, most) = clopper_pearson(means, 2000, 0.999);
        assert!(least <= 0.05 && most >= 0.045, "{means} of 2000");
    }

    #[test]
    fn what_has_changed_is_found() {
        let one = |value: f64| Measure { value, std_error: 0.001, df: f64::INFINITY };
        let change = difference(one(1.0), one(1.01), 1e-3, 0.0);
        assert!(change.is_beyond(0.0, 0.0) && !change.is_beyond(-0.01, 0.01));
        assert!(!difference(one(1.0), one(1.01), 1e-3, 0.01).is_beyond(0.0, 0.0));
        let change = ratio(one(2.0), one(1.0), 1e-3, 0.0).unwrap();
        assert!((change.estimate - 0.5).abs() < 1e-12 && change.is_beyond(0.99, 1.01));
        // 3.2905 standard errors of the logarithm, 0.001 / 2 and 0.001 / 1
        let reach = 3.290_526_7 * 0.001 * (0.25_f64 + 1.0).sqrt();
        assert!((change.high.ln() - 0.5_f64.ln() - reach).abs() < 1e-9);
        assert_eq!(ratio(one(0.0), one(1.0), 1e-3, 0.0), None);
        assert_eq!(difference(one(3.0), one(3.0), 1e-3, 0.0).estimate, 0.0);
    }

    #[test]
    fn what_has_no_noise_changes_with_its_last_bit() {
        let exact = |value: f64| Measure { value, std_error: 0.0, df: 7.0 };
        assert!(!difference(exact(0.1), exact(0.1), 1e-3, 0.0).is_beyond(0.0, 0.0));
        assert!(difference(exact(0.1), exact(0.1 + 1e-16), 1e-3, 0.0).is_beyond(0.0, 0.0));
        let less = difference(exact(1.0), exact(2.0), 1e-3, 0.5).scaled(-1.0);
        assert_eq!((less.low, less.estimate, less.high), (-1.5, -1.0, -0.5));
    }
}
