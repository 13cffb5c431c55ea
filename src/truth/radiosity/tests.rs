//! Checks against quadratures and random walks that share no code with the module except the room's description.

mod numerical;

use super::exchange::Exchange;
use super::mesh::Grid;
use super::*;
use numerical::{from_direct, gauss, lambert, quadrature, random_walk};

fn wall(wall: usize) -> Rect {
    Rect { wall, range: [[0.0, 1.0]; 2] }
}

/// A_1 F_12 of two rectangles [m^2].
fn exchange(a: &Rect, b: &Rect) -> f64 {
    let single = |rect: &Rect| Grid { wall: rect.wall, nodes: rect.range.map(Vec::from) };
    Exchange::new(&single(a), &single(b)).products([&[1.0]; 3], [&[1.0]; 3]).0[0][0]
}

/// All ordered pairs of different walls.
fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (0..6).flat_map(|a| (0..6).filter(move |&b| b != a).map(move |b| (a, b)))
}

/// A closed room of one material: radiance is emission / (1 - albedo) everywhere.
fn furnace() -> Room {
    let surface = Surface { albedo: [0.5, 0.2, 0.8], emission: [1.0; 3] };
    let panel = Rect { wall: 1, range: [[0.3, 0.6], [0.4, 0.7]] };
    Room { walls: [surface; 6], panel, panel_surface: surface }
}

#[test]
fn faces_of_the_cube() {
    for (a, b) in pairs() {
        let opposite = WALLS[a].normal == WALLS[b].normal;
        let known = if opposite { 0.1998248957 } else { 0.2000437761 };
        assert!((exchange(&wall(a), &wall(b)) - known).abs() < 6e-11, "{a} {b}");
    }
}

#[test]
fn exchange_agrees_with_quadrature() {
    let ranges = [[[0.1, 0.35], [0.3, 0.9]], [[0.2, 0.7], [0.15, 0.45]]];
    for (a, b) in pairs() {
        let (a, b) = (Rect { wall: a, range: ranges[0] }, Rect { wall: b, range: ranges[1] });
        let (exact, expected) = (exchange(&a, &b), quadrature(&a, &b, 20));
        assert!((exact / expected - 1.0).abs() < 1e-9, "{a:?} {b:?} {exact} {expected}");
        assert!((exact / exchange(&b, &a) - 1.0).abs() < 1e-13, "reciprocity {a:?} {b:?}");
    }
}

/// What leaves an element arrives somewhere: row and column sums of all tables, the front included.
#[test]
fn tables_are_closed() {
    let grids = [0, 1, 2, 3, 4, 5].map(|wall| Grid::new(wall, &tiles(), &furnace().panel, 1));
    let mut sums = grids.each_ref().map(|grid| vec![0.0; grid.len()]);
    for a in 0..6 {
        for b in 0..a {
            let ones = [vec![1.0; grids[a].len()], vec![1.0; grids[b].len()]];
            let table = Exchange::new(&grids[a], &grids[b]);
            let ([to_a, ..], [to_b, ..]) = table.products([&ones[0]; 3], [&ones[1]; 3]);
            sums[a].iter_mut().zip(to_a).for_each(|(sum, part)| *sum += part);
            sums[b].iter_mut().zip(to_b).for_each(|(sum, part)| *sum += part);
        }
    }
    for (grid, sums) in grids.iter().zip(&sums) {
        for (area, sum) in grid.areas().zip(sums) {
            assert!((sum / area - 1.0).abs() < 1e-12, "wall {} element of {area}: {}", grid.wall, sum / area);
        }
    }
}

#[test]
fn furnace_is_uniform() {
    let room = furnace();
    let solution = extrapolate(&room, &[1, 2]).unwrap();
    for tile in 0..6 {
        for channel in 0..3 {
            let albedo = room.panel_surface.albedo[channel];
            let total = solution.total(tile, channel);
            assert!((total.value * (1.0 - albedo) - 1.0).abs() < 1e-12, "{total:?}");
            for k in 0..=BOUNCES {
                let value = solution.bounce(tile, channel, k).value;
                assert!((value / albedo.powi(k as i32) - 1.0).abs() < 1e-11, "bounce {k}: {value}");
                let value = solution.from_bounce(tile, channel, k).value * (1.0 - albedo);
                assert!((value / albedo.powi(k as i32) - 1.0).abs() < 1e-11, "from bounce {k}: {value}");
            }
        }
    }
}

