//! When a walk ends: every termination rule, for every estimator.
//!
//! A rule gives q, the expected number of continuations after a vertex. q <= 1 is a survival probability, q > 1 splits;
//! whoever goes on is weighted 1/q, so that the mean is kept whatever q > 0 is. The lecture's termination probability
//! chi is 1 - q.

use crate::scene::Rgb;
use serde::{Deserialize, Serialize};

/// How q is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// q = 1: only a clamp ends the walk.
    None,
    /// The same q everywhere.
    Constant {
        /// Expected number of continuations, > 0.
        q: f64,
    },
    /// q = the largest channel of the surface's albedo.
    Albedo,
    /// q = the largest channel of beta x albedo, at least `floor` and at most 1.
    Throughput {
        /// Lower limit of q, in (0, 1]: throughput that falls to zero must not survive with probability zero.
        floor: f64,
    },
}

/// A termination rule.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Roulette {
    /// How q is chosen.
    pub rule: Rule,
    /// The first `from` bounces are certain.
    pub from: u32,
    /// Light scattered more often than this is left out, which biases the result.
    pub clamp: Option<u32>,
}

impl Roulette {
    /// No roulette: at most `bounces` scattering events.
    pub fn depth_clamp(bounces: u32) -> Self {
        Roulette { rule: Rule::None, from: 0, clamp: Some(bounces) }
    }

    /// The given rule from the first bounce on, without a clamp.
    pub fn unclamped(rule: Rule) -> Self {
        Roulette { rule, from: 0, clamp: None }
    }

    /// Whether light scattered `bounce` times is counted.
    #[inline]
    pub fn reaches(&self, bounce: u32) -> bool {
        self.clamp.is_none_or(|clamp| bounce <= clamp)
    }

    /// Expected number of continuations from a vertex with `albedo`, reached after `bounce` scattering events with
    /// throughput `beta`; 0 where either is 0, because nothing goes on.
    #[inline]
    pub fn q(&self, bounce: u32, beta: Rgb, albedo: Rgb) -> f64 {
        if albedo == Rgb::ZERO || beta == Rgb::ZERO {
            return 0.0;
        }
        if bounce < self.from {
            return 1.0;
        }
        self.rule.q(beta.to_array(), albedo.to_array())
    }
}

impl Rule {
    /// Expected number of continuations, given throughput and albedo by channel: of one path, or of several side by side.
    #[inline(always)]
    pub fn q<N: Number>(self, beta: [N; 3], albedo: [N; 3]) -> N {
        match self {
            Rule::None => beta[0].like(1.0),
            Rule::Constant { q } => beta[0].like(q),
            Rule::Albedo => largest(albedo),
            Rule::Throughput { floor } => {
                largest([beta[0] * albedo[0], beta[1] * albedo[1], beta[2] * albedo[2]]).clamp(floor, 1.0)
            }
        }
    }
}

#[inline(always)]
fn largest<N: Number>([r, g, b]: [N; 3]) -> N {
    r.max(g.max(b))
}

/// A number of one path, or of several side by side.
pub trait Number: Copy + std::ops::Mul<Output = Self> {
    /// `x` for each path.
    fn like(self, x: f64) -> Self;

    /// The larger of two.
    fn max(self, other: Self) -> Self;

    /// The nearest number in [low, high].
    fn clamp(self, low: f64, high: f64) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }

    #[inline(always)]
    fn clamp(self, low: f64, high: f64) -> Self {
        f64::clamp(self, low, high)
    }
}
