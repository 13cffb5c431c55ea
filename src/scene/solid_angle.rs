//! Directions drawn uniformly over the solid angle (sr) that a shape fills as seen from a point. The published formulas
//! subtract angles of order one, which leaves nothing of a small or distant shape. Here every small quantity is a
//! product, or the sine of half a small angle, so one formula serves shapes of all sizes.

use glam::DVec3;
use std::f64::consts::PI;

/// A direction sampled uniformly over the solid angle of a shape, as a point on the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidAngleSample {
    /// Where the ray from the receiver in the sampled direction meets the shape, in world coordinates.
    pub point: DVec3,
    /// Solid angle of the whole shape (sr), in (0, 2π]; the density of the direction is 1 / `solid_angle` (1/sr).
    pub solid_angle: f64,
}

/// Heights above a plane below this part of the distance are rounding error: the receiver is in the plane.
const IN_PLANE: f64 = 8.0 * f64::EPSILON;

/// A point on the rectangle `center` ± `half_u` ± `half_v` (perpendicular), uniform over its solid angle (sr) as seen
/// from `from`, for `u` in [0,1)². Both sides count. `None` in the plane of the rectangle, or if it has no area.
///
/// The map of [Ureña, Fajardo, King 2013, An Area-Preserving Parametrization for Spherical Rectangles]:
/// `u.0` places a line parallel to an edge, `u.1` a point on it. Which edge depends on where the receiver is.
pub fn rectangle(
    from: DVec3,
    center: DVec3,
    half_u: DVec3,
    half_v: DVec3,
    u: (f64, f64),
) -> Option<SolidAngleSample> {
    let (length_u, length_v) = (half_u.length(), half_v.length());
    let (to_center, normal) = (center - from, half_u.cross(half_v));
    let z = to_center.dot(normal).abs() / (length_u * length_v);
    if z <= IN_PLANE * (to_center.length() + length_u + length_v) {
        return None;
    }
    // mirrored so that the centre has no negative coordinate: the signs come back at the end
    let (at_u, at_v) = (to_center.dot(half_u) / length_u, to_center.dot(half_v) / length_v);
    let (x, y): (Span, Span) = ((at_u.abs(), length_u), (at_v.abs(), length_v));
    let solid_angle = rectangle_solid_angle(x, y, z);
    // sweep along the edge whose angles are closer in size to the solid angle: less is lost by adding them
    let swap = sweep(ends(y).1, x, z) < sweep(ends(x).1, y, z);
    let (first, second) = if swap { (y, x) } else { (x, y) };
    let angle = sweep(ends(first).0, second, z) + u.0 * solid_angle;
    let fraction = |at: f64, span: Span| ((at - span.0) / span.1).clamp(-1.0, 1.0);
    let s = fraction(sweep_end(angle, second, z), first);
    let p = first.0 + first.1 * s;
    let t = fraction(along((p * p + z * z).sqrt(), second, u.1), second);
    let (s, t) = if swap { (t, s) } else { (s, t) };
    let point = center + half_u * (s * at_u.signum()) + half_v * (t * at_v.signum());
    finish(point, solid_angle)
}

/// Centre (>= 0) and half the length of a rectangle along one of its edges, measured from the foot of the receiver.
type Span = (f64, f64);

fn ends(span: Span) -> (f64, f64) {
    (span.0 - span.1, span.0 + span.1)
}

/// Signed solid angle (sr) of the rectangle [0, x] × `y` at height z. With d² = x² + y² + z² it is the difference of
/// atan(x y / (z d)) between the ends of `y`, by the tangent of a difference, and that by a difference of squares.
fn sweep(x: f64, y: Span, z: f64) -> f64 {
    let (r2, (y0, y1)) = (x * x + z * z, ends(y));
    let (d0, d1) = ((r2 + y0 * y0).sqrt(), (r2 + y1 * y1).sqrt());
    let close = 4.0 * y.0 * y.1 * r2 / (y1 * d0 + y0 * d1);
    let gap = if y0 > 0.0 { close } else { y1 * d0 - y0 * d1 };
    libm::atan2(z * x * gap, z * z * d0 * d1 + x * x * y0 * y1)
}

