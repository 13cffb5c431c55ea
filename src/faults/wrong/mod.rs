//! Means of faulty estimators that have a closed form.

mod exhibits;
mod gains;

use super::averaging::LIMIT;
use super::direct::Light;
use super::photon::{self, Density};
use super::slip::{Averaging, Emission, Ending, HIDDEN, Slip};
use super::survival::{DARK, Surviving};
use super::{Effect, Faulty};
use crate::estimator::{Estimate, Estimator, Property, Rule, Technique};
use crate::scene::library::{Patch, SceneKind, View};
use crate::scene::{Directions, LightSampling, Pick, Rgb, Shape};
use gains::Gains;

impl Faulty {
    /// The mean that it converges to [W m^-2 sr^-1], where there is a closed form. The right one, where its mistake
    /// changes nothing in this scene.
    pub fn wrong(&self, scene: &SceneKind, channel: usize) -> Option<f64> {
        if self.fault.effect != Effect::Mean || self.property() != Property::Unbiased {
            return None;
        }
        if let SceneKind::Exhibit { name, setting, .. } = scene {
            return exhibits::wrong(self, name, setting, scene, channel);
        }
        Closed::of(scene, &self.estimator)?.mean(self.fault.slip, channel)
    }
}

/// A closed scene in which a path is an independent sequence of patches, and the estimator in it.
struct Closed {
    /// Patches, with their shares of the area.
    patches: Vec<Patch>,
    /// The patch that is looked at.
    at: usize,
    /// Radius, if it is a sphere.
    radius: Option<f64>,
    technique: Technique,
    lights: LightSampling,
    directions: Directions,
    /// Probability of survival on each patch.
    q: Vec<f64>,
}

