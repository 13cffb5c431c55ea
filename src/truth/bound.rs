//! The largest value that one sample can take: what evidence for "too dark" needs to know.
//!
//! A contribution of bounce k is Le times k weights f cos / (pdf q), so a bound on each weight bounds it, whatever the
//! path. Copies that splitting makes count together. A bound that does not exist (light sampled over an area that may lie
//! arbitrarily near, throughput that grows without end) is `None`, never a large number.

use super::enclosure::Counted;
use crate::estimator::{Estimator, Recursive, Roulette, Rule, Technique};
use crate::scene::library::SceneKind;
use crate::scene::{Bsdf, Directions, Pick, Points, Rgb, Scene, Sensor, Shape, Sky};
use std::f64::consts::PI;

/// Bounces that are summed one by one before the geometric rest.
const LISTED: u32 = 64;

/// No sample of `estimator` in a scene exceeds it: radiance [W m^-2 sr^-1], or irradiance [W m^-2] on a plate.
pub fn of(kind: &SceneKind, estimator: &Estimator, channel: usize, counted: Counted) -> Option<f64> {
    let scene = kind.build();
    // a narrow lobe has no f that albedo / π bounds
    let unbounded = |bsdf: Bsdf| bsdf.is_clear() || matches!(bsdf, Bsdf::Glossy { .. });
    if !estimator.is_path_tracer()
        || scene.surfaces().iter().any(|s| unbounded(s.material.bsdf))
        || (scene.points().next().is_some() && estimator.samples_lights())
    {
        return None;
    }
    let response = if matches!(scene.sensor, Sensor::Irradiance { .. }) { PI } else { 1.0 };
    let spherical = matches!(kind, SceneKind::Furnace { .. } | SceneKind::IntegratingSphere { .. });
    let walk = Walk { scene: &scene, estimator, channel, spherical };
    Some(response * walk.sum(counted)?)
}

struct Walk<'a> {
    scene: &'a Scene,
    estimator: &'a Estimator,
    channel: usize,
    spherical: bool,
}

