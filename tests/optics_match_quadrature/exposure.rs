//! Pixels and lenses against clipped polygons, quadrature and random points.

use crate::common::{SplitMix, close, integrate, sees, simulate};
use furnace::scene::camera::Lens;
use furnace::truth::optics::exposure::{
    Edge, Parts, Side, blur, disc_through_lens, edge_through_lens, edge_through_lens_and_pixel,
    joint_variance, ramp_random_variance, ramp_stratified_variance, tent_coverage, two_boxes,
};
use std::f64::consts::PI;

const ANGLES: [f64; 7] = [0.0, 1e-12, 1e-3, 0.4, PI / 4.0, 2.0, -2.8];

/// Area of the part of the unit square around the origin with x cos φ + y sin φ <= d, by clipping.
fn clipped(edge: &Edge) -> f64 {
    let square = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let inside = |p: (f64, f64)| edge.distance - p.0 * edge.cos - p.1 * edge.sin;
    let mut polygon: Vec<(f64, f64)> = Vec::new();
    for i in 0..4 {
        let (a, b) = (square[i], square[(i + 1) % 4]);
        let (u, v) = (inside(a), inside(b));
        if u >= 0.0 {
            polygon.push(a);
        }
        if (u > 0.0) != (v > 0.0) && u != v {
            let t = u / (u - v);
            polygon.push((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)));
        }
    }
    let turn = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        a.0 * b.1 - a.1 * b.0
    };
    0.5 * (0..polygon.len()).map(turn).sum::<f64>()
}

#[test]
fn coverage_is_the_clipped_area() {
    for angle in ANGLES {
        for i in -80..=80 {
            let edge = Edge::new(angle, f64::from(i) / 100.0 + 1e-4);
            let area = clipped(&edge);
            assert!((edge.coverage() - area).abs() < 1e-14, "{edge:?} {} {area}", edge.coverage());
        }
    }
    assert_eq!((two_boxes(0.1, 0.0, 0.0), two_boxes(-0.1, 0.0, 0.0)), (1.0, 0.0));
    assert_eq!((two_boxes(0.25, 1.0, 0.0), two_boxes(0.25, 0.0, 1.0)), (0.75, 0.75));
}

fn white(edge: &Edge, x: f64, y: f64) -> f64 {
    if x * edge.cos + y * edge.sin <= edge.distance { 1.0 } else { 0.0 }
}

/// The mean of one uniform sample of `f` in each of `n` x `n` cells.
fn stratified(random: &mut SplitMix, n: u32, f: impl Fn(f64, f64) -> f64) -> f64 {
    let cells = f64::from(n);
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let (u, v) = (random.uniform(), random.uniform());
            sum += f((f64::from(i) + u) / cells - 0.5, (f64::from(j) + v) / cells - 0.5);
        }
    }
    sum / (cells * cells)
}

/// Second moments about the known mean, so that their errors are simple.
#[track_caller]
fn varies(seed: u64, count: usize, expected: f64, mean: f64, mut sample: impl FnMut(&mut SplitMix) -> f64) {
    let sampled = simulate(seed, count, |r| sample(r) - mean);
    sees(sampled.square, sampled.square_error, expected);
}

#[test]
fn edges_vary_as_sampled() {
    for angle in [0.0, 0.4, 2.0] {
        let edge = Edge::new(angle, 0.13);
        let p = clipped(&edge);
        for n in [1, 2, 3] {
            varies(7, 500_000, edge.stratified_variance(n), p, |r| {
                stratified(r, n, |x, y| white(&edge, x, y))
            });
        }
        let four = |r: &mut SplitMix| {
            (0..4).map(|_| white(&edge, r.uniform() - 0.5, r.uniform() - 0.5)).sum::<f64>() / 4.0
        };
        varies(8, 500_000, edge.random_variance(4), p, four);
    }
    // along a side only one column of cells is cut
    for n in [1, 2, 5, 8] {
        let (p, cells) = (0.63, f64::from(n));
        let part = (cells * p).fract();
        close(
            Edge { cos: 1.0, sin: 0.0, distance: p - 0.5 }.stratified_variance(n),
            part * (1.0 - part) / cells.powi(3),
            1e-13,
        );
    }
}

#[test]
fn ramps_vary_as_sampled() {
    let gradient = [0.7, -0.4];
    let ramp = |x: f64, y: f64| gradient[0] * x + gradient[1] * y;
    for n in [1, 3] {
        varies(9, 400_000, ramp_stratified_variance(gradient, n), 0.0, |r| stratified(r, n, ramp));
    }
    let nine =
        |r: &mut SplitMix| (0..9).map(|_| ramp(r.uniform() - 0.5, r.uniform() - 0.5)).sum::<f64>() / 9.0;
    varies(10, 400_000, ramp_random_variance(gradient, 9), 0.0, nine);
}

#[test]
fn tent_coverage_is_the_integral_of_the_tent() {
    for i in -12..=12 {
        let d = f64::from(i) / 10.0;
        let tent = |x: f64| (1.0 - x.abs()).max(0.0);
        let end = d.clamp(-1.0, 1.0);
        let integral =
            integrate(-1.0, end.min(0.0), 1e-13, &tent) + integrate(0.0, end.max(0.0), 1e-13, &tent);
        assert!((tent_coverage(d) - integral).abs() < 1e-12);
    }
    close(tent_coverage(0.3), 1.0 - 0.7 * 0.7 / 2.0, 1e-15);
}

