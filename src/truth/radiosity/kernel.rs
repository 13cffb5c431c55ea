//! Exact exchange between axis-aligned rectangles on the walls of the unit cube.
//!
//! A_1 F_12 is the integral of cos cos' / (pi d^2) over both rectangles. Four indefinite integrations of it are known in
//! closed form, one for parallel and one for perpendicular planes (Gross, Spindler & Hahne 1981; Ehlert & Smith 1993),
//! so that A_1 F_12 is a sum over pairs of corners with alternating signs.
//! All transcendental functions are libm's: the results have the same bits on every machine.

use super::mesh::{WALLS, Wall};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Indefinite integral for parallel planes at distance `c` in m; `u`, `v` are the offsets of the two corners along the two
/// axes in m. Its derivative by u, u, v, v is c^2 / (pi r^4) with r^2 = u^2 + v^2 + c^2.
pub(crate) fn parallel(u: f64, v: f64, c: f64) -> f64 {
    let (uu, vv, cc) = (u * u, v * v, c * c);
    let (a, b) = ((uu + cc).sqrt(), (vv + cc).sqrt());
    let arcs = v * a * libm::atan(v / a) + u * b * libm::atan(u / b);
    0.5 * FRAC_1_PI * (arcs - 0.5 * cc * libm::log(uu + vv + cc))
}

/// Indefinite integral for perpendicular planes; `u` is the offset of the two corners along the common edge line, `y` and
/// `z` their distances from it in m. Its derivative by u, u, y, z is -y z / (pi r^4) with r^2 = u^2 + y^2 + z^2.
pub(crate) fn perpendicular(u: f64, y: f64, z: f64) -> f64 {
    let (uu, ww) = (u * u, y * y + z * z);
    if uu + ww == 0.0 {
        return 0.0; // the limit
    }
    let w = ww.sqrt();
    let logarithm = 0.5 * (uu - ww) * libm::log(uu + ww);
    0.25 * FRAC_1_PI * (logarithm + 2.0 * u * w * libm::atan(u / w))
}

/// Two different walls of the cube.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    a: Wall,
    b: Wall,
    sign: f64,
}

impl Pair {
    /// `a` and `b` are indices into [`WALLS`].
    pub fn new(a: usize, b: usize) -> Self {
        assert_ne!(a, b, "points of one wall do not see each other");
        let (a, b) = (WALLS[a], WALLS[b]);
        // distance from a wall at 1 falls where the coordinate rises
        let sign = if a.normal == b.normal || a.position == b.position { 1.0 } else { -1.0 };
        Pair { a, b, sign }
    }

    /// The function of a corner `p` on the first and `q` on the second wall whose four successive differences - by both
    /// coordinates of `p` and of `q`, upper minus lower - are A_1 F_12 [m^2]. Rounding: about 1e-17 m^2.
    pub fn corner(&self, p: DVec3, q: DVec3) -> f64 {
        let d = p - q;
        if self.a.normal == self.b.normal {
            let [s, t] = self.a.axes();
            return parallel(d[s], d[t], self.a.position - self.b.position);
        }
        let common = 3 - self.a.normal - self.b.normal;
        // q lies in the second wall's plane and p in the first's: these are the distances from the common edge
        self.sign * perpendicular(d[common], d[self.b.normal].abs(), d[self.a.normal].abs())
    }
}
