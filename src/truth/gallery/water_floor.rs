//! A matte floor under still water under a uniform sky: every path to the floor and back goes through the surface, so
//! that sampling lights finds nothing and continued rays must find all.

use super::props::{FLOOR, LE, UPRIGHT, matte, of, under};
use super::{Exhibit, Parameter, Series, Theory, cosine_without_roulette, nothing_missed};
use crate::scene::{Bsdf, Rgb, Sky};
use crate::truth::optics::interface::{FloorUnderLayer, dielectric, diffuse_external, diffuse_internal};

/// Cosine at which the water is looked at.
const COS: f64 = 12.0 / 13.0;
/// Visits to the floor that are written out: what follows is below 1e-12 of the whole.
const VISITS: usize = 80;

/// A pool under an overcast sky.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "water_floor",
    about: "A matte floor under water of index `ior` under a uniform sky: Le (F + (1 - F) ρ e / (1 - ρ ρ_int))",
    parameter: Parameter { name: "ior", usual: 1.33, range: 1.01..=2.5 },
    setting: |ior| {
        let water = of(UPRIGHT.plane(0.0, true), Bsdf::Dielectric { ior });
        let floor = matte(UPRIGHT.plane(-0.7, true), FLOOR);
        under(Sky::Uniform { radiance: LE }, vec![water, floor], UPRIGHT.look_at_floor())
    },
    theory: Theory::Series {
        mean: |ior| {
            let reflected = dielectric(COS, ior);
            let escapes = (1.0 - diffuse_external(ior)) / (ior * ior);
            let mut bounces = vec![Rgb::ZERO, LE * reflected, Rgb::ZERO];
            let mut returning = LE * FLOOR * ((1.0 - reflected) * escapes);
            for _ in 0..VISITS {
                bounces.extend([returning, Rgb::ZERO]);
                returning *= FLOOR * diffuse_internal(ior);
            }
            Series::finite(bounces)
        },
        missed: nothing_missed,
        variance: |ior, estimator| {
            let of = |c: usize| {
                let floor = FloorUnderLayer { n: ior, albedo: FLOOR[c], sky: LE[c] };
                floor.second_moment(COS) - floor.radiance(COS) * floor.radiance(COS)
            };
            let all = cosine_without_roulette(estimator) && estimator.roulette().reaches(2 * VISITS as u32);
            all.then(|| Rgb::new(of(0), of(1), of(2)))
        },
    },
};
