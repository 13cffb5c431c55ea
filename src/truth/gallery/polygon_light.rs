//! A tilted triangle, partly below the horizon of the floor that it lights: Lambert's formula with clipping.

use super::props::{FLOOR, LE, TILTED, light, setting};
use super::{Exhibit, Parameter, Series, Theory, by_chance, nothing_missed};
use crate::scene::{Rgb, Shape};
use crate::truth::direct::form_factor;

/// A point of a floor beside a tilted triangle.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "polygon_light",
    about: "A floor's point beside a tilted triangle that reaches below the horizon (Lambert's formula)",
    parameter: Parameter { name: "height", usual: 0.7, range: 0.1..=10.0 },
    setting: |height| setting(vec![TILTED.floor(), light(triangle(height), LE)], TILTED.look_at_floor()),
    theory: Theory::Series {
        mean: |height| Series::finite(vec![Rgb::ZERO, FLOOR * LE * form_factor(height)]),
        missed: nothing_missed,
        variance: |height, estimator| by_chance(estimator, form_factor(height), FLOOR, LE),
    },
};

fn triangle(height: f64) -> Shape {
    TILTED.triangle([[0.9, -0.5, height], [0.7, 0.8, height - 0.4], [1.1, 0.1, -0.5]])
}

fn form_factor(height: f64) -> f64 {
    form_factor::polygon(TILTED.at(0.0, 0.0, 0.0), TILTED.along(0.0, 0.0, 1.0), &triangle(height).corners())
}
