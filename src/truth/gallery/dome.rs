//! A dome over its floor: the part of a sphere above a plane, and the plane.

use super::props::{TILTED, glowing, setting};
use super::{Exhibit, Parameter, Tail, Theory};
use crate::scene::geometry::Disk;
use crate::scene::{Rgb, Sensor, Shape};
use crate::truth::{Enclosure, Wall};

const RADIUS: f64 = 1.3;
const FLOOR: Wall = Wall { albedo: Rgb::new(0.5, 0.2, 0.8), le: Rgb::new(0.0, 1.0, 0.1) };
const VAULT: Wall = Wall { albedo: Rgb::new(0.7, 0.8, 0.4), le: Rgb::new(2.0, 0.3, 1.0) };

/// A closed cap of a sphere.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "dome",
    about: "The vault over a floor, `fraction` of a whole sphere (1/2: a hemisphere), both matte and glowing",
    parameter: Parameter { name: "fraction", usual: 0.5, range: 0.05..=0.95 },
    setting: |fraction| {
        // the plane z = height cuts the sphere; above it lies 2 fraction of the diameter
        let height = 1.0 - 2.0 * fraction;
        let vault = TILTED.band([0.0; 3], RADIUS, height, 1.0, true);
        let radius = RADIUS * (1.0 - height * height).sqrt();
        let floor = Disk {
            center: TILTED.at(0.0, 0.0, height * RADIUS),
            normal: TILTED.along(0.0, 0.0, 1.0),
            radius,
        };
        let primitives =
            vec![glowing(Shape::Disk(floor), FLOOR.albedo, FLOOR.le), glowing(vault, VAULT.albedo, VAULT.le)];
        // from near the floor up, aslant
        let origin = TILTED.at(0.0, 0.0, RADIUS * (height + 0.01));
        setting(primitives, Sensor::Probe { origin, direction: TILTED.along(0.28, 0.0, 0.96) })
    },
    theory: Theory::Chain {
        enclosure: |fraction| Enclosure::cap(FLOOR, VAULT, fraction),
        looks_at: 1,
        tail: Tail::Always(1.5),
    },
};
