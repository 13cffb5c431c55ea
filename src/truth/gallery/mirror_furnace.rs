//! A closed sphere of glowing mirrors: radiance as in a matte furnace, whatever the directions.

use super::props::{LE, TILTED, setting};
use super::{Exhibit, Parameter, Series, Theory, nothing_missed};
use crate::estimator::Rule;
use crate::scene::library::Primitive;
use crate::scene::{Bsdf, Material, Rgb, Sensor};
use glam::DVec3;

/// A furnace of mirrors.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "mirror_furnace",
    about: "A closed sphere whose walls glow and mirror: Le / (1 - r) everywhere",
    parameter: Parameter { name: "reflectance", usual: 0.6, range: 0.0..=0.9 },
    setting: |reflectance| {
        let bsdf = Bsdf::Mirror { reflectance: Rgb::splat(reflectance) };
        let shape = TILTED.band([0.0; 3], 1.3, -1.0, 1.0, true);
        let wall = Primitive { shape, material: Material { bsdf, le: LE }, velocity: DVec3::ZERO };
        let sensor =
            Sensor::Probe { origin: TILTED.at(0.3, -0.2, 0.4), direction: TILTED.along(0.48, 0.6, -0.64) };
        setting(vec![wall], sensor)
    },
    theory: Theory::Series {
        mean: |reflectance| Series { first: vec![LE], ratio: Rgb::splat(reflectance) },
        missed: nothing_missed,
        variance: |r, estimator| {
            let roulette = estimator.roulette();
            let m = LE / (1.0 - r);
            let q = match roulette.rule {
                Rule::None => return Some(Rgb::ZERO),
                Rule::Constant { q } => q,
                Rule::Albedo => r,
                Rule::Throughput { .. } => return None,
            };
            let known = roulette.from == 0 && roulette.clamp.is_none() && r > 0.0;
            let variance = if q > r * r { r * r * (1.0 - q) / (q - r * r) } else { f64::INFINITY };
            known.then(|| m * m * variance)
        },
    },
};
