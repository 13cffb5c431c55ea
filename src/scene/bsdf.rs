//! Scattering: what a surface reflects and lets through, and how a continued direction is chosen.

use super::{Rgb, fresnel, microfacet};
use crate::sampling::PdfW;
use crate::sampling::warp::{
    Frame, cosine_hemisphere, cosine_hemisphere_pdf, uniform_hemisphere, uniform_hemisphere_pdf,
};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_PI;

/// What a surface is made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// How it scatters light.
    pub bsdf: Bsdf,
    /// Emitted radiance [W m^-2 sr^-1], the same in all directions of the front hemisphere.
    pub le: Rgb,
}

/// How a surface scatters light. All but clear interfaces are black from behind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bsdf {
    /// The same radiance in all directions [Lambert 1760].
    Lambert {
        /// Fraction of the arriving light that is reflected, each channel in [0, 1].
        albedo: Rgb,
    },
    /// A perfect mirror with the same reflectance at all angles.
    Mirror {
        /// Fraction of the arriving light that is reflected, each channel in [0, 1].
        reflectance: Rgb,
    },
    /// A polished metal.
    Conductor {
        /// Real part of the complex refractive index.
        eta: Rgb,
        /// Imaginary part of it.
        k: Rgb,
    },
    /// A rough metal, whose facets are polished [Cook & Torrance 1982; Walter et al. 2007], see [`microfacet`].
    Glossy {
        /// Roughness of the GGX distribution, in [0.001, 1]; towards 0 a polished metal.
        alpha: f64,
        /// Real part of the complex refractive index.
        eta: Rgb,
        /// Imaginary part of it.
        k: Rgb,
    },
    /// A smooth interface between two clear media; seen from both sides.
    Dielectric {
        /// Refractive index behind the surface, relative to the one in front of it.
        ior: f64,
    },
}

/// The density from which directions leaving a Lambert surface are drawn. A glossy one does not ask: there directions
/// always go with the facets that are seen, for any other choice has an unbounded weight in a narrow lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Directions {
    /// cos θ / π: the weight is the albedo.
    #[default]
    Cosine,
    /// 1 / 2π: the weight is 2 cos θ albedo.
    Uniform,
}

/// What a path carries, and so which way light goes along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// Radiance, from where the path will come to where it came from: paths from the eye.
    Radiance,
    /// Power, the way that the path goes: paths from the lights.
    Power,
}

/// A continued direction.
#[derive(Clone, Copy, Debug)]
pub struct DirectionSample {
    /// Unit direction, leaving the surface.
    pub wi: DVec3,
    /// f cos θ / pdf.
    pub weight: Rgb,
    /// Density of `wi` [1/sr]; `None` for a Dirac lobe, where `weight` divides by the probability of the choice.
    pub pdf: Option<PdfW>,
}

impl Material {
    /// A Lambert surface.
    pub fn lambert(albedo: Rgb, le: Rgb) -> Self {
        Material { bsdf: Bsdf::Lambert { albedo }, le }
    }
}

impl Bsdf {
    /// Whether its back can be seen.
    #[inline]
    pub fn is_clear(&self) -> bool {
        matches!(self, Bsdf::Dielectric { .. })
    }

    /// Whether all of its directions are Dirac lobes, which no sampled light can hit.
    #[inline]
    pub fn is_dirac(&self) -> bool {
        !matches!(self, Bsdf::Lambert { .. } | Bsdf::Glossy { .. })
    }

    /// Fraction of the light arriving from where `wo` points that goes on, by channel; `cos` = |cos θ_o|. Of a rough metal
    /// it is what the polished one reflects, a number for roulette: what the rough one reflects has no closed form and is
    /// less, for light is lost between the facets, at grazing angles most of it. It is more only by 5 parts in 10^4, where
    /// facets that face elsewhere reflect better (by some per cent in matter that hardly reflects at all, k = 0).
    #[inline(always)]
    pub fn albedo(&self, cos: f64) -> Rgb {
        match *self {
            Bsdf::Lambert { albedo } => albedo,
            Bsdf::Mirror { reflectance } => reflectance,
            Bsdf::Conductor { eta, k } | Bsdf::Glossy { eta, k, .. } => fresnel::conductor(cos, eta, k),
            Bsdf::Dielectric { .. } => Rgb::ONE,
        }
    }

    /// The BSDF f [1/sr] between two unit directions on a surface of normal `n`, without the cosine; zero where only
    /// Dirac lobes scatter, and where one of the directions does not leave the front.
    #[inline(always)]
    pub fn f(&self, n: DVec3, wo: DVec3, wi: DVec3) -> Rgb {
        match *self {
            Bsdf::Lambert { albedo } if n.dot(wo) > 0.0 && n.dot(wi) > 0.0 => albedo * FRAC_1_PI,
            Bsdf::Glossy { alpha, eta, k } => {
                // wo and wi make the same angle with the facet: half of that between them
                let cos_at_facet = 0.5 * (wo + wi).length();
                fresnel::conductor(cos_at_facet, eta, k) * microfacet::f(alpha, n, wo, wi)
            }
            _ => Rgb::ZERO,
        }
    }

