//! A disk light that rises while the shutter is open.

use super::props::{FLOOR, LE, TILTED, light, setting};
use super::{Exhibit, Parameter, Series, Theory, by_chance, nothing_missed};
use crate::estimator::{Estimator, Technique};
use crate::scene::Rgb;
use crate::scene::library::Primitive;
use crate::truth::optics::motion::RisingDisc;

const RADIUS: f64 = 0.5;
const FROM: f64 = 0.6;

/// A point of a floor under a rising disk.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "rising_light",
    about: "A floor's point under a disk light that rises by `way` during the exposure",
    parameter: Parameter { name: "way", usual: 0.8, range: 0.01..=10.0 },
    setting: |way| {
        let disk = light(TILTED.disk([0.0, 0.0, FROM], RADIUS), LE);
        let disk = Primitive { velocity: TILTED.along(0.0, 0.0, way), ..disk };
        setting(vec![TILTED.floor(), disk], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |way| Series::finite(vec![Rgb::ZERO, FLOOR * LE * disk(way).mean()]),
        missed: nothing_missed,
        variance: |way, estimator| {
            let disk = disk(way);
            match estimator {
                Estimator::Explicit(e) if e.technique == Technique::Light => {
                    let variance = disk.explicit_second_moment() - disk.mean() * disk.mean();
                    Some(FLOOR * FLOOR * LE * LE * variance)
                }
                // samples that share a moment are not independent
                Estimator::Recursive(_) => None,
                _ => by_chance(estimator, disk.mean(), FLOOR, LE),
            }
        },
    },
};

fn disk(way: f64) -> RisingDisc {
    RisingDisc { radius: RADIUS, from: FROM, to: FROM + way, scale: 1.0 }
}
