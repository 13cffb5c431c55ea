//! Tile means against exact form factors between rectangles, and direct light in the Cornell box against rays.

use crate::common::{close, crosses, kernel, sides};
use furnace::truth::direct::cornell_direct::{blocks, corners, direct, light};
use furnace::truth::direct::tile::mean;
use furnace::truth::direct::visibility::Blocker;
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

/// Sum of ± g over two pairs of end points of two segments.
fn corner_sum(a: [f64; 2], b: [f64; 2], g: impl Fn(f64, f64) -> f64) -> f64 {
    g(a[0], b[0]) - g(a[0], b[1]) - g(a[1], b[0]) + g(a[1], b[1])
}

/// Form factor between parallel rectangles a distance c apart, x by y and X by Y (Howell, C-14).
fn parallel(c: f64, [x, y]: [[f64; 2]; 2], [xx, yy]: [[f64; 2]; 2]) -> f64 {
    let primitive = |u: f64, v: f64| {
        let (a, b) = (u.hypot(c), v.hypot(c));
        (v * a * (v / a).atan() + u * b * (u / b).atan() - c * c / 2.0 * (a * a + v * v).ln()) / (2.0 * PI)
    };
    let sum = corner_sum(x, xx, |x, xx| corner_sum(y, yy, |y, yy| primitive(x - xx, y - yy)));
    sum / ((x[1] - x[0]) * (y[1] - y[0]))
}

/// Form factor between perpendicular rectangles: u by y and U by z, y and z from the line where their planes meet.
fn perpendicular([u, y]: [[f64; 2]; 2], [uu, z]: [[f64; 2]; 2]) -> f64 {
    let primitive = |u: f64, w: f64| {
        ((u * u - w * w) / 2.0 * (u * u + w * w).ln() + 2.0 * u * w * (u / w).atan()) / (4.0 * PI)
    };
    // the sign of the mixed derivative in y and z
    let sum = corner_sum(u, uu, |u, uu| corner_sum(y, z, |y, z| primitive(u - uu, y.hypot(z))));
    sum / ((u[1] - u[0]) * (y[1] - y[0]))
}

const X: [f64; 2] = [213.0 / 555.0, 343.0 / 555.0];
const Z: [f64; 2] = [227.0 / 555.0, 332.0 / 555.0];
const MIDDLE: [f64; 2] = [0.375, 0.625];

/// Form factors of the tiles to the light in the empty box.
fn empty_box() -> [f64; 6] {
    let (from_back, from_right) = ([1.0 - Z[1], 1.0 - Z[0]], [1.0 - X[1], 1.0 - X[0]]);
    [
        parallel(1.0, [MIDDLE, MIDDLE], [X, Z]),
        parallel(1.0, [[0.75, 1.0], [0.75, 1.0]], [X, Z]),
        perpendicular([MIDDLE, MIDDLE], [X, from_back]),
        perpendicular([[0.5, 0.75], [0.5, 0.75]], [Z, from_right]),
        0.0,
        perpendicular([[0.5, 0.75], [0.0, 0.25]], [Z, X]),
    ]
}

#[test]
fn without_blockers_a_mean_is_a_form_factor_between_rectangles() {
    for (tile, wanted) in (0..6).zip(empty_box()) {
        let (value, error) = mean(&corners(tile), &light(), &[], 1e-6);
        close(value, wanted, 1e-9 * wanted);
        close(value, wanted, error);
    }
}

#[test]
fn floor_under_a_block_is_dark_to_its_very_edge() {
    // too low to cast a shadow worth mentioning: what is left is the tile less the footprint
    let (x, z) = ([0.41, 0.6], [0.4, 0.55]);
    let block = Blocker::parallelepiped(
        dvec3(x[0], 0.0, z[0]),
        DVec3::Z * (z[1] - z[0]),
        DVec3::X * (x[1] - x[0]),
        DVec3::Y * 1e-10,
    );
    let covered = (x[1] - x[0]) * (z[1] - z[0]) / 0.0625;
    let wanted = empty_box()[0] - covered * parallel(1.0, [x, z], [X, Z]);
    close(mean(&corners(0), &light(), std::slice::from_ref(&block), 1e-6).0, wanted, 1e-8 * wanted);
    // a wall does not touch it
    let (whole, _) = mean(&corners(5), &light(), &[], 1e-6);
    close(mean(&corners(5), &light(), &[block], 1e-6).0, whole, 1e-14);
}

