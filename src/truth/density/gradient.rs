//! Means over the kernel's disc of irradiance that is not uniform: what a fixed radius converges to with ever more photons.
//! Odd terms cancel, so irradiance that is linear along the surface has no bias.

use super::Kernel;
use crate::truth::quadrature::gauss_legendre;

/// Mean over a disc of that radius \[m\] of a function with those iterated Laplacians at its centre: the value itself, its
/// Laplacian [1/m²], the Laplacian of that [1/m^4], and so on. Exact for polynomials whose further ones vanish.
///
/// Σ (r²/4)^n Δ^n f E s^2n / n!²; with the box kernel f + r²/8 Δf + r^4/192 Δ²f + ... (Pizzetti's formula).
pub fn from_laplacians(kernel: Kernel, radius: f64, laplacians: &[f64]) -> f64 {
    let mut scale = 1.0;
    let mut mean = 0.0;
    for (n, laplacian) in (0u32..).zip(laplacians) {
        mean += scale * kernel.moment(n) * laplacian;
        let next = 2.0 * f64::from(n + 1);
        scale *= radius * radius / (next * next);
    }
    mean
}

/// By what cos(k x + phase) is multiplied when it is averaged over a disc of radius r, as a function of `phase` = k r in
/// [0, 50]: 2 J1(z)/z of the box kernel, 8 J2(z)/z² of Epanechnikov's; in [-0.14, 1]. A constant beside it stays as it is.
pub fn cosine(kernel: Kernel, phase: f64) -> f64 {
    assert!((0.0..=50.0).contains(&phase), "{phase} rad across a radius");
    if phase < 1e-3 {
        return from_laplacians(kernel, phase, &[1.0, -1.0, 1.0]);
    }
    match kernel {
        Kernel::Box => 2.0 * libm::j1(phase) / phase,
        Kernel::Epanechnikov => 8.0 * libm::jn(2, phase) / (phase * phase),
        Kernel::Cone { .. } => {
            let ring = |s: f64| 2.0 * s * kernel.profile(s) * libm::j0(phase * s);
            gauss_legendre(64, 0.0, 1.0, ring) / kernel.share()
        }
    }
}

/// By what exp(g·x) at the centre is multiplied when it is averaged over a disc of radius r, as a function of `slope` =
/// |g| r in [0, 500]: 2 I1(z)/z of the box kernel; at least 1.
pub fn exponential(kernel: Kernel, slope: f64) -> f64 {
    assert!((0.0..=500.0).contains(&slope), "a slope of {slope} across a radius");
    let (mut scale, mut mean) = (1.0, 0.0);
    for n in 0..2000u32 {
        let term = scale * kernel.moment(n);
        mean += term;
        if term <= 1e-18 * mean {
            break;
        }
        let half = 0.5 * slope / f64::from(n + 1);
        scale *= half * half;
    }
    mean
}

/// Factor of the box kernel at the foot of a point light, `height` above a plane, for that radius in the same unit:
/// (2h²/r²)(1 - h/√(h² + r²)), in (0, 1].
pub fn foot(height: f64, radius: f64) -> f64 {
    assert!(height > 0.0 && radius >= 0.0, "a light at height {height}, a radius of {radius}");
    let rim = libm::hypot(height, radius);
    2.0 * height * height / (rim * (rim + height))
}

/// A point light inside a sphere, seen at the point of the wall nearest to it; lengths in units of the sphere's radius.
///
/// The kernel is a box over the cap within a chord, which the light sees as a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance of the light from the wall, in (0, 1].
    pub height: f64,
    /// The kernel's radius as a chord, in (0, 2].
    pub radius: f64,
}

impl Nearest {
    /// 1 - cos ψ of the cone's half angle ψ, in (0, 2]; half of it is the share of the light's photons that hit the cap
    /// first.
    fn versine(&self) -> f64 {
        let Nearest { height, radius } = *self;
        assert!(height > 0.0 && height <= 1.0, "a light {height} radii from the wall");
        assert!(radius > 0.0 && radius <= 2.0, "a chord of {radius} radii");
        let square = radius * radius;
        // the cap's rim as seen from the light: how far ahead, and its distance
        let ahead = height - 0.5 * square;
        let rim = (height * height + square * (1.0 - height)).sqrt();
        let aside = square * (1.0 - 0.25 * square);
        if ahead > 0.0 { aside / (rim * (rim + ahead)) } else { (rim - ahead) / rim }
    }

    /// Factor of the direct light alone, 2 h² (1 - cos ψ)/r²; 1 if the light is at the centre, else less than 1. The rest of
    /// the light is uniform and has no bias.
    pub fn factor(&self) -> f64 {
        2.0 * self.height * self.height * self.versine() / (self.radius * self.radius)
    }

    /// Share p of the light's photons that hit the cap first, in (0, 1]. The direct estimate from N photons has the
    /// variance (1 - p)/(p N), over its squared mean.
    pub fn share(&self) -> f64 {
        0.5 * self.versine()
    }
}
