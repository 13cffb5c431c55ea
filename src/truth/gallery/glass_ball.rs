//! A clear ball under a uniform sky: all paths bring the same radiance, so that the ball cannot be seen.

use super::props::{LE, TILTED, of, under};
use super::{Exhibit, Parameter, Series, Theory, nothing_missed};
use crate::estimator::Rule;
use crate::scene::{Bsdf, Rgb, Sensor, Sky};
use crate::truth::optics::interface::dielectric;

/// Cosine of incidence at the ball.
const COS: f64 = 0.8;

/// A ball of glass in a uniform sky.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "glass_ball",
    about: "A clear ball under a uniform sky: the sky's radiance, without noise",
    parameter: Parameter { name: "ior", usual: 1.5, range: 1.01..=4.0 },
    setting: |ior| {
        let ball = of(TILTED.ball([0.0; 3], 0.5), Bsdf::Dielectric { ior });
        // 0.3 off the axis of a ball of radius 0.5: sine 0.6
        let sensor =
            Sensor::Probe { origin: TILTED.at(0.3, 0.0, 2.0), direction: TILTED.along(0.0, 0.0, -1.0) };
        under(Sky::Uniform { radiance: LE }, vec![ball], sensor)
    },
    theory: Theory::Series {
        mean: |ior| {
            let r = dielectric(COS, ior);
            let first = vec![Rgb::ZERO, LE * r, LE * ((1.0 - r) * (1.0 - r))];
            Series { first, ratio: Rgb::splat(r) }
        },
        missed: nothing_missed,
        // a clamp cuts off what circles in the ball for long
        variance: |_, estimator| {
            let roulette = estimator.roulette();
            (roulette.rule == Rule::None && roulette.reaches(60)).then_some(Rgb::ZERO)
        },
    },
};
