//! Integration by other means: Gauss quadrature, Lambert's polygon formula, random walks.

use super::super::{Rect, Room, WALLS};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Gauss-Legendre nodes and weights on 0..1, by Newton's method on the Legendre polynomial.
fn legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut p, mut before) = (1.0, 0.0);
            for k in 0..n {
                let k = k as f64;
                (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
            }
            slope = n as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// Points on a rectangle and their weights, which sum to its area.
pub fn gauss(rect: &Rect, n: usize) -> Vec<(DVec3, f64)> {
    let rule = legendre(n);
    let [[a, b], [c, d]] = rect.range;
    let wall = WALLS[rect.wall];
    let mut points = Vec::new();
    for (x, w) in &rule {
        for (y, v) in &rule {
            points.push((wall.point(a + (b - a) * x, c + (d - c) * y), w * v * rect.area()));
        }
    }
    points
}

fn inward(wall: usize) -> DVec3 {
    let wall = WALLS[wall];
    let mut normal = DVec3::ZERO;
    normal[wall.normal] = 1.0 - 2.0 * wall.position;
    normal
}

/// cos cos' / (pi d^2) between points on two walls [m^-2].
fn transfer((p, a): (DVec3, usize), (q, b): (DVec3, usize)) -> f64 {
    let d = q - p;
    let squared = d.length_squared();
    d.dot(inward(a)) * -d.dot(inward(b)) / (PI * squared * squared)
}

/// The double area integral of [`transfer`] with n^4 points [m^2].
pub fn quadrature(a: &Rect, b: &Rect, n: usize) -> f64 {
    let sources = gauss(b, n);
    let inner =
        |p| sources.iter().map(|&(q, weight)| weight * transfer((p, a.wall), (q, b.wall))).sum::<f64>();
    gauss(a, n).into_iter().map(|(p, weight)| weight * inner(p)).sum()
}

/// Irradiance over pi at `p` of a polygon of radiance 1 (Lambert 1760): half the mean of the edges' angles, each times the
/// cosine between its plane and the receiver.
pub fn lambert(p: DVec3, wall: usize, light: &Rect) -> f64 {
    if wall == light.wall {
        return 0.0;
    }
    let [[a, b], [c, d]] = light.range;
    let corners = [(a, c), (b, c), (b, d), (a, d)].map(|(s, t)| WALLS[light.wall].point(s, t) - p);
    let edge = |i: usize| {
        let (v, w) = (corners[i], corners[(i + 1) % 4]);
        v.cross(w).normalize().dot(inward(wall)) * v.angle_between(w)
    };
    (0..4).map(edge).sum::<f64>().abs() / TAU
}

/// Mean radiance of `tile` scattered exactly twice.
pub fn from_direct(room: &Room, tile: &Rect, channel: usize) -> f64 {
    let albedo = |wall: usize| room.walls[wall].albedo[channel];
    let receivers = gauss(tile, 8);
    let mut sum = 0.0;
    for wall in (0..6).filter(|&wall| wall != tile.wall && wall != room.panel.wall) {
        for (q, weight) in gauss(&Rect { wall, range: [[0.0, 1.0]; 2] }, 24) {
            let radiance = albedo(wall) * lambert(q, wall, &room.panel);
            let arriving = receivers.iter().map(|&(p, w)| w * transfer((p, tile.wall), (q, wall)));
            sum += weight * radiance * arriving.sum::<f64>();
        }
    }
    albedo(tile.wall) * sum / tile.area()
}

/// A 64-bit counter scrambled (Steele, Lea & Flood 2014), as a number in 0..1.
struct SplitMix(u64);

impl SplitMix {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (0.5f64).powi(53)
    }
}

/// The wall that a ray from `p` inside the cube meets first, other than `from`, and where.
fn next_wall(p: DVec3, direction: DVec3, from: usize) -> (usize, DVec3) {
    let distance = |wall: usize| {
        let axis = WALLS[wall].normal;
        (WALLS[wall].position - p[axis]) / direction[axis]
    };
    let ahead = (0..6).filter(|&wall| wall != from && direction.dot(inward(wall)) < 0.0);
    let wall = ahead.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).expect("the cube is closed");
    (wall, p + distance(wall) * direction)
}

/// Mean radiance of `tile` by cosine-weighted walks that end on black, with standard errors.
pub fn random_walk(room: &Room, tile: &Rect, walks: usize) -> ([f64; 3], [f64; 3]) {
    let mut random = SplitMix(tile.wall as u64);
    let [[a, b], [c, d]] = tile.range;
    let (mut sums, mut squares) = (DVec3::ZERO, DVec3::ZERO);
    for _ in 0..walks {
        let mut p = WALLS[tile.wall].point(a + (b - a) * random.uniform(), c + (d - c) * random.uniform());
        let (mut wall, mut throughput, mut radiance) = (tile.wall, DVec3::ONE, DVec3::ZERO);
        for _ in 0..60 {
            let [[a, b], [c, d]] = room.panel.range;
            let [s, t] = WALLS[wall].axes().map(|axis| p[axis]);
            let on_panel = wall == room.panel.wall && (a..b).contains(&s) && (c..d).contains(&t);
            let surface = if on_panel { room.panel_surface } else { room.walls[wall] };
            radiance += throughput * DVec3::from(surface.emission);
            throughput *= DVec3::from(surface.albedo);
            if throughput == DVec3::ZERO {
                break;
            }
            let (cos, angle) = (2.0 * random.uniform() - 1.0, TAU * random.uniform());
            let sin = (1.0 - cos * cos).sqrt();
            let direction = DVec3::new(sin * angle.cos(), sin * angle.sin(), cos) + inward(wall);
            (wall, p) = next_wall(p, direction, wall);
        }
        sums += radiance;
        squares += radiance * radiance;
    }
    let mean = sums / walks as f64;
    let variance = (squares / walks as f64 - mean * mean) / walks as f64;
    (mean.to_array(), variance.to_array().map(f64::sqrt))
}
