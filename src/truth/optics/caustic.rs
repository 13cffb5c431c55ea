//! Caustics of a point light with closed forms: the beam of a paraboloid mirror, and the floor of a still
//! pool.

use super::interface::dielectric;

/// A paraboloid mirror z = s² / 4f without losses, with a point light at its focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// Focal length f > 0 (m).
    pub focal_length: f64,
    /// Intensity I of the light [W/sr].
    pub intensity: f64,
}

impl Paraboloid {
    /// Irradiance [W m^-2] by reflected light alone of a plane across the axis, at distance `s` from it:
    /// (I / f²) / (1 + s² / 4f²)². A ray that leaves at angle φ to the axis ends at s = 2 f tan(φ/2), and
    /// E s ds = I sin φ dφ.
    pub fn irradiance(&self, s: f64) -> f64 {
        let (f, t) = (self.focal_length, 0.5 * s / self.focal_length);
        let spread = f * (1.0 + t * t);
        self.intensity / (spread * spread)
    }

    /// Power (W) within distance `s` of the axis: 4 π I times the mirror's part of the sphere around the
    /// light.
    pub fn flux(&self, s: f64) -> f64 {
        let t = 0.5 * s / self.focal_length;
        4.0 * std::f64::consts::PI * self.intensity * t * t / (1.0 + t * t)
    }
}

/// A point light above a still pool with a flat floor.
///
/// Landing distance grows with the angle of emission, from 0 at the foot to infinity, as the relative index
/// is >= 1: each point of the floor is reached by one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pool {
    /// Height h > 0 of the light above the water (m).
    pub height: f64,
    /// Depth D >= 0 of the water (m).
    pub depth: f64,
    /// Relative index n >= 1 of the water.
    pub n: f64,
    /// Intensity I of the light [W/sr].
    pub intensity: f64,
}

impl Pool {
    /// Distance x (m) from the foot at which a ray lands that leaves at `angle` (rad) in [0, π/2) to the
    /// vertical: h tan θ + D tan θ', n sin θ' = sin θ. Relative error below 1e-15 / cos θ.
    pub fn position(&self, angle: f64) -> f64 {
        self.landing(libm::tan(angle))
    }

    /// Irradiance [W m^-2] of the floor by light straight from the lamp, where a ray that leaves at `angle`
    /// (rad) in [0, π/2) lands: I T sin θ / (x dx/dθ). Relative error below 1e-14 / cos θ.
    pub fn irradiance(&self, angle: f64) -> f64 {
        self.irradiance_of(libm::tan(angle))
    }

    /// The limit at the foot: I T(0) / (h + D/n)².
    pub fn irradiance_at_foot(&self) -> f64 {
        let reduced = self.height + self.depth / self.n;
        self.intensity * (1.0 - dielectric(1.0, self.n)) / (reduced * reduced)
    }

    /// Irradiance [W m^-2] at distance `x` >= 0 (m) from the foot. Relative error below 1e-14 / cos θ, for h
    /// >= 1e-4 D.
    pub fn irradiance_at(&self, x: f64) -> f64 {
        self.irradiance_of(self.tangent_to(x))
    }

    /// tan θ of the ray that lands at distance `x` >= 0 (m).
    ///
    /// x is a concave function of tan θ, so Newton's method started below the root rises to it without
    /// overshooting.
    pub fn tangent_to(&self, x: f64) -> f64 {
        // the steepest slope, that at the foot, gives a start that is too small
        let mut tangent = x / (self.height + self.depth / self.n);
        for _ in 0..100 {
            let next = tangent + (x - self.landing(tangent)) / self.slope(tangent);
            if next <= tangent {
                break;
            }
            tangent = next;
        }
        tangent
    }

    fn landing(&self, tangent: f64) -> f64 {
        let (cos, below) = self.cosines(tangent);
        tangent * (self.height + self.depth * cos / (self.n * below))
    }

    /// dx / d tan θ
    fn slope(&self, tangent: f64) -> f64 {
        let (cos, below) = self.cosines(tangent);
        let ratio = cos / below;
        self.height + self.depth * ratio * ratio * ratio / self.n
    }

    /// I T cos³ θ / ((x / tan θ) (dx / d tan θ)), where nothing vanishes at the foot.
    fn irradiance_of(&self, tangent: f64) -> f64 {
        let (cos, below) = self.cosines(tangent);
        let transmitted = 1.0 - dielectric(cos, self.n);
        let mean_slope = self.height + self.depth * cos / (self.n * below);
        self.intensity * transmitted * cos * cos * cos / (mean_slope * self.slope(tangent))
    }

    /// cos θ above the water and cos θ' below.
    fn cosines(&self, tangent: f64) -> (f64, f64) {
        let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
        let sin_below = tangent * cos / self.n;
        (cos, ((1.0 - sin_below) * (1.0 + sin_below)).sqrt())
    }
}
