//! Two parallel plates without end, both of which glow.

use super::props::{UPRIGHT, glowing, setting};
use super::{Exhibit, Parameter, Tail, Theory};
use crate::scene::Rgb;
use crate::truth::{Enclosure, Wall};

const LE: [Rgb; 2] = [Rgb::new(0.0, 2.0, 1.0), Rgb::new(3.0, 0.5, 0.0)];
const UPPER: Rgb = Rgb::new(0.4, 0.6, 0.9);

/// Between plates.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "parallel_plates",
    about: "The lower of two matte, glowing plates; `albedo` is the lower one's: (E1 + ρ1 E2) / (1 - ρ1 ρ2)",
    parameter: Parameter { name: "albedo", usual: 0.7, range: 0.0..=1.0 },
    setting: |albedo| {
        let [lower, upper] = walls(albedo);
        let primitives = vec![
            glowing(UPRIGHT.plane(-0.3, true), lower.albedo, lower.le),
            glowing(UPRIGHT.plane(0.5, false), upper.albedo, upper.le),
        ];
        setting(primitives, UPRIGHT.look_at_floor())
    },
    theory: Theory::Chain {
        enclosure: |albedo| {
            let [lower, upper] = walls(albedo);
            Enclosure::plates(lower, upper)
        },
        looks_at: 0,
        // G falls as 1/d⁴ over a plane: index 1/2, up to values as large as the plane is
        tail: Tail::ByArea(0.5),
    },
};

fn walls(albedo: f64) -> [Wall; 2] {
    [Wall { albedo: Rgb::splat(albedo), le: LE[0] }, Wall { albedo: UPPER, le: LE[1] }]
}
