//! Promise: a thin lens is sharp in its plane of focus and lets light through uniformly, without a radius it is the
//! pinhole, and a parallel sensor looks through all of its rectangle alike.
//!
//! Two chi-squares of 2^18 points in 1024 cells each; their false alarm probability is 2e-9 together. The rest holds
//! for every ray.

mod chi_square;

use chi_square::assert_follows;
use furnace::sampling::{Address, Stream};
use furnace::scene::camera::{Camera, Lens};
use furnace::scene::geometry::NOWHERE;
use furnace::scene::{Scene, Sensor};
use glam::DVec3;
use std::f64::consts::TAU;

const SIDE: usize = 32;
const N: u32 = 1 << 18;

fn stream(name: &str) -> Stream {
    Address::of(&["sensors_draw_their_rays", name]).stream(0, 0)
}

/// Looks along a direction that no axis shares at an image that is not square.
fn camera(lens: Option<Lens>) -> Camera {
    let (origin, direction, up) =
        (DVec3::new(0.3, -0.7, 1.1), DVec3::new(0.36, 0.48, -0.8), DVec3::new(0.1, 0.9, 0.2));
    Camera { lens, ..Camera::pinhole(origin, direction, up, 50.0, (12, 8)) }
}

/// Cells of equal probability of two numbers that are uniform in [0, 1].
fn assert_uniform(name: &str, points: impl Iterator<Item = (f64, f64)>) {
    let (mut counts, mut lost) = (vec![0; SIDE * SIDE], 0);
    for (a, b) in points {
        if !((0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b)) {
            lost += 1;
            continue;
        }
        let place = |x: f64| ((x * SIDE as f64) as usize).min(SIDE - 1);
        counts[place(a) * SIDE + place(b)] += 1;
    }
    let probability = vec![1.0 / (SIDE * SIDE) as f64; SIDE * SIDE];
    assert_follows(name, &counts, lost, &probability, 1e-9);
}

/// Where a ray through a pixel meets the plane at distance `focus` along the camera's axis, by similar triangles alone:
/// as fractions of a pixel.
fn on_the_image(camera: &Camera, focus: f64, o: DVec3, d: DVec3) -> (f64, f64) {
    let t = (focus - (o - camera.origin).dot(camera.forward)) / d.dot(camera.forward);
    let p = (o + t * d - camera.origin) / focus;
    let (x, y) =
        (p.dot(camera.right) / camera.right.length_squared(), p.dot(camera.up) / camera.up.length_squared());
    ((0.5 + 0.5 * x) * f64::from(camera.width), (0.5 - 0.5 * y) * f64::from(camera.height))
}

/// Both draw the position in the pixel first, so that with the same numbers they look at the same point.
#[test]
fn rays_through_one_position_meet_in_the_plane_of_focus() {
    let focus = 2.7;
    for radius in [0.4, 1e-9] {
        let (sharp, lens) = (camera(None), camera(Some(Lens { radius, focus })));
        let mut stream = stream("focus");
        for i in 0..20_000 {
            let pixel = (i % 12, i / 12 % 8);
            let mut again = stream.clone();
            let (through, response) = Sensor::Camera(lens).ray(pixel, &mut stream);
            let (axis, same) = Sensor::Camera(sharp).ray(pixel, &mut again);
            assert_eq!((response, same, through.from, axis.from), (1.0, 1.0, NOWHERE, NOWHERE));
            assert!((through.d.length() - 1.0).abs() < 1e-15 && (axis.d.length() - 1.0).abs() < 1e-15);
            let [a, b] = [through, axis].map(|ray| on_the_image(&lens, focus, ray.o, ray.d));
            assert!((a.0 - b.0).abs().max((a.1 - b.1).abs()) < 1e-12, "{a:?} {b:?}");
            let inside = |x: f64, pixel: u32| (0.0..1.0 + 1e-12).contains(&(x - f64::from(pixel) + 1e-12));
            assert!(inside(b.0, pixel.0) && inside(b.1, pixel.1), "{b:?} is not in {pixel:?}");
            // on the lens, which is a disk across the axis
            let offset = through.o - lens.origin;
            assert!(offset.length() <= radius * (1.0 + 1e-9) + 1e-15, "{offset}");
            assert!(offset.dot(lens.forward).abs() < 1e-15);
            // elsewhere it blurs: by the lens's radius times the relative distance from the focus
            let blur = (through.o + through.d * (2.0 * focus / through.d.dot(lens.forward)))
                - (axis.o + axis.d * (2.0 * focus / axis.d.dot(lens.forward)));
            assert!((blur + offset).length() < 1e-13, "{blur} {offset}");
            if radius < 1e-8 {
                assert!((through.o - axis.o).length() <= 2e-9 && (through.d - axis.d).length() < 2e-9);
            }
        }
    }
}

#[test]
fn the_lens_is_used_uniformly() {
    let lens = Lens { radius: 0.4, focus: 2.7 };
    let camera = camera(Some(lens));
    let mut stream = stream("lens");
    let (right, up) = (camera.right.normalize(), camera.up.normalize());
    let points = (0..N).map(|_| {
        let offset = (Sensor::Camera(camera).ray((3, 5), &mut stream).0.o - camera.origin) / lens.radius;
        let (x, y) = (offset.dot(right), offset.dot(up));
        (offset.length_squared().min(1.0), libm::atan2(y, x) / TAU + 0.5)
    });
    assert_uniform("lens", points);
}

#[test]
fn a_parallel_sensor_looks_through_all_of_its_rectangle() {
    let (center, direction) = (DVec3::new(0.3, -0.7, 1.1), DVec3::new(0.36, 0.48, -0.8));
    let (half_u, half_v) = (DVec3::new(0.8, -0.6, 0.0) * 0.3, DVec3::new(0.48, 0.64, 0.6) * 1.7);
    let sensor = Sensor::Parallel { center, direction, half_u, half_v };
    assert_eq!(sensor.resolution(), (1, 1));
    let mut stream = stream("parallel");
    let points = (0..N).map(|_| {
        let (ray, response) = sensor.ray((0, 0), &mut stream);
        assert_eq!((ray.d, response, ray.from), (direction, 1.0, NOWHERE));
        let q = ray.o - center;
        let (a, b) = (q.dot(half_u) / half_u.length_squared(), q.dot(half_v) / half_v.length_squared());
        assert!((q - a * half_u - b * half_v).length() < 1e-15, "{q} is not in the rectangle's plane");
        (0.5 + 0.5 * a, 0.5 + 0.5 * b)
    });
    assert_uniform("parallel", points);
}

/// A scene at rest takes as many numbers as its sensor does.
#[test]
fn a_scene_at_rest_draws_no_time() {
    let sensors = [
        Sensor::Camera(camera(None)),
        Sensor::Camera(camera(Some(Lens { radius: 0.1, focus: 1.0 }))),
        Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z },
    ];
    for sensor in sensors {
        let (mut one, mut other) = (stream("rest"), stream("rest"));
        let start = Scene::new(Vec::new(), sensor).start((1, 2), &mut one);
        let (ray, response) = sensor.ray((1, 2), &mut other);
        assert_eq!((start.ray.o, start.ray.d, start.time, start.response), (ray.o, ray.d, 0.0, response));
        assert_eq!(one, other, "{sensor:?}");
    }
}