/// The x at which `sweep` is `angle`. With x = z tan φ and b = y / √(y² + z²), the sweep is C = asin(b1 sin φ) -
/// asin(b0 sin φ), so sin² φ = sin² C / (b0² + b1² - 2 b0 b1 cos C), and tan φ needs only products of sines.
fn sweep_end(angle: f64, y: Span, z: f64) -> f64 {
    let (y0, y1) = ends(y);
    // the angles between the ends of `y` and its axis: their difference (the limit of the sweep) and sum
    let b = libm::atan2(2.0 * y.1 * z, z * z + y0 * y1);
    let k = libm::atan2(z, y0) + libm::atan2(z, y1);
    let pair = |limit: f64| libm::sin(0.5 * (limit - angle)) * libm::sin(0.5 * (limit + angle));
    // rounding may carry `angle` past its limit, where x is infinite: the caller clamps
    0.5 * z * libm::sin(angle) / (pair(b) * pair(k)).max(f64::MIN_POSITIVE).sqrt()
}

/// The y at which y / √(d² + y²) is the fraction `v` of its range: the solid angle of a thin strip is proportional to
/// it. Interpolates one minus that, which keeps its digits where all are close to one.
fn along(d: f64, y: Span, v: f64) -> f64 {
    let lack = |y: f64| {
        let r = (d * d + y * y).sqrt();
        let above = d * d / (r * (r + y.abs()));
        if y > 0.0 { above } else { 2.0 - above }
    };
    let k = (1.0 - v) * lack(ends(y).0) + v * lack(ends(y).1);
    d * (1.0 - k) / (k * (2.0 - k)).sqrt()
}

/// Solid angle (sr) of the rectangle `x` × `y` at height z: in two parts of one sign on the two sides of the foot, or
/// in two triangles where the foot is beside the rectangle.
fn rectangle_solid_angle(x: Span, y: Span, z: f64) -> f64 {
    let ((x0, x1), (y0, y1)) = (ends(x), ends(y));
    if x0 <= 0.0 {
        sweep(x1, y, z) - sweep(x0, y, z)
    } else if y0 <= 0.0 {
        sweep(y1, x, z) - sweep(y0, x, z)
    } else {
        let corner = |x, y| DVec3::new(x, y, z);
        let (a, c, det) = (corner(x0, y0), corner(x1, y1), 4.0 * x.1 * y.1 * z);
        let upper = triangle_solid_angle(det, a, c, corner(x0, y1));
        upper + triangle_solid_angle(det, a, corner(x1, y0), c)
    }
}

/// Solid angle (sr) of the triangle with corners a, b, c from the receiver and |det(a, b, c)|: [Van Oosterom, Strackee
/// 1983, The Solid Angle of a Plane Triangle, equation 8].
fn triangle_solid_angle(det: f64, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let denominator = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    2.0 * libm::atan2(det, denominator)
}

/// A point on the triangle `a`, `b`, `c` (either orientation), uniform over its solid angle (sr) as seen from `from`,
/// for `u` in [0,1)². Both sides count. `None` in the plane of the triangle, or if it has no area.
///
/// The map of [Arvo 1995, Stratified Sampling of Spherical Triangles]: `u.0` cuts off a part by a line from `b` to a
/// point of the edge `a c` (here by solving Van Oosterom and Strackee's equation), `u.1` is a point on that line.
pub fn triangle(from: DVec3, a: DVec3, b: DVec3, c: DVec3, u: (f64, f64)) -> Option<SolidAngleSample> {
    let (ra, rb, rc) = (a - from, b - from, c - from);
    let (la, lb, normal) = (ra.length(), rb.length(), (b - a).cross(c - a));
    let det = ra.dot(normal).abs();
    if det <= IN_PLANE * normal.length() * la.max(lb).max(rc.length()) {
        return None;
    }
    let solid_angle = triangle_solid_angle(det, ra, rb, rc);
    // products with an edge: ra × rb would lose the digits of a small triangle
    let (ab, ac) = (ra.cross(b - a), ra.cross(c - a));
    let (sin, cos) = libm::sincos(0.5 * u.0 * solid_angle);
    // la lb (1 + cos of the angle between them), by a sum of vectors, which is better when they are opposite
    let near = (ra * lb + rb * la).length_squared() / (2.0 * la * lb);
    let cut = 2.0 * libm::atan2(sin * near * ac.length(), cos * la * det - sin * ab.dot(ac));
    let p = a + (c - a) * edge_fraction(ra, rc, libm::atan2(ac.length(), ra.dot(rc)), cut);
    let side = libm::atan2(rb.cross(p - b).length(), rb.dot(p - from));
    // 1 - cos is uniform along the line: both are 2 sin² of the half angle
    let angle = 2.0 * libm::asin(u.1.sqrt() * libm::sin(0.5 * side));
    let point = b + (p - b) * edge_fraction(rb, p - from, side, angle);
    finish(point, solid_angle)
}

