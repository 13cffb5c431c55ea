//! Light from infinitely far away.

use super::{Material, Rgb};
use crate::sampling::PdfW;
use crate::sampling::warp::{Frame, sin_cos_turn, sphere_band};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// An environment around the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sky {
    /// The same radiance from everywhere [W m^-2 sr^-1].
    Uniform {
        /// It.
        radiance: Rgb,
    },
    /// radiance cos^exponent of the angle to `up`, nothing from below.
    Cosine {
        /// Radiance from straight above [W m^-2 sr^-1].
        radiance: Rgb,
        /// n >= 0.
        exponent: f64,
        /// Unit vector.
        up: DVec3,
    },
}

/// The sky seen as a surface: the number by which rays and samples name it.
pub const SKY: u32 = u32::MAX - 1;

/// As far away as the sky is drawn [scene units]: far enough for every difference of directions to vanish, and near
/// enough for its square to be a number.
pub const FAR: f64 = 1e30;

/// What a ray that meets the sky finds there: nothing scatters.
pub const BLACK: Material = Material { bsdf: super::Bsdf::Lambert { albedo: Rgb::ZERO }, le: Rgb::ZERO };

impl Sky {
    /// Radiance arriving from the unit direction `wi` [W m^-2 sr^-1].
    #[inline]
    pub fn radiance(&self, wi: DVec3) -> Rgb {
        match *self {
            Sky::Uniform { radiance } => radiance,
            Sky::Cosine { radiance, exponent, up } => {
                let cos = up.dot(wi);
                if cos > 0.0 { radiance * libm::pow(cos, exponent) } else { Rgb::ZERO }
            }
        }
    }

    /// A unit direction drawn in proportion to radiance.
    #[inline]
    pub fn sample(&self, u: (f64, f64)) -> DVec3 {
        match *self {
            Sky::Uniform { .. } => sphere_band(-1.0, 1.0, u),
            Sky::Cosine { exponent, up, .. } => {
                let z = libm::pow(1.0 - u.0, 1.0 / (exponent + 1.0)); // in (0, 1]
                let r = (1.0 - z * z).max(0.0).sqrt();
                let (sin, cos) = sin_cos_turn(u.1);
                Frame::around(up).to_world(DVec3::new(r * cos, r * sin, z))
            }
        }
    }

    /// Density of [`Sky::sample`] [1/sr].
    #[inline]
    pub fn pdf(&self, wi: DVec3) -> PdfW {
        PdfW(match *self {
            Sky::Uniform { .. } => 1.0 / (4.0 * PI),
            Sky::Cosine { exponent, up, .. } => {
                let cos = up.dot(wi);
                if cos > 0.0 { (exponent + 1.0) / (2.0 * PI) * libm::pow(cos, exponent) } else { 0.0 }
            }
        })
    }

    /// Integral of the radiance over all directions [W m^-2].
    pub fn fluence(&self) -> Rgb {
        match *self {
            Sky::Uniform { radiance } => radiance * (4.0 * PI),
            Sky::Cosine { radiance, exponent, .. } => radiance * (2.0 * PI / (exponent + 1.0)),
        }
    }
}
