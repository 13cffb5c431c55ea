//! Radius and number of neighbours with the least mean squared error, to leading order in the radius: irradiance with a
//! Laplacian, and photons so many that their number within the disc is Poisson-distributed.

use super::Kernel;
use super::nearest::limit_without_last;
use std::f64::consts::PI;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Irradiance [W m^-2], above 0.
    pub irradiance: f64,
    /// Its Laplacian along the surface [W m^-4], not 0 where an optimum is asked for.
    pub laplacian: f64,
    /// Power of one photon \[W\]: that of the lights over the number of photons sent out.
    pub photon: f64,
}

impl Spot {
    /// Bias [W m^-2] for that radius \[m\].
    pub fn bias(&self, kernel: Kernel, radius: f64) -> f64 {
        kernel.bias() * radius * radius * self.laplacian
    }

    /// Variance [(W m^-2)²] for that radius \[m\], of uniform irradiance.
    pub fn variance(&self, kernel: Kernel, radius: f64) -> f64 {
        kernel.variance() * self.irradiance * self.photon / (PI * radius * radius)
    }

    /// Mean squared error [(W m^-2)²] for that radius \[m\].
    pub fn error(&self, kernel: Kernel, radius: f64) -> f64 {
        let bias = self.bias(kernel, radius);
        bias * bias + self.variance(kernel, radius)
    }

    /// The radius \[m\] with the least mean squared error: r^6 = 32 E `photon` / (π ΔE²) for the box kernel. There the
    /// variance is twice the squared bias, and the error falls as the photons' number to the -2/3.
    pub fn best_radius(&self, kernel: Kernel) -> f64 {
        let slope = kernel.bias() * self.laplacian;
        assert!(slope != 0.0, "without a Laplacian, larger radii are always better");
        let sixth = kernel.variance() * self.irradiance * self.photon / (2.0 * PI * slope * slope);
        libm::cbrt(sixth.sqrt())
    }

    /// Mean squared error [(W m^-2)²] with the best radius.
    pub fn least_error(&self, kernel: Kernel) -> f64 {
        let bias = self.bias(kernel, self.best_radius(kernel));
        3.0 * bias * bias
    }

    /// Bias [W m^-2] of the k nearest without the outermost, (k - 1) `photon` / (π r_k²), k from 2: as for a fixed radius
    /// that holds k - 1 photons.
    pub fn nearest_bias(&self, k: u64) -> f64 {
        assert!(k >= 2);
        Kernel::Box.bias() * self.laplacian * (k as f64 - 1.0) * self.photon / (PI * self.irradiance)
    }

    /// Its mean squared error [(W m^-2)²], infinite for k = 2.
    pub fn nearest_error(&self, k: u64) -> f64 {
        let bias = self.nearest_bias(k);
        bias * bias + self.irradiance * self.irradiance * limit_without_last(k)
    }

    /// The k with the least such error, at least 3. It grows as the photons' number to the 2/3:
    /// k³ ≈ 32 π² E^4 / (ΔE `photon`)².
    pub fn best_count(&self) -> u64 {
        let one = self.nearest_bias(2) / self.irradiance;
        assert!(one != 0.0, "without a Laplacian, more neighbours are always better");
        // (k - 2)² (k - 1) = 1 / (2 one²), whose root is between 1 and 2 above the cube root of the right side
        let root = libm::cbrt(0.5 / (one * one)) as u64;
        let candidates = root.max(2) + 1..=root.max(2) + 3;
        candidates.min_by(|&a, &b| self.nearest_error(a).total_cmp(&self.nearest_error(b))).unwrap_or(3)
    }
}
