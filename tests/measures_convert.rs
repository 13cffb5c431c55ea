//! Promise: a density per area and one per solid angle are turned into each other by d² / cos θ', and there and back
//! changes nothing.

use furnace::sampling::{PdfA, PdfW};
use glam::DVec3;
use std::f64::consts::TAU;

/// A plate of 2a x 2b at `center`, its edges along `u` and `v`.
struct Plate {
    center: DVec3,
    u: DVec3,
    v: DVec3,
    half: (f64, f64),
}

impl Plate {
    /// Density of directions from the origin towards the point (s, t) in [-1, 1]² of the plate, drawn uniformly over it.
    fn pdf(&self, s: f64, t: f64) -> PdfW {
        let p = self.center + self.u * (s * self.half.0) + self.v * (t * self.half.1);
        let cos = self.u.cross(self.v).dot(p).abs() / p.length();
        PdfA(1.0 / (4.0 * self.half.0 * self.half.1)).per_solid_angle(p.length_squared(), cos)
    }

    fn is_hit_by(&self, d: DVec3) -> bool {
        let n = self.u.cross(self.v);
        let q = d * (n.dot(self.center) / n.dot(d)) - self.center;
        q.dot(self.u).abs() <= self.half.0 && q.dot(self.v).abs() <= self.half.1
    }
}

#[test]
fn there_and_back_is_the_identity() {
    for pdf in [1e-12, 0.3, 1.0, 4e9] {
        for distance_squared in [1e-14, 0.7, 2e11] {
            for cos in [1e-9, 0.5, 1.0] {
                let there = PdfA(pdf).per_solid_angle(distance_squared, cos);
                let back = there.per_area(distance_squared, cos);
                // four operations, each of which rounds by half an epsilon
                assert!((back.0 / pdf - 1.0).abs() < 2.0 * f64::EPSILON, "{pdf} {distance_squared} {cos}");
                let again = PdfW(pdf).per_area(distance_squared, cos).per_solid_angle(distance_squared, cos);
                assert!((again.0 / pdf - 1.0).abs() < 2.0 * f64::EPSILON, "{pdf} {distance_squared} {cos}");
            }
        }
    }
}

/// Rays through a grid of equal cells on the plane at distance 1 count the solid angle of a small tilted plate:
/// a cell at (x, y) fills dx dy / (1 + x² + y²)^1.5. Uniform points of the plate have the density 1 / that.
#[test]
fn a_small_patch_has_the_density_one_over_its_solid_angle() {
    const CELLS: i32 = 1500;
    // cos θ' = 0.6, d² = 9, neither of which is its own inverse or square
    let patch =
        Plate { center: DVec3::Z * 3.0, u: DVec3::X, v: DVec3::new(0.0, 0.6, 0.8), half: (0.02, 0.03) };
    let width = 0.02; // of the window, in which the patch fills 0.013 x 0.012
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(CELLS) * width - 0.5 * width;
    let mut solid_angle = 0.0;
    for (x, y) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (at(i), at(j)))) {
        if patch.is_hit_by(DVec3::new(x, y, 1.0)) {
            solid_angle += (width / f64::from(CELLS)).powi(2) * (1.0 + x * x + y * y).powf(-1.5);
        }
    }
    // A row or column of cells too many is one part in 900, and across the patch the density varies by 1 part in 10^4
    // about its value in the middle.
    let product = patch.pdf(0.0, 0.0).0 * solid_angle;
    assert!((product - 1.0).abs() < 3e-3, "{product}");
}

/// Over a plate that is not small the mean of 1 / pdf is the solid angle, whose closed form for a rectangle a x b with
/// a corner at height h above the eye is atan(a b / (h √(a² + b² + h²))).
#[test]
fn the_mean_of_one_over_pdf_is_the_solid_angle() {
    const CELLS: i32 = 1000;
    let plate = Plate { center: DVec3::new(0.7, 0.4, 0.5), u: DVec3::X, v: DVec3::Y, half: (0.7, 0.4) };
    let at = |i: i32| (2.0 * f64::from(i) + 1.0) / f64::from(CELLS) - 1.0;
    let inverse = |i: i32| 1.0 / plate.pdf(at(i % CELLS), at(i / CELLS)).0;
    let mean = (0..CELLS * CELLS).map(inverse).sum::<f64>() / f64::from(CELLS * CELLS);
    let exact = libm::atan(1.4 * 0.8 / (0.5 * libm::sqrt(1.4 * 1.4 + 0.8 * 0.8 + 0.5 * 0.5)));
    assert!(exact < TAU && (mean / exact - 1.0).abs() < 1e-6, "{mean} {exact}");
}
