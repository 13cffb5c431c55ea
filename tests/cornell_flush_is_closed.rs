//! Promise: the Cornell box with a flush light is what its closed forms take it for: a unit cube open at z = 0 and
//! nowhere else, a light in the plane of the ceiling that nothing overlaps, blocks without gaps, and sensors that look
//! at their tiles.
//!
//! Nothing here is statistical: what is asserted holds for every ray, and the random rays only choose examples.

use furnace::sampling::{Address, Stream, warp};
use furnace::scene::cornell_flush::{BLOCKS, Block, GREEN, LIGHT, RED, TILES, WHITE, cornell_flush};
use furnace::scene::geometry::{NOWHERE, Rectangle};
use furnace::scene::{Bsdf, Hit, Ray, Rgb, Scene, Sensor, Shape};
use glam::DVec3;

fn stream(name: &str) -> Stream {
    Address::of(&["cornell_flush_is_closed", name]).stream(0, 0)
}

fn point(stream: &mut Stream) -> DVec3 {
    DVec3::new(stream.u1(), stream.u1(), stream.u1())
}

fn albedo(hit: &Hit<'_>) -> Rgb {
    let Bsdf::Lambert { albedo } = hit.material.bsdf else { panic!("{hit:?} is not Lambert") };
    albedo
}

/// The point at (s, t) of a block's footprint, at its top.
fn on_top(block: &Block, s: f64, t: f64) -> DVec3 {
    let xz = [0, 1].map(|i| block.corner[i] + s * block.u[i] + t * block.v[i]);
    DVec3::new(xz[0], block.height, xz[1]) / 555.0
}

/// Coordinates (s, t) of a point in a block's footprint.
fn footprint(block: &Block, p: DVec3) -> (f64, f64) {
    let (x, z) = (p.x * 555.0 - block.corner[0], p.z * 555.0 - block.corner[1]);
    let (u, v) = (block.u, block.v);
    let det = u[0] * v[1] - u[1] * v[0];
    ((x * v[1] - z * v[0]) / det, (u[0] * z - u[1] * x) / det)
}

/// Whether a point is in a block, by more than `margin` of its edges.
fn is_inside(p: DVec3, margin: f64) -> bool {
    BLOCKS.iter().any(|block| {
        let (s, t) = footprint(block, p);
        let within = |x: f64| (margin..1.0 - margin).contains(&x);
        within(s) && within(t) && p.y * 555.0 < block.height * (1.0 - margin)
    })
}

fn scenes() -> [(bool, Scene); 2] {
    [false, true].map(|blocks| (blocks, cornell_flush(0, blocks)))
}

/// From inside, a ray meets a front, or leaves through the open side.
#[test]
fn nothing_leaks_but_through_the_front() {
    for (blocks, scene) in scenes() {
        let mut stream = stream("leak");
        let (mut met, mut left) = (0, 0);
        for _ in 0..200_000 {
            let (o, d) = (point(&mut stream), warp::sphere_band(-1.0, 1.0, stream.u2()));
            if blocks && is_inside(o, -1e-9) {
                continue;
            }
            let ray = Ray { o, d, from: NOWHERE };
            let front = o - d * (o.z / d.z);
            let open = d.z < 0.0 && [front.x, front.y].iter().all(|x| (0.0..1.0).contains(x));
            match scene.intersect(&ray, 0.0) {
                Some(hit) => {
                    met += 1;
                    assert!(!open || hit.p.z > 0.0, "{ray:?}");
                    let near = (DVec3::splat(0.5) - hit.p).abs().max_element();
                    assert!(near < 0.5 + 1e-12, "{hit:?} is outside");
                    let colour = match hit.p {
                        p if p.x < 1e-12 => GREEN,
                        p if p.x > 1.0 - 1e-12 => RED,
                        _ if hit.surface == 0 => Rgb::ZERO,
                        _ => WHITE,
                    };
                    assert_eq!(albedo(&hit), colour, "{hit:?}");
                    assert_eq!(hit.le, if hit.surface == 0 { Rgb::ONE } else { Rgb::ZERO });
                    // whatever reflects is seen from the side from which light can come
                    assert!(hit.frame.n.dot(d) < 0.0);
                }
                None => {
                    left += 1;
                    assert!(open, "{ray:?} leaks");
                }
            }
        }
        assert!(met > 50_000 && left > 5_000, "{met} {left} are too few to tell");
    }
}

