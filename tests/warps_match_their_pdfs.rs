//! Promise: every map of the unit square has the density that stands beside it, and the trigonometry under it is as
//! exact as it says.
//!
//! Each chi-square compares 2^20 points with 1024 cells of equal probability, whose limits come from the closed form
//! of the distribution function and not from the map. False alarm probability 1e-9 for the file; a deviation of 3 %
//! (root mean square over the cells) is seen almost surely, one of 10 % of a single tenth of the domain as well.

use furnace::sampling::warp::{self, Frame};
use furnace::sampling::{Address, Stream};
use glam::DVec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::TAU;

const N: u32 = 1 << 20;
/// Cells along each axis.
const SIDE: usize = 32;
/// Chi-square tests in this file: four warps and three more bands, rounded up.
const ALARMS: f64 = 8.0;

fn stream(name: &str) -> Stream {
    Address::of(&["warps_match_their_pdfs", name]).stream(0, 0)
}

/// The cell of (a, b), two coordinates that are uniform in [0, 1] if the density is right.
fn cell((a, b): (f64, f64)) -> usize {
    assert!((0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b), "{a} {b}");
    let place = |x: f64| ((x * SIDE as f64) as usize).min(SIDE - 1);
    place(a) * SIDE + place(b)
}

/// Draws points and counts them by cell.
fn assert_uniform(name: &str, cell: impl Fn((f64, f64)) -> usize) {
    let mut counts = vec![0u32; SIDE * SIDE];
    let mut stream = stream(name);
    (0..N).for_each(|_| counts[cell(stream.u2())] += 1);
    let expected = f64::from(N) / counts.len() as f64;
    let chi2 = counts.iter().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum::<f64>();
    let p = ChiSquared::new(counts.len() as f64 - 1.0).unwrap().sf(chi2);
    assert!(p > 1e-9 / ALARMS, "{name}: chi-square {chi2}, p = {p}");
}

/// Azimuth as a fraction of a turn in [0, 1].
fn turn(x: f64, y: f64) -> f64 {
    (libm::atan2(y, x) / TAU + 0.5).clamp(0.0, 1.0)
}

/// The same vector, which must have unit length up to rounding.
fn unit(d: DVec3) -> DVec3 {
    assert!((d.length_squared() - 1.0).abs() < 4.0 * f64::EPSILON && d.is_finite(), "{d}");
    d
}

/// P(cos θ < z) = z² for the density cos θ / π, because 2π ∫ z / π dz = z².
#[test]
fn cosine_hemisphere() {
    assert_uniform("cosine_hemisphere", |u| {
        let d = unit(warp::cosine_hemisphere(u));
        cell((d.z * d.z, turn(d.x, d.y)))
    });
}

/// P(cos θ < z) = z for the density 1 / 2π.
#[test]
fn uniform_hemisphere() {
    assert_uniform("uniform_hemisphere", |u| {
        let d = unit(warp::uniform_hemisphere(u));
        cell((d.z, turn(d.x, d.y)))
    });
}

/// The functions beside the maps are the densities whose distribution functions are used above. Both are linear in z,
/// so that the value in the middle of a ring times its solid angle is the ring's probability exactly.
#[test]
fn densities_are_derivatives_of_the_distribution_functions() {
    for ring in 0..SIDE {
        let (low, high) = (ring as f64 / SIDE as f64, (ring + 1) as f64 / SIDE as f64);
        let (z, solid_angle) = (0.5 * (low + high), TAU * (high - low));
        let cosine = warp::cosine_hemisphere_pdf(z).0 * solid_angle;
        let uniform = warp::uniform_hemisphere_pdf().0 * solid_angle;
        assert!((cosine - (high * high - low * low)).abs() < 1e-15, "{z} {cosine}");
        assert!((uniform - (high - low)).abs() < 1e-15, "{z} {uniform}");
    }
}

/// P(radius < r) = r² for the density 1/π.
#[test]
fn disk() {
    assert_uniform("disk", |u| {
        let (x, y) = warp::disk(u);
        cell(((x * x + y * y).min(1.0), turn(x, y)))
    });
}

/// SIDE² congruent triangles: the lower and upper halves of the squares of a grid over the (b, c) plane.
#[test]
fn triangle() {
    let n = SIDE as f64;
    assert_uniform("triangle", |u| {
        let (b, c) = warp::triangle(u);
        assert!(b >= 0.0 && c >= 0.0 && b + c <= 1.0 + f64::EPSILON, "{b} {c}");
        let (column, row) = ((b * n) as usize, (c * n) as usize);
        let upper = (b * n).fract() + (c * n).fract() > 1.0;
        // column k holds 2 (SIDE - k) - 1 triangles, the columns before it k (2 SIDE - k)
        column * (2 * SIDE - column) + 2 * row + usize::from(upper)
    });
}

/// P(height < z) = (z - low) / (high - low) [Archimedes], also for a thin band, a cap and the whole sphere.
#[test]
fn sphere_band() {
    for (low, high) in [(-1.0, 1.0), (0.25, 0.75), (-1.0, -0.999), (0.9, 1.0)] {
        assert_uniform(&format!("sphere_band {low} {high}"), |u| {
            let d = unit(warp::sphere_band(low, high, u));
            assert!(d.z >= low && d.z <= high, "{d}");
            cell(((d.z - low) / (high - low), turn(d.x, d.y)))
        });
    }
}

