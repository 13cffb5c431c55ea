//! Promise: a sky's samples, its density and its radiance belong together, and it lights a plate as integrals say,
//! whether its light is sampled or met by chance, unless something stands before it.
//!
//! One chi-square for each sky, of 2^19 directions in 64 x 32 cells whose probabilities are quadratures of `pdf`; nothing
//! may be lost, above or below. Irradiances are means of 2^16 samples, held to SIGMAS standard errors of at most 2 %
//! each. False alarm probability of the file: 8 chi-squares of 1e-9 and about 150 means of 3e-12 each, below 1e-8.

mod chi_square;

use chi_square::assert_follows;
use furnace::estimator::{Ctx, Tally};
use furnace::sampling::Address;
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch};
use furnace::scene::sky::SKY;
use furnace::scene::{Directions, Hit, LightSampling, Material, Ray, Rgb, Scene, Sensor, Shape, Sky, Start};
use furnace::scene::{Pick, Surface};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

const L: Rgb = Rgb::new(3.0, 0.5, 1.0);
/// Upwards directions that no axis shares, on both sides of the frame's sign.
const UPS: [DVec3; 2] = [DVec3::new(0.36, 0.48, 0.8), DVec3::new(0.64, -0.48, -0.6)];
const EXPONENTS: [f64; 4] = [0.0, 1.0, 2.5, 40.0];
const N: u32 = 1 << 19;
const RINGS: usize = 64;
const SECTORS: usize = 32;
const SIGMAS: f64 = 7.0;

fn cosine(exponent: f64, up: DVec3) -> Sky {
    Sky::Cosine { radiance: L, exponent, up }
}

/// The skies with the direction from which their angles count.
fn skies() -> Vec<(Sky, DVec3)> {
    let mut all: Vec<_> =
        UPS.iter().flat_map(|&up| EXPONENTS.map(|exponent| (cosine(exponent, up), up))).collect();
    all.push((Sky::Uniform { radiance: L }, UPS[0]));
    all
}

/// Directions around `up` by height and turn, with a frame of the test's own.
fn direction(up: DVec3, z: f64, turn: f64) -> DVec3 {
    let (s, (sin, cos)) = (up.cross(DVec3::X).normalize(), libm::sincos(TAU * (turn - 0.5)));
    up * z + (s * cos + up.cross(s) * sin) * (1.0 - z * z).max(0.0).sqrt()
}

fn ring_and_sector(up: DVec3, wi: DVec3) -> (f64, f64) {
    let s = up.cross(DVec3::X).normalize();
    (wi.dot(up), libm::atan2(wi.dot(up.cross(s)), wi.dot(s)) / TAU + 0.5)
}

/// Integral over a cell's solid angle by Gauss's rule: five points in each of four parts of its height.
fn over_cell(up: DVec3, cell: usize, f: &dyn Fn(DVec3) -> f64) -> f64 {
    const X: [f64; 5] = [-0.906179845938664, -0.5384693101056831, 0.0, 0.5384693101056831, 0.906179845938664];
    const W: [f64; 5] = [
        0.23692688505618908,
        0.47862867049936647,
        0.5688888888888889,
        0.47862867049936647,
        0.23692688505618908,
    ];
    const PARTS: usize = 4;
    let (ring, sector) = (cell / SECTORS, cell % SECTORS);
    let turn = (sector as f64 + 0.37) / SECTORS as f64;
    let half = 1.0 / (RINGS * PARTS) as f64;
    let part = |part: usize| {
        let middle = ((ring * PARTS + part) as f64 + 0.5) * 2.0 * half - 1.0;
        (0..5).map(|i| W[i] * f(direction(up, middle + half * X[i], turn))).sum::<f64>()
    };
    (0..PARTS).map(part).sum::<f64>() * half * TAU / SECTORS as f64
}

