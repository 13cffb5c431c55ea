//! Promise: a rough metal samples its density, its weight is f cos / pdf, f is that of the textbooks and reciprocal, light
//! is lost and never made, and the smoother it is the more it is a polished metal. However direct light is found, it
//! reflects the same.
//!
//! Directions are binned in 1024 cells a case and tested by chi-square, those below the horizon in a cell of their own;
//! the false alarm probability of the nine tests together is below 1e-8. f and the directional albedo are held to
//! formulas in angles and tangents that share nothing with the code but the reflectance of a polished metal.

mod chi_square;

use chi_square::assert_follows;
use furnace::estimator::{Estimator, Explicit, Heuristic, Implicit, Roulette, Technique};
use furnace::experiment::{Cell, sample};
use furnace::sampling::warp::Frame;
use furnace::sampling::{Address, Stream};
use furnace::scene::geometry::{Rectangle, SpherePatch};
use furnace::scene::{
    Bsdf, Carried, DirectionSample, Directions, LightSampling, Material, Rgb, Scene, Sensor, Shape, Sky,
    Surface, fresnel,
};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const ETA: Rgb = Rgb::new(0.2, 1.4, 1.5);
const K: Rgb = Rgb::new(3.9, 1.6, 0.0);
const ALPHAS: [f64; 3] = [0.05, 0.3, 1.0];
/// Cosines of `wo`: straight, slanting, grazing.
const COSINES: [f64; 3] = [1.0, 0.6, 0.08];
const NORMAL: DVec3 = DVec3::new(0.64, -0.48, -0.6);

fn glossy(alpha: f64) -> Bsdf {
    Bsdf::Glossy { alpha, eta: ETA, k: K }
}

fn stream(name: &str) -> Stream {
    Address::of(&["glossy_reflection_is_consistent", name]).stream(0, 0)
}

/// The direction at polar angle `theta` and azimuth `phi` around `n`, from axes that are not the frame's own.
fn towards(n: DVec3, theta: f64, phi: f64) -> DVec3 {
    let s = n.cross(DVec3::X).normalize();
    let across = s * libm::cos(phi) + n.cross(s) * libm::sin(phi);
    n * libm::cos(theta) + across * libm::sin(theta)
}

fn draw(bsdf: Bsdf, n: DVec3, wo: DVec3, u: (f64, f64)) -> DirectionSample {
    bsdf.sample(Carried::Radiance, Directions::Cosine, &Frame::around(n), wo, u)
}

// -------------------------------------------------------------------------------------------------------- the textbook

/// D of a facet at the angle `theta` to the normal, and the share of facets seen at the angle `theta`
/// [Walter et al. 2007, eqs. 33 and 34].
fn textbook_d(alpha: f64, theta: f64) -> f64 {
    let (cos, tan) = (libm::cos(theta), libm::tan(theta));
    alpha * alpha / (PI * cos.powi(4) * (alpha * alpha + tan * tan).powi(2))
}

fn textbook_g1(alpha: f64, theta: f64) -> f64 {
    let slope = alpha * libm::tan(theta);
    2.0 / (1.0 + (1.0 + slope * slope).sqrt())
}

/// f between directions at two polar angles, `phi` apart in azimuth [Walter et al. 2007, eq. 20, with G = G1 G1].
fn textbook_f(alpha: f64, o: f64, i: f64, phi: f64) -> Rgb {
    let between = libm::cos(o) * libm::cos(i) + libm::sin(o) * libm::sin(i) * libm::cos(phi);
    let at_facet = 0.5 * libm::acos(between.clamp(-1.0, 1.0));
    // cos θ_m = (cos θ_o + cos θ_i) / |wo + wi|, and |wo + wi| = 2 cos of half the angle
    let theta_m = libm::acos(((libm::cos(o) + libm::cos(i)) / (2.0 * libm::cos(at_facet))).min(1.0));
    let d = textbook_d(alpha, theta_m);
    let g = textbook_g1(alpha, o) * textbook_g1(alpha, i);
    fresnel::conductor(libm::cos(at_facet), ETA, K) * (d * g / (4.0 * libm::cos(o) * libm::cos(i)))
}

