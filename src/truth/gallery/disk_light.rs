//! A disk light straight above a point of the floor: every technique's variance has a closed form.

use super::props::{FLOOR, LE, TILTED, light, setting};
use super::{Exhibit, Parameter, Series, Theory, by_chance, nothing_missed, one_sample};
use crate::estimator::{Estimator, Technique};
use crate::scene::{Directions, Points, Rgb};
use crate::truth::direct::direct_variance::CoaxialDisk;

const HEIGHT: f64 = 1.4;

/// A point of a floor under the middle of a disk.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "disk_light",
    about: "A floor's point under the middle of a disk light: albedo Le r² / (r² + h²)",
    parameter: Parameter { name: "radius", usual: 0.6, range: 0.01..=100.0 },
    setting: |radius| {
        let disk = TILTED.disk([0.0, 0.0, HEIGHT], radius);
        setting(vec![TILTED.floor(), light(disk, LE)], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |radius| Series::finite(vec![Rgb::ZERO, FLOOR * LE * disk(radius).mean()]),
        missed: nothing_missed,
        variance: |radius, estimator| {
            let disk = disk(radius);
            let scale = FLOOR * FLOOR * LE * LE;
            let known = match *estimator {
                Estimator::Explicit(e) if e.technique == Technique::Light => disk.explicit(Points::Area),
                Estimator::Explicit(e) if one_sample(&e.roulette) && e.directions == Directions::Cosine => {
                    match e.technique {
                        Technique::Both(heuristic) => disk.mis(Points::Area, heuristic),
                        _ => disk.implicit_cosine(),
                    }
                }
                Estimator::Implicit(e) if one_sample(&e.roulette) && e.directions == Directions::Uniform => {
                    disk.implicit_uniform()
                }
                _ => return by_chance(estimator, disk.mean(), FLOOR, LE),
            };
            Some(scale * known)
        },
    },
};

fn disk(radius: f64) -> CoaxialDisk {
    CoaxialDisk { height: HEIGHT, radius }
}
