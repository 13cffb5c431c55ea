//! Scenes of lectures as they are meant.

use super::{Choice, points};
use crate::experiment::input::Sweep;
use crate::experiment::spec::{CausticSpec, DofSpec, MotionSpec};
use crate::scene::lecture::{Lecture, Source};
use crate::scene::library::SceneKind;

/// Half the edge of a caustic's light [m].
const LIGHT: f64 = 0.02;
/// Radius of the lens [m].
const APERTURE: f64 = 0.08;
/// Way of the moving board [m].
const TRAVEL: f64 = 0.5;

/// A scene without a parameter that can be swept.
pub fn plain(base: &str, lecture: Lecture) -> Vec<Choice<SceneKind>> {
    vec![Choice::new(base, &[], Vec::new(), SceneKind::Lecture(lecture))]
}

/// A scene with one, at its usual value or at those given.
fn swept(
    base: &str,
    name: &'static str,
    (given, usual): (Option<&Sweep>, f64),
    at: impl Fn(f64) -> Lecture,
) -> Vec<Choice<SceneKind>> {
    let Some(sweep) = given else { return plain(base, at(usual)) };
    let one = |p: (&'static str, f64, bool)| Choice::new(base, &[], vec![p], SceneKind::Lecture(at(p.1)));
    points(name, sweep).map(one).collect()
}

/// A caustic, which `of` makes from what lights it; lit by a point it has a name of its own.
pub fn caustic(
    names: [&str; 2],
    spec: &CausticSpec,
    of: impl Fn(Source, u32) -> Lecture,
) -> Result<Vec<Choice<SceneKind>>, String> {
    let CausticSpec { light, point, resolution } = spec;
    match (light, point) {
        (Some(_), true) => {
            Err("a point light has no extent; leave out `light`, or `point = true`".to_owned())
        }
        (None, true) => Ok(plain(names[1], of(Source::Point, *resolution))),
        (light, false) => Ok(swept(names[0], "light", (light.as_ref(), LIGHT), |half| {
            of(Source::Square { half }, *resolution)
        })),
    }
}

pub fn dof(spec: &DofSpec) -> Vec<Choice<SceneKind>> {
    let resolution = spec.resolution;
    swept("dof", "aperture", (spec.aperture.as_ref(), APERTURE), |aperture| Lecture::Dof {
        aperture,
        resolution,
    })
}

pub fn motion(spec: &MotionSpec) -> Vec<Choice<SceneKind>> {
    let resolution = spec.resolution;
    swept("motion", "travel", (spec.travel.as_ref(), TRAVEL), |travel| Lecture::Motion { travel, resolution })
}
