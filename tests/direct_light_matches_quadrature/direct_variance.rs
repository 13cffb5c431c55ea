//! Variances of direct-light estimators against their definition: quadrature of each sample's value and square.

use crate::common::{close, kernel, simpson};
use furnace::estimator::Heuristic::{Balance, Power};
use furnace::scene::Points::{self, Area, SolidAngle};
use furnace::truth::direct::direct_variance::{CoaxialDisk, implicit_cosine, sphere_area, sphere_cone};
use furnace::truth::quadrature::gauss_legendre;
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

const DISKS: [CoaxialDisk; 5] = [
    CoaxialDisk { height: 1.0, radius: 1.0 },
    CoaxialDisk { height: 2.0, radius: 0.5 },
    CoaxialDisk { height: 0.3, radius: 2.0 },
    CoaxialDisk { height: 1.0, radius: 0.1 },
    CoaxialDisk { height: 1.0, radius: 20.0 },
];

/// The integral of g(cos θ) over the solid angle of a disk, by rings of the disk.
fn hits(disk: &CoaxialDisk, g: impl Fn(f64) -> f64) -> f64 {
    let ring = |s: f64| {
        let slant = s.hypot(disk.height);
        2.0 * PI * disk.height * s / (slant * slant * slant) * g(disk.height / slant)
    };
    // geometric pieces, as wide disks need near their middle
    let pieces: f64 = (0..12)
        .map(|i| disk.radius / 2.0_f64.powi(i))
        .map(|outer| simpson(300, outer / 2.0, outer, ring))
        .sum();
    pieces + simpson(300, 0.0, disk.radius / 2.0_f64.powi(12), ring)
}

/// Density per solid angle of a point of the light in a direction of cosine mu.
fn light_density(disk: &CoaxialDisk, sampled: Points, mu: f64) -> f64 {
    match sampled {
        Area => {
            let square = (disk.height / mu).powi(2);
            square / (mu * PI * disk.radius * disk.radius)
        }
        SolidAngle => 1.0 / (2.0 * PI * (1.0 - disk.height / disk.height.hypot(disk.radius))),
    }
}

/// Variance of f/p with the given density, where f = mu / π on the light.
fn single(disk: &CoaxialDisk, density: impl Fn(f64) -> f64) -> f64 {
    let value = |mu: f64| mu / PI / density(mu);
    let mean = hits(disk, |mu| density(mu) * value(mu));
    hits(disk, |mu| density(mu) * value(mu) * value(mu)) - mean * mean
}

#[test]
fn disk_estimators_match_quadrature() {
    for disk in &DISKS {
        close(disk.mean(), hits(disk, |mu| mu / PI), 1e-9);
        close(disk.implicit_cosine(), single(disk, |mu| mu / PI), 1e-9);
        close(disk.implicit_cosine(), implicit_cosine(disk.mean()), 1e-15);
        close(disk.implicit_uniform(), single(disk, |_| 1.0 / (2.0 * PI)), 1e-9);
        for sampled in [Area, SolidAngle] {
            let value = disk.explicit(sampled);
            close(value, single(disk, |mu| light_density(disk, sampled, mu)), 1e-9 * value.max(1.0));
        }
    }
}

#[test]
fn the_shortened_variances_equal_the_published_ones() {
    for disk in &DISKS {
        let t = (disk.radius / disk.height).powi(2);
        let (f, c) = (t / (1.0 + t), 1.0 / (1.0 + t).sqrt());
        close(disk.explicit(Area), t / 3.0 * (1.0 - (1.0 + t).powi(-3)) - f * f, 1e-12 * (1.0 + t));
        close(disk.explicit(SolidAngle), 4.0 * (1.0 - c) * (1.0 - c * c * c) / 3.0 - f * f, 1e-14);
        close(disk.implicit_uniform(), 4.0 / 3.0 * (1.0 - c * c * c) - f * f, 1e-14);
    }
    // a light too small for the published differences
    let tiny = CoaxialDisk { height: 1.0, radius: 1e-4 };
    close(tiny.explicit(SolidAngle) / (5e-9_f64.powi(4) / 3.0), 1.0, 1e-7);
    close(tiny.explicit(Area) / (1e-32 / 3.0), 1.0, 1e-7);
}

#[test]
fn mis_matches_quadrature() {
    for disk in &DISKS {
        for sampled in [Area, SolidAngle] {
            for heuristic in [Balance, Power] {
                let light = |mu: f64| light_density(disk, sampled, mu);
                let weigh = |x: f64| if heuristic == Balance { x } else { x * x };
                let weight = |own: f64, other: f64| weigh(own) / (weigh(own) + weigh(other));
                // each sample's weighted value and its variance
                let (mut mean, mut variance) = (0.0, 0.0);
                for (own, other) in [
                    (&(|mu: f64| mu / PI) as &dyn Fn(f64) -> f64, &light as &dyn Fn(f64) -> f64),
                    (&light, &(|mu: f64| mu / PI)),
                ] {
                    let x = |mu: f64| weight(own(mu), other(mu)) * mu / PI / own(mu);
                    let first = hits(disk, |mu| own(mu) * x(mu));
                    mean += first;
                    variance += hits(disk, |mu| own(mu) * x(mu) * x(mu)) - first * first;
                }
                close(mean, disk.mean(), 1e-9);
                close(disk.mis(sampled, heuristic), variance, 1e-9);
            }
        }
    }
}

