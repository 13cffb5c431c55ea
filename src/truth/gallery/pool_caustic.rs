//! A point light over still water and a plate at the bottom: light reaches it through the surface only, and no path from
//! the plate can find a point behind a refraction. It takes paths from the light.

use super::props::{LE, UPRIGHT, lit_by, of};
use super::{Exhibit, Parameter, Series, Theory};
use crate::scene::{Bsdf, PointLight, Rgb, Sensor};
use crate::truth::optics::caustic::Pool;

const HEIGHT: f64 = 0.9;
const DEPTH: f64 = 0.6;

/// The bottom of a pool.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "pool_caustic",
    about: "Irradiance at the bottom of a pool beside a point light over it: I T sin θ / (x dx/dθ)",
    parameter: Parameter { name: "distance", usual: 0.8, range: 0.0..=10.0 },
    setting: |distance| {
        let water = of(UPRIGHT.plane(0.0, true), Bsdf::Dielectric { ior: 1.33 });
        let point = PointLight { position: UPRIGHT.at(distance, 0.0, HEIGHT), intensity: LE };
        let (point_below, normal) = (UPRIGHT.at(0.0, 0.0, -DEPTH), UPRIGHT.along(0.0, 0.0, 1.0));
        lit_by(point, vec![water], Sensor::Irradiance { point: point_below, normal, on: None })
    },
    theory: Theory::Series {
        mean: theory,
        missed: |distance, _| Some(theory(distance)),
        variance: |_, _| Some(Rgb::ZERO),
    },
};

fn theory(distance: f64) -> Series {
    let pool = Pool { height: HEIGHT, depth: DEPTH, n: 1.33, intensity: 1.0 };
    Series::finite(vec![Rgb::ZERO, LE * pool.irradiance_at(distance)])
}
