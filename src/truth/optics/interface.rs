//! Closed forms for light at smooth interfaces: Fresnel's equations by complex amplitudes, their average over
//! diffuse light, a clear slab, and a diffuse floor seen through a flat interface.
//!
//! Light is taken as unpolarized before every interface, as renderers do.

use std::f64::consts::PI;

/// Reflectance of an interface to a clear medium of relative index `n` = n_t / n_i > 0; `cos` in (0, 1] is
/// that of the angle of incidence. 1 under total reflection. Absolute error below 1e-14 for `n` >= 1; for `n`
/// < 1 below 1e-15 over the cosine of refraction, as it is ill-conditioned at the critical angle. [Born &
/// Wolf 1999, sec. 1.5.2]
pub fn dielectric(cos: f64, n: f64) -> f64 {
    conductor(cos, n, 0.0)
}

/// Reflectance of an interface to an absorbing medium of relative index `n` + i `k`, `n` > 0, `k` >= 0; `cos`
/// in (0, 1]. Errors as of [`dielectric`]. [Fresnel 1823; amplitudes for a complex index: Born & Wolf 1999,
/// sec. 14.2]
pub fn conductor(cos: f64, n: f64, k: f64) -> f64 {
    let square = Complex { re: n * n - k * k, im: 2.0 * n * k };
    // the wave vector's component along the normal, over that of light in the near medium; n² - sin² = n² - 1
    // + cos²
    let normal = Complex { re: square.re - 1.0 + cos * cos, im: square.im }.sqrt();
    let perpendicular = ratio(Complex { re: cos, im: 0.0 }, normal);
    let parallel = ratio(Complex { re: square.re * cos, im: square.im * cos }, normal);
    0.5 * (perpendicular + parallel)
}

/// |(a - b) / (a + b)|²
fn ratio(a: Complex, b: Complex) -> f64 {
    let difference = Complex { re: a.re - b.re, im: a.im - b.im };
    let sum = Complex { re: a.re + b.re, im: a.im + b.im };
    difference.square_modulus() / sum.square_modulus()
}

#[derive(Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn square_modulus(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// The root with a real part >= 0, for `im` >= 0: a wave that decays into the medium. The smaller part
    /// comes from the larger, which no subtraction spoils.
    fn sqrt(self) -> Self {
        let larger = (0.5 * (libm::hypot(self.re, self.im) + self.re.abs())).sqrt();
        if larger == 0.0 {
            return Complex { re: 0.0, im: 0.0 };
        }
        let smaller = 0.5 * self.im / larger;
        if self.re >= 0.0 { Complex { re: larger, im: smaller } } else { Complex { re: smaller, im: larger } }
    }
}

/// Reflectance of an interface for diffuse light (equal radiance from everywhere) from outside a clear medium
/// of relative index `n` >= 1: the mean of [`dielectric`] over the cosine-weighted hemisphere. Absolute error
/// below 1e-14 + 1e-15 / (`n` - 1). [Walsh 1926; Duntley 1942]
pub fn diffuse_external(n: f64) -> f64 {
    if n == 1.0 {
        return 0.0;
    }
    let n2 = n * n;
    let n4 = n2 * n2;
    let sum = n2 + 1.0;
    // as a product, since n - 1 is exact near 1 and n⁴ - 1 is not
    let difference = (n - 1.0) * (n + 1.0);
    let fourth = difference * sum;
    let ln_n = libm::log1p(n - 1.0);
    let ln_ratio = libm::log((n - 1.0) / (n + 1.0));
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * difference * difference / (sum * sum * sum) * ln_ratio
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / (sum * fourth)
        + 8.0 * n4 * (n4 + 1.0) / (sum * fourth * fourth) * ln_n
}

/// Reflectance for diffuse light from inside, total reflection included, for `n` >= 1 as in
/// [`diffuse_external`]: what leaves equals what enters in equilibrium, where the radiance inside is n² times
/// that outside. [Judd 1942]
pub fn diffuse_internal(n: f64) -> f64 {
    1.0 - (1.0 - diffuse_external(n)) / (n * n)
}

/// A clear plate with parallel faces, or a clear ball: all interfaces along a path reflect alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Reflectance R of one interface at the angle of the path, in [0, 1).
    pub interface: f64,
}

impl Slab {
    /// Rays that choose between reflection and refraction by chance meet (1) + (1 - R) (1 + R + R² + ...)
    /// interfaces on average, for any R.
    pub const EXPECTED_EVENTS: f64 = 2.0;

    /// A slab of relative index `n` > 1 under light at an angle with cosine `cos` in (0, 1].
    pub fn new(cos: f64, n: f64) -> Self {
        Slab { interface: dielectric(cos, n) }
    }

    /// The part of the light that passes, after all reflections between the faces: (1 - R) / (1 + R), [Stokes
    /// 1862].
    pub fn transmittance(self) -> f64 {
        (1.0 - self.interface) / (1.0 + self.interface)
    }

    /// Radiance seen, with `behind` the radiance behind the slab and `before` that in the mirror direction
    /// [W m^-2 sr^-1].
    pub fn mean(self, behind: f64, before: f64) -> f64 {
        before + self.transmittance() * (behind - before)
    }

    /// Variance of one path that chooses between reflection and refraction by chance: two outcomes.
    pub fn variance(self, behind: f64, before: f64) -> f64 {
        let (passes, step) = (self.transmittance(), behind - before);
        passes * (1.0 - passes) * step * step
    }
}

/// An infinite diffuse floor under a flat clear layer of any depth, under a sky of equal radiance. Light
/// reaches the floor and the eye only through the interface, so next-event estimation finds nothing.
/// [Saunderson 1942]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloorUnderLayer {
    /// Relative index n >= 1 of the layer.
    pub n: f64,
    /// Albedo of the floor, in [0, 1].
    pub albedo: f64,
    /// Radiance of the sky [W m^-2 sr^-1].
    pub sky: f64,
}

impl FloorUnderLayer {
    /// Radiance towards an eye above, at an angle to the normal with cosine `cos` in (0, 1] [W m^-2 sr^-1].
    pub fn radiance(&self, cos: f64) -> f64 {
        self.sky * self.expected(cos, self.albedo)
    }

    /// Second moment of one path that chooses between reflection and refraction by chance, samples the floor
    /// by the cosine, and is weighted by its albedo at each visit.
    pub fn second_moment(&self, cos: f64) -> f64 {
        self.sky * self.sky * self.expected(cos, self.albedo * self.albedo)
    }

    /// Irradiance of the floor, interreflection included [W m^-2].
    pub fn irradiance(&self) -> f64 {
        let entering = PI * self.sky * (1.0 - diffuse_external(self.n));
        entering / (1.0 - self.albedo * diffuse_internal(self.n))
    }

    /// E `weight`^visits, with visits the number of times a path meets the floor before it leaves to the sky.
    fn expected(&self, cos: f64, weight: f64) -> f64 {
        let reflected = dielectric(cos, self.n);
        let returned = diffuse_internal(self.n);
        reflected + (1.0 - reflected) * weight * (1.0 - returned) / (1.0 - weight * returned)
    }
}
