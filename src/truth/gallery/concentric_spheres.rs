//! The space between two concentric spheres, both of which glow: a Markov chain of two patches.

use super::props::{TILTED, glowing, setting};
use super::{Exhibit, Parameter, Tail, Theory};
use crate::scene::{Rgb, Sensor};
use crate::truth::{Enclosure, Wall};

const OUTER: f64 = 1.3;
const INSIDE: Wall = Wall { albedo: Rgb::new(0.8, 0.6, 0.3), le: Rgb::new(1.0, 0.2, 0.0) };
const OUTSIDE: Wall = Wall { albedo: Rgb::new(0.3, 0.7, 0.6), le: Rgb::new(0.5, 3.0, 2.0) };

/// A ball in a sphere.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "concentric_spheres",
    about: "The wall of a sphere around a ball of `radius` spheres' radii, both matte and glowing",
    parameter: Parameter { name: "radius", usual: 0.55, range: 0.05..=0.95 },
    setting: |radius| {
        let ball = TILTED.ball([0.0; 3], radius * OUTER);
        let sphere = TILTED.band([0.0; 3], OUTER, -1.0, 1.0, true);
        let primitives =
            vec![glowing(ball, OUTSIDE.albedo, OUTSIDE.le), glowing(sphere, INSIDE.albedo, INSIDE.le)];
        let (origin, out) =
            (TILTED.at(0.6 * 0.99 * OUTER, 0.0, -0.8 * 0.99 * OUTER), TILTED.along(0.6, 0.0, -0.8));
        setting(primitives, Sensor::Probe { origin, direction: out })
    },
    theory: Theory::Chain {
        enclosure: |radius| Enclosure::concentric(OUTSIDE, INSIDE, radius * radius),
        looks_at: 1,
        tail: Tail::None,
    },
};
