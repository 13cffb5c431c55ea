//! A clear plate between two lights: part of each is seen, by all reflections between the faces.

use super::props::{LE, Place, UPRIGHT, light, of, setting};
use super::{Exhibit, Parameter, Series, Theory, nothing_missed};
use crate::estimator::Rule;
use crate::scene::{Bsdf, Rgb, Sensor};
use crate::truth::optics::interface::Slab;

const BEHIND: Rgb = Rgb::new(1.0, 7.0, 4.0);
/// Reflections that are written out: what follows is below 1e-16 of the whole.
const TERMS: i32 = 40;

/// A window.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "clear_slab",
    about: "A clear plate before a light and under another: T Le behind + (1 - T) Le before",
    parameter: Parameter { name: "ior", usual: 1.5, range: 1.01..=2.5 },
    setting: |ior| {
        let place: Place = UPRIGHT;
        let glass = Bsdf::Dielectric { ior };
        let primitives = vec![
            of(place.plane(0.0, true), glass),
            of(place.plane(-0.4, false), glass),
            light(place.plane(-2.0, true), BEHIND),
            light(place.plane(2.0, false), LE),
        ];
        setting(
            primitives,
            Sensor::Probe { origin: place.at(0.5, 0.2, 1.0), direction: place.along(0.36, 0.48, -0.8) },
        )
    },
    theory: Theory::Series {
        mean: |ior| {
            let r = Slab::new(0.8, ior).interface;
            let passed = (1.0 - r) * (1.0 - r);
            let mut bounces = vec![Rgb::ZERO, LE * r];
            let mut inside = 1.0; // R^j after j reflections within
            for j in 0..TERMS {
                bounces.push(if j % 2 == 0 { BEHIND } else { LE } * (passed * inside));
                inside *= r;
            }
            Series::finite(bounces)
        },
        missed: nothing_missed,
        variance: |ior, estimator| {
            let slab = Slab::new(0.8, ior);
            let of = |c: usize| slab.variance(BEHIND[c], LE[c]);
            // a clamp cuts off what goes to and fro for long
            let all = estimator.roulette().rule == Rule::None && estimator.roulette().reaches(40);
            all.then(|| Rgb::new(of(0), of(1), of(2)))
        },
    },
};
