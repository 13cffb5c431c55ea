//! A point light over a floor: one sample, no noise, and nothing for those who wait for chance.

use super::props::{FLOOR, LE, TILTED, lit_by};
use super::{Exhibit, Parameter, Series, Theory};
use crate::scene::{PointLight, Rgb};
use crate::truth::direct::point_light::irradiance;
use std::f64::consts::FRAC_1_PI;

/// A point of a floor beside a point light.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "point_over_plane",
    about: "A floor's point beside a point light: albedo I cos θ / (π d²), and nothing by chance",
    parameter: Parameter { name: "height", usual: 0.8, range: 0.05..=10.0 },
    setting: |height| {
        let point = PointLight { position: TILTED.at(0.5, 0.3, height), intensity: LE };
        lit_by(point, vec![TILTED.floor()], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: theory,
        missed: |height, estimator| (!estimator.samples_lights()).then(|| theory(height)),
        variance: |_, _| Some(Rgb::ZERO),
    },
};

fn theory(height: f64) -> Series {
    let (p, n) = (TILTED.at(0.0, 0.0, 0.0), TILTED.along(0.0, 0.0, 1.0));
    let e = irradiance(1.0, TILTED.at(0.5, 0.3, height), p, n);
    Series::finite(vec![Rgb::ZERO, FLOOR * LE * (e * FRAC_1_PI)])
}
