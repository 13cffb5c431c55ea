//! The recursive estimator: N samples of the integral at each vertex, to a stated depth.
//!
//! - estimates: radiance, L = Le + (1/N) sum L_i f cos / pdf [Cook, Porter & Carpenter 1984], up to `clamp` bounces
//! - property: biased by the light of later bounces
//! - cost: (N^(D+1) - 1) / (N - 1) rays for depth D: exponential, while bounce k contributes as albedo^k
//! - fails when: one waits for it

use super::{Ctx, Estimate, Property, Roulette};
use crate::scene::{Directions, Ray, Rgb};
use serde::{Deserialize, Serialize};

/// N samples at each vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recursive {
    /// N, the number of samples at each vertex.
    pub samples: u32,
    /// How directions are drawn.
    pub directions: Directions,
    /// When the recursion ends: its clamp is the depth; each of the N samples plays roulette on its own.
    pub roulette: Roulette,
}

impl Estimate for Recursive {
    type Pass = ();

    fn begin(&self, _: u64, _: &mut Ctx<'_>) {}

    fn estimate(&self, (): &(), ray: Ray, cx: &mut Ctx<'_>) {
        self.shade(ray, Rgb::ONE, 0, cx);
    }

    fn property(&self) -> Property {
        Property::of(&self.roulette)
    }
}

impl Recursive {
    fn shade(&self, ray: Ray, beta: Rgb, bounce: u32, cx: &mut Ctx<'_>) {
        let Some(x) = cx.hit(&ray) else { return };
        cx.add(bounce, beta * x.le);
        if !self.roulette.reaches(bounce + 1) {
            return;
        }
        let q = self.roulette.q(bounce, beta, x.albedo());
        for _ in 0..self.samples {
            for _ in 0..cx.copies(q) {
                let next = cx.scatter(&x, self.directions);
                self.shade(next.ray, beta * next.weight / (q * f64::from(self.samples)), bounce + 1, cx);
            }
        }
    }
}
