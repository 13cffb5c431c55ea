//! Means over discs and caps against quadrature, and a cap's share of a light against random directions.

use crate::common::{KERNELS, Random, agrees, close, distance, dot, integrate, over_disc, weight};
use furnace::truth::density::{Kernel, gradient};
use std::f64::consts::PI;

fn mean(kernel: Kernel, radius: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    over_disc(1.0, |x, y| weight(kernel, x.hypot(y)) * f(radius * x, radius * y))
}

#[test]
fn waves_are_flattened() {
    for kernel in KERNELS {
        for k in [0.0, 1e-4, 9e-4, 1.1e-3, 0.3, 1.0, 4.0, 11.0] {
            let radius = 0.7;
            let wave = mean(kernel, radius, |x, y| (k / radius * (0.6 * x - 0.8 * y) + 0.4).cos());
            let error = (gradient::cosine(kernel, k) - wave / 0.4f64.cos()).abs();
            assert!(error < 1e-11, "{kernel:?} {k}: {error}");
        }
        // far out, where the nested rule above is too coarse: ring by ring, each an average over angles
        let ring =
            |s: f64| (0..256).map(move |i| (45.0 * s * (PI * f64::from(i) / 128.0).cos()).cos() / 256.0);
        let far = integrate(0.0, 1.0, |s| 2.0 * PI * s * weight(kernel, s) * ring(s).sum::<f64>());
        assert!((gradient::cosine(kernel, 45.0) - far).abs() < 1e-10, "{kernel:?}: {far}");
    }
}

#[test]
fn exponentials_are_raised() {
    for kernel in KERNELS {
        for slope in [0.0, 1e-3, 0.5, 2.0, 9.0] {
            let expected = mean(kernel, 0.5, |x, y| (2.0 * slope * (0.28 * x + 0.96 * y)).exp());
            close(gradient::exponential(kernel, slope), expected, 1e-11);
        }
    }
    assert!(gradient::exponential(Kernel::Box, 500.0).is_finite());
}

#[test]
fn polynomials_follow_from_their_laplacians() {
    let field = |x: f64, y: f64| x.powi(4) + 2.0 * x * x * y * y + y.powi(3) + 1.0;
    let (x, y): (f64, f64) = (0.3, -0.2);
    let laplacians = [field(x, y), 16.0 * x * x + 4.0 * y * y + 6.0 * y, 40.0];
    for kernel in KERNELS {
        let expected = mean(kernel, 0.9, |dx, dy| field(x + dx, y + dy));
        close(gradient::from_laplacians(kernel, 0.9, &laplacians), expected, 1e-12);
    }
}

#[test]
fn the_foot_of_a_light_darkens() {
    for (height, radius) in [(1.0, 1e-3), (0.8, 0.5), (0.4, 1.0), (0.2, 1.5)] {
        let irradiance = |x: f64, y: f64| height / (height * height + x * x + y * y).powf(1.5);
        let expected = mean(Kernel::Box, radius, irradiance) * height * height;
        close(gradient::foot(height, radius), expected, 1e-9);
    }
    assert_eq!(gradient::foot(2.0, 0.0), 1.0);
}

/// The light is at (0, 0, 1 - height), the estimate at (0, 0, 1).
#[test]
fn the_nearest_wall_darkens() {
    for (height, radius) in [(1.0f64, 0.8f64), (0.6, 0.2), (0.5, 1.2), (0.3, 1.0), (0.2, 1.9)] {
        let light = [0.0, 0.0, 1.0 - height];
        let irradiance = |angle: f64| {
            let point = [angle.sin(), 0.0, angle.cos()];
            let way = [point[0] - light[0], 0.0, point[2] - light[2]];
            dot(point, way) / dot(way, way).powf(1.5)
        };
        let rim = 2.0 * (0.5 * radius).asin();
        let flux = integrate(0.0, rim, |angle| 2.0 * PI * angle.sin() * irradiance(angle));
        let cap = gradient::Nearest { height, radius };
        close(cap.factor(), flux / (PI * radius * radius) * height * height, 1e-11);
        close(cap.share(), flux / (4.0 * PI), 1e-11);
    }
    close(gradient::Nearest { height: 0.3, radius: 1e-4 }.factor(), 1.0, 1e-6);
    close(gradient::Nearest { height: 0.3, radius: 2.0 }.share(), 1.0, 1e-15);
}

/// A deviation of 3 % is noticed.
#[test]
fn the_nearest_wall_has_its_share_of_photons() {
    let mut random = Random::new(31);
    for cap in
        [gradient::Nearest { height: 0.5, radius: 0.5 }, gradient::Nearest { height: 0.4, radius: 1.1 }]
    {
        let light = 1.0 - cap.height;
        let mut meets = || {
            let w = random.direction();
            let along = light * w[2];
            let way = -along + (along * along + 1.0 - light * light).sqrt();
            let hit = [way * w[0], way * w[1], light + way * w[2]];
            distance(hit, [0.0, 0.0, 1.0]) < cap.radius
        };
        let count = 300_000;
        let share = (0..count).filter(|_| meets()).count() as f64 / f64::from(count);
        agrees(share, (share * (1.0 - share) / f64::from(count)).sqrt(), cap.share(), 0.03);
    }
}
