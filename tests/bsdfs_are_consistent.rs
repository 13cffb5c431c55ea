//! Promise: what is sampled, its density and its weight belong together: weight x pdf = f cos, directions follow the
//! pdf, and a surface reflects its albedo and no more.
//!
//! One chi-square for each way of sampling, of 2^20 directions in 1024 cells of equal probability; together their
//! false alarm probability is 1e-9, and a deviation of 3 % (root mean square over the cells) is seen almost surely.

use furnace::sampling::Address;
use furnace::sampling::warp::Frame;
use furnace::scene::{Directions, Material, Rgb};
use glam::DVec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::{FRAC_1_PI, PI, TAU};

const WAYS: [Directions; 2] = [Directions::Cosine, Directions::Uniform];
const MATERIAL: Material = Material { albedo: Rgb::new(0.9, 0.35, 0.0), le: Rgb::ONE };
/// A normal that no axis shares, and one on the lower side, where the frame's sign is the other.
const NORMALS: [DVec3; 2] = [DVec3::new(0.36, 0.48, 0.8), DVec3::new(0.64, -0.48, -0.6)];
const N: u32 = 1 << 20;
const SIDE: usize = 32;

/// The probability that cos θ is below `z`.
fn distribution(way: Directions, z: f64) -> f64 {
    match way {
        Directions::Cosine => z * z,
        Directions::Uniform => z,
    }
}

/// Two directions perpendicular to `n` and to each other, not the frame's own.
fn across(n: DVec3) -> (DVec3, DVec3) {
    let s = n.cross(DVec3::X).normalize();
    (s, n.cross(s))
}

/// Lambert: f is albedo / π for every pair of directions. It takes none, so that it cannot but be reciprocal.
#[test]
fn f_is_albedo_over_pi() {
    assert!((MATERIAL.f() * PI - MATERIAL.albedo).abs().max_element() < f64::EPSILON);
}

#[test]
fn weight_times_pdf_is_f_cos() {
    let mut stream = Address::of(&["bsdfs_are_consistent", "weight"]).stream(0, 0);
    let last = 1f64.next_down();
    let mut points = vec![(0.0, 0.0), (0.0, last), (last, 0.0), (last, last)];
    points.extend((0..100_000).map(|_| stream.u2()));
    for (way, n) in WAYS.into_iter().flat_map(|way| NORMALS.map(|n| (way, n))) {
        for &u in &points {
            let s = way.sample(&MATERIAL, &Frame::around(n), u);
            let cos = s.wi.dot(n);
            // cos is rounded once more on its way through the frame: by some epsilons of 1, however small it is
            let error = s.weight * s.pdf.0 - MATERIAL.f() * cos;
            assert!(error.abs().max_element() < 2.0 * f64::EPSILON, "{way:?} {n} {u:?}: {error}");
            let density = if way == Directions::Cosine { cos * FRAC_1_PI } else { 0.5 * FRAC_1_PI };
            assert!((s.pdf.0 - density).abs() < 2.0 * f64::EPSILON, "{way:?} {n} {u:?}: {}", s.pdf.0);
            assert!(
                (s.wi.length_squared() - 1.0).abs() < 8.0 * f64::EPSILON && cos > -2.0 * f64::EPSILON,
                "{s:?}"
            );
        }
    }
}

/// Cells of equal probability: the distribution function of cos θ follows from the pdf, the azimuth is uniform.
#[test]
fn directions_follow_their_pdf() {
    for (way, n) in WAYS.into_iter().flat_map(|way| NORMALS.map(|n| (way, n))) {
        let name = format!("{way:?} {n}");
        let mut stream = Address::of(&["bsdfs_are_consistent", &name]).stream(0, 0);
        let ((s, t), frame) = (across(n), Frame::around(n));
        let cell = |x: f64| ((x * SIDE as f64) as usize).min(SIDE - 1);
        let mut counts = vec![0u32; SIDE * SIDE];
        for _ in 0..N {
            let wi = way.sample(&MATERIAL, &frame, stream.u2()).wi;
            let turn = libm::atan2(wi.dot(t), wi.dot(s)) / TAU + 0.5;
            counts[cell(distribution(way, wi.dot(n))) * SIDE + cell(turn)] += 1;
        }
        let expected = f64::from(N) / counts.len() as f64;
        let chi2 = counts.iter().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum::<f64>();
        let p = ChiSquared::new(counts.len() as f64 - 1.0).unwrap().sf(chi2);
        assert!(p > 1e-9 / 4.0, "{name}: chi-square {chi2}, p = {p}");
    }
}

/// The mean weight is the albedo, and so is the integral of f cos over the hemisphere: both are integrals over the unit
/// square, whose integrands are at most linear in each coordinate, so that the midpoint rule is exact.
#[test]
fn the_mean_weight_is_the_albedo() {
    const CELLS: u32 = 16; // few terms, so that their sum errs by less than 1e-13
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(CELLS);
    let mean = |f: &dyn Fn((f64, f64)) -> Rgb| {
        (0..CELLS * CELLS).map(|i| f((at(i % CELLS), at(i / CELLS)))).sum::<Rgb>() / f64::from(CELLS * CELLS)
    };
    let frame = Frame::around(NORMALS[0]);
    for way in WAYS {
        let energy = mean(&|u| way.sample(&MATERIAL, &frame, u).weight);
        assert!((energy - MATERIAL.albedo).abs().max_element() < 1e-13, "{way:?}: {energy}");
    }
    let reflected = mean(&|(cos, _)| MATERIAL.f() * cos * TAU);
    assert!((reflected - MATERIAL.albedo).abs().max_element() < 1e-13, "{reflected}");
}
