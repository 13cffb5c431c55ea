//! Promise: what a surface of finite density samples, its density and its weight belong together: weight x pdf = f cos,
//! directions follow the pdf, f is reciprocal, and a surface reflects its albedo and no more.
//!
//! One chi-square for each way of sampling and each normal, of 2^20 directions in 1024 cells; together their false alarm
//! probability is 4e-9. The cells' probabilities are integrals of `pdf`, and a direction below the horizon has a cell of
//! its own: a pdf that does not integrate to 1 is seen as soon as it misses or exceeds it by 1 part in 10^4, and of
//! samples that must not be lost a single one. A deviation of 3 % (root mean square over the cells) is seen almost
//! surely.

mod chi_square;

use chi_square::assert_follows;
use furnace::sampling::warp::Frame;
use furnace::sampling::{Address, PdfW};
use furnace::scene::{Bsdf, Carried, Directions, Rgb};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, TAU};

const WAYS: [Directions; 2] = [Directions::Cosine, Directions::Uniform];
const ALBEDO: Rgb = Rgb::new(0.9, 0.35, 0.0);
const LAMBERT: Bsdf = Bsdf::Lambert { albedo: ALBEDO };
/// A normal that no axis shares, and one on the lower side, where the frame's sign is the other.
const NORMALS: [DVec3; 2] = [DVec3::new(0.36, 0.48, 0.8), DVec3::new(0.64, -0.48, -0.6)];
const N: u32 = 1 << 20;
const SIDE: usize = 32;

/// Every way with every normal.
fn cases() -> impl Iterator<Item = (Directions, DVec3)> {
    WAYS.into_iter().flat_map(|way| NORMALS.map(|n| (way, n)))
}

/// Two directions perpendicular to `n` and to each other, not the frame's own.
fn across(n: DVec3) -> (DVec3, DVec3) {
    let s = n.cross(DVec3::X).normalize();
    (s, n.cross(s))
}