/// In the plane y = 1 lie the light and its strips: inside the unit square, side by side, of area 1 together.
#[test]
fn ceiling_and_light_cover_the_square_once() {
    for (_, scene) in scenes() {
        let flat = |s: &furnace::scene::Surface| match s.shape {
            Shape::Rectangle(r) if r.center.y == 1.0 && r.normal().y.abs() > 0.5 => Some(r),
            _ => None,
        };
        let strips: Vec<Rectangle> = scene.surfaces().iter().filter_map(flat).collect();
        assert_eq!(strips.len(), 5);
        assert!(strips.iter().all(|r| r.normal().abs_diff_eq(-DVec3::Y, 1e-15)), "they face down");
        let area: f64 = strips.iter().map(|r| Shape::Rectangle(*r).area()).sum();
        assert!((area - 1.0).abs() < 1e-14, "{area}");
        let bounds = |r: &Rectangle| Shape::Rectangle(*r).bounds();
        for (i, r) in strips.iter().enumerate() {
            let (low, high) = bounds(r);
            assert!(low.min_element() >= -1e-15 && high.max_element() <= 1.0 + 1e-15, "{r:?}");
            for other in &strips[..i] {
                let (a, b) = bounds(other);
                let overlap = high.min(b) - low.max(a);
                assert!(overlap.x.min(overlap.z) < 1e-15, "{r:?} and {other:?} overlap");
            }
        }
        // straight up, across the light's edges
        for (x, z) in (0..1000).flat_map(|i| [0.3, 0.5, 0.9].map(|z| ((f64::from(i) + 0.5) / 1000.0, z))) {
            let up = Ray { o: DVec3::new(x, 0.9, z), d: DVec3::Y, from: NOWHERE };
            let lit = LIGHT[0].contains(&x) && LIGHT[1].contains(&z);
            let hit = scene.intersect(&up, 0.0).expect("the ceiling");
            assert_eq!((hit.surface == 0, hit.le == Rgb::ONE), (lit, lit), "{x} {z}");
        }
        assert_eq!(scene.light_count(), 1);
        let Shape::Rectangle(light) = scene.surfaces()[0].shape else { panic!("the light is a rectangle") };
        let area = (130.0 * 105.0) / (555.0 * 555.0);
        assert!((Shape::Rectangle(light).area() - area).abs() < 1e-15);
        // from above it is black
        let down = Ray { o: DVec3::new(0.5, 1.5, 0.5), d: -DVec3::Y, from: NOWHERE };
        assert!(scene.intersect(&down, 0.0).is_none());
    }
}

/// From above, the top is met everywhere in the footprint, beside its seam and up to its edges. On the seam between its
/// two triangles rounding decides: nearer to it than 1e-13 of an edge a ray may pass, which no simulation will see.
#[test]
fn block_tops_are_whole() {
    let (scene, mut stream) = (cornell_flush(0, true), stream("tops"));
    for block in &BLOCKS {
        for i in 0..60_000 {
            let tiny = [1e-6, 1e-9, 1e-12][i % 3] * (stream.u1() - 0.5);
            let (s, t) = match i % 4 {
                0 => (stream.u1(), stream.u1()),
                // along the seam between the two triangles
                1 => {
                    let s = stream.u1();
                    (s, s + tiny + 1e-13f64.copysign(tiny))
                }
                // along the edges
                2 => (stream.u1(), tiny.abs().max(1e-12)),
                _ => (1.0 - tiny.abs().max(1e-12), stream.u1()),
            };
            let target = on_top(block, s.clamp(1e-12, 1.0 - 1e-12), t.clamp(1e-12, 1.0 - 1e-12));
            for o in [target.with_y(0.95), DVec3::new(0.5, 0.95, 0.3)] {
                let ray = Ray { o, d: (target - o).normalize(), from: NOWHERE };
                let hit = scene.intersect(&ray, 0.0).unwrap_or_else(|| panic!("{s} {t}: {ray:?} leaks"));
                let other = hit.p.y * 555.0 > block.height + 1e-9;
                assert!(other || (hit.p - target).length() < 1e-11, "{s} {t}: {hit:?}");
                assert!(other || hit.frame.n.y > 1.0 - 1e-15, "{s} {t}: {hit:?}");
            }
        }
    }
}

