//! Mistakes that multiply: emission, sampled light and continuations each gain a factor, and radiance follows.

use super::Closed;
use crate::estimator::{Heuristic, Technique};
use crate::faults::direct::{Light, Shadow};
use crate::faults::mis::{SCALE, Weighting};
use crate::faults::scatter::Scattering;
use crate::faults::slip::{Emission, Slip};
use crate::faults::survival::{LEVELS, Surviving};
use crate::scene::{Directions, Rgb};
use std::f64::consts::PI;

/// What light gains by a mistake; all are 1 or the weight of a technique without one.
pub struct Gains {
    /// Emission that the camera sees.
    seen: f64,
    /// Emission of patch i that is hit later.
    hit: Vec<f64>,
    /// Sampled light of patch i.
    light: Vec<f64>,
    /// Continuation on patch i.
    go: Vec<f64>,
    /// Albedo of patch i.
    albedo: Vec<f64>,
}

impl Gains {
    /// The gains of a mistake, where they are constants.
    pub fn of(scene: &Closed, slip: Slip, channel: usize) -> Option<Self> {
        let n = scene.patches.len();
        let each = |value: &dyn Fn(usize) -> f64| (0..n).map(value).collect::<Vec<f64>>();
        let weight = |i: usize| weights(scene, slip, i);
        let mut gains = Gains {
            seen: 1.0,
            hit: each(&|i| weight(i).0),
            light: each(&|i| weight(i).1),
            go: vec![1.0; n],
            albedo: each(&scene.albedo(channel)),
        };
        if let Some(surviving) = slip.surviving() {
            gains.go = (0..n).map(|i| survival(scene, surviving, i)).collect::<Option<_>>()?;
        }
        if let Some(emission) = slip.emission() {
            gains.emission(scene, emission);
        }
        match slip {
            Slip::Sound | Slip::Emission(_) | Slip::Surviving(_) | Slip::Printed => {}
            Slip::Scattering(slip) => gains.go = vec![scattering(scene, slip)?],
            Slip::Light(slip) => {
                let factor: Vec<f64> = (0..n).map(|i| light(scene, slip, i)).collect::<Option<_>>()?;
                gains.light.iter_mut().zip(factor).for_each(|(gain, factor)| *gain *= factor);
            }
            Slip::Shadow(Shadow::MeetsLight | Shadow::NoEnd) => gains.light = vec![0.0; n],
            Slip::Shadow(Shadow::None) => {}
            Slip::Weighting(Weighting::Scaled | Weighting::PointShared) => {}
            Slip::Weighting(Weighting::RouletteOnce) if scene.q.iter().all(|q| *q == scene.q[0]) => {}
            Slip::Weighting(Weighting::PerAreaOnce) => gains.light = vec![per_area_once(scene)?],
            _ => return None,
        }
        Some(gains)
    }

    fn emission(&mut self, scene: &Closed, slip: Emission) {
        let n = scene.patches.len();
        match slip {
            Emission::Twice => self.hit = vec![1.0; n],
            Emission::NotAtCamera => self.seen = 0.0,
            Emission::Never => (self.seen, self.hit) = (0.0, vec![0.0; n]),
            Emission::Ends => {
                let emits = |i: usize| scene.patches[i].emission != Rgb::ZERO;
                (0..n).filter(|&i| emits(i)).for_each(|i| self.albedo[i] = 0.0);
            }
            // there is no mirror
            Emission::NotAfterMirror | Emission::SeenFromFirst => {}
            Emission::WithoutThroughput => unreachable!("no factor makes up for it"),
        }
    }

    /// R_j = rho_j (sampled + go_j (hit + <R>)), averaged and solved for <R>.
    pub fn mean(&self, scene: &Closed, channel: usize) -> Option<f64> {
        let le = scene.le(channel);
        let sampled = scene.average(|i| self.light[i] * le(i));
        let hit = scene.average(|i| self.hit[i] * le(i));
        let go = scene.average(|i| self.go[i] * self.albedo[i]);
        let reflected = (scene.average(|i| self.albedo[i]) * sampled + go * hit) / (1.0 - go);
        let at = scene.at;
        let mean = self.seen * le(at) + self.albedo[at] * (sampled + self.go[at] * (hit + reflected));
        (go < 1.0).then_some(mean)
    }
}

