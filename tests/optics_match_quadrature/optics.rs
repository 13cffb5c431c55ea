//! Interfaces against Fresnel's equations in another form, quadrature, and walks that choose by chance.

use crate::common::{Sampled, SplitMix, close, fresnel_in_angles, integrate, sees, simulate};
use furnace::truth::optics::interface::{
    FloorUnderLayer, Slab, conductor, dielectric, diffuse_external, diffuse_internal,
};
use std::f64::consts::PI;

#[test]
fn dielectric_agrees_with_the_form_in_angles() {
    for n in [0.5, 1.0 / 1.5, 0.99, 1.01, 1.33, 1.5, 2.4, 10.0] {
        for i in 1..1000 {
            let cos = f64::from(i) / 1000.0;
            let difference = dielectric(cos, n) - fresnel_in_angles(cos, n);
            assert!(difference.abs() < 1e-11, "{n} {cos} {difference}");
        }
    }
    assert_eq!(dielectric(0.3, 1.0), 0.0);
    close(dielectric(1.0, 1.5), 0.04, 1e-15);
    // Brewster's angle leaves only the perpendicular part
    let cos = 1.0 / (1.0f64 + 1.5 * 1.5).sqrt();
    close(dielectric(cos, 1.5), 0.5 * ((1.5f64 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0)).powi(2), 1e-14);
}

#[test]
fn what_a_dielectric_does_not_reflect_it_transmits() {
    for i in 1..100 {
        let (cos, n) = (f64::from(i) / 100.0, 1.5);
        let below = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
        let perpendicular = 2.0 * cos / (cos + n * below);
        let parallel = 2.0 * cos / (n * cos + below);
        let transmitted = 0.5 * (perpendicular.powi(2) + parallel.powi(2)) * n * below / cos;
        assert!((1.0 - dielectric(cos, n) - transmitted).abs() < 1e-14);
        // and the same from the other side
        assert!((dielectric(below, 1.0 / n) - dielectric(cos, n)).abs() < 1e-15 / cos + 1e-15);
    }
}

/// In real numbers throughout. [Lazányi & Szirmay-Kalos 2005]
fn conductor_in_reals(cos: f64, n: f64, k: f64) -> f64 {
    let (cos2, sin2) = (cos * cos, 1.0 - cos * cos);
    let real = n * n - k * k - sin2;
    let modulus = (real * real + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (modulus + real)).sqrt();
    let perpendicular = (modulus + cos2 - 2.0 * a * cos) / (modulus + cos2 + 2.0 * a * cos);
    let (sum, cross) = (modulus * cos2 + sin2 * sin2, 2.0 * a * cos * sin2);
    0.5 * perpendicular * (1.0 + (sum - cross) / (sum + cross))
}