/// White part of the blur disc by chords: at x = c sin u the chord's half length is c cos u.
fn edge_by_chords(edge: f64, blur: f64) -> f64 {
    let end = (edge / blur).clamp(-1.0, 1.0).asin();
    integrate(-0.5 * PI, end, 1e-13, &|u| 2.0 * u.cos() * u.cos() / PI)
}

#[test]
fn lens_blurs_edges() {
    let lens = Lens { radius: 0.05, focus: 4.0 };
    // by similar triangles: a ray from the rim through the point in focus
    for distance in [1.0f64, 4.0, 10.0] {
        let at = 0.05 + (0.0 - 0.05) / 4.0 * distance;
        assert!((blur(&lens, distance) - at.abs()).abs() < 1e-15);
    }
    for i in -15..=15 {
        let edge = f64::from(i) / 10.0 + 1e-3;
        assert!((edge_through_lens(edge, 0.8) - edge_by_chords(edge, 0.8)).abs() < 1e-11);
        for width in [0.1, 1.0, 3.0] {
            let average =
                integrate(edge - 0.5 * width, edge + 0.5 * width, 1e-10, &|x| edge_by_chords(x, 0.8));
            let value = edge_through_lens_and_pixel(edge, 0.8, width);
            assert!((value - average / width).abs() < 1e-8, "{value} {average}");
        }
        let sharp = edge_through_lens_and_pixel(edge, 0.0, 1.0);
        assert!((sharp - (edge + 0.5).clamp(0.0, 1.0)).abs() < 1e-15);
    }
    assert_eq!((edge_through_lens(0.1, 0.0), edge_through_lens(-0.1, 0.0)), (1.0, 0.0));
}

#[test]
fn lens_blurs_discs() {
    for (radius, blur) in [(0.3, 1.0), (1.0, 0.3), (0.7, 0.7), (2.0, 1.9)] {
        for i in 0..40 {
            let offset = f64::from(i) / 10.0 + 0.017;
            // overlap of the two chords at height y
            let width = |y: f64| {
                let (a, b) =
                    ((radius * radius - y * y).max(0.0).sqrt(), (blur * blur - y * y).max(0.0).sqrt());
                ((b.min(offset + a)) - (offset - a).max(-b)).max(0.0)
            };
            let end = f64::min(radius, blur);
            let area = integrate(-PI / 2.0, PI / 2.0, 1e-9, &|u| width(end * u.sin()) * end * u.cos());
            let expected = area / (PI * blur * blur);
            let value = disc_through_lens(radius, offset, blur);
            assert!((value - expected).abs() < 1e-6, "{radius} {blur} {offset}: {value} {expected}");
        }
    }
    close(disc_through_lens(1.0, 1.0, 1.0), (2.0 * PI / 3.0 - 3f64.sqrt() / 2.0) / PI, 1e-14);
    assert_eq!((disc_through_lens(1.0, 0.5, 0.0), disc_through_lens(1.0, 1.5, 0.0)), (1.0, 0.0));
}

#[test]
fn lens_and_pixel_agree_with_samples() {
    let (lens, object, edge, width) = (Lens { radius: 0.2, focus: 4.0 }, 9.0, 0.07, 0.3);
    let sampled = simulate(11, 1_000_000, |r| {
        let (s, angle) = (0.2 * r.uniform().sqrt(), 2.0 * PI * r.uniform());
        // from the lens through the point in focus of the pixel's chief ray
        let (on_lens, chief) = (s * angle.cos(), width * (r.uniform() - 0.5));
        let in_focus = chief / object * lens.focus;
        let x = on_lens + (in_focus - on_lens) / lens.focus * object;
        if x <= edge { 1.0 } else { 0.0 }
    });
    sees(sampled.mean, sampled.error, edge_through_lens_and_pixel(edge, blur(&lens, object), width));
}

/// Paths of a side are exponential variables with its mean, plus noise of zero mean.
#[test]
fn joint_variance_agrees_with_samples() {
    let (inside, outside) = (Side { mean: 2.0, variance: 5.0 }, Side { mean: 0.5, variance: 0.25 });
    let p = 0.3;
    let draw = |r: &mut SplitMix, side: Side| {
        let sign = if r.uniform() < 0.5 { -1.0 } else { 1.0 };
        side.mean * -r.uniform().ln() + sign * (side.variance - side.mean * side.mean).sqrt()
    };
    let mean = p * inside.mean + (1.0 - p) * outside.mean;
    let Parts { within, between } = joint_variance(p, inside, outside);
    let parts = joint_variance(p, inside, outside);
    varies(12, 2_500_000, parts.total(), mean, |r| {
        let side = if r.uniform() < p { inside } else { outside };
        draw(r, side)
    });
    // a pixel that is stratified to the end has p of its samples inside
    let (count, covered) = (10, 3);
    varies(13, 400_000, within / f64::from(count), mean, |r| {
        let total: f64 = (0..count).map(|i| draw(r, if i < covered { inside } else { outside })).sum();
        total / f64::from(count)
    });
    close(between, 0.3 * 0.7 * 1.5 * 1.5, 1e-14);
    let black = joint_variance(p, inside, Side { mean: 0.0, variance: 0.0 });
    close(black.total(), p * (5.0 + 4.0) - p * p * 4.0, 1e-14);
}
