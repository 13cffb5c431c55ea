//! Four lights that differ in shape, size, colour and distance: how one is picked must not change the sum.

use super::props::{FLOOR, LE, TILTED, light, setting};
use super::{Exhibit, Parameter, Series, Theory};
use crate::scene::library::Setting;
use crate::scene::{PointLight, Rgb, Shape};
use crate::truth::direct::{form_factor, point_light};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

const COLOURS: [Rgb; 3] = [LE, Rgb::new(0.3, 4.0, 9.0), Rgb::new(11.0, 0.2, 1.0)];
const INTENSITY: Rgb = Rgb::new(0.4, 0.3, 0.9);

/// A point of a floor under four lights.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "unequal_lights",
    about: "A floor's point under a disk, a ball, a rectangle and a point light of different colours",
    parameter: Parameter { name: "radius", usual: 0.25, range: 0.05..=0.6 },
    setting: |radius| {
        let [disk, ball, rectangle] = shapes(radius);
        let lights = [light(disk, COLOURS[0]), light(ball, COLOURS[1]), light(rectangle, COLOURS[2])];
        let primitives = [TILTED.floor()].into_iter().chain(lights).collect();
        let point = PointLight { position: position(), intensity: INTENSITY };
        Setting { points: vec![point], ..setting(primitives, TILTED.look_at_floor()) }
    },
    theory: Theory::Series {
        mean: |radius| {
            let (p, n) = (TILTED.at(0.0, 0.0, 0.0), TILTED.along(0.0, 0.0, 1.0));
            let [_, _, rectangle] = shapes(radius);
            let direct = COLOURS[0] * form_factor::disk_parallel(1.0, 1.1, radius)
                + COLOURS[1] * form_factor::sphere(p, n, TILTED.at(-0.9, 0.5, 0.6), radius)
                + COLOURS[2] * form_factor::polygon(p, n, &rectangle.corners())
                + point();
            Series::finite(vec![Rgb::ZERO, FLOOR * direct])
        },
        missed: |_, estimator| {
            (!estimator.samples_lights()).then(|| Series::finite(vec![Rgb::ZERO, FLOOR * point()]))
        },
        variance: |_, _| None,
    },
};

fn shapes(radius: f64) -> [Shape; 3] {
    [
        TILTED.disk([0.6, 0.8, 1.1], radius),
        TILTED.ball([-0.9, 0.5, 0.6], radius),
        TILTED.rectangle([1.2, -0.7, 1.3], [0.0, 0.3, 0.0], [0.1, 0.0, -0.1]),
    ]
}

fn position() -> DVec3 {
    TILTED.at(-0.2, -0.9, 0.8)
}

/// What the point light brings, divided by the albedo.
fn point() -> Rgb {
    let (p, n) = (TILTED.at(0.0, 0.0, 0.0), TILTED.along(0.0, 0.0, 1.0));
    INTENSITY * (FRAC_1_PI * point_light::irradiance(1.0, position(), p, n))
}
