//! Point lights against geometry, quadrature over the sphere, and simulation.

use crate::common::{close, simpson};
use furnace::truth::direct::point_light::{PointInSphere, irradiance};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

const CASES: [PointInSphere; 3] = [
    PointInSphere { intensity: 2.0, offset: 0.7, radius: 1.5, albedo: 0.6 },
    PointInSphere { intensity: 1.0, offset: 0.0, radius: 1.0, albedo: 0.5 },
    PointInSphere { intensity: 3.0, offset: 1e-5, radius: 2.0, albedo: 0.8 },
];

#[test]
fn irradiance_is_what_a_small_patch_receives() {
    let light = dvec3(0.4, -0.3, 1.2);
    close(irradiance(2.0, DVec3::Z * 2.0, DVec3::ZERO, DVec3::Z), 0.5, 1e-16);
    assert_eq!(irradiance(2.0, light, DVec3::ZERO, -DVec3::Z), 0.0);
    // over a plane it adds up to the flux of half the directions, 2 pi I, in rings r = tan
    let flux = simpson(2000, 0.0, 1.0, |x| {
        let r = x / (1.0 - x).max(1e-9);
        let on_ring = irradiance(2.0, DVec3::Z, DVec3::X * r, DVec3::Z);
        2.0 * PI * r * on_ring / (1.0 - x).max(1e-9).powi(2)
    });
    close(flux, 4.0 * PI, 1e-6);
}

#[test]
fn a_sphere_around_a_point_light() {
    for case in CASES {
        let light = DVec3::Z * case.offset;
        for mu in [-1.0, -0.4, 0.3, 1.0] {
            let n = dvec3(f64::sqrt(1.0 - mu * mu), 0.0, mu);
            close(case.irradiance(mu), irradiance(case.intensity, light, n * case.radius, -n), 1e-14);
        }
        let moment = |power: i32| simpson(3000, -1.0, 1.0, |mu| 0.5 * case.irradiance(mu).powi(power));
        close(case.mean_irradiance(), moment(1), 1e-9);
        close(case.mean_square_irradiance(), moment(2), 1e-9);
        let mean = moment(1);
        let variance = simpson(3000, -1.0, 1.0, |mu| 0.5 * (case.irradiance(mu) - mean).powi(2));
        close(case.irradiance_variance(), variance, 1e-8 * variance + 1e-15);
        // radiance solves L = albedo / pi (D + pi mean L): from a wall point all of the wall looks alike
        let mean_radiance = simpson(3000, -1.0, 1.0, |mu| 0.5 * case.radiance(mu));
        let balance = case.albedo / PI * (case.irradiance(0.2) + PI * mean_radiance);
        close(case.radiance(0.2), balance, 1e-9);
        // the published sum, which has no value at offset 0
        let (a, r) = (case.offset, case.radius);
        if a > 0.1 {
            let d = r * r - a * a;
            let bracket =
                4.0 * a * r * (r * r + a * a) / (d * d) + 8.0 * a * r / d + 2.0 * ((r + a) / (r - a)).ln();
            let published = case.intensity.powi(2) / (16.0 * a * r.powi(3)) * bracket;
            close(case.mean_square_irradiance(), published, 1e-14);
        }
    }
}

#[test]
fn explicit_variance_matches_its_recursion_and_simulation() {
    let case = CASES[0];
    let (scale, rho, q) = (case.albedo / PI, case.albedo, 0.7);
    let a1 = scale * case.mean_irradiance();
    let a2 = scale * scale * case.mean_square_irradiance();
    let m = a1 / (1.0 - rho);
    let e2 = (a2 + 2.0 * a1 * rho * m) / (1.0 - rho * rho / q);
    let variance = case.explicit_variance(q);
    close(variance, rho * rho / q * e2 - rho * rho * m * m, 1e-14);

    // uniform numbers by a linear congruence (Knuth, MMIX)
    let mut state = 1_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let paths = 1_000_000;
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..paths {
        let (mut x, mut weight) = (scale * case.irradiance(0.2), 1.0);
        while uniform() < q {
            weight *= rho / q;
            x += weight * scale * case.irradiance(2.0 * uniform() - 1.0);
        }
        (sum, squares) = (sum + x, squares + x * x);
    }
    let mean = sum / f64::from(paths);
    let simulated = squares / f64::from(paths) - mean * mean;
    close(mean, case.radiance(0.2), 5.0 * (variance / f64::from(paths)).sqrt());
    close(simulated, variance, 0.02 * variance);
}

#[test]
fn the_edges_of_explicit_variance() {
    let centred = CASES[1];
    assert_eq!(centred.explicit_variance(1.0), 0.0);
    assert_eq!(centred.explicit_variance(0.25), f64::INFINITY);
    assert_eq!(centred.explicit_variance(0.2), f64::INFINITY);
    assert!(centred.explicit_variance(0.26).is_finite());
}
