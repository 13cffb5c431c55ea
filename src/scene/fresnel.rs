//! How much light a smooth interface reflects, unpolarized [Fresnel 1823].

use super::Rgb;

/// Reflectance of an interface between two clear media and the cosine of the refracted direction.
///
/// `cos` in (0, 1] is taken on the side where light arrives; `eta` = n_t / n_i is the index of the far side relative to
/// the near one. (1, 0) under total reflection. [Born & Wolf 1999, sec. 1.5.2, eqs. 20 and 21]
#[inline]
pub fn dielectric(cos: f64, eta: f64) -> (f64, f64) {
    let sin2_t = (1.0 - cos * cos) / (eta * eta);
    if sin2_t >= 1.0 {
        return (1.0, 0.0);
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos - cos_t) / (eta * cos + cos_t);
    let perpendicular = (cos - eta * cos_t) / (cos + eta * cos_t);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), cos_t)
}

/// Reflectance of a metal whose complex index relative to the near side is `eta` + i `k`, channel by channel;
/// `cos` in (0, 1]. [Born & Wolf 1999, sec. 14.2, in the real form of Lazányi & Szirmay-Kalos 2005]
#[inline]
pub fn conductor(cos: f64, eta: Rgb, k: Rgb) -> Rgb {
    Rgb::new(one_channel(cos, eta.x, k.x), one_channel(cos, eta.y, k.y), one_channel(cos, eta.z, k.z))
}

fn one_channel(cos: f64, eta: f64, k: f64) -> f64 {
    let (cos2, sin2) = (cos * cos, 1.0 - cos * cos);
    // (a + ib)² = (eta + ik)² - sin²
    let real = eta * eta - k * k - sin2;
    let modulus = (real * real + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (modulus + real)).max(0.0).sqrt();
    let perpendicular = (modulus + cos2 - 2.0 * a * cos) / (modulus + cos2 + 2.0 * a * cos);
    let (sum, cross) = (modulus * cos2 + sin2 * sin2, 2.0 * a * cos * sin2);
    let parallel = perpendicular * (sum - cross) / (sum + cross);
    0.5 * (perpendicular + parallel)
}
