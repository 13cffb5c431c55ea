//! Photon maps inside a sphere: light is uniform there, so that blurring changes nothing, and photons are independent.

use crate::estimator::{DirectLight, Estimator, Gather, Kernel, Last, PhotonMap, Rule};
use crate::scene::library::{Patch, SceneKind, View};
use crate::scene::{Directions, Rgb, Shape};
use crate::truth::density::Photons;
use crate::truth::density::nearest::Stored;
use crate::truth::{Counted, Known};

/// A photon map in a sphere.
pub(super) struct Density {
    map: PhotonMap,
    /// Radius of the sphere.
    radius: f64,
    /// Albedo and emission, if they are the same everywhere and one point is looked at.
    uniform: Option<(Rgb, Rgb)>,
}

/// Radius over that of the sphere up to which all photons within it pass for those of one surface.
const NEAR: f64 = 1.3;

impl Density {
    /// The map that an estimator makes of a sphere; `None` elsewhere.
    pub fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let Estimator::PhotonMap(map) = estimator else { return None };
        let uniform = match scene {
            SceneKind::Furnace { albedo, emission, view } => {
                (*view == View::Probe).then_some((*albedo, *emission))
            }
            SceneKind::IntegratingSphere { patches, .. } => match patches.as_slice() {
                [Patch { albedo, emission, .. }] => Some((*albedo, *emission)),
                _ => None,
            },
            _ => return None,
        };
        let Shape::Sphere(sphere) = scene.build().surfaces()[0].shape else { return None };
        Some(Density { map: *map, radius: sphere.radius, uniform })
    }

    /// Mean of the light that photons tell of, over the right one.
    pub fn factor(&self) -> Option<f64> {
        match self.map.gather {
            Gather::Within { radius } | Gather::Shrinking { radius, .. } => {
                (radius < NEAR * self.radius).then_some(1.0)
            }
            Gather::Nearest { k, last } => {
                // a random number of photons, independent of where they are
                self.uniform?;
                let rim = if last == Last::Counted { self.map.kernel.weight(1.0) } else { 0.0 };
                (4 * u64::from(k) <= self.map.photons).then(|| 1.0 + rim / (f64::from(k) - 1.0))
            }
        }
    }

    /// Whether light scattered once comes from sampled emitters, not from photons.
    pub fn samples_direct(&self) -> bool {
        self.map.direct == DirectLight::Sampled
    }

    /// Probability with which photons survive, if it is the same for all.
    fn q(&self) -> Option<f64> {
        let (albedo, _) = self.uniform?;
        let roulette = &self.map.roulette;
        let simple = roulette.from == 0 && self.map.directions == Directions::Cosine;
        match roulette.rule {
            Rule::Constant { q } if simple && q < 1.0 => Some(q),
            Rule::Albedo if simple => Some(albedo.max_element()),
            _ => None,
        }
    }

    /// Central moment of one map and gather, where light is counted that was scattered so often. The area that holds k
    /// photons has the moments of 1 / area up to order k - 1 only.
    pub fn central(&self, channel: usize, counted: Counted, order: usize) -> Known {
        match self.map.gather {
            Gather::Nearest { k, .. } if k as usize <= order => return Known::Infinite,
            _ if order != 2 => return Known::Unknown,
            _ => {}
        }
        self.known_variance(channel, counted).map_or(Known::Unknown, |variance| match variance.is_finite() {
            true => Known::Value(variance),
            false => Known::Infinite,
        })
    }

    fn known_variance(&self, channel: usize, counted: Counted) -> Option<f64> {
        let (albedo, le) = self.uniform?;
        // what the eye sees directly has no noise, nor has light sampled on a sphere, from where all of it is alike
        let first = if self.samples_direct() { 2 } else { 1 };
        if matches!(counted, Counted::Only(k) if k < first) {
            return Some(0.0);
        }
        let (albedo, q, map) = (albedo[channel], self.q()?, &self.map);
        if map.final_gather > 0 || map.roulette.clamp.is_some() || albedo == 0.0 {
            return None;
        }
        // hit j makes the surface send on light of bounce j + 1
        let hits = match counted {
            Counted::All => Counted::From(first - 1),
            Counted::Only(k) => Counted::Only(k - 1),
            Counted::From(k) => Counted::From(k.max(first) - 1),
        };
        let scale = albedo * le[channel];
        let photons = Photons::uniform(albedo, q);
        match map.gather {
            Gather::Within { radius } => {
                let relative = radius / self.radius;
                Some(scale * scale * photons.variance(map.kernel.into(), relative, map.photons, hits))
            }
            Gather::Nearest { k, last } => {
                self.factor().filter(|_| map.kernel == Kernel::Box)?;
                let stored = Stored { albedo, q, photons: map.photons, k: u64::from(k) };
                let relative = match last {
                    Last::Counted => stored.variance_of_all(hits),
                    Last::LeftOut => stored.variance_without_last(hits),
                };
                let mean = scale * photons.mean(hits);
                Some(mean * mean * relative)
            }
            Gather::Shrinking { .. } => None,
        }
    }

    /// Expected rays of one map and gather.
    pub fn rays(&self) -> Option<f64> {
        let simple =
            self.map.final_gather == 0 && !self.samples_direct() && self.map.roulette.clamp.is_none();
        let q = self.q().filter(|_| simple)?;
        Some(self.map.photons as f64 / (1.0 - q) + 1.0)
    }
}
