//! Direct light behind blockers against ray tests and against special cases with exact answers.

use crate::common::{close, corners, crosses, sides, visible_factor};
use furnace::truth::direct::form_factor::polygon;
use furnace::truth::direct::visibility::{Blocker, visible_fraction};
use glam::{DVec3, dvec3};

const UP: DVec3 = DVec3::Z;

/// The square of half-width `half` about (x, y) at height z, shining down.
fn square(x: f64, y: f64, z: f64, half: f64) -> [DVec3; 4] {
    [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(i, j)| dvec3(x + i * half, y + j * half, z))
}

fn solid([c, u, v, w]: [DVec3; 4]) -> Blocker {
    Blocker::parallelepiped(c, u, v, w)
}

const TILTED: [DVec3; 4] =
    [dvec3(-0.4, -0.3, 0.4), dvec3(0.5, 0.2, -0.1), dvec3(-0.1, 0.4, 0.2), dvec3(0.0, -0.1, 0.3)];

#[test]
fn a_plate_parallel_to_the_light_hides_its_projection() {
    let light = square(0.0, 0.0, 2.0, 1.0);
    for p in [DVec3::ZERO, dvec3(0.3, -0.8, 0.2), dvec3(2.0, 1.0, 0.5)] {
        // x and y from p double between the plate and the light
        let z = 0.5 * (p.z + 2.0);
        let projected = square(0.2, 0.1, 2.0, 0.6);
        let plate = Blocker::plate(&projected.map(|q| p + 0.5 * (q - p)));
        assert!((plate.faces().next().unwrap()[0].z - z).abs() < 1e-15);
        for n in [UP, dvec3(-0.9, 0.3, 0.4).normalize()] {
            let wanted = polygon(p, n, &light) - polygon(p, n, &projected);
            assert!(wanted > 0.01);
            close(visible_fraction(p, n, &light, std::slice::from_ref(&plate)), wanted, 1e-15);
        }
    }
}

#[test]
fn half_of_a_light_is_half_the_light() {
    let light = square(0.0, 0.0, 2.0, 1.0);
    let whole = polygon(DVec3::ZERO, UP, &light);
    let half = Blocker::plate(&square(5.0, 0.0, 1.0, 5.0));
    close(visible_fraction(DVec3::ZERO, UP, &light, &[half]), whole / 2.0, 1e-16);
    let block = solid([dvec3(0.0, -7.0, 0.5), DVec3::X * 9.0, DVec3::Y * 7.0, DVec3::Z]);
    close(visible_fraction(DVec3::ZERO, UP, &light, &[block]), 0.75 * whole, 1e-15);
}

/// Greatest difference over receivers all around, some of which see the light cut by the horizon.
fn worst(light: [DVec3; 3], blockers: &[Blocker], bodies: &[&[(DVec3, DVec3)]], steps: u32) -> f64 {
    let hidden = |p, q| bodies.iter().any(|body| crosses(body, p, q));
    let mut partial = 0;
    let mut worst = 0.0_f64;
    for p in [dvec3(0.0, 0.0, 0.0), dvec3(0.6, -0.5, 0.1), dvec3(-0.9, 0.4, 0.3), dvec3(0.2, 1.1, -0.4)] {
        for n in [UP, dvec3(0.7, -0.9, 0.3).normalize(), dvec3(-0.8, 0.1, 0.1).normalize()] {
            let value = visible_fraction(p, n, &corners(light), blockers);
            worst = worst.max((value - visible_factor((p, n), light, steps, hidden)).abs());
            partial += u32::from(value > 0.0 && value < polygon(p, n, &corners(light)) - 1e-3);
        }
    }
    assert!(partial >= 3, "only {partial} receivers in the penumbra");
    worst
}

const LIGHT: [DVec3; 3] = [dvec3(-0.7, -0.8, 1.3), dvec3(0.1, 1.7, 0.2), dvec3(1.5, 0.2, 0.1)];

#[test]
fn boxes_plates_and_wedges_match_rays() {
    let body = sides(TILTED);
    let difference = worst(LIGHT, &[solid(TILTED)], &[&body], 500);
    assert!(difference < 2e-4, "box {difference:e}");

    // a plate as a body of no thickness
    let [c, u, v, _] = TILTED;
    let m = u.cross(v);
    let thin = sides([c, u, v, m * 1e-9]);
    let difference = worst(LIGHT, &[Blocker::plate(&corners([c, u, v]))], &[&thin], 500);
    assert!(difference < 2e-4, "plate {difference:e}");

    let [a, b, d, e] = [c, c + u, c + v, c + dvec3(0.2, 0.0, 0.6)];
    let tetrahedron = Blocker::solid(vec![a, b, d, e], &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]);
    let side = |x: DVec3, y: DVec3, z: DVec3| (x, (y - x).cross(z - x));
    let body = [side(a, d, b), side(a, b, e), side(b, d, e), side(d, a, e)];
    let difference = worst(LIGHT, &[tetrahedron], &[&body], 500);
    assert!(difference < 2e-4, "tetrahedron {difference:e}");
}

#[test]
fn several_blockers_match_rays_in_any_order() {
    let other = [dvec3(-0.2, 0.2, 0.7), DVec3::X * 0.6, DVec3::Y * 0.5, DVec3::Z * 0.2];
    let third = [dvec3(-1.5, -0.5, 0.6), DVec3::X * 0.9, DVec3::Y * 0.1, DVec3::Z * 0.3];
    let bodies = [TILTED, other, third];
    let blockers = bodies.map(solid);
    let sides = bodies.map(sides);
    let difference = worst(LIGHT, &blockers, &[&sides[0], &sides[1], &sides[2]], 500);
    assert!(difference < 2e-4, "{difference:e}");

    let [a, b, c] = blockers;
    let f = |order: &[Blocker]| visible_fraction(DVec3::ZERO, UP, &corners(LIGHT), order);
    let value = f(&[a.clone(), b.clone(), c.clone()]);
    close(f(&[c.clone(), a.clone(), b.clone()]), value, 1e-15);
    close(f(&[a.clone(), b.clone(), c.clone(), b.clone()]), value, 1e-15);
}

