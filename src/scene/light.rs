//! Emitters, picked in proportion to their power, and points on them.

use super::{Rgb, Shape, Surface, solid_angle};
use crate::sampling::warp::Frame;
use crate::sampling::{PdfA, PdfW};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How a point on an emitter is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightSampling {
    /// Uniformly over the emitter's area.
    #[default]
    Area,
    /// Uniformly over the solid angle that it subtends: rectangles, triangles, and whole spheres seen from outside;
    /// other shapes fall back to area.
    SolidAngle,
}

/// A point on an emitter, seen from a receiver.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// The point on the emitter minus the receiver's point; not normalized.
    pub to_light: DVec3,
    /// Distance [scene units].
    pub distance: f64,
    /// Radiance sent towards the receiver [W m^-2 sr^-1].
    pub le: Rgb,
    /// Density of the direction, the choice of the emitter included [1/sr].
    pub pdf: PdfW,
    /// The emitter's surface.
    pub surface: u32,
}

/// The emitters of a scene.
#[derive(Clone, Debug)]
pub struct Lights {
    lights: Vec<Light>,
}

#[derive(Clone, Copy, Debug)]
struct Light {
    surface: u32,
    /// Probability of picking this one.
    pmf: f64,
    /// Sum of the probabilities up to and including this one.
    cdf: f64,
    /// Density of a point uniform over its area.
    pdf: PdfA,
}

impl Lights {
    /// Collects the emitters; a light's power is area x (sum of the channels of its emission), up to a factor π.
    pub fn new(surfaces: &[Surface]) -> Self {
        let power = |s: &Surface| s.shape.area() * s.material.le.element_sum();
        let total: f64 = surfaces.iter().map(power).sum();
        let mut cdf = 0.0;
        let mut lights = Vec::new();
        for (id, surface) in surfaces.iter().enumerate() {
            let pmf = power(surface) / total;
            if pmf > 0.0 {
                cdf += pmf;
                lights.push(Light { surface: id as u32, pmf, cdf, pdf: PdfA(1.0 / surface.shape.area()) });
            }
        }
        Lights { lights }
    }

    /// How many emitters there are.
    #[inline]
    pub fn count(&self) -> usize {
        self.lights.len()
    }

    /// See [`super::Scene::sample_light`].
    #[inline]
    pub fn sample(
        &self,
        surfaces: &[Surface],
        how: LightSampling,
        p: DVec3,
        u: f64,
        v: (f64, f64),
    ) -> Option<LightSample> {
        // the last one catches a cdf that rounding leaves below 1
        let last = self.lights.last()?;
        let light = self.lights.iter().find(|l| u < l.cdf).unwrap_or(last);
        let surface = &surfaces[light.surface as usize];
        let (point, frame, solid_angle) = match how {
            LightSampling::SolidAngle => by_solid_angle(surface, p, v)?,
            LightSampling::Area => by_area(surface, v),
        };
        let to_light = point - p;
        let distance_squared = to_light.length_squared();
        let distance = distance_squared.sqrt();
        let cos = -frame.n.dot(to_light) / distance;
        if cos <= 0.0 || distance == 0.0 {
            return None;
        }
        let pdf = match solid_angle {
            Some(solid_angle) => PdfW(1.0 / solid_angle),
            None => light.pdf.per_solid_angle(distance_squared, cos),
        };
        Some(LightSample {
            to_light,
            distance,
            le: surface.material.le,
            pdf: PdfW(light.pmf * pdf.0),
            surface: light.surface,
        })
    }
}

/// A point, the frame of the front's normal there, and the solid angle [sr] if the point is uniform over it.
type Point = (DVec3, Frame, Option<f64>);

#[inline]
fn by_area(surface: &Surface, v: (f64, f64)) -> Point {
    let (point, frame) = surface.sample_area(v);
    (point, frame, None)
}

/// Uniform over the solid angle, or over the area where the shape has no such map; nothing where the shape subtends no
/// solid angle.
#[inline]
fn by_solid_angle(surface: &Surface, p: DVec3, v: (f64, f64)) -> Option<Point> {
    let sample = match &surface.shape {
        Shape::Rectangle(r) => solid_angle::rectangle(p, r.center, r.half_u, r.half_v, v)?,
        Shape::Triangle(t) => solid_angle::triangle(p, t.a, t.b, t.c, v)?,
        Shape::Sphere(s) if !s.inward && s.low <= -1.0 && s.high >= 1.0 => {
            solid_angle::sphere(p, s.center, s.radius, v)?
        }
        _ => return Some(by_area(surface, v)),
    };
    let (point, frame) = surface.at(sample.point);
    Some((point, frame, Some(sample.solid_angle)))
}
