//! A point light of intensity I (watts a steradian), over a plane and in a diffuse sphere.

use glam::DVec3;

/// Irradiance on an element at `p` with unit normal `n` (watts an area): I cos θ / d² (Lambert, Photometria, 1760).
pub fn irradiance(intensity: f64, light: DVec3, p: DVec3, n: DVec3) -> f64 {
    let to_light = light - p;
    let square = to_light.length_squared();
    intensity * n.dot(to_light).max(0.0) / (square * square.sqrt())
}

/// A point light inside a Lambert sphere. From a wall point all of the wall is seen with the same cos cos' / d², so
/// that what is scattered more than once is uniform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointInSphere {
    /// Watts a steradian.
    pub intensity: f64,
    /// Distance from the centre, less than `radius`.
    pub offset: f64,
    /// Of the sphere.
    pub radius: f64,
    /// Below 1.
    pub albedo: f64,
}

impl PointInSphere {
    /// Direct irradiance where the angle at the centre between light and wall point has cosine `mu`.
    pub fn irradiance(&self, mu: f64) -> f64 {
        let (a, r) = (self.offset, self.radius);
        let square = (r - a) * (r - a) + 2.0 * a * r * (1.0 - mu);
        self.intensity * (r - a * mu) / (square * square.sqrt())
    }

    /// Mean of the direct irradiance over the wall, I/R², wherever the light is.
    pub fn mean_irradiance(&self) -> f64 {
        self.intensity / (self.radius * self.radius)
    }

    /// Radiance of the wall, all bounces.
    pub fn radiance(&self, mu: f64) -> f64 {
        let scattered = self.albedo / (1.0 - self.albedo) * self.mean_irradiance();
        self.albedo / std::f64::consts::PI * (self.irradiance(mu) + scattered)
    }

    /// Mean over the wall of the squared direct irradiance:
    /// (I²/4R⁴) ((1 + s²)/(1 - s²)² + 2/(1 - s²) + artanh(s)/s), s = offset/radius.
    pub fn mean_square_irradiance(&self) -> f64 {
        let mean = self.mean_irradiance();
        mean * mean + self.irradiance_variance()
    }

    /// Variance of the direct irradiance over the wall, in (watts an area)².
    pub fn irradiance_variance(&self) -> f64 {
        let s = self.offset / self.radius;
        let square = s * s;
        let rest = (1.0 - s) * (1.0 + s);
        let artanh = if s == 0.0 { 0.0 } else { libm::atanh(s) / s - 1.0 };
        let mean = self.mean_irradiance();
        mean * mean / 4.0 * (square * (3.0 - square) / (rest * rest) + 2.0 * square / rest + artanh)
    }

    /// Variance of a path tracer with next-event estimation, cosine-weighted directions and roulette of survival
    /// probability `q` at every vertex: the same at every wall point, infinite unless albedo² < q.
    ///
    /// A path takes X = A + (B/q) albedo X', its A independent of X' and, after the first vertex, of the past.
    pub fn explicit_variance(&self, q: f64) -> f64 {
        let square = self.albedo * self.albedo;
        if square >= q {
            return f64::INFINITY;
        }
        let scale = self.albedo / std::f64::consts::PI;
        let mean = scale * self.mean_irradiance() / (1.0 - self.albedo);
        let roulette = square * mean * mean * (1.0 - q) / q;
        let later = (scale * scale * self.irradiance_variance() + roulette) / (1.0 - square / q);
        square / q * later + roulette
    }
}