#[test]
fn f_is_that_of_the_textbook_and_reciprocal() {
    let mut stream = stream("f");
    for (alpha, n) in [0.01, 0.05, 0.3, 1.0].into_iter().flat_map(|a| [(a, NORMAL), (a, DVec3::Y)]) {
        for _ in 0..20_000 {
            let ((o, i), phi) = (stream.u2(), TAU * stream.u1());
            let (o, i) = (1.55 * o, 1.55 * i);
            let (wo, wi) = (towards(n, o, 0.4), towards(n, i, 0.4 + phi));
            let (f, right) = (glossy(alpha).f(n, wo, wi), textbook_f(alpha, o, i, phi));
            // an angle near 0 is known to 1e-8 from its cosine
            let error = (f - right).abs().max_element() / right.max_element();
            assert!(error < 1e-6 / alpha.powi(2), "{alpha} {o} {i} {phi}: {f} {right}");
            assert_eq!(f, glossy(alpha).f(n, wi, wo));
            assert_eq!(glossy(alpha).f(n, wo, -wi), Rgb::ZERO);
            assert_eq!(glossy(alpha).f(n, -wo, wi), Rgb::ZERO);
            assert_eq!(glossy(alpha).f(n, -wo, -wi), Rgb::ZERO);
        }
    }
}

// ---------------------------------------------------------------------------------------------------- sample by sample

/// Also at the corners of the unit square, as near to the horizon as numbers go.
#[test]
fn weight_times_pdf_is_f_cos() {
    let mut stream = stream("weight");
    let last = 1f64.next_down();
    let corners = [(0.0, 0.0), (0.0, last), (last, 0.0), (last, last)];
    for alpha in [0.001, 0.05, 0.3, 1.0] {
        let mut below = 0;
        for case in 0..100_000 {
            let u = if case < 400 { corners[case % 4] } else { stream.u2() };
            let grazing = if case % 10 < 4 { 1e-9 } else { 1.0 };
            let theta = libm::acos(grazing * (1.0 - stream.u1()));
            let wo = towards(NORMAL, theta, TAU * stream.u1());
            let s = draw(glossy(alpha), NORMAL, wo, u);
            let (cos, pdf) = (s.wi.dot(NORMAL), s.pdf.expect("a density").0);
            let possible = pdf > 0.0 || s.weight == Rgb::ZERO;
            assert!(s.weight.is_finite() && pdf.is_finite() && possible, "{wo} {u:?}: {s:?}");
            assert!(s.weight.min_element() >= 0.0 && s.weight.max_element() <= 1.0 + 1e-14, "{s:?}");
            assert!((s.wi.length_squared() - 1.0).abs() < 8.0 * f64::EPSILON);
            let asked = glossy(alpha).pdf(Directions::Uniform, NORMAL, wo, s.wi).unwrap().0;
            if cos <= 0.0 {
                assert_eq!((s.weight, asked), (Rgb::ZERO, 0.0), "below the horizon");
                below += 1;
                continue;
            }
            let f_cos = glossy(alpha).f(NORMAL, wo, s.wi) * cos;
            let error = (s.weight * pdf - f_cos).abs().max_element() / f_cos.max_element();
            // what rounding of directions does to so narrow a lobe; above a grazing wi, to its cosine
            let rounding = 1e-13 * (1.0 / alpha + 1.0 / cos + 1.0 / wo.dot(NORMAL).max(alpha * 1e-3));
            assert!(error < rounding, "{alpha} {wo} {u:?}: {error:e} > {rounding:e}");
            assert!((asked / pdf - 1.0).abs() < rounding, "{alpha} {wo}: {asked} {pdf}");
        }
        assert!(below > 0, "no facet of {alpha} mirrors to below the horizon");
    }
}

const SIDE: usize = 32;
const N: u32 = 1 << 20;
/// A cell's probability is the mean over so many points in polar angle and azimuth; a grazing lobe is narrow in azimuth.
const FINE: (usize, usize) = (24, 96);

/// Cells are squares of (θ_i, azimuth). What they leave of 1 is what facets mirror to below the horizon.
#[test]
fn directions_follow_their_pdf() {
    for (alpha, cos_o) in ALPHAS.into_iter().flat_map(|a| COSINES.map(|c| (a, c))) {
        let (name, n) = (format!("alpha {alpha}, cosine {cos_o}"), NORMAL);
        let (mut stream, wo) = (stream(&name), towards(n, libm::acos(cos_o), 0.4));
        let (s, t) = (towards(n, FRAC_PI_2, 0.0), towards(n, FRAC_PI_2, FRAC_PI_2));
        let cell = |x: f64| ((x * SIDE as f64) as usize).min(SIDE - 1);
        let (mut counts, mut below) = (vec![0u64; SIDE * SIDE], 0);
        for _ in 0..N {
            let wi = draw(glossy(alpha), n, wo, stream.u2()).wi;
            if wi.dot(n) <= 0.0 {
                below += 1;
                continue;
            }
            let turn = libm::atan2(wi.dot(t), wi.dot(s)) / TAU + 0.5;
            let theta = libm::atan2(wi.cross(n).length(), wi.dot(n));
            counts[cell(theta / FRAC_PI_2) * SIDE + cell(turn)] += 1;
        }
        let (rows, columns) = (SIDE * FINE.0, SIDE * FINE.1);
        let mut probability = vec![0.0; SIDE * SIDE];
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let theta = FRAC_PI_2 * (i as f64 + 0.5) / rows as f64;
            let wi = towards(n, theta, TAU * ((j as f64 + 0.5) / columns as f64 - 0.5));
            let pdf = glossy(alpha).pdf(Directions::Cosine, n, wo, wi).unwrap().0;
            let solid_angle = libm::sin(theta) * FRAC_PI_2 * TAU / (rows * columns) as f64;
            probability[(i / FINE.0) * SIDE + j / FINE.1] += pdf * solid_angle;
        }
        assert_follows(&name, &counts, below, &probability, 1e-9);
    }
}