/// The light is 130 x 105 in a room of 555, its centre at (278, 279.5).
#[test]
fn light_is_in_place() {
    let [[a, b], [c, d]] = Room::cornell_flush().panel.range.map(|range| range.map(|x| 555.0 * x));
    for (value, known) in [(b - a, 130.0), (d - c, 105.0), (a + b, 556.0), (c + d, 559.0)] {
        assert!((value - known).abs() < 1e-10, "{value} {known}");
    }
}

/// Without absorption the light of a closed room never ends.
#[test]
fn divergence_is_noticed() {
    let mut room = furnace();
    room.walls.iter_mut().chain([&mut room.panel_surface]).for_each(|surface| surface.albedo = [1.0; 3]);
    assert_eq!(extrapolate(&room, &[1, 1]), None);
}

#[test]
fn direct_light_agrees_with_lambert() {
    let room = Room::cornell_flush();
    let solution = extrapolate(&room, &[1, 2]).unwrap();
    for (tile, rect) in tiles().iter().enumerate() {
        let points = gauss(rect, 12).into_iter();
        let mean: f64 = points.map(|(p, weight)| weight * lambert(p, rect.wall, &room.panel)).sum();
        for channel in 0..3 {
            let expected = room.walls[rect.wall].albedo[channel] * mean / rect.area();
            let direct = solution.bounce(tile, channel, 1).value;
            assert!((direct - expected).abs() < 1e-11, "tile {tile} channel {channel}: {direct} {expected}");
            assert_eq!(solution.bounce(tile, channel, 0).value, 0.0);
        }
    }
}

/// Tiles away from the ceiling's and each other's edges, where plain Gauss quadrature converges.
#[test]
fn second_bounce_agrees_with_quadrature() {
    let room = Room::cornell_flush();
    let solution = extrapolate(&room, &[1, 2, 3]).unwrap();
    for tile in [0, 2, 3] {
        for channel in 0..3 {
            let expected = from_direct(&room, &tiles()[tile], channel);
            let Value { value, error } = solution.bounce(tile, channel, 2);
            assert!(
                (value - expected).abs() < error,
                "tile {tile} channel {channel}: {value} {expected} {error}"
            );
            assert!(error < 1e-3 * value);
        }
    }
}

/// All bounces, 4.5 standard errors: one false alarm in 4000 runs of other seeds.
#[test]
fn totals_agree_with_random_walks() {
    let room = Room::cornell_flush();
    let solution = extrapolate(&room, &[1, 2, 3]).unwrap();
    for (tile, rect) in tiles().iter().enumerate() {
        let (means, standard_errors) = random_walk(&room, rect, 200_000);
        for channel in 0..3 {
            let total = solution.total(tile, channel).value;
            let deviation = (means[channel] - total) / standard_errors[channel];
            assert!(deviation.abs() < 4.5, "tile {tile} channel {channel}: {deviation} standard errors");
        }
    }
}

/// A finer mesh more leaves all values within their bounds, and the bounds are not idle.
#[test]
fn errors_are_bounded() {
    let room = Room::cornell_flush();
    let (coarse, fine) =
        (extrapolate(&room, &[1, 2, 3]).unwrap(), extrapolate(&room, &[1, 2, 3, 4]).unwrap());
    for ((value, error), exact) in coarse.values.iter().zip(&coarse.errors).zip(&fine.values) {
        assert!((value - exact).abs() <= *error, "{value} {exact} {error}");
        assert!(*error <= 0.02 * value, "{value} {error}");
    }
    for tile in 0..6 {
        for channel in 0..3 {
            let [rough, better] = [&coarse, &fine].map(|solution| solution.total(tile, channel));
            assert!(better.error < 0.3 * rough.error, "{rough:?} {better:?}");
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let solve = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| extrapolate(&Room::cornell_flush(), &[1, 2]).unwrap())
    };
    assert_eq!(solve(1), solve(3));
}
