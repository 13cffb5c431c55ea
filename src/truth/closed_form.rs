//! What theory says of one estimator in one scene: mean, central moments and cost, per channel and per bounce.

use super::Known;
use super::enclosure::{Counted, Enclosure, Walk};
use super::gallery::{self, Series};
use super::moments::Central;
use crate::estimator::{Estimate, Estimator, Property, Technique};
use crate::scene::library::{Patch, SceneKind, View};
use crate::scene::{Points, Rgb};
use std::f64::consts::PI;

/// Closed forms for one estimator in one scene, per channel and per bounce.
pub struct ClosedForm {
    theory: Theory,
    estimator: Estimator,
}

/// Where light goes.
enum Theory {
    /// Among patches.
    Enclosure {
        enclosure: Enclosure,
        /// The patch that a probe looks at; `None` for a plate, which sees all of them.
        start: Option<usize>,
        /// π for a plate, 1 for a probe.
        response: f64,
        /// Whether next-event estimation has a constant geometry term, as on a sphere.
        spherical: bool,
    },
    /// From lights to where one looks.
    Series {
        series: Series,
        /// Variance of one sample, where known.
        variance: Option<Rgb>,
        /// What this estimator has no way to find.
        missed: Option<Series>,
    },
}

impl ClosedForm {
    /// The closed forms of `estimator` in `scene`, or `None` where the scene has none.
    pub fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let single = |albedo: Rgb, emission: Rgb| vec![Patch { fraction: 1.0, albedo, emission }];
        let theory = match scene {
            SceneKind::Furnace { albedo, emission, view } => {
                enclosure(single(*albedo, *emission), 0, *view, true)
            }
            SceneKind::FurnaceBox { albedo, emission, view } => {
                enclosure(single(*albedo, *emission), 0, *view, false)
            }
            SceneKind::IntegratingSphere { patches, looks_at, view } => {
                enclosure(patches.clone(), *looks_at, *view, true)
            }
            SceneKind::Exhibit { name, parameter, .. } => {
                let exhibit = gallery::find(name)?;
                Theory::Series {
                    series: (exhibit.theory)(*parameter),
                    missed: (exhibit.missed)(*parameter, estimator),
                    variance: (exhibit.variance)(*parameter, estimator),
                }
            }
            SceneKind::CornellBox { .. }
            | SceneKind::CornellEmpty { .. }
            | SceneKind::CornellFlush { .. }
            | SceneKind::Custom { .. } => return None,
        };
        Some(ClosedForm { theory, estimator: *estimator })
    }

    /// The right value, whatever the estimator makes of it.
    pub fn truth(&self, channel: usize, counted: Counted) -> f64 {
        match &self.theory {
            Theory::Series { series, .. } => series.sum(counted)[channel],
            Theory::Enclosure { enclosure, start, response, .. } => {
                let on = |patch| enclosure.radiance(patch, channel, counted);
                let radiance = match start {
                    Some(patch) => on(*patch),
                    None => enclosure.patches.iter().enumerate().map(|(i, p)| p.fraction * on(i)).sum(),
                };
                response * radiance
            }
        }
    }

    /// The mean of this estimator: the right value less what it never finds and what a clamp leaves out.
    pub fn expected(&self, channel: usize, counted: Counted) -> f64 {
        let Property::Clamped { bounces } = self.estimator.property() else {
            return self.found(channel, counted);
        };
        let left_out = match counted {
            Counted::Only(k) if k <= bounces => 0.0,
            Counted::Only(k) => self.found(channel, Counted::Only(k)),
            Counted::All => self.found(channel, Counted::From(bounces + 1)),
            Counted::From(k) => self.found(channel, Counted::From(k.max(bounces + 1))),
        };
        self.found(channel, counted) - left_out
    }

    /// The right value less what this estimator has no way to find.
    fn found(&self, channel: usize, counted: Counted) -> f64 {
        let missed = match &self.theory {
            Theory::Series { missed: Some(missed), .. } => missed.sum(counted)[channel],
            _ => 0.0,
        };
        self.truth(channel, counted) - missed
    }

    /// The central moment of the given order (2, 3 or 4) of one sample.
    pub fn central(&self, channel: usize, counted: Counted, order: usize) -> Known {
        if let Theory::Series { variance, .. } = &self.theory {
            let mean = self.expected(channel, counted);
            return match variance {
                // contributions are not negative: a mean of zero leaves no room for any
                _ if mean == 0.0 => Known::Value(0.0),
                Some(v)
                    if mean == self.expected(channel, Counted::All) && (order == 2 || v[channel] == 0.0) =>
                {
                    Known::Value(v[channel])
                }
                _ => Known::Unknown,
            };
        }
        match self.moments(channel, counted) {
            Err(known) => known,
            Ok(moments) => moments.finite_moment(order).map_or(Known::Infinite, Known::Value),
        }
    }
    /// Skewness of one sample, where finite and known; 0 for a constant.
    pub fn skewness(&self, channel: usize, counted: Counted) -> Option<f64> {
        let variance = self.central(channel, counted, 2).value()?;
        if variance == 0.0 {
            return Some(0.0);
        }
        let third = self.central(channel, counted, 3).value()?;
        Some(third / (variance * variance.sqrt()))
    }

    /// Expected rays a realization, where known.
    pub fn rays(&self) -> Option<f64> {
        let Theory::Enclosure { enclosure, start, spherical, .. } = &self.theory else { return None };
        if self.estimator.samples_lights() && !spherical {
            return None; // a light seen edge-on costs no shadow ray
        }
        let rays = Walk::new(enclosure, &self.estimator)?.rays()?;
        Some(match start {
            Some(patch) => rays[*patch],
            None => enclosure.patches.iter().zip(&rays).map(|(p, r)| p.fraction * r).sum(),
        })
    }

    /// Index of the power-law tail of one sample; the variance is infinite at or below 2.
    pub fn tail_index(&self, channel: usize) -> Option<f64> {
        if self.light_touches_walls() {
            return Some(1.5);
        }
        let Theory::Enclosure { enclosure, .. } = &self.theory else { return None };
        Walk::new(enclosure, &self.estimator)?.tail_index(channel)
    }

    fn moments(&self, channel: usize, counted: Counted) -> Result<Central, Known> {
        let Theory::Enclosure { enclosure, start, response, spherical } = &self.theory else {
            return Err(Known::Unknown);
        };
        if self.light_touches_walls() && counted != Counted::Only(0) {
            return Err(Known::Infinite);
        }
        if self.estimator.samples_lights() && !spherical {
            return Err(Known::Unknown);
        }
        let walk = Walk::new(enclosure, &self.estimator).ok_or(Known::Unknown)?;
        let moments = walk.moments(channel, counted);
        let seen = start.map_or_else(|| enclosure.average(&moments), |patch| moments[patch]);
        Ok(seen.scaled(*response))
    }

    /// Light sampled over an area that adjoins the receiver's wall has a geometry term with tail index 3/2,
    /// averaged over receivers: infinite variance in every box.
    fn light_touches_walls(&self) -> bool {
        let Theory::Enclosure { spherical: false, .. } = self.theory else { return false };
        matches!(&self.estimator, Estimator::Explicit(e) if e.technique == Technique::Light && e.lights.points == Points::Area)
            && self.estimator.roulette().reaches(2)
    }
}

fn enclosure(patches: Vec<Patch>, looks_at: usize, view: View, spherical: bool) -> Theory {
    let (start, response) = match view {
        View::Probe => (Some(looks_at), 1.0),
        View::Irradiance => (None, PI),
    };
    Theory::Enclosure { enclosure: Enclosure { patches }, start, response, spherical }
}
