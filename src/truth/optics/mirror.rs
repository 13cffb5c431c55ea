//! Light seen directly and in a plane mirror: a floor point beside a mirror wall, under a horizontal light.
//!
//! The mirror is the plane x = 0, large enough to hold every reflection; floor, light and receiver lie at x >
//! 0. In it the light appears at -x, unchanged but for its radiance.

use crate::truth::direct::form_factor::disk_parallel;
use crate::truth::quadrature::{Integral, tensor};
use std::f64::consts::PI;

/// Shape of a light parallel to the floor that emits downwards. Lengths in one unit, arbitrary throughout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A disc.
    Disc {
        /// Its radius.
        radius: f64,
    },
    /// A rectangle.
    Rectangle {
        /// Half its extent away from the mirror.
        half_x: f64,
        /// Half its extent along the mirror.
        half_z: f64,
    },
}

/// A floor point beside a mirror wall; light and receiver lie in one plane across the mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorWall {
    /// The light.
    pub shape: Shape,
    /// Distance of the light's centre from the mirror, at least half its extent.
    pub light: f64,
    /// Height of the light above the floor, > 0.
    pub height: f64,
    /// Distance of the receiver from the mirror, >= 0.
    pub receiver: f64,
    /// The floor's albedo times the radiance of the light [W m^-2 sr^-1].
    pub scale: f64,
}

impl MirrorWall {
    /// Form factor from the receiver to the light.
    pub fn direct(&self) -> f64 {
        self.form_factor(self.light - self.receiver)
    }

    /// Form factor from the receiver to the light's image in the mirror.
    pub fn image(&self) -> f64 {
        self.form_factor(self.light + self.receiver)
    }

    /// Radiance of the floor, with `r` the mirror's reflectance at all angles: scale (F1 + r F2).
    pub fn mean(&self, r: f64) -> f64 {
        self.scale * (self.direct() + r * self.image())
    }

    /// Variance of one cosine-sampled path that is weighted by `r` at the mirror: scale² (F1 + r² F2) -
    /// mean².
    pub fn implicit_variance(&self, r: f64) -> f64 {
        let mean = self.mean(r);
        self.scale * self.scale * (self.direct() + r * r * self.image()) - mean * mean
    }

    /// What next-event estimation alone finds: it cannot connect through the mirror.
    pub fn explicit_only(&self) -> f64 {
        self.scale * self.direct()
    }

    /// [`MirrorWall::mean`] for a mirror with `reflectance` of the cosine of its angle of incidence. Relative
    /// error below 1e-8 where the height is at least a fifth of the light's extent and the index of a clear
    /// mirror at least 1.05; beyond, see the error given.
    pub fn fresnel_mean(&self, reflectance: impl Fn(f64) -> f64) -> Integral {
        let Integral { value, error } = self.weighted_image(reflectance);
        Integral { value: self.scale * (self.direct() + value), error: self.scale.abs() * error }
    }

    /// [`MirrorWall::implicit_variance`] for such a mirror. A path that chooses by chance whether to be
    /// reflected has scale times the mean in place of the second moment.
    pub fn fresnel_implicit_variance(&self, reflectance: impl Fn(f64) -> f64) -> Integral {
        let mean = self.fresnel_mean(&reflectance);
        let square = self.weighted_image(|cos| reflectance(cos) * reflectance(cos));
        let scale = self.scale * self.scale;
        Integral {
            value: scale * (self.direct() + square.value) - mean.value * mean.value,
            error: scale * square.error + 2.0 * mean.value.abs() * mean.error,
        }
    }

    /// The image's form factor with each direction weighted by a function of the cosine at the mirror, as an
    /// integral over the light's area: dF = h² / (π d⁴) dA.
    pub fn weighted_image(&self, weight: impl Fn(f64) -> f64) -> Integral {
        let density = |dx: f64, z: f64| {
            let across = self.light + self.receiver + dx;
            let square = across * across + self.height * self.height + z * z;
            weight(across / square.sqrt()) * self.height * self.height / (PI * square * square)
        };
        // one half of the light, and twice that
        let half = match self.shape {
            Shape::Disc { radius } => tensor((0.0, radius), (0.0, PI), |s, angle| {
                s * density(s * libm::cos(angle), s * libm::sin(angle))
            }),
            Shape::Rectangle { half_x, half_z } => tensor((-half_x, half_x), (0.0, half_z), density),
        };
        Integral { value: 2.0 * half.value, error: 2.0 * half.error }
    }

    fn form_factor(&self, offset: f64) -> f64 {
        match self.shape {
            Shape::Disc { radius } => disk_parallel(offset, self.height, radius),
            Shape::Rectangle { half_x, half_z } => {
                let corner = |x: f64| rectangle_corner(x / self.height, half_z / self.height);
                2.0 * (corner(offset + half_x) - corner(offset - half_x))
            }
        }
    }
}

/// Form factor from a point to a parallel rectangle of extents `a` and `b`, in heights, with one corner right
/// above the point; odd in both. Absolute error below 1e-15. [Hamilton & Morgan 1952]
pub fn rectangle_corner(a: f64, b: f64) -> f64 {
    let part = |a: f64, b: f64| {
        let root = (1.0 + a * a).sqrt();
        a / root * libm::atan(b / root)
    };
    (part(a, b) + part(b, a)) / (2.0 * PI)
}