// ------------------------------------------------------------------------------------------------------------- energy

/// The integral of f cos over the hemisphere, for light that leaves at the angle `o`: midpoint rule over the polar angle
/// and half of the azimuth.
fn textbook_albedo(alpha: f64, o: f64) -> Rgb {
    const STEPS: u32 = 1500;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
    let mut sum = Rgb::ZERO;
    for theta in (0..STEPS).map(|i| FRAC_PI_2 * at(i)) {
        let ring: Rgb = (0..STEPS).map(|j| textbook_f(alpha, o, theta, PI * at(j))).sum();
        sum += ring * (libm::cos(theta) * libm::sin(theta));
    }
    sum * (2.0 * FRAC_PI_2 * PI / f64::from(STEPS).powi(2))
}

/// The mean weight over the unit square.
fn mean_weight(bsdf: Bsdf, cos_o: f64) -> Rgb {
    const STEPS: u32 = 1024;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
    let wo = towards(NORMAL, libm::acos(cos_o), 0.4);
    let sum: Rgb =
        (0..STEPS * STEPS).map(|i| draw(bsdf, NORMAL, wo, (at(i % STEPS), at(i / STEPS))).weight).sum();
    sum / f64::from(STEPS * STEPS)
}

/// And that is less than 1, even of a metal that loses nothing at its facets.
#[test]
fn the_mean_weight_is_the_directional_albedo() {
    for (alpha, cos_o) in [0.1, 0.3, 1.0].into_iter().flat_map(|a| [1.0, 0.6, 0.2].map(|c| (a, c))) {
        let (mean, right) = (mean_weight(glossy(alpha), cos_o), textbook_albedo(alpha, libm::acos(cos_o)));
        let error = (mean / right - 1.0).abs().max_element();
        assert!(error < 3e-4, "{alpha} {cos_o}: {mean} instead of {right}");
        let lossless = Bsdf::Glossy { alpha, eta: Rgb::ZERO, k: Rgb::ONE };
        let kept = mean_weight(lossless, cos_o);
        assert!(mean.max_element() < kept.x && kept.x < 1.0, "{alpha} {cos_o}: {kept} of 1");
    }
}

/// What roulette goes by is the reflectance of the polished metal. A rough one exceeds it by no more than 5 parts in
/// 10^4, and matter that hardly reflects at all by some per cent: no bound in the strict sense.
#[test]
fn the_polished_albedo_is_all_but_a_bound() {
    let (mut of_metal, mut of_glass) = (0.0_f64, 0.0_f64);
    for (alpha, cos_o) in
        [0.03, 0.1, 0.3, 1.0].into_iter().flat_map(|a| [1.0, 0.9, 0.7, 0.5, 0.3, 0.1].map(|c| (a, c)))
    {
        // gold in red, a metal of low index, iron; then three glasses
        let [metal, glass] =
            [(at(0.2, 0.5, 2.9), at(3.9, 1.0, 3.1)), (at(1.1, 1.5, 2.0), Rgb::ZERO)].map(|(eta, k)| {
                let bsdf = Bsdf::Glossy { alpha, eta, k };
                (mean_weight(bsdf, cos_o) / bsdf.albedo(cos_o)).max_element()
            });
        (of_metal, of_glass) = (of_metal.max(metal), of_glass.max(glass));
    }
    assert!(of_metal < 1.0005, "{of_metal}");
    assert!(of_glass > 1.05 && of_glass < 1.1, "{of_glass}");
}

// ----------------------------------------------------------------------------------------------------------- in scenes

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn rectangle(center: DVec3, half_u: DVec3, half_v: DVec3, material: Material) -> Surface {
    Surface::new(Shape::Rectangle(Rectangle { center, half_u, half_v }), material)
}

fn mean_of(scene: &Scene, estimator: Estimator, samples: u64) -> Cell {
    let address = Address::of(&["glossy_reflection_is_consistent", &format!("{estimator:?}")]);
    let cell = sample(scene, &estimator, &address, samples, samples / 128);
    assert_eq!(cell.invalid(), None);
    cell
}

