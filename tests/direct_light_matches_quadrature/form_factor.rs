//! Form factors against quadrature over the light and against special cases.

use crate::common::{close, corners, kernel, parallelogram_factor, simpson};
use furnace::truth::direct::form_factor::{
    cosine_sky, cosine_sky_variance, disk_coaxial, disk_parallel, disk_perpendicular, polygon, sphere,
};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

#[test]
fn polygons_match_quadrature_over_their_area() {
    let light = [dvec3(-0.4, 0.3, 1.1), dvec3(0.2, 1.0, 0.4), dvec3(0.9, -0.1, 0.3)];
    for (p, n) in [
        (DVec3::ZERO, dvec3(0.1, 0.2, 1.0).normalize()),
        (dvec3(-0.2, 0.1, 0.3), dvec3(0.5, 0.8, 1.0).normalize()),
        (dvec3(0.1, 0.9, 0.0), DVec3::Z),
    ] {
        let wanted = parallelogram_factor(p, n, light, 100);
        assert!(wanted > 0.05);
        close(polygon(p, n, &corners(light)), wanted, 1e-9);
    }
}

#[test]
fn a_polygon_below_the_horizon_is_cut_there() {
    // its lower half, z from -1 to 0, does not count
    let whole = [dvec3(1.0, 0.7, -1.0), dvec3(0.2, -1.6, 0.0), dvec3(0.0, 0.0, 2.0)];
    let upper = [dvec3(1.0, 0.7, 0.0), dvec3(0.2, -1.6, 0.0), dvec3(0.0, 0.0, 1.0)];
    let wanted = parallelogram_factor(DVec3::ZERO, DVec3::Z, upper, 100);
    close(polygon(DVec3::ZERO, DVec3::Z, &corners(whole)), wanted, 1e-9);
    let below = corners(whole).map(|c| c - DVec3::Z * 1.001);
    assert_eq!(polygon(DVec3::ZERO, DVec3::Z, &below), 0.0);
}

#[test]
fn a_rectangle_over_its_corner_has_howells_form_factor() {
    for (a, b, h) in [(1.0, 2.0, 0.5), (1e-3, 1.0, 1.0), (100.0, 50.0, 0.1)] {
        let rectangle = [DVec3::Z * h, DVec3::Y * b, DVec3::X * a];
        let side = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        let wanted = (side(a / h, b / h) + side(b / h, a / h)) / (2.0 * PI);
        close(polygon(DVec3::ZERO, DVec3::Z, &corners(rectangle)), wanted, 1e-15);
    }
}

#[test]
fn walls_all_around_cover_the_hemisphere() {
    let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let inward = [[o, x, y], [z, y, x], [o, y, z], [x, z, y], [o, z, x], [y, x, z]];
    for p in [dvec3(0.3, 0.6, 0.2), dvec3(1e-7, 0.5, 1.0 - 1e-9), dvec3(0.5, 0.5, 1e-9)] {
        for n in [z, dvec3(1.0, 2.0, -3.0).normalize(), dvec3(-1.0, 1e-9, 0.0).normalize()] {
            let sum: f64 = inward.iter().map(|&wall| polygon(p, n, &corners(wall))).sum();
            close(sum, 1.0, 1e-11);
        }
    }
    // on a wall, the other five cover it
    let sum: f64 = inward.iter().map(|&wall| polygon(dvec3(0.3, 0.6, 0.0), z, &corners(wall))).sum();
    close(sum, 1.0, 1e-14);
}

#[test]
fn a_polygon_with_a_notch_is_the_sum_of_its_convex_parts() {
    let l = [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 1.0), (3.0, 1.0), (3.0, 0.0)];
    let at = |x: f64, y: f64| dvec3(x - 0.5, y - 1.5, 1.1 + 0.3 * x - 0.6 * y);
    let whole = l.map(|(x, y)| at(x, y));
    let parts = [
        [at(0.0, 0.0), at(0.0, 2.0), at(1.0, 2.0), at(1.0, 0.0)],
        [at(1.0, 0.0), at(1.0, 1.0), at(3.0, 1.0), at(3.0, 0.0)],
    ];
    let value = polygon(DVec3::ZERO, DVec3::Z, &whole);
    assert!(value > 0.01 && whole.iter().any(|c| c.z < 0.0));
    close(value, parts.iter().map(|part| polygon(DVec3::ZERO, DVec3::Z, part)).sum(), 1e-15);
}

#[test]
fn nothing_is_seen_from_behind_or_from_the_plane() {
    let light = [dvec3(0.1, 0.2, 1.0), dvec3(0.3, 1.0, 0.4), dvec3(1.0, -0.1, 0.2)];
    let ring = corners(light);
    let n = DVec3::Z;
    assert!(polygon(DVec3::ZERO, n, &ring) > 0.0);
    let mut back = ring;
    back.reverse();
    assert_eq!(polygon(DVec3::ZERO, n, &back), 0.0);
    // beside, inside, on an edge, on its extension, on a corner
    let [c, u, v] = light;
    for (s, t) in [(1.7, -0.3), (0.4, 0.3), (0.5, 0.0), (-2.0, 0.0), (0.0, 0.0), (1.0, 1.0)] {
        assert_eq!(polygon(c + u * s + v * t, n, &ring), 0.0, "{s} {t}");
    }
    // hardly above the plane, beside the light and on the extension of an edge
    for s in [1.5, -0.5] {
        let f = polygon(c + u * s + u.cross(v) * -1e-9, n, &ring);
        assert!((0.0..1e-8).contains(&f), "{f}");
    }
    assert_eq!(polygon(DVec3::ZERO, n, &[]), 0.0);
}