#[test]
fn directions_follow_their_pdf() {
    for (sky, up) in skies() {
        let name = format!("{sky:?}");
        let mut stream = Address::of(&["skies", &name]).stream(0, 0);
        let (mut counts, mut lost) = (vec![0u64; RINGS * SECTORS], 0);
        for _ in 0..N {
            let wi = sky.sample(stream.u2());
            let (z, turn) = ring_and_sector(up, wi);
            if !((wi.length_squared() - 1.0).abs() < 1e-14 && sky.pdf(wi).0 > 0.0) {
                lost += 1;
                continue;
            }
            let place = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
            counts[place(0.5 + 0.5 * z, RINGS) * SECTORS + place(turn, SECTORS)] += 1;
        }
        let probability: Vec<f64> =
            (0..RINGS * SECTORS).map(|cell| over_cell(up, cell, &|wi| sky.pdf(wi).0)).collect();
        let total: f64 = probability.iter().sum();
        assert!((total - 1.0).abs() < 1e-9, "{name}: the density integrates to {total}");
        assert_follows(&name, &counts, lost, &probability, 1e-9);
    }
}

/// Radiance / pdf is the integral of the radiance, for every direction; no light, no density.
#[test]
fn radiance_over_pdf_is_the_fluence() {
    let mut stream = Address::of(&["skies", "fluence"]).stream(0, 0);
    for (sky, up) in skies() {
        let by_cells =
            (0..RINGS * SECTORS).map(|cell| over_cell(up, cell, &|wi| sky.radiance(wi).x)).sum::<f64>();
        let fluence = sky.fluence();
        assert!((by_cells / fluence.x - 1.0).abs() < 1e-9, "{sky:?}: {by_cells} {fluence}");
        assert!((fluence / fluence.x - L / L.x).abs().max_element() < 1e-15);
        for i in 0..10_000 {
            let wi = direction(up, 2.0 * stream.u1() - 1.0, stream.u1());
            let wi = if i % 2 == 0 { wi } else { sky.sample((stream.u1(), stream.u1())) };
            let (radiance, pdf) = (sky.radiance(wi), sky.pdf(wi).0);
            if pdf > 1e-290 {
                assert!((radiance / pdf / fluence - 1.0).abs().max_element() < 1e-13, "{sky:?} {wi}");
            } else {
                assert!(radiance.max_element() <= 1e-280, "{sky:?} {wi}: {radiance} {pdf}");
            }
        }
    }
}

const WHITE: Material = Material { bsdf: furnace::scene::Bsdf::Lambert { albedo: Rgb::ONE }, le: Rgb::ZERO };

/// A small white plate at the origin, under the sky and whatever else there is.
fn plate(normal: DVec3, sky: Sky, others: &[Shape]) -> Scene {
    let (u, v) = normal.any_orthonormal_pair();
    let small = Rectangle { center: DVec3::ZERO, half_u: u * 0.01, half_v: v * 0.01 };
    let mut surfaces = vec![Surface::new(Shape::Rectangle(small), WHITE)];
    let black = Material::lambert(Rgb::ZERO, Rgb::ZERO);
    surfaces.extend(others.iter().map(|&shape| Surface::new(shape, black)));
    Scene::lit_by(surfaces, &[], Some(sky), Sensor::Probe { origin: normal * 1e-3, direction: -normal })
}

/// Even the largest random numbers, which take the horizon, give no weight that is not a number.
#[test]
fn the_horizon_is_a_number() {
    let last = 1f64.next_down();
    for (sky, up) in skies() {
        let scene = plate(up, sky, &[]);
        for i in 0..1000 {
            let turn = f64::from(i) / 1000.0;
            for u in [(last, turn), (0.0, turn), (last.next_down(), turn)] {
                let sampled = scene.sample_light(LightSampling::AREA, (DVec3::ZERO, 0.0), 0.0, u);
                let Some(light) = sampled else { continue };
                assert!((light.le * light.weight).is_finite() && light.surface == SKY, "{sky:?}: {light:?}");
                assert!(light.pdf.unwrap().0 > 0.0);
            }
        }
    }
}

/// Mean and standard error of a sampled quantity.
fn mean(mut sample: impl FnMut() -> Rgb) -> (Rgb, Rgb) {
    const SAMPLES: u32 = 1 << 16;
    let (mut sum, mut squares) = (Rgb::ZERO, Rgb::ZERO);
    for _ in 0..SAMPLES {
        let value = sample();
        (sum, squares) = (sum + value, squares + value * value);
    }
    let (n, mean) = (f64::from(SAMPLES), sum / f64::from(SAMPLES));
    (mean, ((squares / n - mean * mean).max(Rgb::ZERO) / n).map(f64::sqrt))
}

fn first_hit(scene: &Scene) -> (Ray, Hit<'_>) {
    let Sensor::Probe { origin, direction } = scene.sensor else { unreachable!() };
    let ray = Ray { o: origin, d: direction, from: NOWHERE };
    (ray, scene.intersect(&ray, 0.0).expect("the plate"))
}