#[test]
fn mis_of_cosine_and_cone_by_the_balance_heuristic_has_a_closed_form() {
    for disk in &DISKS {
        let c = disk.height / disk.height.hypot(disk.radius);
        let k = 1.0 / (2.0 * (1.0 - c));
        let over = |f: &dyn Fn(f64) -> f64| f(1.0) - f(c);
        let log = |mu: f64| (mu + k).ln();
        let i21 = over(&|mu| mu * mu / 2.0 - k * mu + k * k * log(mu));
        let i32 = over(&|mu| mu * mu / 2.0 - 2.0 * k * mu + 3.0 * k * k * log(mu) + k * k * k / (mu + k));
        let i11 = over(&|mu| mu - k * log(mu));
        let i22 = over(&|mu| mu - 2.0 * k * log(mu) - k * k / (mu + k));
        let wanted = 2.0 * i32 - (2.0 * i21).powi(2) + i22 / (1.0 - c) - (i11 / (1.0 - c)).powi(2);
        // the closed form cancels for small lights
        close(disk.mis(SolidAngle, Balance), wanted, 1e-15 * k.powi(4) + 1e-13);
    }
}

#[test]
fn mis_quadrature_has_converged() {
    // against 8 times as many points on geometric pieces of the light
    for radius in [0.03, 0.1, 1.0, 10.0, 100.0] {
        let disk = CoaxialDisk { height: 1.0, radius };
        let t = radius * radius;
        let c = 1.0 / (1.0 + t).sqrt();
        let pieces = |f: &dyn Fn(f64) -> f64| -> f64 {
            let at = |i: i32| c.powf(1.0 - f64::from(i) / 24.0);
            (0..24).map(|i| gauss_legendre(64, at(i), at(i + 1), f)).sum()
        };
        let weight = |mu: f64| mu.powi(4) / (mu.powi(4) + 1.0 / t);
        let m1 = pieces(&|mu| 2.0 * mu * weight(mu));
        let v1 = pieces(&|mu| 2.0 * mu * (weight(mu) - m1).powi(2)) + c * c * m1 * m1;
        let m2 = pieces(&|mu| 2.0 / (t * mu.powi(3)) * weight(mu));
        let v2 = pieces(&|mu| 2.0 / (t * mu.powi(3)) * (weight(mu) - m2).powi(2));
        let value = disk.mis(Area, Balance);
        close(value, v1 + v2, 1e-12 * value);
    }
}

#[test]
fn gauss_legendre_is_exact_for_polynomials() {
    for n in [1, 2, 5, 16, 64] {
        let degree = 2 * n as i32 - 1;
        let wanted = (2.0_f64.powi(degree + 1) - 1.0) / f64::from(degree + 1);
        close(gauss_legendre(n, 1.0, 2.0, |x| x.powi(degree)) / wanted, 1.0, 1e-13);
    }
    close(gauss_legendre(20, 0.0, 1.0, f64::exp), 1.0_f64.exp() - 1.0, 2e-15);
}

#[test]
fn sphere_by_cone_matches_quadrature() {
    for (distance, radius, theta) in [(2.0, 1.0, 0.0_f64), (2.0, 1.0, 1.0), (1.2, 1.0, 0.3), (5.0, 0.1, 1.5)]
    {
        let sigma = f64::asin(radius / distance);
        let density = 1.0 / (2.0 * PI * (1.0 - sigma.cos()));
        let n = dvec3(theta.sin(), 0.0, theta.cos());
        let moment = |power: i32| {
            simpson(500, 0.0, sigma, |alpha| {
                let (s, c) = alpha.sin_cos();
                let value = |phi: f64| n.dot(dvec3(s * phi.cos(), s * phi.sin(), c)) / PI / density;
                s * density * simpson(50, 0.0, 2.0 * PI, |phi| value(phi).powi(power))
            })
        };
        close(moment(1), theta.cos() * (radius / distance).powi(2), 1e-10);
        let wanted = moment(2) - moment(1) * moment(1);
        close(sphere_cone(distance, radius, theta.cos()), wanted, 1e-10 * wanted.max(1e-4));
    }
}

#[test]
fn whole_sphere_by_area_matches_quadrature() {
    for (distance, radius) in [(2.0, 1.0), (1.1, 1.0), (10.0, 0.5)] {
        let area = 4.0 * PI * radius * radius;
        // the seen cap ends where the view is tangent, cos = radius / distance
        let moment = |power: i32| {
            simpson(4000, radius / distance, 1.0, |z| {
                let m = dvec3((1.0 - z * z).sqrt(), 0.0, -z);
                let q = DVec3::Z * distance + m * radius;
                0.5 * (area * kernel(DVec3::ZERO, DVec3::Z, q, m)).powi(power)
            })
        };
        close(moment(1), (radius / distance).powi(2), 1e-9);
        let wanted = moment(2) - moment(1) * moment(1);
        close(sphere_area(distance, radius), wanted, 1e-8 * wanted);
    }
    close(sphere_area(2.0, 1.0), 0.5 - 1.0 / 16.0, 1e-16);
}