/// Directions at angle alpha from the centre's, sin sigma = radius / distance, around which cos θ is clipped at 0.
fn sphere_by_rings(theta: f64, sigma: f64) -> f64 {
    let ring = |alpha: f64| {
        let (a, b) = (alpha.cos() * theta.cos(), alpha.sin() * theta.sin());
        let up =
            if b.abs() < 1e-300 { if a > 0.0 { PI } else { 0.0 } } else { (-a / b).clamp(-1.0, 1.0).acos() };
        2.0 * alpha.sin() * (a * up + b * up.sin()) / PI
    };
    // the rings that the horizon touches give a power 3/2, which the square makes smooth
    let kink = (PI / 2.0 - theta).abs().min(sigma);
    simpson(2000, 0.0, kink, ring)
        + simpson(2000, 0.0, 1.0, |s| 2.0 * s * (sigma - kink) * ring(kink + (sigma - kink) * s * s))
}

#[test]
fn spheres_match_quadrature_over_directions() {
    for (radius, distance) in [(1.0, 1.2), (1.0, 3.0), (0.01, 1.0)] {
        let sigma = f64::asin(radius / distance);
        for step in 0..=36 {
            let theta = PI * f64::from(step) / 36.0;
            let n = dvec3(theta.sin(), 0.0, theta.cos());
            let p = dvec3(0.2, -0.4, 0.7);
            let value = sphere(p, n, p + DVec3::Z * distance, radius);
            close(value, sphere_by_rings(theta, sigma), 1e-11);
        }
    }
}

#[test]
fn a_sphere_is_continuous_at_the_horizon_and_on_its_surface() {
    let (centre, radius) = (DVec3::Z * 2.0, 1.0);
    let at = |theta: f64| sphere(DVec3::ZERO, dvec3(theta.sin(), 0.0, theta.cos()), centre, radius);
    for border in [PI / 3.0, 2.0 * PI / 3.0] {
        close(at(border - 1e-9), at(border + 1e-9), 1e-8);
    }
    assert_eq!(at(2.0 * PI / 3.0 + 1e-9), 0.0);
    // on the surface the sphere covers a half-space
    for theta in [0.3_f64, 1.2, 2.0] {
        let n = dvec3(theta.sin(), 0.0, theta.cos());
        close(sphere(DVec3::Z, n, centre, radius), 0.5 * (1.0 + theta.cos()), 1e-15);
    }
    assert_eq!(sphere(DVec3::Z, -DVec3::Z, centre, radius), 0.0);
    assert_eq!(sphere(DVec3::Z * 1.5, DVec3::X, centre, radius), 1.0);
}

fn disk_by_quadrature(n: DVec3, centre: DVec3, radius: f64) -> f64 {
    let ring = |r: f64| {
        let at = |phi: f64| centre + dvec3(r * phi.cos(), r * phi.sin(), 0.0);
        r * simpson(100, 0.0, 2.0 * PI, |phi| kernel(DVec3::ZERO, n, at(phi), -DVec3::Z))
    };
    simpson(200, 0.0, radius, ring)
}

#[test]
fn disks_match_quadrature_over_their_area() {
    for (offset, height, radius) in [(0.0, 1.0, 1.0), (0.7, 0.9, 0.4), (0.5, 0.8, 1.3), (3.0, 1.0, 0.01)] {
        let wanted = disk_by_quadrature(DVec3::Z, dvec3(offset, 0.0, height), radius);
        close(disk_parallel(offset, height, radius), wanted, 1e-9 * wanted);
        if radius < offset {
            let wanted = disk_by_quadrature(DVec3::X, dvec3(offset, 0.0, height), radius);
            close(disk_perpendicular(offset, height, radius), wanted, 1e-9 * wanted);
        }
    }
    close(disk_parallel(0.0, 0.3, 0.4), disk_coaxial(0.3, 0.4), 1e-15);
    close(disk_coaxial(3.0, 4.0), 0.64, 1e-15);
    // on the disk, in its plane, far away
    assert_eq!(disk_parallel(0.2, 0.0, 0.4), 1.0);
    assert_eq!(disk_parallel(0.9, 0.0, 0.4), 0.0);
    close(disk_parallel(1e6, 1.0, 1e-6) / 1e-36, 1.0, 1e-11);
    assert_eq!(disk_perpendicular(1.0, 0.0, 1.0), 0.0);
}

#[test]
fn skies_match_quadrature_over_directions() {
    for exponent in [0.0, 1.0, 5.0, 30.0] {
        // mu = cos θ of a cosine-weighted direction has density 2 mu
        let moment = |power: f64| simpson(4000, 0.0, 1.0, |mu| 2.0 * mu * mu.powf(power * exponent));
        let mean = cosine_sky(exponent);
        close(mean, moment(1.0), 1e-10);
        close(cosine_sky_variance(exponent), moment(2.0) - mean * mean, 1e-10);
    }
}