/// A ball under a sky that is brightest on one side. What two bounces on it show differs from the polished one by the
/// light in the tails of the lobe, of the order α².
#[test]
fn the_smoothest_metal_is_a_polished_one() {
    let shown = |bsdf| {
        let ball = SpherePatch {
            center: at(0.1, 0.2, 0.3),
            radius: 0.7,
            axis: DVec3::Z,
            low: -1.0,
            high: 1.0,
            inward: false,
        };
        let sky = Sky::Cosine { radiance: at(1.0, 2.0, 3.0), exponent: 3.0, up: at(0.48, 0.8, 0.36) };
        let direction = (at(0.3, 0.5, 0.5) - at(0.6, 1.4, 2.6)).normalize();
        let probe = Sensor::Probe { origin: at(0.6, 1.4, 2.6), direction };
        let surfaces = vec![Surface::new(Shape::Sphere(ball), Material { bsdf, le: Rgb::ZERO })];
        let implicit = Implicit { directions: Directions::Cosine, roulette: Roulette::depth_clamp(3) };
        let scene = Scene::lit_by(surfaces, &[], Some(sky), probe);
        let cell = mean_of(&scene, Estimator::Implicit(implicit), 1 << 18);
        Rgb::from([0, 1, 2].map(|c| cell.total[c].mean))
    };
    let polished = shown(Bsdf::Conductor { eta: ETA, k: K });
    let [rough, smooth] = [0.1, 0.001].map(|alpha| (shown(glossy(alpha)) / polished - 1.0).abs());
    assert!(polished.min_element() > 0.01, "{polished}");
    assert!(rough.min_element() > 3e-3, "nothing was tested: {rough}");
    assert!(smooth.max_element() < 3e-4, "{smooth}");
}

/// A glossy floor and a glossy ball before a wall, under a light that the floor mirrors, seen by a plain probe.
fn studio() -> Scene {
    let metal = |alpha| Material { bsdf: glossy(alpha), le: Rgb::ZERO };
    let white = Material::lambert(at(0.7, 0.6, 0.5), Rgb::ZERO);
    let light = Material::lambert(Rgb::splat(0.1), at(3.0, 4.0, 5.0));
    let ball = SpherePatch {
        center: at(0.4, 0.5, -0.3),
        radius: 0.5,
        axis: DVec3::Z,
        low: -1.0,
        high: 1.0,
        inward: false,
    };
    let (origin, target) = (at(0.2, 1.1, 2.4), at(-0.3, 0.0, 0.3));
    let probe = Sensor::Probe { origin, direction: (target - origin).normalize() };
    let surfaces = vec![
        rectangle(DVec3::ZERO, 2.0 * DVec3::Z, 2.0 * DVec3::X, metal(0.25)),
        rectangle(at(0.0, 1.0, -1.0), 2.0 * DVec3::X, DVec3::Y, white),
        rectangle(at(-0.8, 1.6, -0.4), 0.4 * DVec3::X, 0.4 * at(0.0, 0.6, 0.8), light),
        Surface::new(Shape::Sphere(ball), metal(0.5)),
    ];
    Scene::new(surfaces, probe)
}

/// Bounces up to the third, each known to 2 % (standard error) at least; false alarms of the 180 comparisons below 1e-8.
#[test]
fn all_techniques_find_the_same_light() {
    const LAST: usize = 3;
    let (scene, roulette) = (studio(), Roulette::depth_clamp(LAST as u32));
    let directions = Directions::Cosine;
    let mut cells = vec![mean_of(&scene, Estimator::Implicit(Implicit { directions, roulette }), 1 << 22)];
    for technique in [
        Technique::Light,
        Technique::Direction,
        Technique::Both(Heuristic::Balance),
        Technique::Both(Heuristic::Power),
    ] {
        let lights = LightSampling::SOLID_ANGLE;
        let explicit = Explicit { technique, lights, directions, roulette };
        let samples = if technique == Technique::Direction { 1 << 22 } else { 1 << 20 };
        cells.push(mean_of(&scene, Estimator::Explicit(explicit), samples));
    }
    for (i, a) in cells.iter().enumerate() {
        for (b, bounce, c) in
            cells[..i].iter().flat_map(|b| (1..=LAST).flat_map(move |k| [0, 1, 2].map(|c| (b, k, c))))
        {
            let (one, other) = (&a.bounces[bounce][c], &b.bounces[bounce][c]);
            let (e, f) = (one.std_error().unwrap(), other.std_error().unwrap());
            assert!(one.mean > 0.0 && e < 0.02 * one.mean, "bounce {bounce}: {} ± {e}", one.mean);
            let t = (one.mean - other.mean) / e.hypot(f);
            assert!(t.abs() < 7.0, "bounce {bounce}: {} ± {e}, {} ± {f}: {t}", one.mean, other.mean);
        }
    }
}
