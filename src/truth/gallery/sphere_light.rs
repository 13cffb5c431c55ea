//! A ball of light above the horizon, cut by it, or below it.

use super::props::{FLOOR, LE, TILTED, light, setting};
use super::{Exhibit, Parameter, Series, Theory, by_chance, nothing_missed};
use crate::estimator::{Estimator, Technique};
use crate::scene::{Points, Rgb};
use crate::truth::direct::direct_variance::sphere_cone;
use crate::truth::direct::form_factor;

const RADIUS: f64 = 0.4;

/// A point of a floor beside a ball.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "sphere_light",
    about: "A floor's point beside a ball of light, which the horizon cuts at heights within its radius",
    parameter: Parameter { name: "height", usual: 0.9, range: -0.39..=10.0 },
    setting: |height| {
        let ball = TILTED.ball([0.7, -0.4, height], RADIUS);
        setting(vec![TILTED.floor(), light(ball, LE)], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |height| Series::finite(vec![Rgb::ZERO, FLOOR * LE * form_factor(height)]),
        missed: nothing_missed,
        variance: |height, estimator| match estimator {
            Estimator::Explicit(e) if e.technique == Technique::Light => {
                let distance = TILTED.along(0.7, -0.4, height).length();
                let whole = e.lights.points == Points::SolidAngle && height >= RADIUS;
                let scale = FLOOR * FLOOR * LE * LE;
                whole.then(|| scale * sphere_cone(distance, RADIUS, height / distance))
            }
            _ => by_chance(estimator, form_factor(height), FLOOR, LE),
        },
    },
};

fn form_factor(height: f64) -> f64 {
    let normal = TILTED.along(0.0, 0.0, 1.0);
    form_factor::sphere(TILTED.at(0.0, 0.0, 0.0), normal, TILTED.at(0.7, -0.4, height), RADIUS)
}
