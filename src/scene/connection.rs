//! How a sensor is seen from a point of the scene: the other way round from [`Sensor::ray`].

use super::Sensor;
use super::camera::Camera;
use super::geometry::NOWHERE;
use crate::sampling::warp::disk;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// The way from a point of the scene to the sensor.
#[derive(Clone, Copy, Debug)]
pub struct Connection {
    /// From the point to the sensor; not normalized.
    pub to_sensor: DVec3,
    /// Unit direction in which light must leave the point.
    pub wo: DVec3,
    /// The pixel that it falls into, row by row from the top left.
    pub pixel: u32,
    /// What a watt of light that falls on the point adds to the pixel's mean radiance before the sensor's response, for
    /// each unit of f cos θ [m^-2].
    pub importance: f64,
    /// The surface on which the sensor lies, or [`NOWHERE`].
    pub surface: u32,
}

impl Sensor {
    /// Whether light from anywhere but one line reaches it, so that a point of the scene can be connected to it.
    pub fn has_extent(&self) -> bool {
        !matches!(self, Sensor::Probe { .. })
    }

    /// The way from `p` to a point of the sensor drawn by `u`; `None` where the sensor does not see `p`. Integrated over
    /// a surface and over the sensor it is the adjoint of [`Sensor::ray`] [Veach 1997, sec. 4.7].
    #[inline]
    pub fn connect(&self, p: DVec3, u: (f64, f64)) -> Option<Connection> {
        match self {
            Sensor::Probe { .. } => None,
            Sensor::Irradiance { point, normal, on } => {
                let to_sensor = *point - p;
                let squared = to_sensor.length_squared();
                let wo = to_sensor / squared.sqrt();
                let importance = -normal.dot(wo) * FRAC_1_PI / squared; // its response is π
                let surface = on.unwrap_or(NOWHERE);
                (importance > 0.0 && importance.is_finite()).then_some(Connection {
                    to_sensor,
                    wo,
                    pixel: 0,
                    importance,
                    surface,
                })
            }
            Sensor::Parallel { center, direction, half_u, half_v } => {
                let normal = half_u.cross(*half_v); // a quarter of the area long
                let slope = direction.dot(normal);
                let t = (p - *center).dot(normal) / slope;
                let offset = p - t * *direction - *center;
                let inside = offset.dot(*half_u).abs() <= half_u.length_squared()
                    && offset.dot(*half_v).abs() <= half_v.length_squared();
                (t > 0.0 && inside).then_some(Connection {
                    to_sensor: -t * *direction,
                    wo: -*direction,
                    pixel: 0,
                    importance: 0.25 / slope.abs(),
                    surface: NOWHERE,
                })
            }
            Sensor::Camera(camera) => camera.connect(p, u),
        }
    }
}

impl Camera {
    /// A pixel's mean is one over its area in the plane at unit distance, dA = dω / cos³; solid angle is dω = cos θ dA / d²
    /// on the surface. Through a lens, the plane that is sharp takes that plane's place.
    #[inline]
    fn connect(&self, p: DVec3, u: (f64, f64)) -> Option<Connection> {
        let offset = self.lens.map_or(DVec3::ZERO, |lens| {
            let (a, b) = disk(u);
            lens.radius * (a * self.right.normalize() + b * self.up.normalize())
        });
        let from = self.origin + offset - p;
        let depth = -from.dot(self.forward);
        if depth <= self.near {
            return None;
        }
        // where the line crosses the plane at unit distance, as the pinhole at the lens's centre would see it
        let at = match self.lens {
            None => -from / depth,
            Some(lens) => offset / lens.focus - from / depth,
        };
        let place = |axis: DVec3, pixels: u32| {
            let s = at.dot(axis) / axis.length_squared(); // -1 to 1 over the image
            (0.5 * (s + 1.0) * f64::from(pixels)).floor()
        };
        let (x, y) = (place(self.right, self.width), place(-self.up, self.height));
        let is_seen = x >= 0.0 && x < f64::from(self.width) && y >= 0.0 && y < f64::from(self.height);
        let squared = from.length_squared();
        let distance = squared.sqrt();
        let cos = depth / distance;
        let pixel_area =
            4.0 * self.right.length() * self.up.length() / (f64::from(self.width) * f64::from(self.height));
        is_seen.then(|| Connection {
            to_sensor: from * (1.0 - self.near / depth),
            wo: from / distance,
            pixel: y as u32 * self.width + x as u32,
            importance: 1.0 / (squared * cos * cos * cos * pixel_area),
            surface: NOWHERE,
        })
    }
}
