//! Reference values, always with an error: closed forms, and stored images of an independent renderer.

pub mod enclosure;
pub mod gain;
pub mod linear;
pub mod moments;
pub mod optimum;
pub mod reference;
pub mod walk;

pub use enclosure::{Counted, Enclosure};
pub use optimum::{Optimum, best_constant_q};
pub use reference::Reference;
pub use walk::Walk;

use crate::estimator::{Estimate, Estimator, Explicit, Property, Technique};
use crate::scene::library::{Patch, SceneKind, View};
use crate::scene::{LightSampling, Material, Rgb};
use enclosure::average;
use moments::Central;
use std::f64::consts::PI;

/// What theory says of a central moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Its value.
    Value(f64),
    /// It is infinite.
    Infinite,
    /// There is no closed form.
    Unknown,
}

impl Known {
    /// The value, if theory gives one.
    pub fn value(self) -> Option<f64> {
        match self {
            Known::Value(value) => Some(value),
            _ => None,
        }
    }
}

/// Closed forms for one estimator in one scene, per channel and per bounce.
pub struct ClosedForm {
    enclosure: Enclosure,
    /// With which probability the first ray meets each patch: one of them for a probe, all of them for a plate.
    seen: Vec<f64>,
    /// π for a plate, 1 for a probe.
    response: f64,
    estimator: Estimator,
}

impl ClosedForm {
    /// The closed forms of `estimator` in `scene`, or `None` where the scene has none.
    pub fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let furnace = |albedo: &Rgb, le: &Rgb| Enclosure::furnace(Material { albedo: *albedo, le: *le });
        let whole = |albedo: &Rgb, emission: &Rgb| {
            Enclosure::sphere(&[Patch { fraction: 1.0, albedo: *albedo, emission: *emission }])
        };
        let (enclosure, looks_at, view) = match scene {
            SceneKind::Furnace { albedo, emission, view } => (whole(albedo, emission), 0, view),
            SceneKind::FurnaceBox { albedo, emission, view } => (furnace(albedo, emission), 0, view),
            SceneKind::IntegratingSphere { patches, looks_at, view } => {
                (Enclosure::sphere(patches), *looks_at, view)
            }
            SceneKind::CornellBox { .. } | SceneKind::CornellEmpty { .. } | SceneKind::Custom { .. } => {
                return None;
            }
        };
        let probe = |patch| if patch == looks_at { 1.0 } else { 0.0 };
        let (seen, response) = match view {
            View::Probe => ((0..enclosure.patches().len()).map(probe).collect(), 1.0),
            View::Irradiance => (enclosure.seen_from(looks_at).to_vec(), PI),
        };
        Some(ClosedForm { enclosure, seen, response, estimator: *estimator })
    }

    /// The right value, whatever the estimator makes of it.
    pub fn truth(&self, channel: usize, counted: Counted) -> f64 {
        let on = |patch| self.enclosure.radiance(patch, channel, counted);
        let radiance: Vec<f64> = (0..self.seen.len()).map(on).collect();
        self.response * average(&self.seen, &radiance)
    }

    /// The mean of this estimator: the right value less what a clamp leaves out.
    pub fn expected(&self, channel: usize, counted: Counted) -> f64 {
        let whole = self.truth(channel, counted);
        let Property::Clamped { bounces } = self.estimator.property() else { return whole };
        let left_out = match counted {
            Counted::Only(k) if k <= bounces => 0.0,
            Counted::Only(_) => whole,
            Counted::All => self.truth(channel, Counted::From(bounces + 1)),
            Counted::From(k) => self.truth(channel, Counted::From(k.max(bounces + 1))),
        };
        whole - left_out
    }

    /// The central moment of the given order (2, 3 or 4) of one sample.
    pub fn central(&self, channel: usize, counted: Counted, order: usize) -> Known {
        match self.moments(channel, counted) {
            Err(unknown) => unknown,
            Ok(moments) => moments.finite_moment(order).map_or(Known::Infinite, Known::Value),
        }
    }

    /// Skewness of one sample, where finite and known; 0 for a constant.
    pub fn skewness(&self, channel: usize, counted: Counted) -> Option<f64> {
        let variance = self.central(channel, counted, 2).value()?;
        let third = self.central(channel, counted, 3).value()?;
        Some(if variance == 0.0 { 0.0 } else { third / (variance * variance.sqrt()) })
    }

    /// Expected rays a realization, where known.
    pub fn rays(&self) -> Option<f64> {
        let rays = average(&self.seen, &Walk::new(&self.enclosure, &self.estimator)?.rays()?);
        rays.is_finite().then_some(rays)
    }

    /// Index of the power-law tail of one sample; the variance is infinite at or below 2.
    pub fn tail_index(&self, channel: usize) -> Option<f64> {
        if self.light_touches_walls() {
            return Some(1.5);
        }
        let on_patches = Walk::new(&self.enclosure, &self.estimator)?.tail_index(channel);
        let seen = on_patches.into_iter().zip(&self.seen).filter(|(_, p)| **p > 0.0);
        seen.filter_map(|(alpha, _)| alpha).min_by(f64::total_cmp)
    }

    fn moments(&self, channel: usize, counted: Counted) -> Result<Central, Known> {
        if self.light_touches_walls() && counted != Counted::Only(0) {
            return Err(Known::Infinite);
        }
        let walk = Walk::new(&self.enclosure, &self.estimator).ok_or(Known::Unknown)?;
        let moments = walk.moments(channel, counted).ok_or(Known::Unknown)?;
        Ok(Central::mixture(self.seen.iter().copied().zip(moments)).scaled(self.response))
    }

    /// Light sampled over an area that adjoins the receiver's wall has a geometry term with tail index 3/2,
    /// averaged over receivers: infinite variance in every box.
    fn light_touches_walls(&self) -> bool {
        let area = |e: &Explicit| e.lights == LightSampling::Area && e.technique == Technique::Light;
        !self.enclosure.is_spherical()
            && matches!(&self.estimator, Estimator::Explicit(e) if area(e))
            && self.estimator.roulette().reaches(2)
    }
}
