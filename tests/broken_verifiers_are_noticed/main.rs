//! Promise: mistakes in the statistics themselves would be noticed. Each verifier below is wrong in a way that has
//! happened somewhere; what it says of samples with a known mean is counted exactly as for the sound one beside it. The
//! sound one passes, the broken one is told apart by its own error rates.

mod bets;
mod students;

use furnace::stats::Moments;
use furnace::stats::binomial::clopper_pearson;
use furnace::stats::nulls::Law;
use rayon::prelude::*;

/// All laws here have this mean.
const RIGHT: f64 = 1.0;

/// Whether samples are called wrong at a level.
type Verifier = fn(&[f64], f64) -> bool;

/// Multiplies all samples by a factor that is found in nine of ten runs at the least.
macro_rules! times {
    ($factor:expr) => {
        |samples: &mut [f64]| samples.iter_mut().for_each(|x| *x *= $factor)
    };
}
pub(crate) use times;

struct Case {
    mistake: &'static str,
    law: Law,
    samples: usize,
    runs: u64,
    level: f64,
    /// What happens to the samples of a run of an estimator that is wrong.
    wrong: fn(&mut [f64]),
    sound: Verifier,
    broken: Verifier,
}

/// Nearly normal, with a standard deviation of 5 %.
const TAME: Law = Law::Lognormal { sigma: 0.05 };
const SKEWED: Law = Law::Lognormal { sigma: 1.0 };

impl Case {
    /// In how many runs the verifier rejects.
    fn rejected(&self, verifier: Verifier, change: fn(&mut [f64])) -> u64 {
        let rejects = |run: &u64| {
            let mut samples: Vec<f64> = self.law.samples(20_260, *run).take(self.samples).collect();
            change(&mut samples);
            verifier(&samples, self.level)
        };
        (0..self.runs).into_par_iter().filter(rejects).count() as u64
    }

    fn complaint(&self, verifier: Verifier) -> Option<String> {
        let (alarms, found) = (self.rejected(verifier, |_| ()), self.rejected(verifier, self.wrong));
        println!("{}: {alarms} {found} of {}", self.mistake, self.runs);
        complaint(alarms, found, self.runs, self.level)
    }
}

/// What a calibration holds against a verifier: more false alarms than its level allows, or less found than the nine in
/// ten that were promised; neither explained by chance at 99.9 %.
fn complaint(alarms: u64, found: u64, runs: u64, level: f64) -> Option<String> {
    let (least, most) = (clopper_pearson(alarms, runs, 0.999).0, clopper_pearson(found, runs, 0.999).1);
    if least > level {
        return Some(format!("{alarms} false alarms in {runs} runs, at a level of {level}"));
    }
    (most < 0.9).then(|| format!("found in {found} of {runs} runs only"))
}

fn all_noticed(cases: &[Case]) {
    let mut wrong = Vec::new();
    for case in cases {
        match (case.complaint(case.sound), case.complaint(case.broken)) {
            (None, Some(_)) => {}
            (Some(why), _) => wrong.push(format!("{}: the sound one, {why}", case.mistake)),
            (None, None) => wrong.push(format!("{}: not noticed", case.mistake)),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// 2^25 equal values, next to which a sum in single precision stops growing.
#[test]
fn sums_in_single_precision_are_noticed() {
    const N: u64 = 1 << 25;
    const RUNS: u64 = 4;
    let single = |x: f64| {
        let mut sum = 0.0_f32;
        (0..N).for_each(|_| sum += std::hint::black_box(x as f32));
        f64::from(sum) / N as f64
    };
    let double = |x: f64| {
        let mut m = Moments::default();
        (0..N).for_each(|_| m.push(std::hint::black_box(x)));
        m.mean
    };
    assert_eq!(single(0.5), 0.25);
    // without noise, values are compared
    let complaint = |mean: &(dyn Fn(f64) -> f64 + Sync)| {
        let rejected = |bias: f64| {
            let differs = |run: &u64| {
                let right = 0.5 + *run as f64 / 16.0;
                (mean(right * (1.0 + bias)) - right).abs() > 1e-12 * right
            };
            (0..RUNS).into_par_iter().filter(differs).count() as u64
        };
        complaint(rejected(0.0), rejected(1e-3), RUNS, 0.01)
    };
    assert_eq!(complaint(&double), None);
    assert!(complaint(&single).is_some());
}