/// A unit vector whose cosine to z is exactly this.
fn leaving(cos: f64) -> DVec3 {
    DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

/// The mean over the cells of the unit square.
fn mean(cells: u32, f: impl Fn((f64, f64)) -> Rgb) -> Rgb {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(cells);
    (0..cells * cells).map(|i| f((at(i % cells), at(i / cells)))).sum::<Rgb>() / f64::from(cells * cells)
}

#[test]
fn weight_times_pdf_is_f_cos() {
    let mut stream = Address::of(&["bsdfs_are_consistent", "weight"]).stream(0, 0);
    let last = 1f64.next_down();
    let mut points = vec![(0.0, 0.0), (0.0, last), (last, 0.0), (last, last)];
    points.extend((0..100_000).map(|_| stream.u2()));
    for (way, n) in cases() {
        let wo = (n + 0.3 * across(n).0).normalize();
        for &u in &points {
            let s = LAMBERT.sample(Carried::Radiance, way, &Frame::around(n), wo, u);
            let (cos, PdfW(pdf)) = (s.wi.dot(n), s.pdf.expect("a density"));
            // cos is rounded once more on its way through the frame: by some epsilons of 1, however small it is
            let f_cos = LAMBERT.f(n, wo, s.wi) * cos;
            let error = s.weight * pdf - f_cos;
            assert!(error.abs().max_element() < 2.0 * f64::EPSILON, "{way:?} {n} {u:?}: {error}");
            let asked = LAMBERT.pdf(way, n, wo, s.wi).unwrap().0;
            assert!(cos <= 0.0 || (asked - pdf).abs() < 2.0 * f64::EPSILON, "{way:?} {u:?}: {asked} {pdf}");
            let length = s.wi.length_squared();
            assert!((length - 1.0).abs() < 8.0 * f64::EPSILON && cos > -2.0 * f64::EPSILON, "{s:?}");
        }
    }
}

/// The density does not depend on azimuth and is at most linear in the cosine, so that a cell's probability is the value
/// in its middle times its solid angle.
#[test]
fn directions_follow_their_pdf() {
    for (way, n) in cases() {
        let name = format!("{way:?} {n}");
        let mut stream = Address::of(&["bsdfs_are_consistent", &name]).stream(0, 0);
        let ((s, t), frame) = (across(n), Frame::around(n));
        let cell = |x: f64| ((x * SIDE as f64) as usize).min(SIDE - 1);
        let (mut counts, mut lost) = (vec![0u64; SIDE * SIDE], 0);
        for _ in 0..N {
            let wi = LAMBERT.sample(Carried::Radiance, way, &frame, n, stream.u2()).wi;
            let cos = wi.dot(n);
            if !(wi.is_finite() && cos > 0.0) {
                lost += 1;
                continue;
            }
            let turn = libm::atan2(wi.dot(t), wi.dot(s)) / TAU + 0.5;
            counts[cell(cos) * SIDE + cell(turn)] += 1;
        }
        let solid_angle = TAU / (SIDE * SIDE) as f64;
        let middle = |i: usize| ((i / SIDE) as f64 + 0.5) / SIDE as f64;
        let probability: Vec<f64> = (0..SIDE * SIDE)
            .map(|i| LAMBERT.pdf(way, DVec3::Z, DVec3::Z, leaving(middle(i))).unwrap().0 * solid_angle)
            .collect();
        assert_follows(&name, &counts, lost, &probability, 1e-9);
    }
}

/// Lambert: albedo / π above the surface and nothing below it, whichever of the two directions is which.
#[test]
fn f_is_albedo_over_pi_and_reciprocal() {
    let cosines = [-1.0, -0.3, -f64::MIN_POSITIVE, 0.0, f64::MIN_POSITIVE, 1e-9, 0.2, 0.7, 1.0];
    for (o, i) in cosines.into_iter().flat_map(|o| cosines.map(|i| (o, i))) {
        let f = LAMBERT.f(DVec3::Z, leaving(o), leaving(i));
        assert_eq!(f, LAMBERT.f(DVec3::Z, leaving(i), leaving(o)), "{o} {i}");
        let expected = if o > 0.0 && i > 0.0 { ALBEDO * FRAC_1_PI } else { Rgb::ZERO };
        assert!((f - expected).abs().max_element() < f64::EPSILON, "{o} {i}: {f}");
        let pdf = WAYS.map(|way| LAMBERT.pdf(way, DVec3::Z, leaving(o), leaving(i)).unwrap().0);
        assert_eq!(pdf.map(|pdf| pdf > 0.0), [i > 0.0; 2], "a density below the horizon: {i} {pdf:?}");
    }
}

/// The mean weight is the albedo, and so is the integral of f cos over the hemisphere: both are integrals over the unit
/// square, whose integrands are at most linear in each coordinate, so that the midpoint rule is exact.
#[test]
fn a_surface_reflects_its_albedo_and_no_more() {
    const CELLS: u32 = 16; // few terms, so that their sum errs by less than 1e-13
    let frame = Frame::around(NORMALS[0]);
    for way in WAYS {
        let energy = mean(CELLS, |u| LAMBERT.sample(Carried::Radiance, way, &frame, NORMALS[0], u).weight);
        assert!((energy - ALBEDO).abs().max_element() < 1e-13, "{way:?}: {energy}");
    }
    for cos_o in [1e-3, 0.4, 1.0] {
        let reflected = mean(CELLS, |(cos, _)| LAMBERT.f(DVec3::Z, leaving(cos_o), leaving(cos)) * cos * TAU);
        assert!((reflected - LAMBERT.albedo(cos_o)).abs().max_element() < 1e-13, "{reflected}");
        assert!(reflected.max_element() <= 1.0 && LAMBERT.albedo(cos_o) == ALBEDO);
    }
}
