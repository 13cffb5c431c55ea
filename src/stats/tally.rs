//! The ten statistical checks that MCNP prints for each tally, on our data.
//!
//! X-5 Monte Carlo Team, "MCNP: A General Monte Carlo N-Particle Transport Code,
//! Version 5", volume I, chapter 2 (LA-UR-03-1987, 2003). They look at the last half
//! of a run: is the mean steady, does its relative error R fall as it should, is
//! the variance itself known, do the largest scores belong to a law with a finite
//! variance. A run that passes is not proven right; one that fails is not done.
//!
//! The manual says "monotonic", "constant" and "no trend" without figures; the
//! figures here are ours. On 10^5 exponential values each light is green in 99 % of
//! runs at least. Of walks in a furnace with infinite variance (tail index 1.76, see
//! [`super::tails`]) 99 % show red in 5, 6, 7 or 10 at 10^5 and 10^6 values, of a
//! Pareto law of index 1.7 91 %; but so do 43 % of lognormal samples (sigma = 1,
//! 10^5 values) and 66 % of a Pareto law of index 3, mostly by check 7.

use super::Moments;
use super::tails::{KEPT, Light, Tail};
use serde::Serialize;

/// Snapshots that the last half must hold: the fewest steps whose order can be
/// significant at 1 % are 6.
pub const MIN_POINTS: usize = 7;

/// One of the ten checks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What is looked at, in a few words.
    pub name: &'static str,
    /// The number that decides; none if it can not be computed.
    pub value: Option<f64>,
    /// The number with its meaning, for people.
    pub text: String,
    /// The judgement.
    pub light: Light,
}

/// What the checks are called, in order.
const NAMES: [&str; 10] = [
    "mean without trend",
    "relative error small",
    "relative error decreases",
    "relative error as 1/sqrt(n)",
    "variance of the variance small",
    "variance of the variance decreases",
    "variance of the variance as 1/n",
    "figure of merit constant",
    "figure of merit without trend",
    "tail of the largest values",
];

const NOTHING: &str = "nothing was hit, or nothing varies";

/// The ten checks of a sample of radiance.
///
/// `history` holds the moments of the first n values for increasing n, the last
/// one of all values; 8 or more snapshots a doubling are meant. `tail` is that of all
/// values, `cost` the rays a value. In the manual's order:
///
/// 1. means of the steps have no trend: p of Kendall's (1938) test, green from 1 %, red below 0.1 %;
/// 2. R < 0.10 by the manual, which asks a point detector (next-event estimation) for 0.05: green;
/// 3. R falls: at every step green, in total only yellow;
/// 4. R falls as n^-1/2: exponent -0.6..-0.4 green, -0.75..-0.25 yellow;
/// 5. VOV = Σ(x - mean)⁴ / (Σ(x - mean)²)² - 1/n < 0.10 by the manual;
/// 6. VOV falls, as 3;
/// 7. VOV falls as 1/n: exponent -1.2..-0.8 green, -1.3..-0.7 yellow;
/// 8. figure of merit 1 / (R² · rays) is constant: within 10 % green, 25 % yellow;
/// 9. that of the steps has no trend, as 1;
/// 10. density of the largest values falls as x^-s with s > 3, i.e. with a finite variance, by
///     the manual; s = 1 + the index by Hill (1975), 10 at most; MCNP fits up to 200 values, this [`KEPT`].
///
/// With fewer than [`MIN_POINTS`] snapshots in the last half (or too few large values) the
/// light is yellow, as where nothing varies or nothing was hit; red if a value was not finite.
pub fn checks(history: &[Moments], tail: &Tail, cost: f64) -> [Check; 10] {
    let half = last_half(history);
    let verdicts = if half.last().is_some_and(|all| !(all.mean + all.m2 + all.m4).is_finite()) {
        std::array::from_fn(|_| (None, "a value is not finite".to_string(), Light::Red))
    } else if half.len() < MIN_POINTS {
        std::array::from_fn(|i| if i == 9 { largest(tail) } else { unknown("too few snapshots") })
    } else if half.last().is_some_and(|all| all.m2 == 0.0) {
        std::array::from_fn(|_| unknown(NOTHING))
    } else {
        judged(&half, tail, cost)
    };
    let mut names = NAMES.into_iter();
    verdicts.map(|(value, text, light)| Check { name: names.next().unwrap_or_default(), value, text, light })
}

/// Value, text and light of a check.
type Judged = (Option<f64>, String, Light);

fn unknown(why: &str) -> Judged {
    (None, why.to_string(), Light::Yellow)
}

/// Snapshots from half of all values on, in strictly increasing order.
fn last_half(history: &[Moments]) -> Vec<Moments> {
    let all = history.last().map_or(0, |all| all.n);
    let mut half: Vec<Moments> = Vec::new();
    for snapshot in history.iter().filter(|snapshot| 2 * snapshot.n >= all && snapshot.n >= 2) {
        if half.last().is_none_or(|last| last.n < snapshot.n) {
            half.push(*snapshot);
        }
    }
    half
}

fn judged(half: &[Moments], tail: &Tail, cost: f64) -> [Judged; 10] {
    let of = |f: &dyn Fn(&Moments) -> f64| half.iter().map(|m| (m.n as f64, f(m))).collect::<Vec<_>>();
    let (r, vov) = (of(&relative_error), of(&variance_of_variance));
    let merit = of(&|m| 1.0 / (relative_error(m) * relative_error(m) * m.n as f64 * cost));
    let steps: Vec<Moments> = half.windows(2).map(|pair| between(&pair[1], &pair[0])).collect();
    let means = steps.iter().map(|step| step.mean).collect::<Vec<_>>();
    let merits = steps.iter().map(|step| step.mean * step.mean / step.m2 * step.n as f64).collect::<Vec<_>>();
    [
        trend(&means),
        small(r.last(), "relative error", 0.05, 0.10),
        decreasing(&r),
        exponent(&r, -0.5, 0.1, 0.25),
        small(vov.last(), "variance of the variance", 0.10, 0.10),
        decreasing(&vov),
        exponent(&vov, -1.0, 0.2, 0.3),
        constant(&merit),
        trend(&merits),
        largest(tail),
    ]
}

