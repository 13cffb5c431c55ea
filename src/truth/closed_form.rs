//! What theory says of one estimator in one scene: mean, central moments and cost, per channel and per bounce.

mod photons;

use super::enclosure::{Counted, Enclosure, Wall, average};
use super::gallery::{self, Series, Tail};
use super::moments::Central;
use super::walk::Walk;
use super::{After, Known};
use crate::estimator::{Estimator, Rule, Technique};
use crate::scene::library::{Patch, SceneKind, Setting, View};
use crate::scene::{Points, Rgb, Sensor};
use photons::Density;
use std::f64::consts::PI;

/// Closed forms for one estimator in one scene, per channel and per bounce.
pub struct ClosedForm {
    theory: Theory,
    estimator: Estimator,
    /// What is known of it as a photon map.
    density: Option<Density>,
}

/// Where light goes.
enum Theory {
    /// Among patches.
    Enclosure {
        enclosure: Enclosure,
        /// With which probability the first ray meets each patch: one of them for a probe, all of them for a plate.
        seen: Vec<f64>,
        /// π for a plate, 1 for a probe.
        response: f64,
        /// How sampled lights scatter.
        tail: Tail,
    },
    /// From lights to where one looks.
    Series {
        series: Series,
        /// What this estimator has no way to find.
        missed: Option<Series>,
        /// Variance of one sample, where known.
        variance: Option<Rgb>,
        /// Bounces below this one have no noise.
        steady: u32,
    },
}

