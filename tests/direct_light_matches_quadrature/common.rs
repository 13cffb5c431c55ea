//! Quadrature and ray tests that share nothing with the formulas under test.
#![allow(dead_code, reason = "each test uses some")]

use glam::DVec3;
use std::f64::consts::PI;

/// Simpson's rule with 2 `n` intervals.
pub fn simpson(n: u32, a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let h = (b - a) / f64::from(2 * n);
    let at = |i: u32| f(a + h * f64::from(i));
    let inner: f64 = (1..2 * n).map(|i| if i % 2 == 1 { 4.0 * at(i) } else { 2.0 * at(i) }).sum();
    h / 3.0 * (at(0) + inner + at(2 * n))
}

/// cos cos' / (π d²) from the element at `p` to a light element at `q` whose normal is `m`.
pub fn kernel(p: DVec3, n: DVec3, q: DVec3, m: DVec3) -> f64 {
    let d = q - p;
    let square = d.length_squared();
    (n.dot(d).max(0.0) * (-m.dot(d)).max(0.0)) / (PI * square * square)
}

/// Form factor of the parallelogram c + su + tv, which shines along u × v, by Simpson's rule in s and t.
pub fn parallelogram_factor(p: DVec3, n: DVec3, [c, u, v]: [DVec3; 3], steps: u32) -> f64 {
    let area = u.cross(v);
    let m = area.normalize();
    let line = |s: f64| simpson(steps, 0.0, 1.0, |t| kernel(p, n, c + u * s + v * t, m));
    area.length() * simpson(steps, 0.0, 1.0, line)
}

/// The same by the midpoint rule over the unhidden points; first order at shadow borders.
pub fn visible_factor(
    (p, n): (DVec3, DVec3),
    [c, u, v]: [DVec3; 3],
    steps: u32,
    hidden: impl Fn(DVec3, DVec3) -> bool,
) -> f64 {
    let area = u.cross(v);
    let m = area.normalize();
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(steps);
    let mut sum = 0.0;
    for i in 0..steps {
        for j in 0..steps {
            let q = c + u * at(i) + v * at(j);
            sum += if hidden(p, q) { 0.0 } else { kernel(p, n, q, m) };
        }
    }
    sum * area.length() / f64::from(steps * steps)
}

/// Whether the segment from `p` to `q` meets the convex body of the points x with normal · (x - point) <= 0 for all
/// pairs (point, normal).
pub fn crosses(body: &[(DVec3, DVec3)], p: DVec3, q: DVec3) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for &(point, normal) in body {
        let (at_p, at_q) = (normal.dot(p - point), normal.dot(q - point));
        if at_p > 0.0 && at_q > 0.0 {
            return false;
        }
        let t = at_p / (at_p - at_q);
        if at_p > 0.0 {
            enter = enter.max(t);
        } else if at_q > 0.0 {
            leave = leave.min(t);
        }
    }
    enter < leave
}

/// The sides of the parallelepiped with corner `c` and edges `u`, `v`, `w`, right-handed.
pub fn sides([c, u, v, w]: [DVec3; 4]) -> [(DVec3, DVec3); 6] {
    let far = c + u + v + w;
    [
        (c, v.cross(u)),
        (c, w.cross(v)),
        (c, u.cross(w)),
        (far, u.cross(v)),
        (far, v.cross(w)),
        (far, w.cross(u)),
    ]
}

/// A parallelogram's corners.
pub fn corners([c, u, v]: [DVec3; 3]) -> [DVec3; 4] {
    [c, c + u, c + u + v, c + v]
}

pub fn close(value: f64, wanted: f64, tolerance: f64) {
    assert!(
        (value - wanted).abs() <= tolerance,
        "{value:e} against {wanted:e}, off by {:.1e}",
        value - wanted
    );
}
