//! Variances of one-bounce estimators of direct light on a Lambert surface under disk and sphere lights, for one
//! sample (one of each kind for MIS), in units of (albedo · Le)². Multiply by (albedo · Le)² for radiance.
//!
//! Differences such as E X² - F² are expanded by hand: errors are a few 1e-16 relative unless stated.

use super::form_factor::disk_coaxial;
use crate::estimator::Heuristic;
use crate::scene::Points;
use crate::truth::quadrature::gauss_legendre;

/// Cosine-weighted directions and any light of one radiance: a hit with probability F, the form factor.
pub fn implicit_cosine(form_factor: f64) -> f64 {
    form_factor * (1.0 - form_factor)
}

/// A disk light whose axis passes through the receiver along its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoaxialDisk {
    /// Over the receiver, positive.
    pub height: f64,
    /// In the unit of `height`, positive.
    pub radius: f64,
}

impl CoaxialDisk {
    /// Mean F of every estimator, the form factor.
    pub fn mean(&self) -> f64 {
        disk_coaxial(self.height, self.radius)
    }

    /// Cosine of the cone's half-angle c, and 1 - c.
    fn cosine(&self) -> (f64, f64) {
        let slant = libm::hypot(self.height, self.radius);
        (self.height / slant, self.radius / slant * (self.radius / (slant + self.height)))
    }

    /// Cosine-weighted directions: F (1 - F).
    pub fn implicit_cosine(&self) -> f64 {
        let (c, _) = self.cosine();
        self.mean() * c * c
    }

    /// Directions uniform over the hemisphere: (4/3)(1 - c³) - F².
    pub fn implicit_uniform(&self) -> f64 {
        let (c, rest) = self.cosine();
        rest * (4.0 / 3.0 * (1.0 + c + c * c) - rest * (1.0 + c) * (1.0 + c))
    }

    /// A point of the light: with t = (radius/height)², (t/3)(1 - (1 + t)⁻³) - F² = F⁴ / (3c²) per area, and
    /// 4 (1 - c)(1 - c³)/3 - F² = (1 - c)⁴/3 per solid angle.
    pub fn explicit(&self, sampled: Points) -> f64 {
        let (c, rest) = self.cosine();
        let square = |x: f64| x * x;
        match sampled {
            Points::Area => square(square(self.mean()) / c) / 3.0,
            Points::SolidAngle => square(square(rest)) / 3.0,
        }
    }

    /// MIS of one cosine-weighted direction and one point of the light. Quadrature, to 1e-12 relative for a radius of
    /// 0.01 to 100 heights.
    pub fn mis(&self, sampled: Points, heuristic: Heuristic) -> f64 {
        let (c, rest) = self.cosine();
        let t = self.radius / self.height * (self.radius / self.height);
        // π times the light's density per solid angle at direction cosine mu, where that of the other is mu
        let density = |mu: f64| match sampled {
            Points::Area => 1.0 / (t * mu * mu * mu),
            Points::SolidAngle => 0.5 / rest,
        };
        // mu / density times the weight, for the direction and for the point
        let direction = |mu: f64| match heuristic {
            Heuristic::Balance => mu / (mu + density(mu)),
            Heuristic::Power => mu * mu / (mu * mu + density(mu) * density(mu)),
        };
        let point = |mu: f64| match heuristic {
            Heuristic::Balance => mu / (mu + density(mu)),
            Heuristic::Power => mu * density(mu) / (mu * mu + density(mu) * density(mu)),
        };
        // mu = c^(1 - s): a wide disk has its densities cross at some power of c
        let log = -0.5 * libm::log1p(t);
        let over_light = |f: &dyn Fn(f64) -> f64| {
            gauss_legendre(192, 0.0, 1.0, |s| {
                let mu = libm::exp((1.0 - s) * log);
                -log * mu * f(mu)
            })
        };
        let of_directions = over_light(&|mu| 2.0 * mu * direction(mu));
        let of_points = over_light(&|mu| 2.0 * density(mu) * point(mu));
        // a direction misses with probability c²
        let off = |x: f64, mean: f64| (x - mean) * (x - mean);
        over_light(&|mu| 2.0 * mu * off(direction(mu), of_directions))
            + c * c * of_directions * of_directions
            + over_light(&|mu| 2.0 * density(mu) * off(point(mu), of_points))
    }
}

/// A point of a sphere uniform per solid angle of its cone, for a receiver whose normal is at angle θ to the centre's
/// direction: variance, where the horizon does not cut the sphere (cos θ >= radius / distance).
pub fn sphere_cone(distance: f64, radius: f64, cos_theta: f64) -> f64 {
    assert!(cos_theta * distance >= radius, "the horizon cuts the sphere");
    let sin_sigma = radius / distance;
    let c = ((1.0 - sin_sigma) * (1.0 + sin_sigma)).sqrt();
    let rest = sin_sigma * sin_sigma / (1.0 + c);
    let cos2 = cos_theta * cos_theta;
    let sin2 = (1.0 - cos_theta) * (1.0 + cos_theta);
    rest * rest * rest / 3.0 * (cos2 * rest + 2.0 * sin2 * (2.0 + c))
}

/// A point of a whole sphere uniform per area, its far side giving 0, for a receiver that faces the centre: variance
/// R⁴ (5d - 3R)(d + R) / (3 d⁴ (d - R)²).
pub fn sphere_area(distance: f64, radius: f64) -> f64 {
    let ratio = radius * radius / (distance * distance * (distance - radius));
    ratio * ratio * (5.0 * distance - 3.0 * radius) * (distance + radius) / 3.0
}
