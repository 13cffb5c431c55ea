//! The constant survival probability that is most efficient, by theory.

use super::{ClosedForm, Counted, Known};
use crate::estimator::{Estimator, Roulette, Rule};
use crate::scene::library::SceneKind;

/// Efficiency over q as theory has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optimum {
    /// The largest q known to give an infinite variance (0 if none does).
    pub infinite_up_to: f64,
    /// The most efficient q; `None` if efficiency only grows towards q = 1.
    pub best: Option<f64>,
}

/// The same estimator with constant q from the first bounce on, without a clamp.
pub fn with_constant_q(estimator: &Estimator, q: f64) -> Estimator {
    estimator.with_roulette(Roulette::unclamped(Rule::Constant { q }))
}

/// 1 / (variance x rays) of one sample with constant q; 0 where the variance is infinite, `None` where unknown.
pub fn efficiency(scene: &SceneKind, estimator: &Estimator, channel: usize, q: f64) -> Option<f64> {
    let closed = ClosedForm::of(scene, &with_constant_q(estimator, q))?;
    match closed.central(channel, Counted::All, 2) {
        Known::Unknown => None,
        Known::Infinite => Some(0.0),
        Known::Value(variance) => Some(1.0 / (variance * closed.rays()?)),
    }
}

/// Scans q over (0, 1) and refines the best by golden sections; `None` where there is no closed form or no noise.
pub fn best_constant_q(scene: &SceneKind, estimator: &Estimator, channel: usize) -> Option<Optimum> {
    const STEPS: u32 = 1000;
    let at = |i: u32| f64::from(i) / f64::from(STEPS);
    let value = |q: f64| efficiency(scene, estimator, channel, q);
    let scan: Vec<f64> = (1..STEPS).map(|i| value(at(i))).collect::<Option<_>>()?;
    let best = (1..STEPS).max_by(|&i, &j| scan[i as usize - 1].total_cmp(&scan[j as usize - 1]))?;
    if scan[best as usize - 1].is_infinite() {
        return None;
    }
    let last_infinite = (1..STEPS).rev().find(|&i| scan[i as usize - 1] == 0.0);
    let infinite_up_to = last_infinite.map_or(0.0, |i| threshold(&value, at(i), at(i + 1)));
    let interior = best + 1 < STEPS;
    Some(Optimum { infinite_up_to, best: interior.then(|| golden(&value, at(best - 1), at(best + 1))) })
}

/// Bisects for the q above which the efficiency is positive.
fn threshold(value: &dyn Fn(f64) -> Option<f64>, mut zero: f64, mut positive: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (zero + positive);
        if value(middle).unwrap_or(0.0) == 0.0 { zero = middle } else { positive = middle }
    }
    zero
}

/// Golden-section search for the maximum.
fn golden(value: &dyn Fn(f64) -> Option<f64>, mut low: f64, mut high: f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    for _ in 0..60 {
        let (a, b) = (high - RATIO * (high - low), low + RATIO * (high - low));
        if value(a) < value(b) { low = a } else { high = b }
    }
    0.5 * (low + high)
}
