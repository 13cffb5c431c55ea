//! The scenes that rendering lectures show, each hard for an estimator of its own kind: caustics, light that comes round
//! corners, glossy plates, a lens, a shutter. Parameters are resolved; lengths are in metres, y points up.

mod caustic_glass;
mod caustic_mirror;
mod dof;
mod indirect;
mod motion;
pub(super) mod props;
mod smallpt;
mod veach_mis;

use super::Scene;
use serde::{Deserialize, Serialize};

/// A scene and its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Lecture {
    /// A ball of glass gathers light on the floor: paths L S S D E.
    CausticGlass {
        /// What lights it.
        source: Source,
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// A mirror ring throws a bright curve on the floor within: paths L S D E.
    CausticMirror {
        /// What lights it.
        source: Source,
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// A closed room whose lamp shines into a corner behind a partition.
    Indirect {
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// The scene of a path tracer in 99 lines [Beason 2008].
    Smallpt {
        /// Pixels from top to bottom of the image, which is 4 : 3.
        resolution: u32,
    },
    /// Four plates of different roughness mirror four lights of different size [Veach 1997, fig. 9.2].
    VeachMis {
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// Balls at different depths through a thin lens.
    Dof {
        /// Radius of the lens.
        aperture: f64,
        /// Pixels along each edge of the image.
        resolution: u32,
    },
    /// A board that moves while the shutter is open, and its shadow.
    Motion {
        /// How far it goes.
        travel: f64,
        /// Pixels along each edge of the image.
        resolution: u32,
    },
}

/// What a caustic comes from; the radiant intensity straight ahead is the same for all.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// A square that shines to one side.
    Square {
        /// Half of its edge.
        half: f64,
    },
    /// A point, which no path from the eye can hit.
    Point,
}

impl Lecture {
    /// Builds the scene.
    pub fn build(&self) -> Scene {
        match *self {
            Lecture::CausticGlass { source, resolution } => caustic_glass::scene(source, resolution),
            Lecture::CausticMirror { source, resolution } => caustic_mirror::scene(source, resolution),
            Lecture::Indirect { resolution } => indirect::scene(resolution),
            Lecture::Smallpt { resolution } => smallpt::scene(resolution),
            Lecture::VeachMis { resolution } => veach_mis::scene(resolution),
            Lecture::Dof { aperture, resolution } => dof::scene(aperture, resolution),
            Lecture::Motion { travel, resolution } => motion::scene(travel, resolution),
        }
    }
}
