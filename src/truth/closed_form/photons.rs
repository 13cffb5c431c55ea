//! Photon maps inside a sphere. Where light is uniform, blurring changes nothing; behind a point light, at the wall's
//! nearest point, it takes a known share of direct light. Photons are independent.

use crate::estimator::{DirectLight, Estimator, Gather, Kernel, Last, PhotonMap, Rule};
use crate::scene::library::{Patch, SceneKind, View};
use crate::scene::{Directions, Rgb, Shape};
use crate::truth::density::Photons;
use crate::truth::density::gradient::Nearest;
use crate::truth::density::near_wall::NearWall;
use crate::truth::density::nearest::Stored;
use crate::truth::gallery::point_near_wall;
use crate::truth::{Counted, Known};
use std::f64::consts::PI;

/// A photon map in a sphere.
pub(super) struct Density {
    map: PhotonMap,
    /// Radius of the sphere.
    radius: f64,
    light: Light,
}

/// Light in a sphere.
enum Light {
    /// It comes from the wall: albedo and emission, if they are the same everywhere and one point is looked at.
    OfWall(Option<(Rgb, Rgb)>),
    /// It comes from a point at this height over what is looked at, in radii of the sphere.
    Near(f64),
}

/// Radius over that of the sphere up to which all photons within it pass for those of one surface.
const NEAR: f64 = 1.3;

impl Density {
    /// The map that an estimator makes of a sphere; `None` elsewhere.
    pub fn of(scene: &SceneKind, estimator: &Estimator) -> Option<Self> {
        let Estimator::PhotonMap(map) = estimator else { return None };
        let light = match scene {
            SceneKind::Furnace { albedo, emission, view } => {
                Light::OfWall((*view == View::Probe).then_some((*albedo, *emission)))
            }
            SceneKind::IntegratingSphere { patches, .. } => Light::OfWall(match patches.as_slice() {
                [Patch { albedo, emission, .. }] => Some((*albedo, *emission)),
                _ => None,
            }),
            SceneKind::Exhibit { name, parameter, .. } if name == point_near_wall::EXHIBIT.name => {
                Light::Near(1.0 - parameter)
            }
            _ => return None,
        };
        let Shape::Sphere(sphere) = scene.build().surfaces()[0].shape else { return None };
        Some(Density { map: *map, radius: sphere.radius, light })
    }

    /// Maps that make one picture.
    pub fn passes(&self) -> u64 {
        match self.map.gather {
            Gather::Shrinking { passes, .. } => passes,
            Gather::Nearest { .. } | Gather::Within { .. } => 1,
        }
    }

    /// Mean over the first `passes` maps of what depends on their radius [scene units].
    fn over_passes(&self, passes: u64, of: impl Fn(f64) -> Option<f64>) -> Option<f64> {
        match self.map.gather {
            Gather::Nearest { .. } => None,
            Gather::Within { radius } => of(radius),
            Gather::Shrinking { radius, alpha, .. } => {
                let shrunk = |(i, square): &(f64, f64)| Some((i + 1.0, square * (i + alpha) / (i + 1.0)));
                let radii = std::iter::successors(Some((1.0, radius * radius)), shrunk);
                let sum: Option<f64> = radii.take(passes as usize).map(|(_, square)| of(square.sqrt())).sum();
                Some(sum? / passes as f64)
            }
        }
    }

    /// Mean of light scattered once, and of all light scattered more often, in the mean of the first `passes` maps, over
    /// the right one.
    pub fn factors(&self, passes: u64) -> Option<[f64; 2]> {
        let rest = match self.map.gather {
            Gather::Within { radius } | Gather::Shrinking { radius, .. } => {
                (radius < NEAR * self.radius).then_some(1.0)?
            }
            Gather::Nearest { .. } => self.of_nearest()?,
        };
        let direct = match self.light {
            _ if self.samples_direct() => 1.0,
            Light::OfWall(_) => rest,
            Light::Near(height) => {
                let is_simple = self.map.kernel == Kernel::Box && self.map.final_gather == 0;
                let factor = |radius| is_simple.then(|| self.nearest(height, radius).factor());
                self.over_passes(passes, factor)?
            }
        };
        Some([direct, rest])
    }

    /// The same of the k nearest: a random number of photons, independent of where they are.
    fn of_nearest(&self) -> Option<f64> {
        let (Gather::Nearest { k, last }, Light::OfWall(Some(_))) = (self.map.gather, &self.light) else {
            return None;
        };
        let rim = if last == Last::Counted { self.map.kernel.weight(1.0) } else { 0.0 };
        (4 * u64::from(k) <= self.map.photons).then(|| 1.0 + rim / (f64::from(k) - 1.0))
    }

    fn nearest(&self, height: f64, radius: f64) -> Nearest {
        Nearest { height, radius: radius / self.radius }
    }

    /// Whether light scattered once comes from sampled emitters, not from photons.
    fn samples_direct(&self) -> bool {
        self.map.direct == DirectLight::Sampled
    }

