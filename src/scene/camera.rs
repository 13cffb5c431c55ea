//! Sensors: what one realization measures, pixel by pixel.

use super::Ray;
use super::geometry::NOWHERE;
use crate::sampling::Stream;
use crate::sampling::warp::{Frame, cosine_hemisphere, disk};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sensor {
    /// The radiance that arrives along one ray [W m^-2 sr^-1].
    Probe {
        /// Where the eye is.
        origin: DVec3,
        /// Unit direction in which it looks.
        direction: DVec3,
    },
    /// The irradiance on a small plate [W m^-2].
    Irradiance {
        /// Where the plate is.
        point: DVec3,
        /// Its unit normal.
        normal: DVec3,
        /// The surface on which it lies, if on any.
        #[serde(default)]
        on: Option<u32>,
    },
    /// The mean radiance that arrives along parallel rays through a rectangle [W m^-2 sr^-1].
    Parallel {
        /// The rectangle's centre.
        center: DVec3,
        /// Unit direction in which it looks.
        direction: DVec3,
        /// Half of one edge.
        half_u: DVec3,
        /// Half of the other edge.
        half_v: DVec3,
    },
    /// Pixel means of the radiance through a pinhole or a thin lens, box filter [W m^-2 sr^-1].
    Camera(Camera),
}

/// A camera with a pinhole or a thin lens.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Where the eye is.
    pub origin: DVec3,
    /// Unit viewing direction.
    pub forward: DVec3,
    /// From the image's centre to the middle of its right edge, at unit distance.
    pub right: DVec3,
    /// From the image's centre to the middle of its top edge, at unit distance.
    pub up: DVec3,
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from top to bottom.
    pub height: u32,
    /// The lens; a pinhole if there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lens: Option<Lens>,
    /// Distance from the eye or lens, along the viewing direction, at which rays start: what is nearer is not seen.
    #[serde(default, skip_serializing_if = "starts_at_the_eye")]
    pub near: f64,
}

fn starts_at_the_eye(near: &f64) -> bool {
    *near == 0.0
}

/// A thin lens, uniform over its area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lens {
    /// Its radius [scene units].
    pub radius: f64,
    /// Distance of the plane that is sharp, along the viewing direction [scene units].
    pub focus: f64,
}

impl Camera {
    /// A pinhole at `origin` looking along `direction`, with the full vertical field of view in degrees.
    pub fn pinhole(
        origin: DVec3,
        direction: DVec3,
        up: DVec3,
        fov_degrees: f64,
        (width, height): (u32, u32),
    ) -> Self {
        let forward = direction.normalize();
        let right = forward.cross(up).normalize();
        let half = libm::tan(0.5 * fov_degrees * PI / 180.0);
        Camera {
            origin,
            forward,
            right: right * (half * f64::from(width) / f64::from(height)),
            up: right.cross(forward) * half,
            width,
            height,
            lens: None,
            near: 0.0,
        }
    }

    /// A ray through pixel `(x, y)`, from the top left.
    #[inline]
    fn ray(&self, (x, y): (u32, u32), stream: &mut Stream) -> Ray {
        let (u, v) = stream.u2();
        let sx = 2.0 * (f64::from(x) + u) / f64::from(self.width) - 1.0;
        let sy = 1.0 - 2.0 * (f64::from(y) + v) / f64::from(self.height);
        let d = self.forward + sx * self.right + sy * self.up;
        let Some(lens) = self.lens else {
            return Ray { o: self.origin + self.near * d, d: d.normalize(), from: NOWHERE };
        };
        let (a, b) = disk(stream.u2());
        let offset = lens.radius * (a * self.right.normalize() + b * self.up.normalize());
        let to_focus = d * lens.focus - offset;
        let o = self.origin + offset + (self.near / lens.focus) * to_focus;
        Ray { o, d: to_focus.normalize(), from: NOWHERE }
    }
}

impl Sensor {
    /// Width and height in pixels; only a camera has more than one.
    pub fn resolution(&self) -> (u32, u32) {
        match self {
            Sensor::Camera(c) => (c.width, c.height),
            _ => (1, 1),
        }
    }

    /// A ray for pixel `(x, y)` (from the top left) and the factor that turns its radiance into the measured quantity.
    #[inline]
    pub fn ray(&self, pixel: (u32, u32), stream: &mut Stream) -> (Ray, f64) {
        match self {
            Sensor::Probe { origin, direction } => (Ray { o: *origin, d: *direction, from: NOWHERE }, 1.0),
            Sensor::Irradiance { point, normal, on } => {
                let d = Frame::around(*normal).to_world(cosine_hemisphere(stream.u2()));
                (Ray { o: *point, d, from: on.unwrap_or(NOWHERE) }, PI) // cos / pdf = π
            }
            Sensor::Parallel { center, direction, half_u, half_v } => {
                let (u, v) = stream.u2();
                let o = *center + (2.0 * u - 1.0) * *half_u + (2.0 * v - 1.0) * *half_v;
                (Ray { o, d: *direction, from: NOWHERE }, 1.0)
            }
            Sensor::Camera(camera) => (camera.ray(pixel, stream), 1.0),
        }
    }
}
