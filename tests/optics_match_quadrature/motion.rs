//! Motion against quadrature over time and random times.

use crate::common::{SplitMix, close, integrate, sees, simulate};
use furnace::truth::optics::motion::{PassingLight, RisingDisc, disc_passing, edge_moving};
use std::f64::consts::PI;

#[test]
fn passing_disc_covers_as_long_as_counted() {
    for (offset, from, to) in
        [(0.3, -2.0, 3.0), (0.0, -0.2, 5.0), (-0.9, 0.1, -0.2), (1.2, -1.0, 1.0), (0.5, 2.0, 4.0)]
    {
        let count = 1_000_000;
        let inside = |i: u32| {
            let at = from + (to - from) * (f64::from(i) + 0.5) / f64::from(count);
            at * at + offset * offset < 1.0
        };
        let counted = (0..count).filter(|&i| inside(i)).count() as f64 / f64::from(count);
        assert!((disc_passing(1.0, offset, from, to) - counted).abs() < 3e-6);
    }
    // the whole passage
    let (radius, offset, speed, time) = (0.5f64, 0.3f64, 2.0, 4.0);
    let expected = 2.0 * (radius * radius - offset * offset).sqrt() / (speed * time);
    close(disc_passing(radius, offset, -4.0, 4.0), expected, 1e-14);
    assert_eq!(disc_passing(1.0, 0.0, -0.5, 0.5), 1.0);
    assert_eq!((disc_passing(1.0, 0.0, 0.5, 0.5), disc_passing(1.0, 0.0, 1.5, 1.5)), (1.0, 0.0));
}

#[test]
fn moving_edge_covers_the_average() {
    for (width, from, to) in
        [(1.0, -0.7, 0.4), (1.0, 0.4, -0.7), (0.5, -3.0, 2.0), (2.0, 0.1, 0.2), (1.0, 0.8, 2.0)]
    {
        let covered = |t: f64| ((from + (to - from) * t) / width + 0.5).clamp(0.0, 1.0);
        let times = (0..100_000).map(|i| covered((f64::from(i) + 0.5) / 1e5));
        let average = times.sum::<f64>() / 1e5;
        let value = edge_moving(width, from, to);
        assert!((value - average).abs() < 1e-9, "{value} {average}");
        // second differences of the squared positive part
        let q = |u: f64| u.max(0.0).powi(2) / 2.0;
        let half = 0.5 * width;
        let differences = q(to + half) - q(to - half) - q(from + half) + q(from - half);
        assert!((edge_moving(width, from, to) - differences / (width * (to - from))).abs() < 1e-13);
    }
    close(edge_moving(2.0, 0.5, 0.5), 0.75, 1e-15);
}

const DISCS: [RisingDisc; 3] = [
    RisingDisc { radius: 0.8, from: 0.5, to: 2.0, scale: 1.5 },
    RisingDisc { radius: 3.0, from: 0.4, to: 0.9, scale: 1.0 },
    RisingDisc { radius: 0.2, from: 1.0, to: 4.0, scale: 2.0 },
];

/// A time's radiance, by rings of the light: each weighs cos²/(π d²) times its area.
fn by_rings(disc: &RisingDisc, h: f64, power: i32) -> f64 {
    let area = PI * disc.radius * disc.radius;
    integrate(0.0, disc.radius, 1e-12, &|s| {
        let square = h * h + s * s;
        let sample = disc.scale * area * h * h / (PI * square * square);
        2.0 * s / (disc.radius * disc.radius) * sample.powi(power)
    })
}

#[test]
fn rising_disc_agrees_with_quadrature() {
    for disc in DISCS {
        let average =
            |f: &dyn Fn(f64) -> f64| integrate(disc.from, disc.to, 1e-10, f) / (disc.to - disc.from);
        let mean = average(&|h| by_rings(&disc, h, 1));
        close(disc.mean(), mean, 1e-8);
        close(disc.time_variance(), average(&|h| (by_rings(&disc, h, 1) - mean).powi(2)), 1e-7);
        close(disc.explicit_second_moment(), average(&|h| by_rings(&disc, h, 2)), 1e-8);
    }
    // a short exposure shows the light at rest
    let still = RisingDisc { radius: 0.8, from: 1.0, to: 1.0 + 1e-6, scale: 1.0 };
    close(still.mean(), 0.64 / 1.64, 1e-6);
}

#[test]
fn rising_disc_agrees_with_shadow_rays() {
    for disc in DISCS {
        let sampled = simulate(14, 8_000_000, |r: &mut SplitMix| {
            let h = r.between(disc.from, disc.to);
            let square = h * h + disc.radius * disc.radius * r.uniform();
            disc.scale / PI * (h * h / (square * square)) * PI * disc.radius * disc.radius
        });
        sees(sampled.mean, sampled.error, disc.mean());
        sees(sampled.square, sampled.square_error, disc.explicit_second_moment());
        let mean = disc.mean();
        let times = simulate(15, 1_000_000, |r| {
            let h = r.between(disc.from, disc.to);
            disc.scale * disc.radius.powi(2) / (h * h + disc.radius.powi(2)) - mean
        });
        sees(times.square, times.square_error, disc.time_variance());
    }
}

#[test]
fn passing_light_agrees_with_quadrature() {
    for (from, to) in [(-1.0, 2.0), (0.5, 0.7), (3.0, 9.0)] {
        let light = PassingLight { height: 1.4, from, to, intensity: 3.0, albedo: 0.6 };
        // inverse-square law and cosine, times the BRDF
        let radiance = |x: f64| {
            let distance = f64::hypot(1.4, x);
            0.6 / PI * 3.0 / (distance * distance) * (1.4 / distance)
        };
        let average = |power: i32| integrate(from, to, 1e-13, &|x| radiance(x).powi(power)) / (to - from);
        close(light.mean(), average(1), 1e-10);
        close(light.second_moment(), average(2), 1e-9);
        let sampled = simulate(16, 1_000_000, |r| radiance(r.between(from, to)));
        sees(sampled.mean, sampled.error, light.mean());
        sees(sampled.square, sampled.square_error, light.second_moment());
    }
}
