//! Which light: by chance, or by its surface. Both are found by halving, for there may be many.

use super::{Emitter, Light, Lights, Pick};
use crate::scene::sky::SKY;

impl Lights {
    /// One light and the probability of its choice.
    #[inline]
    pub(super) fn pick(&self, pick: Pick, u: f64) -> Option<(&Light, f64)> {
        // the last one catches a cdf that rounding leaves below 1
        let last = self.lights.last()?;
        Some(match pick {
            Pick::Power => {
                let light = self.lights.get(self.lights.partition_point(|l| l.cdf <= u)).unwrap_or(last);
                (light, light.pmf)
            }
            Pick::Uniform => {
                let n = self.lights.len();
                (&self.lights[((u * n as f64) as usize).min(n - 1)], 1.0 / n as f64)
            }
        })
    }

    /// The light that this surface is, if it is one. Surfaces come first, in their order; the sky is last.
    #[inline]
    pub(super) fn of(&self, surface: u32) -> Option<&Light> {
        let number = |light: &Light| match light.emitter {
            Emitter::Surface(id, _) => id,
            Emitter::Point(_) | Emitter::Sky(_) => SKY,
        };
        let first = self.lights.partition_point(|light| number(light) < surface);
        let light = if surface == SKY { self.lights.last() } else { self.lights.get(first) };
        light.filter(|light| number(light) == surface && !matches!(light.emitter, Emitter::Point(_)))
    }
}
