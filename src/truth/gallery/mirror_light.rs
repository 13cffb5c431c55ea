//! A disk light, seen directly and in a plane mirror: paths that leave the light, meet the mirror and end on a matte
//! floor, which sampling the light cannot find.

use super::props::{FLOOR, LE, TILTED, light, of, setting};
use super::{Exhibit, Parameter, Series, Theory, cosine_without_roulette, nothing_missed};
use crate::scene::library::Setting;
use crate::scene::{Bsdf, Rgb};
use crate::truth::optics::mirror::{MirrorWall, Shape};

/// A point of a floor beside a mirror wall.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "mirror_light",
    about: "A floor's point under a disk light and beside a mirror: albedo Le (F + r F of the image)",
    parameter: Parameter { name: "reflectance", usual: 0.7, range: 0.01..=1.0 },
    setting: |reflectance| beside_mirror(Bsdf::Mirror { reflectance: Rgb::splat(reflectance) }),
    theory: Theory::Series {
        mean: |reflectance| {
            let wall = wall();
            Series::finite(vec![
                Rgb::ZERO,
                FLOOR * LE * wall.direct(),
                FLOOR * LE * (reflectance * wall.image()),
            ])
        },
        missed: nothing_missed,
        variance: |reflectance, estimator| {
            let two_bounces = cosine_without_roulette(estimator) && estimator.roulette().reaches(2);
            two_bounces.then(|| FLOOR * FLOOR * LE * LE * wall().implicit_variance(reflectance))
        },
    },
};

/// Floor, light and mirror as theory has them.
pub fn wall() -> MirrorWall {
    MirrorWall { shape: Shape::Disc { radius: 0.35 }, light: 0.8, height: 0.9, receiver: 0.5, scale: 1.0 }
}

/// The same as surfaces; the mirror is large enough to hold every reflection.
pub fn beside_mirror(bsdf: Bsdf) -> Setting {
    let w = wall();
    let mirror = TILTED.rectangle([-w.receiver, 0.0, 0.0], [0.0, 30.0, 0.0], [0.0, 0.0, 30.0]);
    let disk = TILTED.disk([w.light - w.receiver, 0.0, w.height], 0.35);
    setting(vec![TILTED.floor(), light(disk, LE), of(mirror, bsdf)], TILTED.look_at_floor())
}
