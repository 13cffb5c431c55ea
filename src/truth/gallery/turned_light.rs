//! Two lights of one side each: one shows it to the floor, the other its back, which is black. Which side a light is on
//! is what no closed scene tests.

use super::props::{FLOOR, LE, TILTED, light, setting};
use super::{Exhibit, Parameter, Series, Theory, by_chance, nothing_missed};
use crate::scene::geometry::Disk;
use crate::scene::{Rgb, Shape};
use crate::truth::direct::form_factor::disk_parallel;

/// Distance from the floor's normal, height and radius of the light that shines down.
const LAMP: [f64; 3] = [0.5, 1.1, 0.4];
const TURNED: Rgb = Rgb::new(1.0, 4.0, 6.0);

/// A point of a floor under a light and under the back of another.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "turned_light",
    about: "A floor's point under a disk light and under the back of another, of `radius`, which brings nothing",
    parameter: Parameter { name: "radius", usual: 0.4, range: 0.01..=0.5 },
    setting: |radius| {
        let [offset, height, size] = LAMP;
        let lamp = light(TILTED.disk([offset, 0.0, height], size), LE);
        let turned = Disk { center: TILTED.at(-0.7, 0.3, 0.8), normal: TILTED.along(0.0, 0.0, 1.0), radius };
        setting(vec![TILTED.floor(), lamp, light(Shape::Disk(turned), TURNED)], TILTED.look_at_floor())
    },
    theory: Theory::Series {
        mean: |_| Series::finite(vec![Rgb::ZERO, FLOOR * LE * form_factor()]),
        missed: nothing_missed,
        variance: |_, estimator| by_chance(estimator, form_factor(), FLOOR, LE),
    },
};

fn form_factor() -> f64 {
    let [offset, height, radius] = LAMP;
    disk_parallel(offset, height, radius)
}
