//! A floor under a uniform sky: albedo Le, and without noise by cosine-weighted directions.

use super::props::{FLOOR, LE, TILTED, under};
use super::{Exhibit, Parameter, Series, Theory, cosine_without_roulette, nothing_missed};
use crate::scene::{Rgb, Sky};

/// A point of a floor under a uniform sky.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "uniform_sky",
    about: "A floor under a uniform sky of radiance `brightness` Le: albedo Le",
    parameter: Parameter { name: "brightness", usual: 0.4, range: 0.001..=1000.0 },
    setting: |brightness| {
        under(Sky::Uniform { radiance: LE * brightness }, vec![TILTED.floor()], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |brightness| Series::finite(vec![Rgb::ZERO, FLOOR * LE * brightness]),
        missed: nothing_missed,
        variance: |_, estimator| cosine_without_roulette(estimator).then_some(Rgb::ZERO),
    },
};
