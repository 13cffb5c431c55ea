//! A rectangle of light, part of which a plate hides: visibility, which no furnace tests.

use super::props::{FLOOR, LE, TILTED, light, matte, setting};
use super::{Exhibit, Parameter, Series, Theory, by_chance, nothing_missed};
use crate::scene::{Rgb, Shape};
use crate::truth::direct::visibility::{Blocker, visible_fraction};

/// A point of a floor in the penumbra of a plate.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "hidden_light",
    about: "A floor's point under a rectangle of light that a black plate hides up to its `edge`",
    parameter: Parameter { name: "edge", usual: 0.15, range: -0.6..=0.6 },
    setting: |edge| {
        let plate = matte(plate(edge), Rgb::ZERO);
        setting(vec![TILTED.floor(), light(lamp(), LE), plate], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |edge| Series::finite(vec![Rgb::ZERO, FLOOR * LE * form_factor(edge)]),
        missed: nothing_missed,
        variance: |edge, estimator| by_chance(estimator, form_factor(edge), FLOOR, LE),
    },
};

fn lamp() -> Shape {
    TILTED.rectangle([0.1, 0.2, 1.2], [0.0, 0.4, 0.1], [0.5, 0.0, 0.0])
}

/// Slanted, so that its edge crosses the light askew.
fn plate(edge: f64) -> Shape {
    TILTED.rectangle([edge - 0.6, 0.1, 0.5], [0.6, 0.15, 0.1], [-0.2, 0.8, 0.0])
}

fn form_factor(edge: f64) -> f64 {
    let plate = Blocker::plate(&plate(edge).corners());
    visible_fraction(TILTED.at(0.0, 0.0, 0.0), TILTED.along(0.0, 0.0, 1.0), &lamp().corners(), &[plate])
}
