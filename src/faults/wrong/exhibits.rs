//! Wrong means in scenes of the gallery.

use crate::estimator::{Estimator, Explicit, Heuristic, Technique};
use crate::faults::Faulty;
use crate::faults::direct::{EXPONENT, Facing, Light, Shadow};
use crate::faults::mis::Weighting;
use crate::faults::scatter::Scattering;
use crate::faults::slip::{Emission, Slip};
use crate::scene::library::{SceneKind, Setting};
use crate::scene::{Bsdf, Directions, Rgb, Shape, Sky};
use crate::truth::direct::form_factor;
use crate::truth::{ClosedForm, Counted};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// The mean in the exhibit `name`, where it is known.
pub fn wrong(
    faulty: &Faulty,
    name: &str,
    setting: &Setting,
    scene: &SceneKind,
    channel: usize,
) -> Option<f64> {
    let slip = faulty.fault.slip;
    let expected = |counted| Some(ClosedForm::of(scene, &faulty.estimator)?.expected(channel, counted));
    let sampled = |technique: fn(Technique) -> bool| match faulty.estimator {
        Estimator::Explicit(e) if technique(e.technique) => Some(e),
        _ => None,
    };
    match (name, slip) {
        ("mirror_light" | "metal_light", Slip::Emission(Emission::SeenFromFirst)) => {
            expected(Counted::Only(1))
        }
        ("mirror_light" | "metal_light", Slip::Emission(Emission::NotAfterMirror)) => {
            sampled(Technique::samples_lights)?;
            expected(Counted::Only(1))
        }
        ("clear_slab", Slip::Scattering(Scattering::EveryOther)) => {
            // reflectance 1/2 at each face: 1/3 of the light goes through
            let [behind, before] = [2, 3].map(|i| setting.primitives[i].material.le[channel]);
            Some(behind / 3.0 + before * 2.0 / 3.0)
        }
        ("disk_light" | "sky_over_plane", Slip::Scattering(slip)) => {
            by_chance(&faulty.estimator)?;
            mistaken_directions(slip, setting, channel)
        }
        ("point_over_plane", slip) => {
            let factor = mistaken_point(slip, &sampled(Technique::samples_lights)?, setting)?;
            Some(factor * expected(Counted::All)?)
        }
        _ => {
            sampled(|technique| technique == Technique::Light)?;
            mistaken_light(slip, name, setting, expected(Counted::All)?, channel)
        }
    }
}

/// Where all light is sampled.
fn mistaken_light(slip: Slip, name: &str, setting: &Setting, right: f64, channel: usize) -> Option<f64> {
    match (name, slip) {
        ("hidden_light", Slip::Shadow(Shadow::None)) => {
            let (p, n, scale) = floor(setting, channel);
            Some(scale * form_factor::polygon(p, n, &setting.primitives[1].shape.corners()))
        }
        ("turned_light", Slip::Facing(Facing::LightBehind)) => {
            let Shape::Disk(turned) = setting.primitives[2].shape else { return None };
            let (p, n, _) = floor(setting, channel);
            let (height, offset) = (n.dot(turned.center - p), n.cross(turned.center - p).length());
            let le = albedo(setting)[channel] * setting.primitives[2].material.le[channel];
            Some(right + le * form_factor::disk_parallel(offset, height, turned.radius))
        }
        ("disk_light", Slip::Light(slip)) => {
            let (height, radius) = disk(setting)?;
            Some(floor(setting, channel).2 * mistaken_disk(slip, radius / height, height)?)
        }
        ("rising_light", Slip::Light(Light::ShutterOpens)) => {
            let (height, radius) = disk(setting)?;
            let s = radius / height;
            Some(floor(setting, channel).2 * s * s / (1.0 + s * s))
        }
        ("sky_over_plane", Slip::Light(Light::SkyExponent)) => {
            let Some(Sky::Cosine { radiance, exponent: n, .. }) = setting.sky else { return None };
            let m = n + EXPONENT;
            let albedo = albedo(setting)[channel];
            Some(2.0 * albedo * radiance[channel] * (n + 1.0) / ((m + 1.0) * (2.0 * n - m + 2.0)))
        }
        _ => None,
    }
}

