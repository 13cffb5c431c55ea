//! A floor under a sky that is brightest in the zenith: radiance cos^n; n = 0 is a uniform half sky.

use super::props::{FLOOR, LE, TILTED, under};
use super::{Exhibit, Parameter, Series, Theory, cosine_without_roulette, nothing_missed};
use crate::scene::{Rgb, Sky};
use crate::truth::direct::form_factor::{cosine_sky, cosine_sky_variance};

/// A point of a floor under the open sky.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "sky_over_plane",
    about: "A floor under a sky of radiance Le cos^n: albedo Le 2/(n + 2)",
    parameter: Parameter { name: "exponent", usual: 3.0, range: 0.0..=100.0 },
    setting: |exponent| {
        let sky = Sky::Cosine { radiance: LE, exponent, up: TILTED.along(0.0, 0.0, 1.0) };
        under(sky, vec![TILTED.floor()], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |exponent| Series::finite(vec![Rgb::ZERO, FLOOR * LE * cosine_sky(exponent)]),
        missed: nothing_missed,
        variance: |exponent, estimator| {
            let scale = FLOOR * FLOOR * LE * LE;
            cosine_without_roulette(estimator).then(|| scale * cosine_sky_variance(exponent))
        },
    },
};
