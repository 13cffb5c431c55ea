//! How the error of a cell's runs falls with their samples, and whether it does so as theory says.

use super::cell::Cell;
use super::plan::CellPlan;
use super::row::Estimand;
use super::spec::{Claim, ErrorKind};
use super::subject::Subject;
use super::verdict::Sheet;
use crate::stats::decay::{self, Estimate, Falling, Runs, exponent_of};
use crate::stats::tails::Light;
use crate::stats::{Moments, Question};
use crate::truth::{After, Counted, Known, Source, Truth, Value};

/// Variance and mean squared error are fitted from here on, all numbers of samples alike: the means of fewer are far from
/// normal.
const FIRST: u64 = 4;

/// The bias is fitted where theory has it at so many of its standard errors, also by theory, or more.
const RESOLVED: f64 = 5.0;

/// Relative variance that outliers may add to a sample variance, at most, for its logarithm to have a standard error.
const OUTLIERS: f64 = 0.1;

/// Share of the error at the end that the truth's own error may make up, at most.
const TRUTH: f64 = 0.1;

/// The error of a cell's runs in one channel, and what theory says of it.
pub struct Decline {
    /// Realizations after which the runs were looked at.
    pub marks: Vec<u64>,
    /// What theory says, at each of them.
    pub theory: Vec<After>,
    means: Vec<Vec<f64>>,
    right: Option<Value>,
    rates: crate::estimator::Rates,
    /// Why the variance between runs has no exponent to be judged.
    unfit: Option<String>,
}

/// How a part of the error falls: the power of the number of samples.
#[derive(Clone, Debug, Default)]
pub struct Fall {
    /// As measured, with its standard error.
    pub measured: Option<Estimate>,
    /// By theory, at the same numbers of samples with the same weights.
    pub exact: Option<f64>,
    /// By theory, in the long run.
    pub late: Option<f64>,
    /// Why it cannot be judged.
    pub unfit: Option<String>,
}

impl Decline {
    /// That of a cell which was cut into runs; `None` elsewhere.
    pub fn of(plan: &CellPlan, cell: &Cell, truth: &Truth, channel: usize) -> Option<Self> {
        let first = cell.traces.first()?;
        let marks: Vec<u64> = (0..first.len()).map(|i| (1 << i).min(plan.block)).collect();
        let means =
            cell.traces.iter().map(|trace| trace.iter().map(|mean| mean[channel]).collect()).collect();
        let theory: Vec<After> = marks.iter().map(|&n| truth.after(channel, n)).collect();
        let right = truth.mean(channel, Counted::All);
        let unfit = unfit(cell, truth, channel, &theory);
        Some(Decline { marks, theory, means, right, rates: truth.rates(), unfit })
    }

    fn runs(&self) -> Runs<'_> {
        Runs {
            marks: &self.marks,
            means: &self.means,
            truth: self.right.map(|right| (right.value, right.std_error)),
        }
    }

    /// The measured errors at each mark.
    pub fn errors(&self) -> Vec<decay::Error> {
        self.runs().errors()
    }

    /// Runs.
    pub fn count(&self) -> usize {
        self.means.len()
    }

    /// The right mean.
    pub fn right(&self) -> Option<Value> {
        self.right
    }

    /// Whether theory knows that there is no variance, and so no standard error of anything.
    pub fn is_infinite(&self) -> bool {
        self.theory.first().is_some_and(|after| after.variance == Known::Infinite)
    }

    /// What is not above this part of an error is rounding.
    pub fn rounding(&self, kind: ErrorKind) -> f64 {
        let relative = self.right.map_or(0.0, |right| 1e-12 * right.value.abs());
        if kind == ErrorKind::Bias { relative } else { relative * relative }
    }

    /// How one part of the error falls.
    pub fn fall(&self, kind: ErrorKind) -> Fall {
        if self.theory.first().is_some_and(|after| after.variance == Known::Value(0.0)) {
            return Fall::default(); // without noise nothing falls
        }
        let all: Vec<f64> = self.marks.iter().map(|&n| if n >= FIRST { 1.0 } else { 0.0 }).collect();
        match kind {
            ErrorKind::Variance => Fall {
                measured: self.runs().exponent(Falling::Variance, &all),
                exact: match self.rates.variance == 1.0 {
                    true => Some(-1.0),
                    false => self.curve(|after| after.variance.value(), &all),
                },
                late: Some(-self.rates.variance),
                unfit: self.unfit.clone(),
            },
            ErrorKind::Mse => Fall {
                measured: self.runs().exponent(Falling::Mse, &all),
                exact: match self.is_unbiased() && self.rates.variance == 1.0 {
                    true => Some(-1.0),
                    false => self.curve(After::mse, &all),
                },
                late: match self.is_unbiased() {
                    true => Some(-self.rates.variance),
                    false => Some(-self.rates.variance.min(2.0 * self.rates.bias)),
                },
                unfit: self.unfit.clone().or_else(|| self.inexact()),
            },
            ErrorKind::Bias => self.fall_of_bias(),
        }
    }

    fn fall_of_bias(&self) -> Fall {
        let (false, Some(last)) = (self.is_unbiased(), self.theory.last().and_then(|after| after.bias))
        else {
            return Fall::default();
        };
        // squared number of standard errors, all by theory
        let weight = |after: &After| {
            let (bias, variance) = (after.bias?, after.variance.value().filter(|v| *v > 0.0)?);
            Some(bias * bias * self.count() as f64 / variance)
                .filter(|squared| *squared >= RESOLVED * RESOLVED)
        };
        let weights: Vec<f64> = self.theory.iter().map(|after| weight(after).unwrap_or(0.0)).collect();
        Fall {
            measured: self.runs().exponent(Falling::Bias(last.signum()), &weights),
            exact: self.curve(|after| after.bias.map(f64::abs), &weights),
            late: Some(-self.rates.bias),
            unfit: self.inexact(),
        }
    }

    /// The exponent of theory's curve, where all of it is known.
    fn curve(&self, of: impl Fn(&After) -> Option<f64>, weights: &[f64]) -> Option<f64> {
        let curve: Vec<f64> = self.theory.iter().map(of).collect::<Option<_>>()?;
        exponent_of(&self.marks, &curve, weights)
    }

    /// Whether theory has no bias at any number of samples.
    fn is_unbiased(&self) -> bool {
        let Some(right) = self.right else { return false };
        let rounding = 1e-12 * right.value.abs();
        self.theory.iter().all(|after| after.bias.is_some_and(|bias| bias.abs() <= rounding))
    }

    /// Why the truth is too inexact for what is left of the error.
    fn inexact(&self) -> Option<String> {
        let own = self.right.map(|right| right.std_error + right.bound)?;
        let left = self.errors().last()?.mse?.value.sqrt();
        let share = own / left;
        (share > TRUTH)
            .then(|| format!("the truth's own error is {:.0} % of the last one: not judged", 100.0 * share))
    }
}

