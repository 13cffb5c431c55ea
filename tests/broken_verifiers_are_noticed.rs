//! Promise: mistakes in the statistics themselves would be noticed. Each verifier below is wrong in a way that has
//! happened somewhere; what it says of samples with a known mean is counted exactly as for the sound one beside it. The
//! sound one passes, the broken one is told apart by its own error rates.

use furnace::stats::bets::Bets;
use furnace::stats::binomial::clopper_pearson;
use furnace::stats::multiplicity::sidak;
use furnace::stats::nulls::Law;
use furnace::stats::student::{one_sided_p, two_sided_p};
use furnace::stats::{Engine, Moments, Question, Stake, Table, Verdict, judge, power, skewed};
use rayon::prelude::*;

/// All laws here have this mean.
const RIGHT: f64 = 1.0;

/// Whether samples are called wrong at a level.
type Verifier = fn(&[f64], f64) -> bool;

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

fn moments(samples: &[f64]) -> Moments {
    let mut moments = Moments::default();
    samples.iter().for_each(|&x| moments.push(x));
    moments
}

fn t(m: &Moments) -> f64 {
    (m.mean - RIGHT) / m.std_error().unwrap()
}

fn df(m: &Moments) -> f64 {
    m.n as f64 - 1.0
}

fn brighter(samples: &[f64], level: f64) -> bool {
    let m = moments(samples);
    one_sided_p(t(&m), df(&m)) <= level
}

fn differs(samples: &[f64], level: f64) -> bool {
    let m = moments(samples);
    two_sided_p(t(&m), df(&m)) <= level
}

/// The bench itself: what is wrong or no number at all.
fn judged(samples: &[f64], level: f64) -> bool {
    let question = Question::about(&moments(samples), None, RIGHT, 0.1);
    matches!(judge(&[question], level)[0].verdict, Verdict::Fail | Verdict::Invalid)
}

/// t tests of `samples` at `level` with another denominator.
fn with_error(samples: &[f64], level: f64, error: impl Fn(&Moments) -> f64) -> bool {
    let m = moments(samples);
    one_sided_p((m.mean - RIGHT) / error(&m), df(&m)) <= level
}

/// Multiplies all samples by a factor that is found in nine of ten runs at the least.
macro_rules! times {
    ($factor:expr) => {
        |samples: &mut [f64]| samples.iter_mut().for_each(|x| *x *= $factor)
    };
}

fn cases() -> Vec<Case> {
    let case = Case {
        mistake: "",
        law: TAME,
        samples: 64,
        runs: 2000,
        level: 0.01,
        wrong: times!(1.04),
        sound: brighter,
        broken: brighter,
    };
    vec![
        Case {
            mistake: "n in place of its root",
            broken: |x, level| with_error(x, level, |m| m.variance().unwrap().sqrt() / m.n as f64),
            ..case
        },
        Case {
            mistake: "the standard deviation in place of the standard error",
            broken: |x, level| with_error(x, level, |m| m.variance().unwrap().sqrt()),
            ..case
        },
        Case {
            mistake: "the variance in place of the standard error",
            broken: |x, level| with_error(x, level, |m| m.variance().unwrap() / m.n as f64),
            ..case
        },
        Case {
            mistake: "n in place of n - 1",
            samples: 3,
            runs: 20_000,
            level: 0.05,
            wrong: times!(1.3),
            broken: |x, level| with_error(x, level, |m| m.m2.sqrt() / m.n as f64),
            ..case
        },
        Case {
            mistake: "one side's p-value for both",
            level: 0.05,
            sound: differs,
            broken: |x, level| {
                let m = moments(x);
                one_sided_p(t(&m).abs(), df(&m)) <= level
            },
            ..case
        },
        Case {
            mistake: "what is no number is left out",
            samples: 512,
            // a path in fifty divides zero by zero
            wrong: |x| x.iter_mut().step_by(50).for_each(|x| *x = f64::NAN),
            sound: judged,
            broken: |x, level| judged(&x.iter().copied().filter(|x| !x.is_nan()).collect::<Vec<_>>(), level),
            ..case
        },
        Case {
            mistake: "outliers are left out",
            law: SKEWED,
            samples: 1024,
            runs: 1000,
            level: 0.05,
            wrong: times!(0.8),
            sound: darker,
            broken: |x, level| {
                let m = moments(x);
                let far = 3.0 * m.variance().unwrap().sqrt();
                let near = |v: &f64| (v - m.mean).abs() < far;
                darker(&x.iter().copied().filter(near).collect::<Vec<_>>(), level)
            },
            ..case
        },
        Case {
            mistake: "ten looks, one level",
            samples: 1024,
            level: 0.05,
            broken: |x, level| (0..10).any(|halvings| brighter(&x[..(x.len() >> halvings).max(2)], level)),
            ..case
        },
        Case {
            mistake: "three channels, one level",
            samples: 192,
            level: 0.05,
            sound: |x, level| x.chunks(64).any(|channel| brighter(channel, level / 3.0)),
            broken: |x, level| x.chunks(64).any(|channel| brighter(channel, level)),
            ..case
        },
        Case {
            mistake: "a level for each of many that is rounded away",
            samples: 1024,
            runs: 500,
            level: FAMILY.0,
            sound: |x, alpha| brighter(x, sidak(alpha, FAMILY.1)),
            broken: |x, alpha| brighter(x, 1.0 - (1.0 - alpha).powf(1.0 / FAMILY.1 as f64)),
            ..case
        },
    ]
}