/// A ray that aims into a block from outside meets its surface from the front, also at edges and corners.
#[test]
fn blocks_have_no_gaps_and_face_outwards() {
    let (scene, mut stream) = (cornell_flush(0, true), stream("gaps"));
    let mut met = vec![0; scene.surfaces().len()];
    for (i, block) in BLOCKS.iter().cycle().take(200_000).enumerate() {
        // a target in the block, often next to one of its edges
        let near = |x: f64| match i / 2 % 3 {
            0 => x,
            1 => 1e-9 + x * 1e-7,
            _ => 1.0 - 1e-9 - x * 1e-7,
        };
        let (s, t, y) = (near(stream.u1()), near(stream.u1()), near(stream.u1()));
        let top = on_top(block, s, t);
        let target = top.with_y(top.y * y);
        let o = point(&mut stream);
        if is_inside(o, -1e-6) {
            continue;
        }
        let ray = Ray { o, d: (target - o).normalize(), from: NOWHERE };
        let hit = scene.intersect(&ray, 0.0).unwrap_or_else(|| panic!("{ray:?} meets a back"));
        assert!((hit.p - o).length() <= (target - o).length() + 1e-12, "{ray:?} {target} passes {hit:?}");
        assert!(hit.frame.n.dot(ray.d) < 0.0 && !is_inside(hit.p, 1e-9));
        met[hit.surface as usize] += 1;
    }
    assert_eq!(met.len(), 9 + 12);
    assert!(met[9..].iter().all(|&n| n > 100), "{met:?} are too few to tell");
    // outwards: a small step along the normal leads out of the block
    for surface in &scene.surfaces()[9..] {
        let (p, frame) = surface.sample_area((0.4, 0.5));
        let [out, into] = [1e-4, -1e-4].map(|step| is_inside(p + step * frame.n, 0.0));
        assert!(!out && into, "{surface:?}");
    }
}

/// The first thing a sensor's ray meets is the wall of its tile, within the tile, also where blocks stand about.
#[test]
fn sensors_look_at_their_tiles() {
    for (tile, blocks) in (0..TILES.len()).flat_map(|tile| [false, true].map(|blocks| (tile, blocks))) {
        let (scene, mut stream) = (cornell_flush(tile, blocks), stream("tiles"));
        let (axis, value, a, b) = &TILES[tile];
        let Sensor::Parallel { half_u, half_v, .. } = scene.sensor else { panic!("{:?}", scene.sensor) };
        let area = 4.0 * half_u.length() * half_v.length();
        assert!((area - (a.end - a.start) * (b.end - b.start)).abs() < 1e-15, "{tile}");
        let others: Vec<usize> = (0..3).filter(|i| i != axis).collect();
        let (mut low, mut high) = (DVec3::ONE, DVec3::ZERO);
        for _ in 0..10_000 {
            let start = scene.start((0, 0), &mut stream);
            assert_eq!((start.response, start.time), (1.0, 0.0));
            assert!(start.ray.d.abs() == DVec3::AXES[*axis], "{:?} is not straight", start.ray);
            let hit = scene.intersect(&start.ray, 0.0).expect("the tile");
            assert!((hit.p[*axis] - value).abs() < 1e-15, "{tile} {blocks}: {hit:?}");
            assert!(hit.surface != 0 && (1..9).contains(&hit.surface), "{tile} {blocks}: {hit:?}");
            assert!((hit.frame.n + start.ray.d).length() < 1e-15);
            (low, high) = (low.min(hit.p), high.max(hit.p));
        }
        for (i, range) in others.into_iter().zip([a, b]) {
            let slack = 1e-3;
            assert!(low[i] >= range.start - 1e-15 && low[i] < range.start + slack, "{tile}: {low}");
            assert!(high[i] <= range.end + 1e-15 && high[i] > range.end - slack, "{tile}: {high}");
        }
    }
}
