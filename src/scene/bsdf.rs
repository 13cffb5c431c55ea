//! Reflection: a Lambert surface, and two ways of choosing where to look next.

use super::Rgb;
use crate::sampling::PdfW;
use crate::sampling::warp::{
    Frame, cosine_hemisphere, cosine_hemisphere_pdf, uniform_hemisphere, uniform_hemisphere_pdf,
};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_PI;

/// What the front of a surface reflects (Lambert) and emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Fraction of the arriving light that is reflected, each channel in [0, 1].
    pub albedo: Rgb,
    /// Emitted radiance [W m^-2 sr^-1], the same in all directions of the front hemisphere.
    pub le: Rgb,
}

impl Material {
    /// The BRDF f = albedo / π [1/sr], without the cosine [Lambert 1760].
    #[inline]
    pub fn f(&self) -> Rgb {
        self.albedo * FRAC_1_PI
    }
}

/// The density from which continued directions are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Directions {
    /// cos θ / π: the weight is the albedo.
    #[default]
    Cosine,
    /// 1 / 2π: the weight is 2 cos θ albedo.
    Uniform,
}

/// A continued direction.
#[derive(Clone, Copy, Debug)]
pub struct DirectionSample {
    /// Unit direction, leaving the surface on its front.
    pub wi: DVec3,
    /// f cos θ / pdf.
    pub weight: Rgb,
    /// Density of `wi` [1/sr].
    pub pdf: PdfW,
}

impl Directions {
    /// Draws a direction around the normal of `frame`.
    #[inline]
    pub fn sample(self, material: &Material, frame: &Frame, u: (f64, f64)) -> DirectionSample {
        match self {
            Directions::Cosine => {
                let local = cosine_hemisphere(u);
                DirectionSample {
                    wi: frame.to_world(local),
                    weight: material.albedo,
                    pdf: cosine_hemisphere_pdf(local.z),
                }
            }
            Directions::Uniform => {
                let local = uniform_hemisphere(u);
                DirectionSample {
                    wi: frame.to_world(local),
                    weight: material.albedo * (2.0 * local.z),
                    pdf: uniform_hemisphere_pdf(),
                }
            }
        }
    }
}
