//! Averages over the time a shutter is open, and the variance of sampling that time. Motion is straight and
//! uniform, so time enters only through the first and the last position.

use super::exposure::two_boxes;
use std::f64::consts::PI;

/// Part of the time for which a disc of `radius` covers a point, while its centre moves from `from` to `to`
/// along a line; both are measured from the foot of the point on that line, which passes it at distance
/// `offset`. For a passage from outside to outside, 2 √(r² - o²) / (v T).
pub fn disc_passing(radius: f64, offset: f64, from: f64, to: f64) -> f64 {
    let (first, last) = (from.min(to), from.max(to));
    if offset.abs() >= radius {
        return 0.0;
    }
    let half = ((radius - offset) * (radius + offset)).sqrt();
    if first == last {
        return if first.abs() <= half { 1.0 } else { 0.0 };
    }
    (last.min(half) - first.max(-half)).max(0.0) / (last - first)
}

/// White part of a box pixel of `width` around 0 over the time in which an edge along its side, white below,
/// moves `from` one position `to` another.
pub fn edge_moving(width: f64, from: f64, to: f64) -> f64 {
    two_boxes(0.5 * (from + to), width, (to - from).abs())
}

/// A disc light that rises above a floor point on its axis, facing it. Errors are some 1e-15 h1 / (h1 - h0)
/// of the squared scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RisingDisc {
    /// Radius R of the light (m).
    pub radius: f64,
    /// Its height h0 > 0 when the shutter opens (m).
    pub from: f64,
    /// Its height h1 > h0 when it closes (m).
    pub to: f64,
    /// The floor's albedo times the radiance of the light [W m^-2 sr^-1].
    pub scale: f64,
}

impl RisingDisc {
    /// Radiance of the floor point: scale times the average of R² / (h² + R²).
    pub fn mean(&self) -> f64 {
        let (r, rise) = (self.radius, self.to - self.from);
        // the difference of two arc tangents
        self.scale * r * libm::atan(r * rise / (r * r + self.from * self.to)) / rise
    }

    /// Variance by time alone: of the radiance at one uniform time.
    pub fn time_variance(&self) -> f64 {
        let r = self.radius;
        let integral = |h: f64| 0.5 * r * (h * r / (h * h + r * r) + libm::atan(h / r));
        self.scale * self.scale * self.average(integral) - self.mean() * self.mean()
    }

    /// Second moment of one shadow ray to a uniform point of the light at a uniform time: the average over h
    /// of (scale²) (R² / 3h²) (1 - (h² / (h² + R²))³).
    pub fn explicit_second_moment(&self) -> f64 {
        let r = self.radius;
        let integral = |h: f64| {
            let square = h * h + r * r;
            -1.0 / h + h * (5.0 * h * h + 3.0 * r * r) / (8.0 * square * square)
                - 3.0 / (8.0 * r) * libm::atan(h / r)
        };
        self.scale * self.scale * r * r / 3.0 * self.average(integral)
    }

    fn average(&self, integral: impl Fn(f64) -> f64) -> f64 {
        (integral(self.to) - integral(self.from)) / (self.to - self.from)
    }
}

/// A point light that moves at constant height over a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassingLight {
    /// Its height h > 0 (m).
    pub height: f64,
    /// Horizontal distance x0 from the floor point, with sign, when the shutter opens (m).
    pub from: f64,
    /// That when it closes, x1 > x0 (m).
    pub to: f64,
    /// Intensity of the light [W/sr].
    pub intensity: f64,
    /// The floor's albedo.
    pub albedo: f64,
}

impl PassingLight {
    /// Radiance of the floor point [W m^-2 sr^-1]: (ρ I / π) times the average of h / (h² + x²)^(3/2).
    pub fn mean(&self) -> f64 {
        let h = self.height;
        self.factor() * self.average(|x| x / (h * libm::hypot(h, x)))
    }

    /// Second moment of the radiance at one uniform time: the average of h² / (h² + x²)³, times the factor's
    /// square.
    pub fn second_moment(&self) -> f64 {
        let h2 = self.height * self.height;
        let integral = |x: f64| {
            let square = h2 + x * x;
            let angle = libm::atan(x / self.height);
            x / (4.0 * square * square)
                + 3.0 * x / (8.0 * h2 * square)
                + 3.0 * angle / (8.0 * h2 * self.height)
        };
        self.factor() * self.factor() * self.average(integral)
    }

    fn factor(&self) -> f64 {
        self.albedo * self.intensity / PI
    }

    fn average(&self, integral: impl Fn(f64) -> f64) -> f64 {
        (integral(self.to) - integral(self.from)) / (self.to - self.from)
    }
}