/// Standard error over mean; NaN where the mean is 0.
fn relative_error(m: &Moments) -> f64 {
    m.std_error().map_or(f64::NAN, |error| error / m.mean.abs())
}

fn variance_of_variance(m: &Moments) -> f64 {
    m.m4 / (m.m2 * m.m2) - 1.0 / m.n as f64
}

/// Number, mean and squared deviations of the values that `later` saw after `earlier`.
fn between(later: &Moments, earlier: &Moments) -> Moments {
    let (all, before) = (later.n as f64, earlier.n as f64);
    let n = all - before;
    let mean = (all * later.mean - before * earlier.mean) / n;
    let m2 = later.m2 - earlier.m2 - (mean - earlier.mean) * (mean - earlier.mean) * before * n / all;
    // of equal values rounding leaves a little
    Moments { n: later.n - earlier.n, mean, m2: if m2 < 0.0 { 0.0 } else { m2 }, ..Moments::default() }
}

fn small(last: Option<&(f64, f64)>, what: &str, green: f64, yellow: f64) -> Judged {
    match last.map(|point| point.1).filter(|value| value.is_finite()) {
        None => unknown(NOTHING),
        Some(value) => (Some(value), format!("{what} {value:.2e}"), grade(value, green, yellow)),
    }
}

/// Green up to the first limit, but not with it, yellow up to the second.
fn grade(value: f64, green: f64, yellow: f64) -> Light {
    if value < green {
        Light::Green
    } else if value < yellow {
        Light::Yellow
    } else {
        Light::Red
    }
}

fn decreasing(points: &[(f64, f64)]) -> Judged {
    if points.iter().any(|point| !point.1.is_finite()) {
        return unknown(NOTHING);
    }
    let rises = points.windows(2).filter(|pair| pair[1].1 >= pair[0].1).count();
    let falls = points.last().zip(points.first()).is_some_and(|(last, first)| last.1 < first.1);
    let light = match (rises, falls) {
        (0, _) => Light::Green,
        (_, true) => Light::Yellow,
        (_, false) => Light::Red,
    };
    (Some(rises as f64), format!("rises in {rises} of {} steps", points.len() - 1), light)
}

/// Exponent of the power of n that fits best (least squares of the logarithms).
fn exponent(points: &[(f64, f64)], ideal: f64, green: f64, yellow: f64) -> Judged {
    let logs: Vec<(f64, f64)> = points.iter().map(|&(n, y)| (libm::log(n), libm::log(y))).collect();
    let slope = super::rate::least_squares(&logs);
    if !slope.is_finite() {
        return unknown(NOTHING);
    }
    let text = format!("falls as n^{slope:.2}, ideally n^{ideal}");
    (Some(slope), text, grade((slope - ideal).abs(), green, yellow))
}

fn constant(merit: &[(f64, f64)]) -> Judged {
    let (low, high) =
        merit.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), m| (low.min(m.1), high.max(m.1)));
    let change = high / low - 1.0;
    match merit.last() {
        Some(last) if change.is_finite() && merit.iter().all(|m| m.1.is_finite()) => {
            let text = format!("figure of merit {:.3e}, within {:.1} %", last.1, 100.0 * change);
            (Some(change), text, grade(change, 0.10, 0.25))
        }
        _ => unknown(NOTHING),
    }
}

fn trend(values: &[f64]) -> Judged {
    let Some(p) = super::trend::kendall(values) else {
        return unknown(NOTHING);
    };
    let light = match p {
        _ if p >= 0.01 => Light::Green,
        _ if p >= 0.001 => Light::Yellow,
        _ => Light::Red,
    };
    (Some(p), format!("a trend as strong by chance: p = {p:.3}"), light)
}

fn largest(tail: &Tail) -> Judged {
    let kept = &tail.largest;
    if kept.len() < KEPT || tail.n < 10 * KEPT as u64 {
        return unknown("too few large values");
    }
    // on a lattice, a value stands for all to half-way between neighbours
    let above: Vec<f64> = kept.iter().copied().filter(|&x| x > kept[0]).collect();
    let threshold = libm::sqrt(kept[0] * above.first().unwrap_or(&kept[0]));
    let excess: f64 = above.iter().map(|x| libm::log(x / threshold)).sum();
    let unbiased = above.len().saturating_sub(1).max(1) as f64;
    // equal values: steeper than any power
    let slope = if above.is_empty() { 10.0 } else { (1.0 + unbiased / excess).min(10.0) };
    let light = if slope > 3.0 { Light::Green } else { Light::Red };
    (Some(slope), format!("density falls as x^-{slope:.1}"), light)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::source::Source;

    #[test]
    fn steps_are_what_lies_between() {
        let mut source = Source(1);
        let (mut all, mut first, mut second) = (Moments::default(), Moments::default(), Moments::default());
        for i in 0..100 {
            let x = source.exponential();
            all.push(x);
            if i < 37 { first.push(x) } else { second.push(x) }
        }
        let step = between(&all, &first);
        assert_eq!(step.n, 63);
        assert!((step.mean - second.mean).abs() < 1e-14 && (step.m2 / second.m2 - 1.0).abs() < 1e-12);
    }
}
