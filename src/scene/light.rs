//! What emits: surfaces, points and the sky; how one of them is picked, and how a point on it is drawn.

pub mod emission;
mod pick;

use super::sky::{FAR, SKY, Sky};
use super::{Hit, Ray, Rgb, Shape, Surface, geometry::NOWHERE, solid_angle};
use crate::sampling::{PdfA, PdfW};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How light is sampled: which emitter, and where on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LightSampling {
    /// How a point on the emitter is drawn.
    pub points: Points,
    /// How the emitter is picked.
    pub pick: Pick,
}

impl LightSampling {
    /// Points uniform over area, emitters picked by power.
    pub const AREA: Self = LightSampling { points: Points::Area, pick: Pick::Power };
    /// Points uniform over solid angle, emitters picked by power.
    pub const SOLID_ANGLE: Self = LightSampling { points: Points::SolidAngle, pick: Pick::Power };
}

/// How a point on an emitting surface is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Points {
    /// Uniformly over the emitter's area.
    #[default]
    Area,
    /// Uniformly over the solid angle that it subtends: rectangles, triangles, and whole spheres seen from outside;
    /// other shapes fall back to area.
    SolidAngle,
}

/// How one of several emitters is picked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Pick {
    /// In proportion to power, all channels added.
    #[default]
    Power,
    /// Each with the same probability.
    Uniform,
}

/// A light of no extent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointLight {
    /// Where it is.
    pub position: DVec3,
    /// Radiant intensity [W sr^-1], the same in all directions.
    pub intensity: Rgb,
}

/// A point on an emitter, seen from a receiver.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// The point on the emitter minus the receiver's point; not normalized.
    pub to_light: DVec3,
    /// Distance [scene units].
    pub distance: f64,
    /// Radiance sent towards the receiver [W m^-2 sr^-1]; from a point light, irradiance on a plate facing it [W m^-2].
    pub le: Rgb,
    /// What `le` is to be multiplied with: 1 / density, or for a Dirac light 1 / probability of its choice.
    pub weight: f64,
    /// Density of the direction, the choice of the emitter included [1/sr]; `None` for a Dirac light.
    pub pdf: Option<PdfW>,
    /// Probability with which this emitter was picked.
    pub pmf: f64,
    /// The emitter's surface, or what stands for it.
    pub surface: u32,
}

/// The emitters of a scene.
#[derive(Clone, Debug)]
pub struct Lights {
    lights: Vec<Light>,
    sky: Option<Sky>,
    /// Of a sphere around the scene.
    center: DVec3,
    radius: f64,
}

#[derive(Clone, Copy, Debug)]
enum Emitter {
    /// A surface, and the density of a point uniform over its area.
    Surface(u32, PdfA),
    Point(PointLight),
    Sky(Sky),
}

#[derive(Clone, Copy, Debug)]
struct Light {
    emitter: Emitter,
    /// Probability of picking this one in proportion to power.
    pmf: f64,
    /// Sum of the probabilities up to and including this one.
    cdf: f64,
}

impl Lights {
    /// Collects the emitters of a scene that fits into the sphere of this centre and radius. A light's power, up to a
    /// factor π: area x radiance, 4 intensity, and what the sky sends through that sphere.
    pub fn new(
        surfaces: &[Surface],
        points: &[PointLight],
        sky: Option<Sky>,
        (center, radius): (DVec3, f64),
    ) -> Self {
        let of_surface = |(id, s): (usize, &Surface)| {
            let area = s.shape.area();
            (Emitter::Surface(id as u32, PdfA(1.0 / area)), area * s.material.le.element_sum())
        };
        let of_point = |p: &PointLight| (Emitter::Point(*p), 4.0 * p.intensity.element_sum());
        let of_sky = |s: Sky| (Emitter::Sky(s), radius * radius * s.fluence().element_sum());
        let emitters: Vec<(Emitter, f64)> = (surfaces.iter().enumerate().map(of_surface))
            .chain(points.iter().map(of_point))
            .chain(sky.map(of_sky))
            .filter(|&(_, power)| power > 0.0)
            .collect();
        let total: f64 = emitters.iter().map(|(_, power)| power).sum();
        let mut cdf = 0.0;
        let light = |(emitter, power): (Emitter, f64)| {
            let pmf = power / total;
            cdf += pmf;
            Light { emitter, pmf, cdf }
        };
        Lights { lights: emitters.into_iter().map(light).collect(), sky, center, radius }
    }

    /// How many emitters there are.
    #[inline]
    pub fn count(&self) -> usize {
        self.lights.len()
    }

    /// The sky, if there is one.
    #[inline]
    pub fn sky(&self) -> Option<&Sky> {
        self.sky.as_ref()
    }

    /// The surface that emits all light, if there is just one emitter.
    pub fn only_surface(&self) -> Option<u32> {
        match self.lights.as_slice() {
            [Light { emitter: Emitter::Surface(id, _), .. }] => Some(*id),
            _ => None,
        }
    }

    /// The lights without extent, but for those that are dark.
    pub fn points(&self) -> impl Iterator<Item = &PointLight> {
        self.lights.iter().filter_map(|l| match &l.emitter {
            Emitter::Point(point) => Some(point),
            _ => None,
        })
    }

