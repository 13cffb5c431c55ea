//! Edges, corners and walls against integrals over what is left of the disc.

use crate::common::{KERNELS, close, integrate, over_disc, weight};
use furnace::truth::density::{Kernel, edge};
use std::f64::consts::PI;

const RADIUS: f64 = 1.6;

#[test]
fn a_straight_edge_cuts_off_a_segment() {
    for kernel in KERNELS {
        for s in [0.0, 1e-9, 0.1, 0.5, 0.83, 0.999] {
            let left = over_disc(s, |x, y| weight(kernel, x.hypot(y)));
            close(edge::straight(kernel, s * RADIUS, RADIUS), left, 1e-11);
        }
        close(edge::straight(kernel, 0.0, RADIUS), 0.5, 1e-15);
        assert_eq!(edge::straight(kernel, RADIUS, RADIUS), 1.0);
        assert_eq!(edge::straight(kernel, 3.0, RADIUS), 1.0);
    }
}

#[test]
fn a_corner_cuts_off_two_segments() {
    for (s, t) in [(0.0, 0.0), (0.0, 0.4), (0.3, 0.2), (0.6, 0.8), (0.7, 0.8), (0.5, 2.0), (3.0, 1.0)] {
        let high = |x: f64| (1.0 - x * x).max(0.0).sqrt();
        let column = |x: f64| high(x).min(t) + high(x);
        // where the second edge meets the circle
        let meets = high(t.min(1.0));
        let ends = [-1.0, (-meets).min(s), meets.min(s), f64::min(s, 1.0)];
        let left: f64 = ends.windows(2).map(|pair| integrate(pair[0], pair[1], column)).sum();
        close(edge::square_corner((s * RADIUS, t * RADIUS), RADIUS), left / PI, 1e-11);
        let swapped = edge::square_corner((t * RADIUS, s * RADIUS), RADIUS);
        close(swapped, left / PI, 1e-11);
    }
    close(edge::square_corner((0.0, 0.0), 1.0), 0.25, 1e-15);
}

#[test]
fn a_wedge_leaves_its_angle() {
    for angle in [0.4, 0.5 * PI, PI] {
        for kernel in KERNELS {
            // the wedge lies along -x, up to the unit circle
            let column = |x: f64| {
                let high = (-x * (0.5 * angle).tan()).min((1.0 - x * x).sqrt());
                2.0 * integrate(0.0, high, |y| weight(kernel, x.hypot(y)))
            };
            let meets = -(0.5 * angle).cos();
            let left = integrate(-1.0, meets, column) + integrate(meets, 0.0, column);
            close(edge::wedge(angle), left, 1e-9);
        }
    }
}

#[test]
fn a_wall_adds_half_a_smaller_disc() {
    for kernel in KERNELS {
        for s in [0.0f64, 0.2, 0.7, 0.99] {
            let size = (1.0 - s * s).sqrt();
            // height z above the floor, y along the edge
            let row = |z: f64| {
                let wide = (size * size - z * z).max(0.0).sqrt();
                2.0 * integrate(0.0, wide, |y| weight(kernel, (s * s + y * y + z * z).sqrt()))
            };
            close(edge::wall(kernel, s * RADIUS, RADIUS), integrate(0.0, size, row), 1e-10);
        }
        assert_eq!(edge::wall(kernel, RADIUS, RADIUS), 0.0);
        close(edge::wall(kernel, 0.0, 1.0) + edge::straight(kernel, 0.0, 1.0), 1.0, 1e-14);
    }
    close(edge::wall(Kernel::Box, 0.6, 1.0), 0.32, 1e-14);
}