    /// Albedo of the wall, if it is the same everywhere.
    fn albedo(&self) -> Option<Rgb> {
        match self.light {
            Light::OfWall(wall) => Some(wall?.0),
            Light::Near(_) => Some(point_near_wall::ALBEDO),
        }
    }

    /// Probability with which photons survive, if it is the same for all.
    fn q(&self) -> Option<f64> {
        let albedo = self.albedo()?;
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
        self.variance(channel, counted)
    }

    /// Variance of one map and gather, where light is counted that was scattered so often.
    fn variance(&self, channel: usize, counted: Counted) -> Known {
        let of_pass = match self.map.gather {
            Gather::Within { radius } => self.variance_within(radius, channel, counted),
            Gather::Nearest { .. } => self.variance_of_nearest(channel, counted),
            // passes have one each
            Gather::Shrinking { .. } => self.hits(counted).is_none().then_some(0.0),
        };
        known(of_pass)
    }

    /// Variance of the mean of the first `passes` maps: they are independent.
    pub fn variance_after(&self, passes: u64, channel: usize) -> Known {
        let n = passes as f64;
        match self.map.gather {
            Gather::Shrinking { .. } => {
                let of = |radius| self.variance_within(radius, channel, Counted::All);
                known(self.over_passes(passes, of).map(|mean| mean / n))
            }
            _ => known(self.variance(channel, Counted::All).value().map(|variance| variance / n)),
        }
    }

    /// The hits by which light is counted that was scattered so often, hit j making the surface send on light of bounce
    /// j + 1; `None` where there is no noise: in what the eye sees directly, and in light sampled on a sphere or at a
    /// point, of which every sample is alike.
    fn hits(&self, counted: Counted) -> Option<Counted> {
        let first = if self.samples_direct() { 2 } else { 1 };
        match counted {
            Counted::Only(k) if k < first => None,
            Counted::Only(k) => Some(Counted::Only(k - 1)),
            Counted::All => Some(Counted::From(first - 1)),
            Counted::From(k) => Some(Counted::From(k.max(first) - 1)),
        }
    }

    /// Albedo in a channel and survival probability, where photons have a simple law.
    fn simple(&self, channel: usize) -> Option<(f64, f64)> {
        let (albedo, q) = (self.albedo()?[channel], self.q()?);
        (self.map.final_gather == 0 && self.map.roulette.clamp.is_none() && albedo > 0.0)
            .then_some((albedo, q))
    }

    fn variance_within(&self, radius: f64, channel: usize, counted: Counted) -> Option<f64> {
        let wall = self.albedo()?;
        let Some(hits) = self.hits(counted) else { return Some(0.0) };
        let (albedo, q) = self.simple(channel)?;
        let (map, relative) = (&self.map, radius / self.radius);
        match self.light {
            Light::OfWall(of_wall) => {
                let scale = wall[channel] * of_wall?.1[channel];
                let photons = Photons::uniform(albedo, q);
                Some(scale * scale * photons.variance(map.kernel, relative, map.photons, hits))
            }
            Light::Near(height) => {
                let near = NearWall { albedo, q, nearest: self.nearest(height, radius) };
                let power = 4.0 * PI * point_near_wall::INTENSITY[channel];
                // radiance for a photon of weight 1, were it the only one
                let scale = albedo / PI * power / (PI * radius * radius);
                let is_box = map.kernel == Kernel::Box;
                is_box.then(|| scale * scale * near.variance(hits) / map.photons as f64)
            }
        }
    }

    fn variance_of_nearest(&self, channel: usize, counted: Counted) -> Option<f64> {
        let (Gather::Nearest { k, last }, Light::OfWall(Some((_, le)))) = (self.map.gather, &self.light)
        else {
            return None;
        };
        let Some(hits) = self.hits(counted) else { return Some(0.0) };
        let (albedo, q) = self.simple(channel)?;
        self.of_nearest().filter(|_| self.map.kernel == Kernel::Box)?;
        let stored = Stored { albedo, q, photons: self.map.photons, k: u64::from(k) };
        let relative = match last {
            Last::Counted => stored.variance_of_all(hits),
            Last::LeftOut => stored.variance_without_last(hits),
        };
        let mean = albedo * le[channel] * Photons::uniform(albedo, q).mean(hits);
        Some(mean * mean * relative)
    }

    /// Expected rays of one map and gather.
    pub fn rays(&self) -> Option<f64> {
        let simple =
            self.map.final_gather == 0 && !self.samples_direct() && self.map.roulette.clamp.is_none();
        let q = self.q().filter(|_| simple)?;
        Some(self.map.photons as f64 / (1.0 - q) + 1.0)
    }
}

fn known(variance: Option<f64>) -> Known {
    variance.map_or(Known::Unknown, |variance| match variance.is_finite() {
        true => Known::Value(variance),
        false => Known::Infinite,
    })
}