impl Walk<'_> {
    fn sum(&self, counted: Counted) -> Option<f64> {
        let clamp = self.estimator.roulette().clamp.unwrap_or(u32::MAX);
        let bounce = |k: u32| if k <= clamp { self.bounce(k) } else { Some(0.0) };
        let first = match counted {
            Counted::Only(k) => return bounce(k),
            Counted::All => 0,
            Counted::From(k) => k,
        };
        let last = first.max(self.estimator.roulette().from) + LISTED;
        let listed: f64 = (first..=last.min(clamp)).map(bounce).sum::<Option<f64>>()?;
        if clamp <= last {
            return Some(listed);
        }
        // from here on each bounce is bounded by the same multiple of the one before
        let ratio = self.weight(last)?;
        (ratio < 1.0).then_some(listed + bounce(last)? * ratio / (1.0 - ratio))
    }

    /// What one bounce adds.
    fn bounce(&self, k: u32) -> Option<f64> {
        let hit = Some(self.throughput(k)? * self.brightest());
        let Estimator::Explicit(e) = self.estimator else { return hit };
        if k == 0 {
            return hit;
        }
        let (before, albedo) = (self.throughput(k - 1)?, self.largest(|a| a[self.channel]));
        match e.technique {
            Technique::Direction => hit,
            // w f cos / p_light <= f cos / p_direction, for both heuristics
            Technique::Both(_) => Some(hit? + before * albedo * self.spread() * self.brightest()),
            Technique::Light => {
                // what a mirror shows counts as a hit
                let mirrors = self.scene.surfaces().iter().any(|s| s.material.bsdf.is_dirac());
                let shown = if mirrors { hit? } else { 0.0 };
                Some(shown + before * albedo * self.sampled(e.lights.points, e.lights.pick)?)
            }
        }
    }

    /// Largest throughput on arrival after `k` scattering events.
    fn throughput(&self, k: u32) -> Option<f64> {
        (0..k).map(|bounce| self.weight(bounce)).product()
    }

    /// Largest f cos / (pdf q) after bounce `bounce`, copies counted together.
    fn weight(&self, bounce: u32) -> Option<f64> {
        let Roulette { rule, from, .. } = *self.estimator.roulette();
        let (spread, albedo) = (self.spread(), |albedo: Rgb| albedo[self.channel]);
        let weight = match rule {
            // throughput starts at 1 and is brought back to at most 1 after each survival
            Rule::Throughput { .. } => return (spread == 1.0 && !self.splits()).then_some(1.0),
            _ if bounce < from => self.largest(albedo),
            Rule::None => self.largest(albedo),
            Rule::Constant { q } => self.largest(albedo) * q.ceil() / q,
            Rule::Albedo => self.largest(|a| a[self.channel] / a.max_element()),
        };
        Some(spread * weight)
    }

    fn splits(&self) -> bool {
        matches!(self.estimator, Estimator::Recursive(Recursive { samples, .. }) if *samples > 1)
    }

    /// Largest f cos / (albedo pdf): 1 for cosine-distributed directions, 2 for uniform ones.
    fn spread(&self) -> f64 {
        let directions = match self.estimator {
            Estimator::Recursive(e) => e.directions,
            Estimator::Implicit(e) => e.directions,
            Estimator::Explicit(e) => e.directions,
            Estimator::LightTracing(e) => e.directions,
            Estimator::PhotonMap(e) => e.directions,
        };
        match directions {
            Directions::Cosine => 1.0,
            Directions::Uniform => 2.0,
        }
    }

    /// Largest value over all surfaces that reflect; metals reflect at most everything.
    fn largest(&self, of: impl Fn(Rgb) -> f64) -> f64 {
        let albedo = |bsdf: &Bsdf| match *bsdf {
            Bsdf::Lambert { albedo } => albedo,
            Bsdf::Mirror { reflectance } => reflectance,
            Bsdf::Conductor { .. } | Bsdf::Glossy { .. } | Bsdf::Dielectric { .. } => Rgb::ONE,
        };
        let albedos = self.scene.surfaces().iter().map(|s| albedo(&s.material.bsdf));
        albedos.filter(|a| *a != Rgb::ZERO).map(of).fold(0.0, f64::max)
    }

    /// Largest radiance that anything emits.
    fn brightest(&self) -> f64 {
        let sky = self.scene.sky().map_or(Rgb::ZERO, |sky| match sky {
            Sky::Uniform { radiance } | Sky::Cosine { radiance, .. } => *radiance,
        });
        let surfaces = self.scene.surfaces().iter().map(|s| s.material.le);
        surfaces.chain([sky]).map(|le| le[self.channel]).fold(0.0, f64::max)
    }

    /// Largest reflected radiance from one sampled light, divided by the albedo.
    fn sampled(&self, points: Points, pick: Pick) -> Option<f64> {
        let lights = || self.scene.surfaces().iter().filter(|s| s.material.le != Rgb::ZERO);
        if self.scene.sky().is_some() {
            return None;
        }
        let power = |area: f64, le: Rgb| area * le.element_sum();
        let all: f64 = lights().map(|s| power(s.shape.area(), s.material.le)).sum();
        let area: f64 = self.scene.surfaces().iter().map(|s| s.shape.area()).sum();
        let mut largest = 0.0_f64;
        for light in lights() {
            let (own, le) = (light.shape.area(), light.material.le);
            let pmf = match pick {
                Pick::Power => power(own, le) / all,
                Pick::Uniform => 1.0 / lights().count() as f64,
            };
            // on a sphere, cos cos' / d² is the same between all points; else the hemisphere bounds the solid angle
            let share = if self.spherical { own / area } else { solid_angle(&light.shape, points)? / PI };
            largest = largest.max(share * le[self.channel] / pmf);
        }
        Some(largest)
    }
}

/// An upper limit of the solid angle from which points on the shape are drawn, where they are drawn by solid angle.
fn solid_angle(shape: &Shape, points: Points) -> Option<f64> {
    let has_map = match shape {
        Shape::Rectangle(_) | Shape::Triangle(_) => true,
        Shape::Sphere(s) => !s.inward && s.low <= -1.0 && s.high >= 1.0,
        Shape::Disk(_) => false,
    };
    (has_map && points == Points::SolidAngle).then_some(2.0 * PI)
}