/// Whether directions find all of the light.
fn by_chance(estimator: &Estimator) -> Option<()> {
    match estimator {
        Estimator::Implicit(_) => Some(()),
        Estimator::Explicit(e) if e.technique == Technique::Direction => Some(()),
        _ => None,
    }
}

/// Weighted as if by the cosine, light counts by the share of the directions that it really has.
fn mistaken_directions(slip: Scattering, setting: &Setting, channel: usize) -> Option<f64> {
    if let Some(Sky::Cosine { radiance, exponent, .. }) = setting.sky {
        let uniform = slip == Scattering::UniformAsCosine;
        return uniform.then(|| albedo(setting)[channel] * radiance[channel] / (exponent + 1.0));
    }
    let (height, radius) = disk(setting)?;
    let scale = floor(setting, channel).2;
    match slip {
        Scattering::UniformAsCosine => {
            Some(scale * (1.0 - height / (height * height + radius * radius).sqrt()))
        }
        Scattering::AngleAsCosine => Some(scale * libm::atan(radius / height) * 2.0 * FRAC_1_PI),
        _ => None,
    }
}

fn albedo(setting: &Setting) -> Rgb {
    match setting.primitives[0].material.bsdf {
        Bsdf::Lambert { albedo } => albedo,
        _ => Rgb::ZERO,
    }
}

/// The floor's point and normal, and its albedo times the radiance of the light.
fn floor(setting: &Setting, channel: usize) -> (DVec3, DVec3, f64) {
    let shape = setting.primitives[0].shape;
    let scale = albedo(setting)[channel] * setting.primitives[1].material.le[channel];
    (shape.origin(), shape.direction(), scale)
}

/// Height and radius of a disk above the floor's point.
fn disk(setting: &Setting) -> Option<(f64, f64)> {
    let Shape::Disk(disk) = setting.primitives[1].shape else { return None };
    Some(((disk.center - setting.primitives[0].shape.origin()).length(), disk.radius))
}

/// What is taken for the form factor of a disk; s = radius / height.
fn mistaken_disk(slip: Light, s: f64, height: f64) -> Option<f64> {
    let right = s * s / (1.0 + s * s);
    match slip {
        Light::NoCosine | Light::NoCosineAtLight => Some(2.0 * (1.0 - 1.0 / (1.0 + s * s).sqrt())),
        Light::NoDistance => Some(height * height * libm::log1p(s * s)),
        Light::NoPi => Some(PI * right),
        Light::DiskRadius => Some(0.5 * s * (s / (1.0 + s * s) + libm::atan(s))),
        Light::Outward => Some(0.0),
        _ => None,
    }
}

/// What the light of one point is multiplied with.
fn mistaken_point(slip: Slip, e: &Explicit, setting: &Setting) -> Option<f64> {
    let floor = setting.primitives[0].shape;
    let to_light = setting.points[0].position - floor.origin();
    let cos = floor.direction().dot(to_light) / to_light.length();
    match slip {
        Slip::Light(Light::NoCosine) => Some(1.0 / cos),
        Slip::Light(Light::NoDistance) => Some(to_light.length_squared()),
        Slip::Light(Light::NoPi) => Some(PI),
        Slip::Weighting(Weighting::PointShared) => {
            // the light's choice is certain
            let direction = match e.directions {
                Directions::Cosine => cos * FRAC_1_PI,
                Directions::Uniform => 0.5 * FRAC_1_PI,
            };
            match e.technique {
                Technique::Both(Heuristic::Balance) => Some(1.0 / (1.0 + direction)),
                Technique::Both(Heuristic::Power) => Some(1.0 / (1.0 + direction * direction)),
                _ => Some(1.0),
            }
        }
        _ => None,
    }
}