/// Error probability and size of a family of tests.
const FAMILY: (f64, usize) = (1e-12, 1_000_000);

/// The t test corrected for skewness.
fn darker(samples: &[f64], level: f64) -> bool {
    let m = moments(samples);
    let g = m.skewness().unwrap() / (m.n as f64).sqrt();
    one_sided_p(-skewed::symmetrical(t(&m), g), df(&m)) <= level
}

/// A guess of the mean that is ten percent too small, which costs a little power and no validity.
const STAKE: Stake = Stake { scale: 0.9, bound: None };

/// Whether what was won after any 16 samples makes `enough` true.
fn ever(samples: &[f64], enough: impl Fn(&Bets) -> bool) -> bool {
    let mut bets = Bets::new(STAKE);
    samples.chunks(16).any(|chunk| {
        let mut table = Table::new(STAKE);
        chunk.iter().for_each(|&x| table.push(x));
        bets.merge(&table.close(chunk.len() as u64));
        enough(&bets)
    })
}

fn bets() -> Vec<Case> {
    let case = Case {
        mistake: "",
        law: SKEWED,
        samples: 1024,
        runs: 2000,
        level: 0.01,
        wrong: times!(1.4),
        sound: |x, level| ever(x, |bets| bets.log_above(RIGHT) >= -level.ln()),
        broken: brighter,
    };
    vec![
        Case {
            mistake: "bets against the guess in place of the right mean",
            broken: |x, level| ever(x, |bets| bets.log_above(STAKE.scale) >= -level.ln()),
            ..case
        },
        Case {
            mistake: "the level in place of its inverse",
            broken: |x, level| ever(x, |bets| bets.log_above(RIGHT) >= level.ln()),
            ..case
        },
        Case {
            mistake: "bets that are made once the sample is seen",
            broken: |x, level| {
                let seen: Vec<f64> = x.iter().copied().filter(|x| *x > 0.9 * RIGHT).collect();
                ever(&seen, |bets| bets.log_above(RIGHT) >= -level.ln())
            },
            ..case
        },
        Case {
            mistake: "the best of sixteen shares, chosen afterwards",
            samples: 2048,
            level: 0.05,
            broken: |x, level| best_share(x) >= -level.ln(),
            ..case
        },
    ]
}

/// Logarithm of the largest fortune over time and over the shares 1/2, 1/4, ..., each of which is honest by itself.
fn best_share(samples: &[f64]) -> f64 {
    let mut logs = [0.0_f64; 16];
    let mut best = 0.0_f64;
    for x in samples {
        let mut share = 1.0;
        for log in &mut logs {
            share *= 0.5;
            *log += (share * (x - RIGHT)).ln_1p();
            best = best.max(*log);
        }
    }
    best
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

#[test]
fn wrong_tests_are_noticed() {
    all_noticed(&cases());
}

#[test]
fn wrong_bets_are_noticed() {
    all_noticed(&bets());
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

/// Biases in the cases are such that a sound test finds them nine times in ten; here for the smallest level.
#[test]
fn the_bias_is_large_enough_for_the_smallest_level() {
    let level = sidak(FAMILY.0, FAMILY.1);
    let se = TAME.variance().unwrap().sqrt() / 1024_f64.sqrt();
    let needed = power::reach(Engine::Asymptotic, 1023.0, level, 0.9) * se;
    assert!(level > 9e-19 && needed < 0.04, "{level:e} {needed}");
}
