//! The mirror wall against nested quadrature in Cartesian coordinates and a path tracer that reflects rays.

use crate::common::{SplitMix, close, fresnel_in_angles, integrate, sees, simulate};
use furnace::truth::optics::interface::{conductor, dielectric};
use furnace::truth::optics::mirror::{MirrorWall, Shape, rectangle_corner};
use furnace::truth::quadrature::{nodes, tensor};
use std::f64::consts::PI;

const SHAPES: [Shape; 2] = [Shape::Disc { radius: 0.6 }, Shape::Rectangle { half_x: 0.5, half_z: 0.8 }];

fn wall(shape: Shape) -> MirrorWall {
    MirrorWall { shape, light: 0.9, height: 1.3, receiver: 0.7, scale: 2.5 }
}

/// The form factor by two nested adaptive rules, `weight` being of the cosine at the mirror.
fn nested(wall: &MirrorWall, offset: f64, weight: &dyn Fn(f64) -> f64) -> f64 {
    let (half_x, disc) = match wall.shape {
        Shape::Disc { radius } => (radius, true),
        Shape::Rectangle { half_x, .. } => (half_x, false),
    };
    // x = half_x sin u: the ends of a disc's chords are smooth in u
    integrate(-0.5 * PI, 0.5 * PI, 1e-11, &|u| {
        let x = offset + half_x * u.sin();
        let end = match wall.shape {
            Shape::Disc { radius } if disc => radius * u.cos(),
            Shape::Rectangle { half_z, .. } => half_z,
            Shape::Disc { .. } => unreachable!(),
        };
        let row = integrate(0.0, end, 1e-12, &|z| {
            let distance = (x * x + wall.height * wall.height + z * z).sqrt();
            weight(x / distance) * (wall.height / distance).powi(2) / (PI * distance * distance)
        });
        2.0 * row * half_x * u.cos()
    })
}

#[test]
fn gauss_legendre_is_exact_for_polynomials() {
    for count in [2, 5, 32, 64] {
        let degree = 2 * count as i32 - 2;
        let sum: f64 = nodes(count).iter().map(|&(x, w)| w * x.powi(degree)).sum();
        close(sum, 2.0 / f64::from(degree + 1), 1e-12);
        let total: f64 = nodes(count).iter().map(|&(_, w)| w).sum();
        close(total, 2.0, 1e-13);
    }
    close(tensor((1.0, 2.0), (-1.0, 3.0), |x, y| x * x * y * y).value, 7.0 / 3.0 * 28.0 / 3.0, 1e-13);
    let exponential = tensor((0.0, 1.0), (0.0, 2.0), |x, y| (x + y).exp());
    close(exponential.value, (1f64.exp() - 1.0) * (2f64.exp() - 1.0), 1e-13);
    assert!(exponential.error < 1e-12);
    // a kink is not resolved, and the error says so
    let kink = tensor((0.0, 1.0), (0.0, 1.0), |x, _| (x - 0.3).abs());
    assert!((kink.value - 0.29).abs() > 1e-7 && (kink.value - 0.29).abs() < 2.0 * kink.error, "{kink:?}");
}

#[test]
fn form_factors_agree_with_quadrature() {
    for shape in SHAPES {
        let wall = wall(shape);
        close(wall.direct(), nested(&wall, 0.2, &|_| 1.0), 1e-9);
        close(wall.image(), nested(&wall, 1.6, &|_| 1.0), 1e-9);
    }
    // right below the corner
    close(rectangle_corner(1e9, 1e9), 0.25, 1e-8);
    assert_eq!(rectangle_corner(-0.5, 2.0), -rectangle_corner(0.5, 2.0));
}

#[test]
fn constant_reflectance_reproduces_the_closed_form() {
    for shape in SHAPES {
        for height in [0.25, 0.32, 1.3, 5.0] {
            for receiver in [0.0, 0.7, 4.0] {
                let wall = MirrorWall { height, receiver, ..wall(shape) };
                let image = wall.weighted_image(|_| 1.0);
                let error = (image.value - wall.image()).abs();
                assert!(error < 1e-9 * wall.image(), "{wall:?} {error}");
                // the closed form rounds, too
                assert!(error <= image.error + 1e-15, "{wall:?} {error} {image:?}");
                let all = wall.fresnel_mean(|_| 0.7);
                assert!((all.value - wall.mean(0.7)).abs() <= 1e-9 * all.value);
                let variance = wall.fresnel_implicit_variance(|_| 0.7).value;
                assert!((variance - wall.implicit_variance(0.7)).abs() <= 1e-8 * variance);
            }
        }
    }
}

