//! A point light off the centre of a matte sphere, and the point of the wall nearest to it: where density estimation
//! blurs direct light by a known factor.

use super::point_in_sphere::variance;
use super::props::{TILTED, lit_by, matte};
use super::{Exhibit, Parameter, Series, Theory};
use crate::scene::{PointLight, Rgb, Sensor};
use crate::truth::direct::point_light::PointInSphere;

/// Radius of the sphere (m).
pub const RADIUS: f64 = 1.3;
/// Albedo of the sphere.
pub const ALBEDO: Rgb = Rgb::new(0.7, 0.5, 0.2);
/// Intensity of the light (W / sr).
pub const INTENSITY: Rgb = Rgb::new(2.0, 3.0, 5.0);

/// The wall behind the light.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "point_near_wall",
    about: "The wall's point nearest to a point light in a matte sphere, `offset` radii from its centre",
    parameter: Parameter { name: "offset", usual: 0.5, range: 0.0..=0.95 },
    setting: |offset| {
        let wall = matte(TILTED.band([0.0; 3], RADIUS, -1.0, 1.0, true), ALBEDO);
        let point = PointLight { position: TILTED.at(0.0, 0.0, offset * RADIUS), intensity: INTENSITY };
        lit_by(
            point,
            vec![wall],
            Sensor::Probe { origin: TILTED.at(0.0, 0.0, 0.0), direction: TILTED.along(0.0, 0.0, 1.0) },
        )
    },
    theory: Theory::Series {
        mean: theory,
        missed: |offset, estimator| (!estimator.samples_lights()).then(|| theory(offset)),
        variance: |offset, estimator| variance(estimator, |channel| sphere(offset, channel)),
    },
};

fn sphere(offset: f64, channel: usize) -> PointInSphere {
    let (intensity, albedo) = (INTENSITY[channel], ALBEDO[channel]);
    PointInSphere { intensity, offset: offset * RADIUS, radius: RADIUS, albedo }
}

fn theory(offset: f64) -> Series {
    super::point_in_sphere::seen(1.0, ALBEDO, |channel| sphere(offset, channel))
}
