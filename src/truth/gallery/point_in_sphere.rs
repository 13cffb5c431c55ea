//! A point light off the centre of a matte sphere: what is scattered more than once is uniform.

use super::props::{TILTED, lit_by, matte};
use super::{Exhibit, Parameter, Series, Theory, sampled_by_cosine};
use crate::estimator::{Estimator, Rule};
use crate::scene::{PointLight, Rgb, Sensor};
use crate::truth::direct::point_light::PointInSphere;

const RADIUS: f64 = 1.3;
const ALBEDO: Rgb = Rgb::new(0.7, 0.5, 0.2);
const INTENSITY: Rgb = Rgb::new(2.0, 3.0, 5.0);
/// Cosine between light and wall point, seen from the centre.
const MU: f64 = -0.352;

/// A point of a sphere's wall.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "point_in_sphere",
    about: "The wall of a matte sphere around a point light at `offset` radii from its centre",
    parameter: Parameter { name: "offset", usual: 0.6, range: 0.0..=0.95 },
    setting: |offset| {
        let wall = matte(TILTED.band([0.0; 3], RADIUS, -1.0, 1.0, true), ALBEDO);
        let point = PointLight { position: TILTED.at(0.0, 0.0, offset * RADIUS), intensity: INTENSITY };
        // (0.576, 0.738.., -0.352) is where it looks, from the centre
        let direction = TILTED.along(0.576, (1.0 - 0.576 * 0.576 - MU * MU).sqrt(), MU);
        lit_by(point, vec![wall], Sensor::Probe { origin: TILTED.at(0.0, 0.0, 0.0), direction })
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
    seen(MU, ALBEDO, |channel| sphere(offset, channel))
}

/// What is seen of the wall, where light and wall point have the cosine `mu` between them from the centre.
pub(super) fn seen(mu: f64, albedo: Rgb, wall: impl Fn(usize) -> PointInSphere) -> Series {
    let each = |f: &dyn Fn(PointInSphere) -> f64| Rgb::from_array([0, 1, 2].map(|c| f(wall(c))));
    let direct = each(&|s| s.albedo * s.irradiance(mu)) / std::f64::consts::PI;
    let second = each(&|s| s.albedo * s.albedo * s.mean_irradiance()) / std::f64::consts::PI;
    Series { first: vec![Rgb::ZERO, direct, second], ratio: albedo }
}

/// Variance of one sample, the same at every point of the wall, with constant q.
pub(super) fn variance(estimator: &Estimator, wall: impl Fn(usize) -> PointInSphere) -> Option<Rgb> {
    let Estimator::Explicit(e) = estimator else { return None };
    let q = match e.roulette.rule {
        Rule::Constant { q } if sampled_by_cosine(e) && e.roulette.from == 0 => q,
        _ => return None,
    };
    let variance = || Rgb::from_array([0, 1, 2].map(|c| wall(c).explicit_variance(q)));
    e.roulette.clamp.is_none().then(variance)
}