#[test]
fn fresnel_mirror_agrees_with_nested_quadrature() {
    let glass = |cos: f64| fresnel_in_angles(cos, 1.5);
    for shape in SHAPES {
        for (height, receiver) in [(1.3, 0.7), (0.3, 0.2), (0.25, 0.05), (3.0, 0.1)] {
            let wall = MirrorWall { height, receiver, ..wall(shape) };
            let offset = 0.9 + receiver;
            let by_area = nested(&wall, offset, &glass);
            let image = wall.weighted_image(|cos| dielectric(cos, 1.5));
            assert!((image.value - by_area).abs() <= 1e-8 * by_area, "{} {by_area}", image.value);
            assert!(image.error <= 1e-8 * image.value, "{wall:?} {image:?}");
            let copper = wall.weighted_image(|cos| conductor(cos, 0.2, 3.9));
            let by_area = nested(&wall, offset, &|cos| conductor(cos, 0.2, 3.9));
            assert!((copper.value - by_area).abs() <= 1e-8 * by_area, "{} {by_area}", copper.value);
            assert!(copper.error <= 1e-8 * copper.value, "{wall:?} {copper:?}");
        }
    }
}

/// The hardest case that is promised: the light touches the mirror, and the receiver lies at its foot.
#[test]
fn light_at_the_mirror_keeps_the_promised_error() {
    for shape in [Shape::Disc { radius: 0.5 }, Shape::Rectangle { half_x: 0.5, half_z: 0.5 }] {
        let wall = MirrorWall { shape, light: 0.5, height: 0.2, receiver: 0.0, scale: 1.0 };
        for (n, k) in [(1.05, 0.0), (1.5, 0.0), (0.2, 3.9), (0.05, 0.9)] {
            // the light's edge lies in the mirror, where 0 may come out as a rounding error below it
            let reflectance = |cos: f64| conductor(cos.max(1e-12), n, k);
            let image = wall.weighted_image(reflectance);
            let by_area = nested(&wall, 0.5, &reflectance);
            assert!((image.value - by_area).abs() <= 1e-8 * by_area, "{n} {k}: {image:?} {by_area}");
            assert!(image.error <= 1e-8 * image.value, "{n} {k}: {image:?}");
        }
    }
}

/// One cosine-sampled path, which may be reflected once; `reflectance` weighs it.
fn path(random: &mut SplitMix, wall: &MirrorWall, reflectance: &dyn Fn(f64) -> f64) -> f64 {
    let (sin, angle) = (random.uniform().sqrt(), 2.0 * PI * random.uniform());
    let mut direction = [sin * angle.cos(), (1.0 - sin * sin).sqrt(), sin * angle.sin()];
    let (mut at, mut weight) = ([wall.receiver, 0.0, 0.0], wall.scale);
    for _ in 0..2 {
        let to_mirror = -at[0] / direction[0];
        let to_light = (wall.height - at[1]) / direction[1];
        if to_mirror <= 0.0 || to_light < to_mirror {
            let (x, z) = (at[0] + to_light * direction[0] - wall.light, at[2] + to_light * direction[2]);
            let hit = match wall.shape {
                Shape::Disc { radius } => x * x + z * z < radius * radius,
                Shape::Rectangle { half_x, half_z } => x.abs() < half_x && z.abs() < half_z,
            };
            return if hit { weight } else { 0.0 };
        }
        for (a, d) in at.iter_mut().zip(direction) {
            *a += to_mirror * d;
        }
        at[0] = 0.0;
        weight *= reflectance(-direction[0]);
        direction[0] = -direction[0];
    }
    0.0
}

#[test]
fn mirror_wall_agrees_with_paths() {
    let check = |wall: &MirrorWall, reflectance: &dyn Fn(f64) -> f64, mean: f64, variance: f64| {
        let sampled = simulate(5, 2_500_000, |r| path(r, wall, reflectance));
        sees(sampled.mean, sampled.error, mean);
        sees(sampled.square, sampled.square_error, variance + mean * mean);
    };
    for shape in SHAPES {
        let wall = wall(shape);
        check(&wall, &|_| 0.8, wall.mean(0.8), wall.implicit_variance(0.8));
        check(&wall, &|_| 0.0, wall.explicit_only(), wall.implicit_variance(0.0));
        let metal = |cos: f64| conductor(cos, 1.1, 2.5);
        let (mean, variance) = (wall.fresnel_mean(metal), wall.fresnel_implicit_variance(metal));
        check(&wall, &metal, mean.value, variance.value);
    }
}
