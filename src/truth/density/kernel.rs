//! How much a photon counts, by its distance from the point of interest.

pub use crate::estimator::Kernel;

/// What theory says of a kernel on a disc of radius r, as a function of s = distance / r in [0, 1]; nothing counts beyond.
impl Kernel {
    /// Weight at `s` = distance / radius relative to that of a photon at the centre, in [0, 1]; 0 for `s` above 1.
    pub fn profile(self, s: f64) -> f64 {
        assert!(s >= 0.0, "a distance of {s} radii");
        match self {
            _ if s > 1.0 => 0.0,
            Kernel::Box => 1.0,
            Kernel::Cone { c } => 1.0 - s / c,
            Kernel::Epanechnikov => 1.0 - s * s,
        }
    }

    /// Mean of the profile over the disc, in (0, 1].
    pub fn share(self) -> f64 {
        self.integral(0)
    }

    /// Integral of the profile over the disc of that radius \[m\] in m²: photons' powers are divided by it.
    pub fn normalization(self, radius: f64) -> f64 {
        std::f64::consts::PI * radius * radius * self.share()
    }

    /// Variance in relation to that of the box kernel of the same radius, for photons so rare that their squared density
    /// does not matter: the mean squared profile over the squared mean. 1 for the box, above 1 for all others.
    pub fn variance(self) -> f64 {
        let share = self.share();
        let square = match self {
            Kernel::Box => 1.0,
            Kernel::Cone { c } => 1.0 - 4.0 / (3.0 * c) + 1.0 / (2.0 * c * c),
            Kernel::Epanechnikov => 1.0 / 3.0,
        };
        square / (share * share)
    }

    /// E s^2n over the disc with the profile as density, in (0, 1].
    pub fn moment(self, n: u32) -> f64 {
        self.integral(n) / self.share()
    }

    /// Leading bias, dimensionless: the expected estimate is E + `bias` · r² · ΔE, where ΔE is the Laplacian of irradiance along the
    /// surface; nothing follows if irradiance is a polynomial of third degree. 1/8 for the box, 1/12 for Epanechnikov.
    pub fn bias(self) -> f64 {
        0.25 * self.moment(1)
    }

    /// Integral of profile · s^2n over the disc, in discs.
    fn integral(self, n: u32) -> f64 {
        let n = f64::from(n);
        match self {
            Kernel::Box => 1.0 / (n + 1.0),
            Kernel::Cone { c } => {
                assert!(c >= 1.0, "a cone of {c} weighs photons negatively");
                1.0 / (n + 1.0) - 2.0 / ((2.0 * n + 3.0) * c)
            }
            Kernel::Epanechnikov => 1.0 / ((n + 1.0) * (n + 2.0)),
        }
    }
}