/// Fraction of the edge p q, seen under the angle `side`, up to the direction at `angle` from p: the law of sines.
fn edge_fraction(p: DVec3, q: DVec3, side: f64, angle: f64) -> f64 {
    let angle = angle.max(0.0).min(side);
    let before = libm::sin(angle) * p.length();
    before / (before + libm::sin(side - angle) * q.length())
}

/// A point on the visible part of a sphere, uniform over its solid angle (sr) as seen from `from` (a cone), for `u` in
/// [0,1)². `None` inside or on the sphere, or if `radius` is not positive.
///
/// The cone of [Shirley, Wang, Zimmerman 1996, Monte Carlo Techniques for Direct Lighting Calculations]. Where a
/// direction meets the sphere follows from the law of sines: the angle at the centre is that of incidence minus θ.
pub fn sphere(from: DVec3, center: DVec3, radius: f64, u: (f64, f64)) -> Option<SolidAngleSample> {
    let distance = from.distance(center);
    if radius <= 0.0 || distance <= radius {
        return None;
    }
    let edge = ((distance - radius) * (distance + radius)).sqrt();
    // 1 - cos of the cone and of the direction, without the cancellation in a small cone
    let m = radius / distance * radius / (distance + edge);
    let k = u.0 * m;
    let (sin, cos) = ((k * (2.0 - k)).sqrt(), 1.0 - k);
    // of the angle of incidence: sin θ distance / radius, in which m cancels
    let sin_hit = (u.0 * (2.0 - k) / (2.0 - m)).sqrt();
    let cos_hit = ((1.0 - u.0) * (2.0 - m - k) / (2.0 - m)).sqrt();
    let towards = (from - center) / distance;
    let (s, t) = towards.any_orthonormal_pair();
    let (sin_around, cos_around) = libm::sincos(2.0 * PI * u.1);
    let across = (s * cos_around + t * sin_around) * (sin_hit * cos - cos_hit * sin);
    let normal = towards * (cos_hit * cos + sin_hit * sin) + across;
    finish(center + normal * radius, 2.0 * PI * m)
}

/// Shapes too small for an f64, or not finite, subtend nothing.
fn finish(point: DVec3, solid_angle: f64) -> Option<SolidAngleSample> {
    let valid = solid_angle > 0.0 && solid_angle.is_finite() && point.is_finite();
    valid.then_some(SolidAngleSample { point, solid_angle })
}

#[cfg(test)]
mod tests {
    use super::*;

    const O: DVec3 = DVec3::ZERO;
    const X: DVec3 = DVec3::X;
    const Y: DVec3 = DVec3::new(0.0, 0.7, 0.0);

    /// Above the shapes, beside each edge (once below), beside a corner, and where they fill 1e-10 sr.
    fn receivers() -> [DVec3; 5] {
        let x = [0.3, 2.0, -0.5, 2.5, 3e4];
        let (y, z) = ([-0.2, 0.4, 3.0, 2.2, -8e4], [1.5, -0.9, 1.1, 0.8, 5e4]);
        [0, 1, 2, 3, 4].map(|i| DVec3::new(x[i], y[i], z[i]))
    }

    /// A rectangle, its lower right half and a sphere.
    fn draw(from: DVec3, u: (f64, f64)) -> [SolidAngleSample; 3] {
        let half = triangle(from, -X - Y, X - Y, X + Y, u);
        [rectangle(from, O, X, Y, u), half, sphere(from, O, 0.7, u)].map(Option::unwrap)
    }

    /// Points of the same, each with the normal times the area that the whole unit square stands for.
    fn surfaces(from: DVec3, u: (f64, f64)) -> [(DVec3, DVec3); 3] {
        let (normal, corner) = (DVec3::Z * 2.8, X * (2.0 * u.0 - 1.0) - Y);
        let (towards, cap) = (from.normalize(), 1.0 - 0.7 / from.length());
        let (s, t) = towards.any_orthonormal_pair();
        let (z, (sin, cos)) = (1.0 - u.0 * cap, libm::sincos(2.0 * PI * u.1));
        let n = towards * z + (s * cos + t * sin) * (1.0 - z * z).sqrt();
        let half = (corner + Y * (2.0 * u.0 * u.1), normal * u.0);
        let whole = (corner + Y * (2.0 * u.1), normal);
        [whole, half, (n * 0.7, n * (0.98 * PI * cap))]
    }