#[test]
fn a_block_cut_in_two_hides_the_same() {
    let [c, u, v, w] = TILTED;
    let parts = [solid([c, u * 0.4, v, w]), solid([c + u * 0.4, u * 0.6, v, w])];
    for p in [DVec3::ZERO, dvec3(0.6, -0.5, 0.1), c + u * 2.0, c + u * 0.4 - w] {
        let whole = visible_fraction(p, UP, &corners(LIGHT), &[solid(TILTED)]);
        close(visible_fraction(p, UP, &corners(LIGHT), &parts), whole, 1e-14);
    }
}

#[test]
fn blockers_that_hide_all_or_nothing() {
    let light = square(0.0, 0.0, 2.0, 1.0);
    let f = |block: [DVec3; 4]| visible_fraction(DVec3::ZERO, UP, &light, &[solid(block)]);
    let whole = polygon(DVec3::ZERO, UP, &light);
    let cube = |x: f64, z: f64, s: f64| [dvec3(x, -s / 2.0, z), DVec3::X * s, DVec3::Y * s, DVec3::Z * s];
    assert_eq!(f(cube(-2.5, 0.5, 5.0)), 0.0);
    // exactly the light's silhouette
    close(f([dvec3(-0.5, -0.5, 1.0), DVec3::X, DVec3::Y, DVec3::Z * 0.1]), 0.0, 1e-16);
    // beside, below, behind, above the light
    for block in [cube(4.0, 0.5, 1.0), cube(-0.5, -2.0, 1.0), cube(-0.5, 2.5, 1.0), cube(-5.0, 2.0, 10.0)] {
        assert_eq!(f(block), whole);
    }
    assert_eq!(visible_fraction(DVec3::ZERO, UP, &light, &[]), whole);
    let mut back = light;
    back.reverse();
    assert_eq!(visible_fraction(DVec3::ZERO, UP, &back, &[]), 0.0);
    // across the light's plane: it hides the part beyond its side at x = 0.5, or in front of which it hangs
    let across = [dvec3(0.5, -3.0, 1.5), DVec3::X * 3.0, DVec3::Y * 6.0, DVec3::Z];
    let lit = [(-1.0, -1.0), (-1.0, 1.0), (0.5, 1.0), (0.5, -1.0)].map(|(x, y)| dvec3(x, y, 2.0));
    close(f(across), polygon(DVec3::ZERO, UP, &lit), 1e-15);
}

#[test]
fn receivers_on_a_block() {
    let light = square(0.1, 0.2, 2.0, 1.0);
    let [c, u, v, w] = [dvec3(-0.3, -0.4, 0.1), dvec3(0.7, 0.3, 0.0), dvec3(-0.2, 0.6, 0.0), DVec3::Z * 0.7];
    let block = [solid([c, u, v, w])];
    let f = |p: DVec3, n: DVec3| visible_fraction(p, n, &light, &block);
    let open = |p: DVec3, n: DVec3| polygon(p, n, &light);
    // inside a face, on an edge, at a corner
    for (s, t) in [(0.3, 0.6), (0.37, 0.0), (1.0, 0.21), (1.0, 1.0)] {
        let on = c + u * s + v * t;
        assert_eq!(f(on + w, UP), open(on + w, UP), "on top at {s} {t}");
    }
    // below: all is hidden, but from an edge only what is on its inner side
    close(f(c + u * 0.3 + v * 0.6, UP), 0.0, 1e-15);
    let wall = solid([c - u * 5.0, u * 10.0, v * 10.0, w * 10.0]);
    close(f(c + u * 0.37, UP), visible_fraction(c + u * 0.37, UP, &light, &[wall]), 1e-15);
    for s in [0.0, 0.13, 0.77, 1.0] {
        for height in [0.0, 0.4, 1.0] {
            let p = c + u * s + w * height;
            let outwards = u.cross(w).normalize();
            assert!(open(p, outwards) > 0.01);
            close(f(p, outwards), open(p, outwards), 1e-11);
        }
    }
    assert_eq!(f(c + (u + v + w) * 0.5, UP), 0.0);
}

#[test]
fn an_edge_that_points_at_the_receiver_does_no_harm() {
    let light = square(0.1, 0.2, 2.0, 1.0);
    let [c, u, v, w] = [dvec3(-0.1, -0.4, 0.0), dvec3(0.7, 0.3, 0.0), dvec3(-0.3, 0.6, 0.0), DVec3::Z * 0.7];
    let block = [solid([c, u, v, w])];
    let f = |p: DVec3| visible_fraction(p, UP, &light, &block);
    for p in [c - u * 0.7, c + v * 1.3, c + u + v * 1.9, c + u * -0.37 + v] {
        assert!(f(p) < polygon(p, UP, &light) - 1e-3 || p.x > 0.0);
        for step in [1e-7, 1e-10, 1e-12, 1e-13, 1e-15] {
            for way in [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z] {
                close(f(p + way * step), f(p), step + 1e-11);
            }
        }
    }
}

#[test]
#[should_panic(expected = "adjoins two faces")]
fn a_body_with_a_hole_is_refused() {
    let c = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    Blocker::solid(c.to_vec(), &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3]]);
}
