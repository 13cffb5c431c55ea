//! Caustics against rays that are reflected and refracted as vectors: power through a ring is conserved.

use crate::common::{SplitMix, close, fresnel_in_angles, integrate};
use furnace::truth::optics::caustic::{Paraboloid, Pool};
use std::f64::consts::PI;

/// A ray from the focus at `angle` to the downward axis, reflected by the paraboloid z = s²/4f; returns where
/// it crosses the focal plane and how far its direction is from the axis.
fn reflect(f: f64, angle: f64) -> (f64, f64) {
    let (dx, dz) = (angle.sin(), -angle.cos());
    // (t dx)² = 4 f (f + t dz)
    let (a, b, c) = (dx * dx, -4.0 * f * dz, -4.0 * f * f);
    let t = -2.0 * c / (b + (b * b - 4.0 * a * c).sqrt());
    let s = t * dx;
    let length = (1.0 + (s / (2.0 * f)).powi(2)).sqrt();
    let normal = (-s / (2.0 * f) / length, 1.0 / length);
    let along = 2.0 * (dx * normal.0 + dz * normal.1);
    let out = (dx - along * normal.0, dz - along * normal.1);
    let to_plane = (f - (f + t * dz)) / out.1;
    (s + to_plane * out.0, out.0)
}

#[test]
fn paraboloid_conserves_the_power_through_rings() {
    let mirror = Paraboloid { focal_length: 0.7, intensity: 3.0 };
    for (inner, outer) in [(1e-9, 0.2), (0.3, 0.31), (0.5, 2.0), (1.0, 2.8)] {
        let ((s0, off0), (s1, off1)) = (reflect(0.7, inner), reflect(0.7, outer));
        assert!(off0.abs() < 1e-12 && off1.abs() < 1e-12);
        let sent = 2.0 * PI * mirror.intensity * (f64::cos(inner) - f64::cos(outer));
        let arrived = integrate(s0, s1, 1e-12, &|s| mirror.irradiance(s) * 2.0 * PI * s);
        close(arrived, sent, 1e-9);
        close(mirror.flux(s1) - mirror.flux(s0), sent, 1e-9);
    }
    close(mirror.irradiance(0.0), 3.0 / 0.49, 1e-15);
}

const POOLS: [Pool; 4] = [
    Pool { height: 1.0, depth: 2.0, n: 1.33, intensity: 5.0 },
    Pool { height: 0.01, depth: 3.0, n: 1.5, intensity: 1.0 },
    Pool { height: 2.0, depth: 0.0, n: 1.33, intensity: 1.0 },
    Pool { height: 2.0, depth: 1.0, n: 1.0, intensity: 1.0 },
];

/// Where a ray lands, by Snell's law for vectors.
fn land(pool: &Pool, angle: f64) -> f64 {
    let (dx, dz) = (angle.sin(), -angle.cos());
    let at_surface = pool.height / -dz * dx;
    let eta = 1.0 / pool.n;
    let along = -(1.0 - eta * eta * (1.0 - dz * dz)).sqrt();
    at_surface + pool.depth / -along * eta * dx
}

#[test]
fn pool_conserves_the_power_through_rings() {
    for pool in POOLS {
        for (inner, outer) in [(0.0, 0.1), (0.3, 0.301), (0.5, 1.2), (1.2, 1.5)] {
            let (x0, x1) = (land(&pool, inner), land(&pool, outer));
            close(pool.position(outer), x1, 1e-13);
            let entering = |angle: f64| (1.0 - fresnel_in_angles(angle.cos(), pool.n)) * angle.sin();
            let entering = |angle: f64| if pool.n == 1.0 { angle.sin() } else { entering(angle) };
            let sent = 2.0 * PI * pool.intensity * integrate(inner, outer, 1e-14, &entering);
            let arrived = integrate(x0, x1, 1e-11, &|x| pool.irradiance_at(x) * 2.0 * PI * x);
            close(arrived, sent, 1e-7);
        }
    }
}

#[test]
fn pool_agrees_with_a_random_bundle() {
    let pool = POOLS[0];
    let (x0, x1) = (1.0, 1.2);
    let mut random = SplitMix(6);
    let (count, mut sum, mut square) = (4_000_000, 0.0, 0.0);
    for _ in 0..count {
        let cos: f64 = random.uniform();
        let x = land(&pool, cos.acos());
        if x >= x0 && x < x1 {
            let part = 1.0 - fresnel_in_angles(cos, pool.n);
            sum += part;
            square += part * part;
        }
    }
    let scale = 2.0 * PI * pool.intensity / f64::from(count) / (PI * (x1 * x1 - x0 * x0));
    let expected = integrate(x0, x1, 1e-10, &|x| 2.0 * x * pool.irradiance_at(x)) / (x1 * x1 - x0 * x0);
    crate::common::sees(scale * sum, scale * f64::sqrt(square), expected);
}

#[test]
fn irradiance_by_distance_and_by_angle_agree() {
    for pool in POOLS {
        for i in 0..=1560 {
            let angle = f64::from(i) / 1000.0;
            let by_distance = pool.irradiance_at(land(&pool, angle));
            close(by_distance, pool.irradiance(angle), 1e-11);
        }
        close(pool.irradiance(0.0), pool.irradiance_at_foot(), 1e-15);
        close(pool.irradiance_at(0.0), pool.irradiance_at_foot(), 1e-15);
        close(pool.irradiance_at(1e-6), pool.irradiance_at_foot(), 1e-6);
    }
}

#[test]
fn landing_distance_grows() {
    for pool in POOLS {
        let far = (1..1570).map(|i| pool.position(f64::from(i) / 1000.0));
        assert!(far.clone().zip(far.skip(1)).all(|(a, b)| b > a));
    }
}

/// Without water the inverse-square law remains.
#[test]
fn dry_pool_obeys_the_inverse_square_law() {
    for pool in &POOLS[3..] {
        for x in [0.0, 0.5, 4.0, 40.0] {
            let h = pool.height + pool.depth;
            close(pool.irradiance_at(x), pool.intensity * h / f64::hypot(h, x).powi(3), 1e-13);
        }
    }
}
