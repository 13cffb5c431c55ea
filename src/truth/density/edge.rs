//! What a kernel misses where the surface ends, and what it finds too much where another one begins. Flat surfaces, uniform
//! irradiance; all factors are dimensionless and hold for any unit of length.

use super::Kernel;
use std::f64::consts::PI;

/// Factor at `distance` from a straight edge, on the surface; in [1/2, 1], and 1 from `radius` on.
///
/// The box kernel misses the segment of a circle, [acos s - s √(1 - s²)]/π with s = `distance`/`radius`.
pub fn straight(kernel: Kernel, distance: f64, radius: f64) -> f64 {
    assert!(distance >= 0.0 && radius > 0.0, "{distance} from an edge with radius {radius}");
    let s = distance / radius;
    if s >= 1.0 {
        return 1.0;
    }
    let (angle, chord) = (libm::acos(s), ((1.0 - s) * (1.0 + s)).sqrt());
    let area = angle - s * chord;
    let missed = match kernel {
        Kernel::Box => area,
        Kernel::Cone { c } => area - first_moment(s, angle, chord) / c,
        Kernel::Epanechnikov => 0.5 * (angle - s * chord * (5.0 - 2.0 * s * s) / 3.0),
    };
    1.0 - missed / (PI * kernel.share())
}

/// Integral of the distance from the centre over the unit circle's segment beyond s.
fn first_moment(s: f64, angle: f64, chord: f64) -> f64 {
    let beside = if s == 0.0 { 0.0 } else { s * s * s * libm::log((1.0 + chord) / s) };
    (2.0 * angle - s * chord - beside) / 3.0
}

/// Factor of every kernel at the tip of a wedge with that inner angle \[rad\], in (0, 2π]: 1/2 on a straight edge, 1/4 in a
/// square corner. K nearest neighbours have this times their own factor.
pub fn wedge(angle: f64) -> f64 {
    assert!(angle > 0.0 && angle <= 2.0 * PI, "a wedge of {angle} rad");
    angle / (2.0 * PI)
}

/// Factor of the box kernel in a square corner, at the given distances from its two edges, both at least 0; in [1/4, 1].
pub fn square_corner(distances: (f64, f64), radius: f64) -> f64 {
    let (s, t) = (distances.0 / radius, distances.1 / radius);
    let one = |distance| 1.0 - straight(Kernel::Box, distance, radius);
    let both = if s * s + t * t < 1.0 {
        let (far, high) = ((1.0 - t * t).sqrt(), (1.0 - s * s).sqrt());
        // under the arc from s to far, less the rectangle below t
        let arc = 0.5 * (far * t - s * high + libm::acos(s) - libm::acos(far));
        (arc - t * (far - s)) / PI
    } else {
        0.0
    };
    1.0 - one(distances.0) - one(distances.1) + both
}

/// What a perpendicular wall of equal irradiance, which rises from the edge at `distance`, adds to the factor if photons
/// are taken from a ball without a look at their surface's normal; in [0, 1/2], 0 from `radius` on.
///
/// (1 - s²)/2 for the box kernel: at s = 0 it makes up for what the floor lacks.
pub fn wall(kernel: Kernel, distance: f64, radius: f64) -> f64 {
    assert!(distance >= 0.0 && radius > 0.0, "{distance} from a wall with radius {radius}");
    let s = distance / radius;
    if s >= 1.0 {
        return 0.0;
    }
    let square = (1.0 - s) * (1.0 + s);
    let seen = match kernel {
        Kernel::Box => 0.5 * square,
        Kernel::Cone { c } => 0.5 * square - (1.0 - s * s * s) / (3.0 * c),
        Kernel::Epanechnikov => 0.25 * square * square,
    };
    seen / kernel.share()
}
