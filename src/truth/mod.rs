//! Reference values, always with an error: closed forms, stored images of an independent renderer or of our own, and
//! which of them is used.

pub mod choice;
pub mod enclosure;
pub mod layers;
pub mod moments;
pub mod optimum;
pub mod own;
pub mod reference;

pub use choice::{Source, Truth, Value};
pub use enclosure::{Counted, Enclosure};
pub use layers::BadReference;
pub use optimum::{Optimum, best_constant_q};
pub use own::Own;
pub use reference::Reference;

use crate::estimator::{Estimate, Estimator, Property};
use crate::scene::library::{Patch, SceneKind, View};
use crate::scene::{LightSampling, Rgb};
use enclosure::Walk;
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
    /// The patch that a probe looks at; `None` for a plate, which sees all of them.
    start: Option<usize>,
    /// π for a plate, 1 for a probe.
    response: f64,
    /// Whether next-event estimation has a constant geometry term, as on a sphere.
    spherical: bool,
    estimator: Estimator,
}

impl ClosedForm {
    /// The closed forms of `estimator` in `scene`, or `None` where the scene has none.
    pub fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let single = |albedo: Rgb, emission: Rgb| vec![Patch { fraction: 1.0, albedo, emission }];
        let (patches, looks_at, view, spherical) = match scene {
            SceneKind::Furnace { albedo, emission, view } => (single(*albedo, *emission), 0, view, true),
            SceneKind::FurnaceBox { albedo, emission, view } => (single(*albedo, *emission), 0, view, false),
            SceneKind::IntegratingSphere { patches, looks_at, view } => {
                (patches.clone(), *looks_at, view, true)
            }
            SceneKind::CornellBox { .. } | SceneKind::CornellEmpty { .. } | SceneKind::Custom { .. } => {
                return None;
            }
        };
        let (start, response) = match view {
            View::Probe => (Some(looks_at), 1.0),
            View::Irradiance => (None, PI),
        };
        let enclosure = Enclosure { patches };
        Some(ClosedForm { enclosure, start, response, spherical, estimator: *estimator })
    }

    /// The right value, whatever the estimator makes of it.
    pub fn truth(&self, channel: usize, counted: Counted) -> f64 {
        let on = |patch| self.enclosure.radiance(patch, channel, counted);
        let radiance = match self.start {
            Some(patch) => on(patch),
            None => self.enclosure.patches.iter().enumerate().map(|(i, p)| p.fraction * on(i)).sum(),
        };
        self.response * radiance
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
        if self.is_explicit() && !self.spherical {
            return None; // a light seen edge-on costs no shadow ray
        }
        let rays = Walk::new(&self.enclosure, &self.estimator)?.rays()?;
        Some(match self.start {
            Some(patch) => rays[patch],
            None => self.enclosure.patches.iter().zip(&rays).map(|(p, r)| p.fraction * r).sum(),
        })
    }

    /// Index of the power-law tail of one sample; the variance is infinite at or below 2.
    pub fn tail_index(&self, channel: usize) -> Option<f64> {
        if self.light_touches_walls() {
            return Some(1.5);
        }
        Walk::new(&self.enclosure, &self.estimator)?.tail_index(channel)
    }

    fn moments(&self, channel: usize, counted: Counted) -> Result<Central, Known> {
        if self.light_touches_walls() && counted != Counted::Only(0) {
            return Err(Known::Infinite);
        }
        if self.is_explicit() && !self.spherical {
            return Err(Known::Unknown);
        }
        let walk = Walk::new(&self.enclosure, &self.estimator).ok_or(Known::Unknown)?;
        let moments = walk.moments(channel, counted);
        let seen = self.start.map_or_else(|| self.enclosure.average(&moments), |patch| moments[patch]);
        Ok(seen.scaled(self.response))
    }

    fn is_explicit(&self) -> bool {
        matches!(self.estimator, Estimator::Explicit(_))
    }

    /// Light sampled over an area that adjoins the receiver's wall has a geometry term with tail index 3/2,
    /// averaged over receivers: infinite variance in every box.
    fn light_touches_walls(&self) -> bool {
        !self.spherical
            && matches!(&self.estimator, Estimator::Explicit(e) if e.lights == LightSampling::Area)
            && self.estimator.roulette().reaches(2)
    }
}
