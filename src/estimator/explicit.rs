//! Explicit path tracing: direct light is sampled on the emitters, indirect light by one continued direction.
//!
//! - estimates: radiance, L = Le + Ld + Lind, where Lind must not see Le again [Kajiya 1986; Veach 1997, sec. 8.2]
//! - property: unbiased; with a clamp, biased by the light of later bounces
//! - cost: a shadow ray and a continued ray a vertex
//! - fails when: an emitter touches what it lights (infinite variance when sampled over its area)

use super::{Ctx, Estimate, Property, Roulette};
use crate::scene::{Directions, LightSampling, Ray, Rgb};
use serde::{Deserialize, Serialize};

/// Next-event estimation at each vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Explicit {
    /// How points on emitters are drawn.
    pub lights: LightSampling,
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When the walk ends.
    pub roulette: Roulette,
    /// Which of two ways to find a light counts.
    #[serde(default)]
    pub technique: Technique,
    /// How a light is picked among several.
    #[serde(default)]
    pub pick: Pick,
}

/// Which of two ways to find a light counts: a sampled point on it, or a continued direction that happens to hit it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Technique {
    /// Points sampled on the emitters alone: next-event estimation.
    #[default]
    Light,
    /// Hits of continued directions alone: the implicit estimator.
    Direction,
    /// Both, in a weighted sum: multiple importance sampling [Veach 1997, ch. 9].
    Both(Heuristic),
}

/// How much of a sample counts that the other technique might have drawn with density p' instead of p
/// [Veach 1997, sec. 9.2].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Heuristic {
    /// p / (p + p').
    #[default]
    Balance,
    /// p^2 / (p^2 + p'^2).
    Power,
}

/// How a light is picked among several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pick {
    /// In proportion to its power.
    #[default]
    Power,
    /// Each with the same probability.
    Uniform,
}

impl Estimate for Explicit {
    #[inline]
    fn estimate(&self, ray: Ray, cx: &mut Ctx<'_>) {
        self.walk(ray, Rgb::ONE, 0, cx);
    }

    fn property(&self) -> Property {
        Property::of(&self.roulette)
    }
}

impl Explicit {
    fn walk(&self, mut ray: Ray, mut beta: Rgb, mut bounce: u32, cx: &mut Ctx<'_>) {
        loop {
            let Some(x) = cx.hit(&ray) else { return };
            if bounce == 0 {
                cx.add(0, x.material.le); // seen directly; later on the emitter was sampled from the vertex before
            }
            bounce += 1;
            if !self.roulette.reaches(bounce) {
                return;
            }
            let direct = cx.direct(&x, self.lights);
            cx.add(bounce, beta * direct);
            if !self.roulette.reaches(bounce + 1) {
                return;
            }
            let q = self.roulette.q(bounce - 1, beta, x.material.albedo);
            let copies = cx.copies(q);
            if copies == 0 {
                return;
            }
            beta *= 1.0 / q;
            for _ in 1..copies {
                let (next, weight) = cx.scatter(&x, self.directions);
                self.walk(next, beta * weight, bounce, cx);
            }
            let (next, weight) = cx.scatter(&x, self.directions);
            (ray, beta) = (next, beta * weight);
        }
    }
}