#[test]
fn conductor_agrees_with_the_form_in_reals() {
    for (n, k) in [(0.2, 3.9), (1.1, 2.5), (1.5, 0.01), (0.05, 0.9), (3.0, 3.0)] {
        for i in 1..1000 {
            let cos = f64::from(i) / 1000.0;
            let difference = conductor(cos, n, k) - conductor_in_reals(cos, n, k);
            assert!(difference.abs() < 1e-12, "{n} {k} {cos} {difference}");
        }
        let normal = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        close(conductor(1.0, n, k), normal, 1e-14);
        assert!((conductor(1e-9, n, k) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn diffuse_reflectances_are_averages() {
    for n in [1.0001, 1.001, 1.05, 1.33, 1.5, 1.8, 2.4, 4.0] {
        let average =
            |n: f64| integrate(0.0, 1.0, 1e-13, &|cos| 2.0 * cos * fresnel_in_angles(cos.max(1e-15), n));
        let external = average(n);
        assert!((diffuse_external(n) - external).abs() < 1e-11, "{n}: {} {external}", diffuse_external(n));
        // the critical angle is the end of the second range
        let critical = (1.0 - 1.0 / (n * n)).sqrt();
        let inside = |cos: f64| 2.0 * cos * fresnel_in_angles(cos, 1.0 / n);
        let internal = critical * critical
            + integrate(0.0, (1.0 - critical).sqrt(), 1e-12, &|u| 2.0 * u * inside(critical + u * u));
        assert!((diffuse_internal(n) - internal).abs() < 1e-7, "{n}: {} {internal}", diffuse_internal(n));
    }
    assert_eq!((diffuse_external(1.0), diffuse_internal(1.0)), (0.0, 0.0));
}

#[test]
fn diffuse_reflectances_of_glass_are_the_known_ones() {
    assert!((diffuse_external(1.5) - 0.091_778_0).abs() < 5e-8);
    assert!((diffuse_internal(1.5) - 0.596_345_8).abs() < 5e-8);
}

/// Whether a walk through a slab ends behind it, and the interfaces it meets.
fn walk_slab(random: &mut SplitMix, interface: f64) -> (bool, f64) {
    let mut events = 1.0;
    if random.uniform() < interface {
        return (false, events);
    }
    let mut at_back = true;
    loop {
        events += 1.0;
        if random.uniform() >= interface {
            return (at_back, events);
        }
        at_back = !at_back;
    }
}

#[test]
fn slab_agrees_with_a_walk() {
    close(Slab::new(1.0, 1.5).transmittance(), 2.0 * 1.5 / (1.5 * 1.5 + 1.0), 1e-14);
    let (behind, before) = (3.0, 0.5);
    for (cos, n) in [(1.0, 1.5), (0.3, 1.5), (0.2, 2.4)] {
        let slab = Slab::new(cos, n);
        let interface = fresnel_in_angles(cos, n);
        let step = behind - before;
        let radiance = simulate(1, 2_000_000, |r| if walk_slab(r, interface).0 { step } else { 0.0 });
        sees(before + radiance.mean, radiance.error, slab.mean(behind, before));
        // a two-valued variable: the variance follows from the mean, to first order
        let slope = (step - 2.0 * slab.transmittance() * step).abs();
        let error = slope * radiance.error + radiance.error * radiance.error;
        sees(radiance.variance(), error, slab.variance(behind, before));
        let events = simulate(2, 200_000, |r| walk_slab(r, interface).1);
        sees(events.mean, events.error, Slab::EXPECTED_EVENTS);
    }
}

/// A ball that a ray meets at one angle from outside has that same reflectance inside at every hit.
#[test]
fn ball_has_one_reflectance() {
    for (cos, n) in [(0.9f64, 1.5f64), (0.2, 1.33)] {
        let below = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
        close(Slab::new(cos, n).interface, dielectric(below, 1.0 / n), 1e-13);
    }
}

/// Follows one path from the eye; the depth of the layer does not matter as the floor is uniform.
fn walk_layer(random: &mut SplitMix, floor: &FloorUnderLayer, cos: f64) -> f64 {
    if random.uniform() < fresnel_in_angles(cos, floor.n) {
        return floor.sky;
    }
    let mut weight = 1.0;
    loop {
        weight *= floor.albedo;
        let up = random.uniform().sqrt();
        if random.uniform() >= fresnel_in_angles(up, 1.0 / floor.n) {
            return weight * floor.sky;
        }
    }
}

#[test]
fn floor_under_a_layer_agrees_with_a_walk() {
    for (n, albedo, cos) in [(1.33, 0.5, 0.9), (1.5, 0.8, 0.4), (1.5, 0.3, 0.1)] {
        let floor = FloorUnderLayer { n, albedo, sky: 2.0 };
        let Sampled { mean, error, square, square_error } =
            simulate(3, 400_000, |r| walk_layer(r, &floor, cos));
        sees(mean, error, floor.radiance(cos));
        sees(square, square_error, floor.second_moment(cos));
        // a path that starts below, weighted by what it brings back: irradiance is π times its mean
        let irradiance = simulate(4, 400_000, |r| {
            let (mut sum, mut weight) = (0.0, 1.0);
            loop {
                let up = r.uniform().sqrt();
                if r.uniform() >= fresnel_in_angles(up, 1.0 / n) {
                    // radiance below the interface is n² that above
                    sum += weight * floor.sky * n * n;
                    return sum * PI;
                }
                weight *= albedo;
            }
        });
        sees(irradiance.mean, irradiance.error, floor.irradiance());
    }
}

#[test]
fn lossless_floor_is_as_bright_as_the_sky() {
    for cos in [1.0, 0.5, 0.01] {
        let floor = FloorUnderLayer { n: 1.5, albedo: 1.0, sky: 2.0 };
        close(floor.radiance(cos), 2.0, 1e-15);
        close(floor.second_moment(cos), 4.0, 1e-15);
        let bare = FloorUnderLayer { n: 1.0, albedo: 0.4, sky: 2.0 };
        close(bare.radiance(cos), 0.8, 1e-15);
        close(bare.irradiance(), 2.0 * PI, 1e-15);
    }
}