impl Closed {
    /// Nothing where the walk is no such sequence, or where roulette depends on more than the patch.
    fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let whole = |&albedo, &emission| vec![Patch { fraction: 1.0, albedo, emission }];
        let (patches, at, view, is_sphere) = match scene {
            SceneKind::Furnace { albedo, emission, view } => (whole(albedo, emission), 0, view, true),
            SceneKind::FurnaceBox { albedo, emission, view } => (whole(albedo, emission), 0, view, false),
            SceneKind::IntegratingSphere { patches, looks_at, view } => {
                (patches.clone(), *looks_at, view, true)
            }
            _ => return None,
        };
        let (technique, lights, directions) = match estimator {
            Estimator::Explicit(e) => (e.technique, e.lights, e.directions),
            Estimator::Implicit(e) => (Technique::Direction, LightSampling::AREA, e.directions),
            Estimator::Recursive(_) | Estimator::LightTracing(_) | Estimator::PhotonMap(_) => return None,
        };
        let roulette = estimator.roulette();
        let simple = roulette.from == 0 && !matches!(roulette.rule, Rule::None | Rule::Throughput { .. });
        // uniform directions do not meet points of a sphere uniformly, which matters where its patches differ
        let mixes = directions == Directions::Cosine
            || patches.len() == 1 && !matches!(technique, Technique::Both(_));
        if *view != View::Probe || !simple || !mixes || !is_sphere && technique.samples_lights() {
            return None;
        }
        let radius = match scene.build().surfaces()[0].shape {
            Shape::Sphere(s) => Some(s.radius),
            _ => None,
        };
        let q = patches.iter().map(|p| roulette.q(0, Rgb::ONE, p.albedo)).collect();
        Some(Closed { patches, at, radius, technique, lights, directions, q })
    }

    /// The material of a furnace.
    fn only(&self) -> Option<&Patch> {
        (self.patches.len() == 1).then(|| &self.patches[0])
    }

    fn mean(&self, slip: Slip, channel: usize) -> Option<f64> {
        match slip {
            Slip::Ending(Ending::Hidden) => Some(self.limited(channel)),
            Slip::Emission(Emission::WithoutThroughput) => self.unweighted(channel),
            Slip::Light(Light::Stale) => self.stale(channel),
            Slip::Surviving(Surviving::DarkEnds) => self.dark_ends(channel),
            Slip::Averaging(Averaging::Clamped) => self.clamped(channel),
            Slip::Density(density) => self.photons(density, channel),
            _ => Gains::of(self, slip, channel)?.mean(self, channel),
        }
    }

    /// Average over the area.
    fn average(&self, value: impl Fn(usize) -> f64) -> f64 {
        (0..self.patches.len()).map(|i| self.patches[i].fraction * value(i)).sum()
    }

    fn albedo(&self, channel: usize) -> impl Fn(usize) -> f64 {
        move |i| self.patches[i].albedo[channel]
    }

    fn le(&self, channel: usize) -> impl Fn(usize) -> f64 {
        move |i| self.patches[i].emission[channel]
    }

    /// The probability that light sampling picks patch `i`.
    fn pmf(&self, i: usize) -> f64 {
        let power = |i: usize| self.patches[i].fraction * self.patches[i].emission.element_sum();
        let emits = (0..self.patches.len()).filter(|&i| power(i) > 0.0);
        match self.lights.pick {
            Pick::Power => power(i) / emits.map(power).sum::<f64>(),
            Pick::Uniform if power(i) > 0.0 => 1.0 / emits.count() as f64,
            Pick::Uniform => 0.0,
        }
    }

    /// Light of at most [`HIDDEN`] bounces.
    fn limited(&self, channel: usize) -> f64 {
        let (albedo, le) = (self.albedo(channel), self.le(channel));
        let bounces = (0..HIDDEN).scan(1.0, |power, _| {
            let this = *power;
            *power *= self.average(&albedo);
            Some(this)
        });
        le(self.at) + albedo(self.at) * self.average(&le) * bounces.sum::<f64>()
    }

    /// Every vertex adds its emission, whatever came before.
    fn unweighted(&self, channel: usize) -> Option<f64> {
        let (q, le) = (|i: usize| self.q[i], self.le(channel));
        let known = self.technique == Technique::Direction && self.average(q) < 1.0;
        known.then(|| le(self.at) + q(self.at) * self.average(&le) / (1.0 - self.average(q)))
    }

    /// Sampled light is reflected with the albedo of the vertex before: R_ij = rho_i E0 + rho_j <R_j.>.
    fn stale(&self, channel: usize) -> Option<f64> {
        let (albedo, le) = (self.albedo(channel), self.le(channel));
        let (lit, here) = (self.average(&le), albedo(self.at));
        let later = self.average(|i| albedo(i) * albedo(i)) * lit / (1.0 - self.average(&albedo));
        let known = self.technique == Technique::Light;
        known.then(|| le(self.at) + here * lit + here * (here * lit + later))
    }

    /// Throughput falls as (rho / q)^k in a furnace, and the walk ends where it is dark.
    fn dark_ends(&self, channel: usize) -> Option<f64> {
        let (patch, q) = (self.only()?, self.q[0]);
        let sampled = match self.technique {
            Technique::Direction => 0,
            Technique::Light => 1,
            Technique::Both(_) => return None,
        };
        let (mut throughput, mut last) = (patch.albedo.max_element(), 0);
        let fall = throughput / q;
        if self.directions != Directions::Cosine || fall >= 1.0 {
            return None;
        }
        while throughput >= DARK {
            (throughput, last) = (throughput * fall, last + 1);
        }
        let albedo = patch.albedo[channel];
        let bounces = (0..=last + sampled).scan(1.0, |power, _| {
            let this = *power;
            *power *= albedo;
            Some(this)
        });
        Some(patch.emission[channel] * bounces.sum::<f64>())
    }

    /// A path of k vertices, which has the probability q^(k-1) (1 - q), brings Le ((rho/q)^k - 1) / (rho/q - 1).
    fn clamped(&self, channel: usize) -> Option<f64> {
        let (patch, q) = (self.only()?, self.q[0]);
        if self.technique != Technique::Direction || self.directions != Directions::Cosine || q >= 1.0 {
            return None;
        }
        let (mut mean, mut probability, mut value, mut term) = (0.0, 1.0 - q, 0.0, patch.emission[channel]);
        while probability > 1e-18 {
            value += term;
            mean += probability * value.min(LIMIT);
            (probability, term) = (probability * q, term * patch.albedo[channel] / q);
        }
        Some(mean)
    }

    fn photons(&self, density: Density, channel: usize) -> Option<f64> {
        self.radius?;
        let (albedo, le) = (self.albedo(channel), self.le(channel));
        let (emitted, reflects) = (le(self.at), albedo(self.at));
        let reflected = reflects * self.average(&le) / (1.0 - self.average(&albedo));
        match density {
            Density::Sound => None,
            Density::NoEmission => Some(reflected),
            Density::Undivided => Some(emitted + reflected * f64::from(photon::SENT)),
            // the mean cosine of light that comes from everywhere alike
            Density::Cosine => self.only().map(|_| emitted + reflected * (2.0 / 3.0)),
            Density::ByStored => self.only().map(|patch| {
                // one of the photon's n visits is near with the same probability for each; visit k has the weight
                // ratio^k, and the mean of their average over n is a logarithm
                let q = patch.albedo.max_element();
                let ratio = reflects / q;
                let average = if ratio == 1.0 {
                    1.0
                } else {
                    (1.0 - q) / (q * (1.0 - ratio)) * libm::log((1.0 - reflects) / (1.0 - q))
                };
                emitted + reflects * emitted * average
            }),
        }
    }
}