    fn mean_of_cells(n: u32, f: impl Fn((f64, f64)) -> DVec3) -> DVec3 {
        let at = |i| (f64::from(i) + 0.5) / f64::from(n);
        (0..n * n).map(|i| f((at(i % n), at(i / n)))).sum::<DVec3>() / f64::from(n * n)
    }

    #[test]
    fn integrals_agree_with_those_over_the_area() {
        for (i, from) in (0..3).flat_map(|i| receivers().map(|from| (i, from))) {
            // the cosine of a slanted receiver, and two that tell points of a distant shape apart
            let cosine = |d: DVec3| d.dot(DVec3::new(0.6, -0.48, 0.64)) / d.length();
            let f = |p: DVec3| DVec3::new(cosine(p - from), 0.5 * p.x, 0.5 * p.x * p.y);
            let by_area = mean_of_cells(400, |u| {
                let (p, normal) = surfaces(from, u)[i];
                f(p) * (p - from).dot(normal).abs() / p.distance(from).powi(3)
            });
            let by_angle = mean_of_cells(512, |u| f(draw(from, u)[i].point));
            let error = by_angle - by_area / draw(from, (0.0, 0.0))[i].solid_angle;
            assert!(error.abs().max_element() < 1e-5, "{i} {from} {error}");
        }
    }

    #[test]
    fn solid_angles_agree_with_other_formulas() {
        let angle = |p: DVec3, q, r| p.cross(q).angle_between(p.cross(r));
        for &from in &receivers()[..4] {
            let [a, b, c] = [-X - Y, X - Y, X + Y].map(|p| p - from);
            let excess = angle(a, b, c) + angle(b, c, a) + angle(c, a, b) - PI;
            let [whole, half, ball] = draw(from, (0.0, 0.0)).map(|s| s.solid_angle);
            let other = triangle(O, c, a, Y - X - from, (0.0, 0.0)).unwrap();
            let cone = 2.0 * PI * (1.0 - (1.0 - 0.49 / from.length_squared()).sqrt());
            let both = half + other.solid_angle;
            let errors = DVec3::new(half / excess, whole / both, ball / cone) - 1.0;
            assert!(errors.abs().max_element() < 1e-13, "{errors}");
        }
    }

    #[test]
    fn near_receivers_see_equal_parts() {
        // beside the longer edge: the line is parallel to it and comes from the other side
        let from = DVec3::new(2.0, 0.4, 1e-6);
        let [whole, half, _] = draw(from, (0.3, 1f64.next_down()));
        let cut = whole.point.with_x(0.0) * 0.5;
        let low = rectangle(from, cut - Y * 0.5, X, cut + Y * 0.5, (0.0, 0.0)).unwrap();
        assert!((low.solid_angle / whole.solid_angle - 0.7).abs() < 1e-8);
        let part = triangle(from, -X - Y, X - Y, half.point, (0.0, 0.0)).unwrap();
        assert!((part.solid_angle / half.solid_angle - 0.3).abs() < 1e-8);
    }

    #[test]
    fn points_are_on_the_shape_at_all_distances() {
        let us = [0.0, 1e-300, 0.3, 0.999, 1f64.next_down()];
        for i in 0..500 {
            let h = [1e-12, 1e-9, 1e-3, 1.0, 1e4][i / 4 % 5];
            let (from, u) = (receivers()[i % 4], (us[i / 20 % 5], us[i / 100]));
            let from = if h < 1.0 { from.with_z(h) } else { from * h };
            let p = rectangle(from, O, X, Y, u).unwrap().point;
            assert!(p.z == 0.0 && p.x.abs() <= 1.0 && p.y.abs() <= 0.7, "{p}");
            let p = triangle(from, -X - Y, X - Y, X + Y, u).unwrap().point;
            let outside = (p.x - 1.0).max(-0.7 - p.y).max(p.y - 0.7 * p.x);
            assert!(p.z == 0.0 && outside < 1e-15, "{p}");
            let from = DVec3::new(0.0, 0.0, -0.5 - h);
            let p = sphere(from, O, 0.5, u).unwrap().point;
            let hidden = p.dot(p - from) / from.length();
            assert!((p.length() - 0.5).abs() < 1e-15 && hidden < 1e-15, "{p}");
            // nothing is seen from within the plane or on the sphere, or of what has no area
            let flat = rectangle(X * h, O, X, Y, u).or(triangle(X, -X, X, Y, u));
            let thin = rectangle(from, O, X, O, u).or(triangle(from, -X, X, O, u));
            let inside = sphere(X * h, O, h, u).or(sphere(X, O, 0.0, u));
            assert_eq!(flat.or(thin).or(inside), None);
        }
    }
}
