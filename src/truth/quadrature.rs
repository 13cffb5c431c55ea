//! Gauss-Legendre integration.

use std::f64::consts::PI;

/// The integral of `f` from `a` to `b` by the rule of `count` points; exact for polynomials of degree 2 count - 1.
pub fn gauss_legendre(count: usize, a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    half * nodes(count).iter().map(|&(node, weight)| weight * f(middle + half * node)).sum::<f64>()
}

/// An integral and what its refinement says of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// Its value.
    pub value: f64,
    /// Change from half as many nodes along each axis, and rounding; for an analytic integrand far above the
    /// true error.
    pub error: f64,
}

/// Nodes along each axis of the finer of the two rules.
const NODES: usize = 64;

/// The integral of `f` over [`x`.0, `x`.1] x [`y`.0, `y`.1] by a tensor product of 64-point rules.
pub fn tensor(x: (f64, f64), y: (f64, f64), f: impl Fn(f64, f64) -> f64) -> Integral {
    let coarse = product(&nodes(NODES / 2), x, y, &f);
    let value = product(&nodes(NODES), x, y, &f);
    Integral { value, error: (value - coarse).abs() + 1e-14 * value.abs() }
}

fn product(rule: &[(f64, f64)], x: (f64, f64), y: (f64, f64), f: &impl Fn(f64, f64) -> f64) -> f64 {
    let at = |(low, high): (f64, f64), node: f64| 0.5 * (low + high) + 0.5 * (high - low) * node;
    let row = |u: f64| rule.iter().map(|&(node, weight)| weight * f(u, at(y, node))).sum::<f64>();
    let sum: f64 = rule.iter().map(|&(node, weight)| weight * row(at(x, node))).sum();
    0.25 * (x.1 - x.0) * (y.1 - y.0) * sum
}

/// Nodes and weights on [-1, 1], for `count` >= 2. [Abramowitz & Stegun 1964, eq. 25.4.29]
pub fn nodes(count: usize) -> Vec<(f64, f64)> {
    (0..count)
        .map(|i| {
            // close enough to the i-th root for Newton's method to find that one
            let mut node = libm::cos(PI * (i as f64 + 0.75) / (count as f64 + 0.5));
            for _ in 0..8 {
                let (value, slope) = legendre(count, node);
                node -= value / slope;
            }
            let slope = legendre(count, node).1;
            (node, 2.0 / ((1.0 - node * node) * slope * slope))
        })
        .collect()
}

/// The Legendre polynomial of degree `n` >= 1 and its derivative at |x| < 1, by recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, n as f64 * (before - x * value) / (1.0 - x * x))
}