    /// Density [1/sr] with which [`Bsdf::sample`] draws `wi` for light that goes on towards `wo`; `None` for Dirac lobes.
    /// Zero below the surface; on a glossy one its integral lacks from 1 what facets mirror to there.
    #[inline]
    pub fn pdf(&self, directions: Directions, n: DVec3, wo: DVec3, wi: DVec3) -> Option<PdfW> {
        let cos_i = n.dot(wi);
        match (*self, directions) {
            (Bsdf::Mirror { .. } | Bsdf::Conductor { .. } | Bsdf::Dielectric { .. }, _) => None,
            _ if cos_i <= 0.0 => Some(PdfW(0.0)),
            (Bsdf::Lambert { .. }, Directions::Cosine) => Some(cosine_hemisphere_pdf(cos_i)),
            (Bsdf::Lambert { .. }, Directions::Uniform) => Some(uniform_hemisphere_pdf()),
            (Bsdf::Glossy { .. }, _) if n.dot(wo) <= 0.0 => Some(PdfW(0.0)),
            (Bsdf::Glossy { alpha, .. }, _) => {
                Some(microfacet::reflected_pdf(alpha, n, (wo + wi).normalize(), n.dot(wo)))
            }
        }
    }

    /// Draws a direction around the normal of `frame`; `wo` is where the path came from. A facet of a glossy surface may
    /// mirror to below the surface, where the weight is zero.
    #[inline(always)]
    pub fn sample(
        &self,
        carried: Carried,
        directions: Directions,
        frame: &Frame,
        wo: DVec3,
        u: (f64, f64),
    ) -> DirectionSample {
        match *self {
            Bsdf::Lambert { albedo } => lambert(directions, albedo, frame, u),
            Bsdf::Mirror { reflectance } => dirac(mirrored(wo, frame.n), reflectance),
            Bsdf::Conductor { .. } => dirac(mirrored(wo, frame.n), self.albedo(frame.n.dot(wo))),
            // by value: an address would keep the hit of every material in memory
            Bsdf::Glossy { alpha, eta, k } => glossy(alpha, (eta, k), *frame, wo, u),
            Bsdf::Dielectric { ior } => dielectric(carried, ior, frame.n, wo, u.0),
        }
    }
}

#[inline(always)]
fn lambert(directions: Directions, albedo: Rgb, frame: &Frame, u: (f64, f64)) -> DirectionSample {
    match directions {
        Directions::Cosine => {
            let local = cosine_hemisphere(u);
            let pdf = Some(cosine_hemisphere_pdf(local.z));
            DirectionSample { wi: frame.to_world(local), weight: albedo, pdf }
        }
        Directions::Uniform => {
            let local = uniform_hemisphere(u);
            let weight = albedo * (2.0 * local.z);
            DirectionSample { wi: frame.to_world(local), weight, pdf: Some(uniform_hemisphere_pdf()) }
        }
    }
}

/// Mirrored at a facet as it is seen from `wo`: of f cos / pdf only the reflectance of the facet and the share of the
/// facets seen from `wi` is left.
#[inline]
fn glossy(alpha: f64, (eta, k): (Rgb, Rgb), frame: Frame, wo: DVec3, u: (f64, f64)) -> DirectionSample {
    let n = frame.n;
    let m = microfacet::visible_normal(alpha, &frame, wo, u);
    let wi = mirrored(wo, m);
    let pdf = Some(microfacet::reflected_pdf(alpha, n, m, n.dot(wo)));
    let cos_i = n.dot(wi);
    if cos_i <= 0.0 {
        return DirectionSample { wi, weight: Rgb::ZERO, pdf };
    }
    // a facet seen edge-on may be turned away by rounding
    let reflectance = fresnel::conductor(wo.dot(m).clamp(0.0, 1.0), eta, k);
    DirectionSample { wi, weight: reflectance * microfacet::seen(alpha, cos_i), pdf }
}

/// Reflection or refraction, chosen with their probabilities by `u`. Refraction squeezes a beam's solid angle by
/// (n_t / n_i)² and radiance grows by as much, so radiance seen through the interface is divided by it; the power of a
/// beam stays what it is [Veach 1997, sec. 5.2].
#[inline]
fn dielectric(carried: Carried, ior: f64, n: DVec3, wo: DVec3, u: f64) -> DirectionSample {
    let outside = n.dot(wo) > 0.0;
    let (n, eta) = if outside { (n, ior) } else { (-n, 1.0 / ior) };
    let cos = n.dot(wo);
    let (reflectance, cos_t) = fresnel::dielectric(cos, eta);
    if u < reflectance {
        return dirac(mirrored(wo, n), Rgb::ONE);
    }
    let wi = n * (cos / eta - cos_t) - wo * (1.0 / eta);
    let weight = match carried {
        Carried::Radiance => 1.0 / (eta * eta),
        Carried::Power => 1.0,
    };
    dirac(wi.normalize(), Rgb::splat(weight))
}

#[inline]
fn dirac(wi: DVec3, weight: Rgb) -> DirectionSample {
    DirectionSample { wi, weight, pdf: None }
}

#[inline]
fn mirrored(wo: DVec3, n: DVec3) -> DVec3 {
    (n * (2.0 * n.dot(wo)) - wo).normalize()
}
