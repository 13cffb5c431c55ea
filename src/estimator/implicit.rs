//! Implicit path tracing: one random walk, light is found by chance.
//!
//! - estimates: radiance, L = Le + T L [Kajiya 1986, eq. 6], one sample of the integral at each vertex
//! - property: unbiased; with a clamp, biased by the light of later bounces
//! - cost: one ray a vertex
//! - fails when: emitters are small (nearly all paths return zero) or points (none ever finds one)

use super::{Ctx, Estimate, Property, Roulette};
use crate::scene::{Directions, Ray, Rgb};
use serde::{Deserialize, Serialize};

/// One sample at each vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Implicit {
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When the walk ends.
    pub roulette: Roulette,
}

impl Estimate for Implicit {
    type Pass = ();

    fn begin(&self, _: u64, _: &mut Ctx<'_>) {}

    #[inline]
    fn estimate(&self, (): &(), ray: Ray, cx: &mut Ctx<'_>) {
        self.walk(ray, Rgb::ONE, 0, cx);
    }

    fn property(&self) -> Property {
        Property::of(&self.roulette)
    }
}

impl Implicit {
    fn walk(&self, mut ray: Ray, mut beta: Rgb, mut bounce: u32, cx: &mut Ctx<'_>) {
        loop {
            let Some(x) = cx.hit(&ray) else { return };
            cx.add(bounce, beta * x.le);
            bounce += 1;
            if !self.roulette.reaches(bounce) {
                return;
            }
            let q = self.roulette.q(bounce - 1, beta, x.albedo());
            let copies = cx.copies(q);
            if copies == 0 {
                return;
            }
            beta *= 1.0 / q;
            for _ in 1..copies {
                let next = cx.scatter(&x, self.directions);
                self.walk(next.ray, beta * next.weight, bounce, cx);
            }
            let next = cx.scatter(&x, self.directions);
            (ray, beta) = (next.ray, beta * next.weight);
        }
    }
}