impl ClosedForm {
    /// The closed forms of `estimator` in `scene`, or `None` where the scene has none.
    pub fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let whole = |albedo, emission| [Patch { fraction: 1.0, albedo, emission }];
        let is_map = matches!(estimator, Estimator::PhotonMap(_));
        let theory = match scene {
            SceneKind::Furnace { albedo, emission, view } => {
                among(Enclosure::sphere(&whole(*albedo, *emission)), 0, *view, Tail::None)
            }
            SceneKind::FurnaceBox { albedo, emission, view } => {
                // emitters adjoin what they light: index 3/2, averaged over receivers, in every box
                among(
                    Enclosure::furnace(Wall { albedo: *albedo, le: *emission }),
                    0,
                    *view,
                    Tail::ByArea(1.5),
                )
            }
            SceneKind::IntegratingSphere { patches, looks_at, view } => {
                among(Enclosure::sphere(patches), *looks_at, *view, Tail::None)
            }
            SceneKind::Exhibit { name, parameter, setting } => match &gallery::find(name)?.theory {
                gallery::Theory::Series { mean, missed, variance } => Theory::Series {
                    series: mean(*parameter),
                    // photons land wherever light does
                    missed: if is_map { None } else { missed(*parameter, estimator) },
                    variance: estimator.is_path_tracer().then(|| variance(*parameter, estimator)).flatten(),
                    steady: steady(setting, estimator),
                },
                gallery::Theory::Chain { enclosure, looks_at, tail } => {
                    among(enclosure(*parameter), *looks_at, View::Probe, *tail)
                }
            },
            SceneKind::CornellBox { .. }
            | SceneKind::CornellEmpty { .. }
            | SceneKind::CornellFlush { .. }
            | SceneKind::ManySpheres { .. }
            | SceneKind::Lecture(_)
            | SceneKind::Custom { .. } => return None,
        };
        Some(ClosedForm { theory, estimator: *estimator, density: Density::of(scene, estimator) })
    }

    /// The right value, whatever the estimator makes of it.
    pub fn truth(&self, channel: usize, counted: Counted) -> f64 {
        match &self.theory {
            Theory::Series { series, .. } => series.sum(counted)[channel],
            Theory::Enclosure { enclosure, seen, response, .. } => {
                let radiance: Vec<f64> =
                    (0..seen.len()).map(|patch| enclosure.radiance(patch, channel, counted)).collect();
                response * average(seen, &radiance)
            }
        }
    }

    /// The mean of this estimator: the right value less what it never finds and what a clamp leaves out.
    pub fn expected(&self, channel: usize, counted: Counted) -> f64 {
        let Some(bounces) = self.estimator.roulette().clamp else {
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

    /// The mean of this estimator, also where it blurs what it sees; `None` where nobody knows by how much.
    pub fn mean(&self, channel: usize, counted: Counted) -> Option<f64> {
        match self.estimator {
            Estimator::PhotonMap(_) => self.blurred(channel, counted),
            _ => Some(self.expected(channel, counted)),
        }
    }

    /// The mean of a density estimate, which blurs what it sees: of all maps that make one picture.
    pub fn blurred(&self, channel: usize, counted: Counted) -> Option<f64> {
        self.blurred_after(self.density.as_ref()?.passes(), channel, counted)
    }

    /// The same of the first `passes` maps.
    fn blurred_after(&self, passes: u64, channel: usize, counted: Counted) -> Option<f64> {
        let [direct, rest] = self.density.as_ref()?.factors(passes)?;
        let of = |counted| self.expected(channel, counted);
        let once = direct * of(Counted::Only(1));
        Some(match counted {
            _ if direct == 1.0 && rest == 1.0 => of(counted),
            Counted::Only(0) => of(counted),
            Counted::Only(1) => once,
            Counted::All | Counted::From(0) => of(Counted::Only(0)) + once + rest * of(Counted::From(2)),
            Counted::From(1) => once + rest * of(Counted::From(2)),
            Counted::Only(_) | Counted::From(_) => rest * of(counted),
        })
    }

    /// What the mean of the first `n` realizations is like: of a picture whose passes differ, the first n of them.
    pub fn after(&self, channel: usize, n: u64) -> After {
        let expected = match &self.density {
            None => Some(self.expected(channel, Counted::All)),
            Some(_) => self.blurred_after(n, channel, Counted::All),
        };
        let variance = match &self.density {
            Some(density) => density.variance_after(n, channel),
            None => match self.central(channel, Counted::All, 2) {
                Known::Value(variance) => Known::Value(variance / n as f64),
                other => other,
            },
        };
        After { bias: expected.map(|mean| mean - self.truth(channel, Counted::All)), variance }
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
        if let Some(density) = &self.density {
            return density.central(channel, counted, order);
        }
        if let Theory::Series { variance, steady, .. } = &self.theory {
            let mean = self.expected(channel, counted);
            return match variance {
                // contributions are not negative: a mean of zero leaves no room for any
                _ if mean == 0.0 || is_below(counted, *steady) => Known::Value(0.0),
                Some(v) if v[channel] == f64::INFINITY && counted == Counted::All => Known::Infinite,
                Some(v)
                    if mean == self.expected(channel, Counted::All) && (order == 2 || v[channel] == 0.0) =>
                {
                    Known::Value(v[channel])
                }
                _ => Known::Unknown,
            };
        }
        // one ray into a scene at rest sees what is there
        let one_ray = |seen: &[f64]| seen.contains(&1.0);
        if let Theory::Enclosure { seen, .. } = &self.theory
            && one_ray(seen)
            && is_below(counted, 1)
        {
            return Known::Value(0.0);
        }
        match self.moments(channel, counted) {
            // roulette alone can make it infinite, whatever the lights do
            Err(Known::Unknown)
                if counted == Counted::All && self.tail_index(channel).is_some_and(|t| t <= order as f64) =>
            {
                Known::Infinite
            }
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

    /// Expected rays a realization, where known and finite.
    pub fn rays(&self) -> Option<f64> {
        if let Some(density) = &self.density {
            return density.rays();
        }
        let Theory::Enclosure { enclosure, seen, .. } = &self.theory else { return None };
        let rays = average(seen, &Walk::new(enclosure, &self.estimator)?.rays()?);
        rays.is_finite().then_some(rays)
    }

    /// Probabilities of 0, 1, ... `most` rays a realization, where known.
    pub fn lengths(&self, most: usize) -> Option<Vec<f64>> {
        let Theory::Enclosure { enclosure, seen, .. } = &self.theory else { return None };
        Walk::new(enclosure, &self.estimator)?.lengths(seen, most)
    }

    /// Whether every realization traces the same number of rays: nothing ends a walk but its clamp.
    pub fn rays_are_certain(&self) -> bool {
        let Theory::Enclosure { enclosure, .. } = &self.theory else { return false };
        self.estimator.roulette().rule == Rule::None && enclosure.never_absorbs()
    }

    /// Index of the power-law tail of one sample; the variance is infinite at or below 2.
    pub fn tail_index(&self, channel: usize) -> Option<f64> {
        if let Some(index) = self.tail_of_lights() {
            return Some(index);
        }
        let Theory::Enclosure { enclosure, seen, .. } = &self.theory else { return None };
        let on_patches = Walk::new(enclosure, &self.estimator)?.tail_index(channel);
        let seen = on_patches.into_iter().zip(seen).filter(|(_, p)| **p > 0.0);
        seen.filter_map(|(alpha, _)| alpha).min_by(f64::total_cmp)
    }

    fn moments(&self, channel: usize, counted: Counted) -> Result<Central, Known> {
        if self.tail_of_lights().is_some() && counted != Counted::Only(0) {
            return Err(Known::Infinite);
        }
        let Theory::Enclosure { enclosure, seen, response, .. } = &self.theory else {
            return Err(Known::Unknown);
        };
        let walk = Walk::new(enclosure, &self.estimator).ok_or(Known::Unknown)?;
        let moments = walk.moments(channel, counted).ok_or(Known::Unknown)?;
        Ok(Central::mixture(seen.iter().copied().zip(moments)).scaled(*response))
    }

    /// Index of the tail that sampled lights bring, of all bounces but emission seen directly.
    fn tail_of_lights(&self) -> Option<f64> {
        let (Theory::Enclosure { tail, .. }, Estimator::Explicit(e)) = (&self.theory, &self.estimator) else {
            return None;
        };
        let by_area = e.lights.points == Points::Area;
        match tail {
            // multiple importance sampling bounds the weights
            _ if e.technique != Technique::Light || !e.roulette.reaches(2) => None,
            Tail::Always(index) => Some(*index),
            Tail::ByArea(index) if by_area => Some(*index),
            Tail::ByArea(_) | Tail::None => None,
        }
    }
}

fn among(enclosure: Enclosure, looks_at: usize, view: View, tail: Tail) -> Theory {
    let probe = |patch| if patch == looks_at { 1.0 } else { 0.0 };
    let (seen, response) = match view {
        View::Probe => ((0..enclosure.patches().len()).map(probe).collect(), 1.0),
        View::Irradiance => (enclosure.seen_from(looks_at).to_vec(), PI),
    };
    Theory::Enclosure { enclosure, seen, response, tail }
}

/// Whether only one bounce counts, and it comes before `bounce`.
fn is_below(counted: Counted, bounce: u32) -> bool {
    matches!(counted, Counted::Only(k) if k < bounce)
}

/// The first bounce with noise: what one ray into a scene at rest sees directly has none, nor has light that one point
/// sends to what it sees, where it is sampled.
fn steady(setting: &Setting, estimator: &Estimator) -> u32 {
    let one_ray = matches!(setting.sensor, Sensor::Probe { .. }) && setting.is_at_rest();
    let dark = setting.sky.is_none() && setting.primitives.iter().all(|p| p.material.le == Rgb::ZERO);
    match (one_ray, dark && setting.points.len() == 1 && estimator.samples_lights()) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => 2,
    }
}