    /// See [`super::Scene::sample_light`].
    #[inline(always)]
    pub fn sample(
        &self,
        surfaces: &[Surface],
        how: LightSampling,
        (p, time): (DVec3, f64),
        u: f64,
        v: (f64, f64),
    ) -> Option<LightSample> {
        let (light, pmf) = self.pick(how.pick, u)?;
        match light.emitter {
            Emitter::Surface(id, pdf) => {
                of_surface(&surfaces[id as usize], id, pdf, pmf, how.points, (p, time), v)
            }
            Emitter::Point(light) => {
                let to_light = light.position - p;
                let squared = to_light.length_squared();
                let sample = LightSample {
                    to_light,
                    distance: squared.sqrt(),
                    le: light.intensity / squared,
                    weight: 1.0 / pmf,
                    pdf: None,
                    pmf,
                    surface: NOWHERE,
                };
                (squared > 0.0).then_some(sample)
            }
            Emitter::Sky(sky) => {
                let wi = sky.sample(v);
                let pdf = PdfW(pmf * sky.pdf(wi).0);
                let sample = LightSample {
                    to_light: wi * FAR,
                    distance: FAR,
                    le: sky.radiance(wi),
                    weight: 1.0 / pdf.0,
                    pdf: Some(pdf),
                    pmf,
                    surface: SKY,
                };
                // rounding may carry a direction below the horizon
                (pdf.0 > 0.0).then_some(sample)
            }
        }
    }

    /// Density [1/sr] with which [`Lights::sample`] at `ray.o` draws the direction towards the emitter that `ray` hit.
    #[inline]
    pub fn pdf(&self, surfaces: &[Surface], how: LightSampling, ray: &Ray, hit: &Hit<'_>, time: f64) -> PdfW {
        let cos = hit.frame.n.dot(hit.wo);
        if cos <= 0.0 {
            return PdfW(0.0); // the back of a clear interface, which emits nothing
        }
        let Some(light) = self.of(hit.surface) else { return PdfW(0.0) };
        let pmf = match how.pick {
            Pick::Power => light.pmf,
            Pick::Uniform => 1.0 / self.lights.len() as f64,
        };
        let direction = match light.emitter {
            Emitter::Point(_) => PdfW(0.0),
            Emitter::Sky(sky) => sky.pdf(ray.d),
            Emitter::Surface(id, pdf) => {
                let surface = &surfaces[id as usize];
                match how.points {
                    Points::SolidAngle => by_solid_angle(surface, (ray.o, time), (0.5, 0.5))
                        .and_then(|(_, _, solid_angle)| solid_angle)
                        .map(|solid_angle| PdfW(1.0 / solid_angle)),
                    Points::Area => None,
                }
                .unwrap_or_else(|| pdf.per_solid_angle((hit.p - ray.o).length_squared(), cos))
            }
        };
        PdfW(pmf * direction.0)
    }
}

/// A point, the front's normal there, and the solid angle [sr] if the point is uniform over it.
type Point = (DVec3, DVec3, Option<f64>);

#[inline(always)]
fn of_surface(
    surface: &Surface,
    id: u32,
    pdf: PdfA,
    pmf: f64,
    points: Points,
    (p, time): (DVec3, f64),
    v: (f64, f64),
) -> Option<LightSample> {
    let (point, n, solid_angle) = match points {
        Points::SolidAngle => by_solid_angle(surface, (p, time), v)?,
        Points::Area => by_area(surface, time, v),
    };
    let to_light = point - p;
    let distance_squared = to_light.length_squared();
    let distance = distance_squared.sqrt();
    let cos = -n.dot(to_light) / distance;
    if cos <= 0.0 || distance == 0.0 {
        return None;
    }
    let pdf = match solid_angle {
        Some(solid_angle) => PdfW(1.0 / solid_angle),
        None => pdf.per_solid_angle(distance_squared, cos),
    };
    let pdf = PdfW(pmf * pdf.0);
    let le = surface.material.le;
    Some(LightSample { to_light, distance, le, weight: 1.0 / pdf.0, pdf: Some(pdf), pmf, surface: id })
}

#[inline(always)]
fn by_area(surface: &Surface, time: f64, v: (f64, f64)) -> Point {
    let (point, frame) = surface.sample_area(v);
    (point + surface.velocity * time, frame.n, None)
}

/// Uniform over the solid angle, or over the area where the shape has no such map; nothing where the shape subtends no
/// solid angle.
#[inline]
fn by_solid_angle(surface: &Surface, (p, time): (DVec3, f64), v: (f64, f64)) -> Option<Point> {
    let moved = surface.velocity * time;
    let from = p - moved; // where the receiver is, seen from the emitter's place at time 0
    let sample = match &surface.shape {
        Shape::Rectangle(r) => solid_angle::rectangle(from, r.center, r.half_u, r.half_v, v)?,
        Shape::Triangle(t) => solid_angle::triangle(from, t.a, t.b, t.c, v)?,
        Shape::Sphere(s) if !s.inward && s.low <= -1.0 && s.high >= 1.0 => {
            solid_angle::sphere(from, s.center, s.radius, v)?
        }
        _ => return Some(by_area(surface, time, v)),
    };
    let (point, frame) = surface.at(sample.point);
    Some((point + moved, frame.n, Some(sample.solid_angle)))
}