/// Weights of emission that is hit and of sampled light. Inside a sphere the densities of the two techniques have the
/// same ratio everywhere.
fn weights(scene: &Closed, slip: Slip, i: usize) -> (f64, f64) {
    let Technique::Both(heuristic) = scene.technique else {
        let sampled = scene.technique == Technique::Light;
        return (f64::from(u8::from(!sampled)), f64::from(u8::from(sampled)));
    };
    let ratio = scene.pmf(i) / scene.patches[i].fraction; // light over direction
    if ratio == 0.0 {
        return (1.0, 0.0); // it does not emit
    }
    let share = |other_over_own: f64| match heuristic {
        Heuristic::Balance => 1.0 / (1.0 + other_over_own),
        Heuristic::Power => 1.0 / (1.0 + other_over_own * other_over_own),
    };
    let scale = if slip == Slip::Weighting(Weighting::Scaled) { SCALE } else { 1.0 };
    let q = if slip == Slip::Weighting(Weighting::RouletteOnce) { scene.q[0] } else { 1.0 };
    (share(ratio / q), share(scale / ratio))
}

fn survival(scene: &Closed, slip: Surviving, i: usize) -> Option<f64> {
    let (q, albedo) = (scene.q[i], scene.patches[i].albedo.max_element());
    let open = q > 0.0 && q < 1.0;
    match slip {
        Surviving::NotWeighted => Some(q),
        Surviving::PrintedByAlbedo => Some(albedo / (1.0 - albedo)),
        Surviving::Complement | Surviving::Flipped | Surviving::Printed | Surviving::Inclusive if !open => {
            Some(1.0)
        }
        Surviving::Complement => Some(q / (1.0 - q)),
        Surviving::Flipped | Surviving::Printed => Some((1.0 - q) / q),
        Surviving::Inclusive => Some(((q * LEVELS).floor() + 1.0) / (q * LEVELS)),
        _ => None,
    }
}

/// In a furnace: what comes back does not depend on the direction, so that the mean of the weight is enough.
fn scattering(scene: &Closed, slip: Scattering) -> Option<f64> {
    scene.only()?;
    let cosine = scene.directions == Directions::Cosine;
    match (slip, scene.technique) {
        (_, Technique::Both(_)) => None,
        (Scattering::LightsCosine, Technique::Light) => Some(4.0 / 3.0),
        (Scattering::LightsCosine, _) => Some(1.0),
        (Scattering::WithoutCosine, _) => Some(2.0),
        (Scattering::CosineAsUniform, _) => Some(4.0 / 3.0),
        (Scattering::UniformAsCosine | Scattering::AngleAsCosine, _) => Some(1.0),
        (Scattering::AngleAsUniform, _) => Some(4.0 / PI),
        (Scattering::CoarseDropped, _) => Some(if cosine { 255.0 / 256.0 } else { 1.0 }),
        (Scattering::EveryOther, _) => Some(1.0),
        (Scattering::Coarse, _) => None,
    }
}

fn light(scene: &Closed, slip: Light, i: usize) -> Option<f64> {
    if !scene.technique.samples_lights() {
        return Some(1.0);
    }
    let emitters = scene.patches.iter().filter(|p| p.emission != Rgb::ZERO).count();
    // from any point of a sphere, points uniform over it have the mean 2 of 1/cos and 2 R² of d²
    match slip {
        Light::NoCosine | Light::NoCosineAtLight => scene.only().map(|_| 2.0),
        Light::NoDistance => scene.only().and(scene.radius).map(|r| 2.0 * r * r),
        Light::NoPi => Some(PI),
        Light::NoChoice => Some(scene.pmf(i)),
        Light::UniformChoice => Some(scene.pmf(i) * emitters as f64),
        Light::Outward => Some(0.0),
        Light::DiskRadius | Light::SkyTurned | Light::SkyExponent | Light::ShutterOpens => Some(1.0),
        Light::Swapped => Some(1.0),
        Light::Stale => None,
    }
}

/// The mean over 2 cos dcos of b / (b + cos), the weight of sampled light where the density per area, 1/(4 π R²),
/// stands for that per solid angle; b = 1/(4 R²).
fn per_area_once(scene: &Closed) -> Option<f64> {
    scene.only()?;
    let radius = scene.radius?;
    let b = 1.0 / (4.0 * radius * radius);
    match scene.technique {
        Technique::Both(Heuristic::Balance) => Some(2.0 * b * (1.0 - b * libm::log((1.0 + b) / b))),
        Technique::Both(Heuristic::Power) => None,
        Technique::Light => Some(1.0),
        Technique::Direction => Some(0.0),
    }
}