/// Form factor of x by z at height 1 over the origin, from four rectangles over their corners (Howell, C-1).
fn point_factor(x: [f64; 2], z: [f64; 2]) -> f64 {
    let side = |a: f64, b: f64| a / a.hypot(1.0) * (b / a.hypot(1.0)).atan() / (2.0 * PI);
    let corner = |a: f64, b: f64| side(a, b) + side(b, a);
    corner(x[0], z[0]) - corner(x[0], z[1]) - corner(x[1], z[0]) + corner(x[1], z[1])
}

#[test]
fn a_penumbra_across_the_tile_matches_quadrature_between_its_kinks() {
    // a plate at height 0.4 that hides the light beyond x = border from the receiver at x
    for edge in [0.5, 0.4777, 0.45, 0.43] {
        let border = |x: f64| x + (edge - x) / 0.4;
        let line = |x: f64| {
            let lit = border(x).clamp(X[0], X[1]);
            crate::common::simpson(20, MIDDLE[0], MIDDLE[1], |z| {
                point_factor([X[0] - x, lit - x], [Z[0] - z, Z[1] - z])
            })
        };
        let kink = |light: f64| ((edge - 0.4 * light) / 0.6).clamp(MIDDLE[0], MIDDLE[1]);
        let between = [MIDDLE[0], kink(X[1]), kink(X[0]), MIDDLE[1]];
        let wanted: f64 = between.windows(2).map(|x| crate::common::simpson(20, x[0], x[1], line)).sum();
        let wanted = wanted / 0.0625;
        let plate = [(edge, -9.0), (9.5, -9.0), (9.5, 9.0), (edge, 9.0)].map(|(x, z)| dvec3(x, 0.4, z));
        for tolerance in [1e-4, 1e-5] {
            let (value, error) = mean(&corners(0), &light(), &[Blocker::plate(&plate)], tolerance);
            close(value, wanted, error);
            let most = tolerance * wanted + 1.01e-6 * empty_box()[0];
            assert!(error <= most, "{edge} {tolerance:e} {error:e}");
        }
    }
}

/// Visible fractions of the tiles with blocks, from a first mesh twice as fine; uniform meshes agree.
const KNOWN: [f64; 6] =
    [6.475_066_4e-3, 2.043_473e-8, 1.363_622_599e-2, 7.519_884_545e-3, 0.0, 1.041_138_200e-2];

#[test]
fn the_cornell_box_with_blocks() {
    for (tile, known) in (0..6).zip(KNOWN) {
        let (value, error) = direct(tile, 1e-5);
        close(value, known, error);
        assert!(error <= 1e-5 * known + 1.01e-6 * empty_box()[tile]);
    }
    // what the blocks cannot hide
    let empty = empty_box();
    for i in [4, 5] {
        close(KNOWN[i], empty[i], 1e-9);
    }
    for i in 0..4 {
        assert!(KNOWN[i] <= empty[i] + 1e-9);
    }
}

/// The point i of a lattice of irrational steps (Kronecker), in the unit cube of four dimensions.
fn lattice(i: u32) -> [f64; 4] {
    let root = 1.167_303_978_261_418_7_f64; // x^5 = x + 1
    [1, 2, 3, 4].map(|k| (0.5 + f64::from(i) / root.powi(k)).fract())
}

#[test]
fn the_cornell_box_matches_rays() {
    let at = |x: f64, z: f64| dvec3(x, 0.0, z) / 555.0;
    let block = |c: DVec3, u: DVec3, v: DVec3, height: f64| sides([c, u, v, DVec3::Y * (height / 555.0)]);
    let bodies = [
        block(at(130.0, 65.0), at(-48.0, 160.0), at(160.0, 49.0), 165.0),
        block(at(423.0, 247.0), at(-158.0, 49.0), at(49.0, 159.0), 330.0),
    ];
    let points = 400_000;
    for (tile, known) in (0..6).zip(KNOWN) {
        let (corners, light) = (corners(tile), light());
        let (c, u, v) = (corners[0], corners[1], corners[3]);
        let (u, v) = (u - c, v - c);
        let n = u.cross(v).normalize();
        let sum: f64 = (0..points)
            .map(|i| {
                let [r, s, t, w] = lattice(i);
                let (p, q) =
                    (c + u * r + v * s, light[0] + (light[1] - light[0]) * t + (light[3] - light[0]) * w);
                let hidden = bodies.iter().any(|body| crosses(body, p, q));
                if hidden { 0.0 } else { kernel(p, n, q, -DVec3::Y) }
            })
            .sum();
        let area = (X[1] - X[0]) * (Z[1] - Z[0]);
        close(area * sum / f64::from(points), known, 2e-5);
    }
    assert_eq!(blocks().len(), bodies.len());
}