#[test]
fn corners_of_the_unit_square_are_harmless() {
    let last = 1f64.next_down();
    for u in [(0.0, 0.0), (0.0, last), (last, 0.0), (last, last)] {
        assert!(unit(warp::cosine_hemisphere(u)).z >= 0.0 && unit(warp::uniform_hemisphere(u)).z > 0.0);
        assert!((-1.0..=1.0).contains(&unit(warp::sphere_band(-1.0, 1.0, u)).z));
        let ((x, y), (b, c)) = (warp::disk(u), warp::triangle(u));
        assert!(x * x + y * y <= 1.0 + 4.0 * f64::EPSILON && b >= 0.0 && c >= 0.0 && b + c <= 1.0);
    }
}

/// What `sin_cos_turn` states about its absolute error.
const STATED: f64 = 4e-16;
/// What libm adds to the error that is measured against it: half a unit in the last place, and a little.
const LIBM: f64 = 0.6e-16;

/// The larger error of sin and cos. The angle's remainder past the nearest quarter turn is exact, and its product with
/// 2π is carried in two parts: rounded to one, it would be off by more than what is measured.
fn error(u: f64) -> f64 {
    const TAU_LOW: f64 = 2.449_293_598_294_706_4e-16; // 2π - TAU
    let quarter = (4.0 * u).round();
    let rest = u - 0.25 * quarter;
    let x = rest * TAU;
    let low = rest.mul_add(TAU, -x) + rest * TAU_LOW;
    let (sin, cos) = libm::sincos(x);
    let (s, c) = warp::sin_cos_turn(u);
    // turned back by the quarter turns
    let (s, c) = [(s, c), (-c, s), (-s, -c), (c, -s)][quarter as usize % 4];
    (s - sin - low * cos).abs().max((c - cos + low * sin).abs())
}

#[test]
fn sin_cos_turn_is_as_exact_as_stated() {
    let mut stream = stream("sin_cos_turn");
    let grid = (0..=1 << 20).map(|i| f64::from(i) / f64::from(1 << 20));
    let seams = (0..8).map(|i| f64::from(2 * i + 1) / 16.0).flat_map(|u| [u.next_down(), u.next_up()]);
    let random: Vec<f64> = (0..1 << 20).map(|_| stream.u1()).collect();
    let worst = grid.chain(seams).chain(random).map(error).fold(0.0, f64::max);
    assert!(worst < STATED + LIBM, "{worst:e}");
}

/// The largest error among 2 10^8 random arguments, against values computed with 60 digits (mpmath), in two parts.
#[test]
fn sin_cos_turn_is_as_exact_as_stated_where_it_is_worst() {
    let (s, c) = warp::sin_cos_turn(0.375_457_435_506_187_26);
    let (sin, cos) =
        ((0.7050715309647314, -2.0587213985222204e-17), (-0.7091361901800315, -2.8107488487256556e-17));
    let worst = (s - sin.0 - sin.1).abs().max((c - cos.0 - cos.1).abs());
    assert!(worst < STATED, "{worst:e}");
}

#[test]
fn quarter_turns_are_exact() {
    let quarters = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0)];
    for (i, exact) in (0..).zip(quarters) {
        assert_eq!(warp::sin_cos_turn(0.25 * f64::from(i)), exact);
    }
}

/// Orthonormal and right-handed to rounding, also where the branch is: at z = ±0, at the poles and beside them.
#[test]
fn frames_are_orthonormal() {
    let mut stream = stream("frames");
    let mut normals: Vec<DVec3> = (0..100_000).map(|_| warp::sphere_band(-1.0, 1.0, stream.u2())).collect();
    normals.extend(DVec3::AXES.iter().flat_map(|&axis| [axis, -axis]));
    normals.extend([DVec3::new(0.6, -0.8, 0.0), DVec3::new(0.6, -0.8, -0.0), DVec3::new(-0.0, -0.0, -1.0)]);
    for tilt in [1e-300, 1e-160, 1e-16, 1e-9, 1e-5] {
        let azimuths = [(tilt, 0.0), (0.0, tilt), (-0.6 * tilt, 0.8 * tilt)];
        normals
            .extend(azimuths.iter().flat_map(|&(x, y)| [1.0, -1.0].map(|z| DVec3::new(x, y, z).normalize())));
    }
    for n in normals {
        let frame = Frame::around(n);
        let [s, t, third] = DVec3::AXES.map(|axis| frame.to_world(axis));
        let lengths = DVec3::new(s.length_squared(), t.length_squared(), third.length_squared()) - 1.0;
        let products = DVec3::new(s.dot(t), t.dot(n), n.dot(s));
        let handed = s.cross(t) - n;
        let worst = lengths.abs().max(products.abs()).max(handed.abs()).max_element();
        assert!(third == n && frame.n == n && worst < 8.0 * f64::EPSILON, "{n} {worst}");
    }
}
