//! Which technique finds the light, and how two of them are combined [Veach & Guibas 1995].

use crate::sampling::PdfW;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How direct light is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Technique {
    /// By points sampled on the emitters.
    #[default]
    Light,
    /// By continued directions that happen to hit an emitter.
    Direction,
    /// By both, weighted.
    Both(Heuristic),
}

/// How the densities of two techniques make weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Heuristic {
    /// In proportion to the density.
    #[default]
    Balance,
    /// In proportion to its square.
    Power,
}

impl Technique {
    /// Whether points on emitters are sampled.
    #[inline]
    pub fn samples_lights(self) -> bool {
        self != Technique::Direction
    }

    /// Weight of light found by a technique of density `own`, where the `other` technique could have found it too.
    #[inline]
    fn weight(self, own: PdfW, other: PdfW) -> f64 {
        match self {
            Technique::Both(Heuristic::Power) => {
                let ratio = other.0 / own.0;
                1.0 / (1.0 + ratio * ratio)
            }
            _ => own.0 / (own.0 + other.0),
        }
    }

    /// Weight of a sampled point on an emitter. A light without extent (`light` = `None`) is found in no other way.
    #[inline]
    pub fn of_light(self, light: Option<PdfW>, direction: impl Fn() -> Option<PdfW>) -> f64 {
        match (light, self) {
            (None, _) | (_, Technique::Light) => 1.0,
            (Some(_), Technique::Direction) => 0.0,
            (Some(light), Technique::Both(_)) => {
                direction().map_or(1.0, |direction| self.weight(light, direction))
            }
        }
    }

    /// Weight of an emitter hit by a continued direction. What a Dirac lobe (`direction` = `None`) shows, or the
    /// camera, is found in no other way.
    #[inline]
    pub fn of_hit(self, direction: Option<PdfW>, light: impl Fn() -> PdfW) -> f64 {
        match (direction, self) {
            (None, _) | (_, Technique::Direction) => 1.0,
            (Some(_), Technique::Light) => 0.0,
            (Some(direction), Technique::Both(_)) => self.weight(direction, light()),
        }
    }
}