/// Why the variance between runs says nothing certain: it is infinite, or outliers make it.
fn unfit(cell: &Cell, truth: &Truth, channel: usize, theory: &[After]) -> Option<String> {
    let variance = theory.first()?.variance;
    if variance == Known::Infinite {
        return Some("infinite variance: no rate is judged".to_owned());
    }
    let fourth = truth.theory().map_or(Known::Unknown, |t| t.central(channel, Counted::All, 4));
    if fourth == Known::Infinite {
        return Some("infinite fourth moment: the variance has no interval, no rate is judged".to_owned());
    }
    let (light, why) = cell.tails[channel].guard();
    if variance == Known::Unknown && light == Light::Red {
        return Some(format!("the tail is too heavy for a variance: {why}"));
    }
    let excess = kurtosis(&cell.total[channel])? - 3.0;
    (excess > OUTLIERS * FIRST as f64 * cell.traces.len() as f64).then(|| {
        format!(
            "outliers (excess kurtosis {excess:.0}): the variance of {FIRST} samples is not certain enough"
        )
    })
}

fn kurtosis(total: &Moments) -> Option<f64> {
    (total.m2 > 0.0).then(|| total.n as f64 * total.m4 / (total.m2 * total.m2))
}

impl Subject<'_> {
    /// Exponents with which the errors of a cell's runs fall, and what is asked about them.
    pub fn rates(&self, sheet: &mut Sheet<'_>) {
        let kinds = [
            (ErrorKind::Mse, Estimand::RateMse),
            (ErrorKind::Variance, Estimand::RateVariance),
            (ErrorKind::Bias, Estimand::RateBias),
        ];
        for channel in 0..3 {
            let Some(decline) = Decline::of(self.plan, self.cell, self.truth, channel) else { return };
            for (kind, estimand) in kinds {
                self.rate(&decline.fall(kind), estimand, channel, decline.count(), sheet);
            }
        }
    }

    fn rate(&self, fall: &Fall, estimand: Estimand, channel: usize, runs: usize, sheet: &mut Sheet<'_>) {
        let Some(measured) = fall.measured else { return };
        let mut row = self.row(estimand, Some(channel), measured.value);
        row.std_error = Some(measured.std_error).filter(|_| fall.unfit.is_none());
        let late = fall.late.map_or_else(String::new, |late| format!("{late:.3} in the long run"));
        row.note = match (&fall.unfit, fall.exact) {
            (Some(why), _) => why.clone(),
            (None, Some(_)) => late,
            (None, None) => "the rate is not known: not judged".to_owned(),
        };
        let judged = fall.exact.filter(|_| fall.unfit.is_none());
        if let Some(exact) = judged {
            row.against(&Value::exact(exact, Source::ClosedForm), Some(exact));
        }
        let claim = sheet.claim(Claim::rate);
        sheet.state(row);
        if let (Some((claim, margin)), Some(expected)) = (claim, judged) {
            let question = Question::about(&self.cell.total[channel], self.cell.invalid(), expected, margin);
            let (mean, std_error, df) = (measured.value, measured.std_error, runs as f64 - 1.0);
            sheet.ask(claim, Question { mean, std_error, df, ..question });
        }
    }
}