/// Irradiance of the plate, sampled and by chance; the plate reflects it divided by π.
fn assert_irradiance(name: &str, scene: &Scene, exact: f64) {
    let (ray, x) = first_hit(scene);
    let start = Start { ray, response: 1.0, time: 0.0, pixel: 0 };
    let hold = |what: &str, (mean, error): (Rgb, Rgb)| {
        let (mean, width) = (mean * PI, SIGMAS * error * PI + 1e-12 * L);
        assert!((width / L).max_element() < 0.15 * exact, "{name} {what}: {width} is too wide");
        assert!(((mean - exact * L).abs() - width).max_element() < 0.0, "{name} {what}: {mean} {exact}");
    };
    for pick in [Pick::Power, Pick::Uniform] {
        let how = LightSampling { pick, ..LightSampling::AREA };
        let mut tally = Tally::default();
        let mut cx = Ctx::new(scene, Address::of(&["skies", name]).stream(0, 0), &mut tally, &start);
        hold("sampled", mean(|| cx.direct(&x, how).map_or(Rgb::ZERO, |light| light.radiance)));
    }
    for directions in [Directions::Cosine, Directions::Uniform] {
        let mut tally = Tally::default();
        let mut cx = Ctx::new(scene, Address::of(&["skies", name]).stream(1, 0), &mut tally, &start);
        let chance = mean(|| {
            let next = cx.scatter(&x, directions);
            cx.hit(&next.ray).map_or(Rgb::ZERO, |hit| next.weight * hit.le)
        });
        hold("by chance", chance);
    }
}

#[test]
fn plates_in_the_open_have_the_irradiance_of_integrals() {
    for up in UPS {
        let (across, uniform) = (up.any_orthonormal_vector(), Sky::Uniform { radiance: L });
        for normal in [up, across] {
            assert_irradiance(&format!("uniform {normal}"), &plate(normal, uniform, &[]), PI);
        }
        for exponent in EXPONENTS {
            let scene = plate(up, cosine(exponent, up), &[]);
            assert_irradiance(&format!("cos^{exponent}"), &scene, TAU / (exponent + 2.0));
        }
        // a wall: the integral of sin² α cos α over the height, times that of cos φ over half a turn
        assert_irradiance("wall", &plate(across, cosine(1.0, up), &[]), 2.0 / 3.0);
        let below = plate(-up, cosine(2.0, up), &[]);
        let (ray, x) = first_hit(&below);
        let (mut tally, start) = (Tally::default(), Start { ray, response: 1.0, time: 0.0, pixel: 0 });
        let stream = Address::of(&["skies", "below"]).stream(0, 0);
        let mut cx = Ctx::new(&below, stream, &mut tally, &start);
        assert!((0..1000).all(|_| cx.direct(&x, LightSampling::AREA).is_none()), "the sky is above");
    }
}

/// A disk, either way round, and a ball take as much of a uniform sky as they would send if they shone.
#[test]
fn what_stands_before_the_sky_hides_it() {
    let (up, sky) = (UPS[0], Sky::Uniform { radiance: L });
    let (h, radius) = (0.9, 0.6);
    for normal in [up, -up] {
        let disk = Shape::Disk(Disk { center: up * h, normal, radius });
        let seen = 1.0 - radius * radius / (radius * radius + h * h);
        assert_irradiance(&format!("disk {normal}"), &plate(up, sky, &[disk]), PI * seen);
    }
    let ball = SpherePatch { center: up * h, radius, axis: DVec3::Z, low: -1.0, high: 1.0, inward: false };
    let seen = 1.0 - radius * radius / (h * h);
    assert_irradiance("ball", &plate(up, sky, &[Shape::Sphere(ball)]), PI * seen);
    // a square over the plate: four times one corner's form factor
    let (u, v) = up.any_orthonormal_pair();
    let (a, s) = (radius / h, (1.0 + radius * radius / (h * h)).sqrt());
    let factor = 4.0 * a / s * libm::atan(a / s) / PI;
    let square = Rectangle { center: up * h, half_u: u * radius, half_v: v * radius };
    assert_irradiance("square", &plate(up, sky, &[Shape::Rectangle(square)]), PI * (1.0 - factor));
}
