//! As `mirror_light`, with a mirror of metal: its reflectance depends on the angle, by Fresnel's equations.

use super::mirror_light::{beside_mirror, wall};
use super::props::{FLOOR, LE};
use super::{Exhibit, Parameter, Series, Theory, cosine_without_roulette, nothing_missed};
use crate::scene::{Bsdf, Rgb};
use crate::truth::optics::interface::conductor;

/// Real part of the index, by channel: that of gold, roughly.
const ETA: Rgb = Rgb::new(0.18, 0.42, 1.37);

/// A point of a floor beside a polished metal wall.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "metal_light",
    about: "A floor's point under a disk light and beside a metal wall of index n + i `k` (Fresnel)",
    parameter: Parameter { name: "k", usual: 2.4, range: 0.1..=10.0 },
    setting: |k| beside_mirror(Bsdf::Conductor { eta: ETA, k: Rgb::splat(k) }),
    theory: Theory::Series {
        mean: |k| {
            let image = |c: usize| wall().weighted_image(|cos| conductor(cos, ETA[c], k)).value;
            let image = Rgb::new(image(0), image(1), image(2));
            Series::finite(vec![Rgb::ZERO, FLOOR * LE * wall().direct(), FLOOR * LE * image])
        },
        missed: nothing_missed,
        variance: |k, estimator| {
            let variance = |c: usize| wall().fresnel_implicit_variance(|cos| conductor(cos, ETA[c], k)).value;
            let two_bounces = cosine_without_roulette(estimator) && estimator.roulette().reaches(2);
            two_bounces.then(|| FLOOR * FLOOR * LE * LE * Rgb::new(variance(0), variance(1), variance(2)))
        },
    },
};
