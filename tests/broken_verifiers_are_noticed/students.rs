//! t tests with mistakes.

use super::{Case, RIGHT, SKEWED, TAME, all_noticed, times};
use furnace::stats::multiplicity::sidak;
use furnace::stats::student::{one_sided_p, two_sided_p};
use furnace::stats::{Engine, Moments, Question, Verdict, judge, power, skewed};

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

pub fn brighter(samples: &[f64], level: f64) -> bool {
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

/// The t test corrected for skewness.
fn darker(samples: &[f64], level: f64) -> bool {
    let m = moments(samples);
    let g = m.skewness().unwrap() / (m.n as f64).sqrt();
    one_sided_p(-skewed::symmetrical(t(&m), g), df(&m)) <= level
}

/// t tests of `samples` at `level` with another denominator.
fn with_error(samples: &[f64], level: f64, error: impl Fn(&Moments) -> f64) -> bool {
    let m = moments(samples);
    one_sided_p((m.mean - RIGHT) / error(&m), df(&m)) <= level
}

/// A case without a mistake.
fn case() -> Case {
    Case {
        mistake: "",
        law: TAME,
        samples: 64,
        runs: 2000,
        level: 0.01,
        wrong: times!(1.04),
        sound: brighter,
        broken: brighter,
    }
}

/// The distance from the right mean is not divided by its standard error.
fn denominators() -> Vec<Case> {
    vec![
        Case {
            mistake: "n in place of its root",
            broken: |x, level| with_error(x, level, |m| m.variance().unwrap().sqrt() / m.n as f64),
            ..case()
        },
        Case {
            mistake: "the standard deviation in place of the standard error",
            broken: |x, level| with_error(x, level, |m| m.variance().unwrap().sqrt()),
            ..case()
        },
        Case {
            mistake: "the variance in place of the standard error",
            broken: |x, level| with_error(x, level, |m| m.variance().unwrap() / m.n as f64),
            ..case()
        },
        Case {
            mistake: "n in place of n - 1",
            samples: 3,
            runs: 20_000,
            level: 0.05,
            wrong: times!(1.3),
            broken: |x, level| with_error(x, level, |m| m.m2.sqrt() / m.n as f64),
            ..case()
        },
    ]
}

/// The wrong samples are looked at, or the wrong side.
fn samples_and_sides() -> Vec<Case> {
    vec![
        Case {
            mistake: "one side's p-value for both",
            level: 0.05,
            sound: differs,
            broken: |x, level| {
                let m = moments(x);
                one_sided_p(t(&m).abs(), df(&m)) <= level
            },
            ..case()
        },
        Case {
            mistake: "what is no number is left out",
            samples: 512,
            // a path in fifty divides zero by zero
            wrong: |x| x.iter_mut().step_by(50).for_each(|x| *x = f64::NAN),
            sound: judged,
            broken: |x, level| judged(&x.iter().copied().filter(|x| !x.is_nan()).collect::<Vec<_>>(), level),
            ..case()
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
        },
    ]
}

/// Error probability and size of a family of tests.
const FAMILY: (f64, usize) = (1e-12, 1_000_000);

/// Many looks or many questions, and one level.
fn many() -> Vec<Case> {
    vec![
        Case {
            mistake: "ten looks, one level",
            samples: 1024,
            level: 0.05,
            broken: |x, level| (0..10).any(|halvings| brighter(&x[..(x.len() >> halvings).max(2)], level)),
            ..case()
        },
        Case {
            mistake: "three channels, one level",
            samples: 192,
            level: 0.05,
            sound: |x, level| x.chunks(64).any(|channel| brighter(channel, level / 3.0)),
            broken: |x, level| x.chunks(64).any(|channel| brighter(channel, level)),
            ..case()
        },
        Case {
            mistake: "a level for each of many that is rounded away",
            samples: 1024,
            runs: 500,
            level: FAMILY.0,
            sound: |x, alpha| brighter(x, sidak(alpha, FAMILY.1)),
            broken: |x, alpha| brighter(x, 1.0 - (1.0 - alpha).powf(1.0 / FAMILY.1 as f64)),
            ..case()
        },
    ]
}

#[test]
fn wrong_distances_are_noticed() {
    all_noticed(&denominators());
}

#[test]
fn wrong_samples_and_sides_are_noticed() {
    all_noticed(&samples_and_sides());
}

#[test]
fn what_is_asked_often_is_noticed() {
    all_noticed(&many());
}

/// Biases in the cases are such that a sound test finds them nine times in ten; here for the smallest level.
#[test]
fn the_bias_is_large_enough_for_the_smallest_level() {
    let level = sidak(FAMILY.0, FAMILY.1);
    let se = TAME.variance().unwrap().sqrt() / 1024_f64.sqrt();
    let needed = power::reach(Engine::Asymptotic, 1023.0, level, 0.9) * se;
    assert!(level > 9e-19 && needed < 0.04, "{level:e} {needed}");
}
