//! Promise: eight rectangles at once find what one rectangle after the other finds: the same surface, at the same
//! distance but for rounding.
//!
//! Nothing here is statistical: the random rays only choose examples.

use furnace::sampling::{Address, Stream, warp};
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle};
use furnace::scene::lanes::RectangleLanes;
use furnace::scene::library::SceneKind;
use furnace::scene::{Bsdf, Carried, Directions, Material, Ray, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;

const GREY: Material = Material { bsdf: Bsdf::Lambert { albedo: Rgb::splat(0.5) }, le: Rgb::ZERO };

fn stream(name: &str) -> Stream {
    Address::of(&["lanes_agree", name]).stream(0, 0)
}

fn direction(stream: &mut Stream) -> DVec3 {
    warp::sphere_band(-1.0, 1.0, stream.u2())
}

/// A point of the cube [-1, 1]³.
fn point(stream: &mut Stream) -> DVec3 {
    2.0 * DVec3::new(stream.u1(), stream.u1(), stream.u1()) - 1.0
}

/// `count` rectangles of any size and place, with a disk before every third, so that lanes and surfaces count apart.
fn rectangles(count: usize, stream: &mut Stream) -> Scene {
    let mut surfaces = Vec::new();
    for i in 0..count {
        if i % 3 == 0 {
            let disk = Disk { center: point(stream), normal: direction(stream), radius: 0.2 };
            surfaces.push(Surface::new(Shape::Disk(disk), GREY));
        }
        let half_u = direction(stream) * (0.05 + stream.u1());
        let half_v = half_u.cross(direction(stream)).normalize() * (0.05 + stream.u1());
        let rectangle = Rectangle { center: point(stream), half_u, half_v };
        surfaces.push(Surface::new(Shape::Rectangle(rectangle), GREY));
    }
    let sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };
    Scene::new(surfaces, sensor)
}

fn is_rectangle(s: &Surface) -> bool {
    matches!(s.shape, Shape::Rectangle(_))
}

/// Distance and number of the nearest of the surfaces that `which` selects, one after the other.
fn nearest(surfaces: &[Surface], ray: &Ray, which: fn(&Surface) -> bool) -> (f64, u32) {
    let selected = (0u32..).zip(surfaces).filter(|(_, s)| which(s));
    let distance = |id, s: &Surface| if id == ray.from { f64::INFINITY } else { s.shape.intersect_flat(ray) };
    let distances = selected.map(|(id, s)| (distance(id, s), id));
    distances.fold((f64::INFINITY, NOWHERE), |a, b| if b.0 < a.0 { b } else { a })
}

/// Holds the lanes to the scalar code for one ray; whether a rectangle was met.
fn assert_agree(scene: &Scene, lanes: &RectangleLanes, ray: &Ray) -> bool {
    let surfaces = scene.surfaces();
    let ((t, id), (exact, same)) = (lanes.nearest(ray), nearest(surfaces, ray, is_rectangle));
    assert_eq!(t.is_finite(), exact.is_finite(), "{ray:?}: {t} {exact}");
    if t.is_finite() {
        assert_eq!(id, same, "{ray:?}: {t} {exact}");
        // t = n · (c - o) / n · d: the numerator errs by some epsilons of |c| + |o|, the denominator of 1
        let cos = surfaces[id as usize].shape.direction().dot(ray.d).abs();
        let size = t + ray.o.length() + 3.0;
        assert!((t - exact).abs() <= 4.0 * f64::EPSILON * size / cos, "{ray:?}: {t} {exact}");
        // a ray that grazes nothing and starts beside nothing has twelve digits
        if cos > 0.01 && exact > 0.1 {
            assert!((t / exact - 1.0).abs() < 1e-12, "{ray:?}: {t} {exact}");
        }
    }
    // through the scene, with all other shapes, and seen from the front
    let (first, id) = nearest(surfaces, ray, |_| true);
    let front = |id: u32| surfaces[id as usize].at(ray.o + first * ray.d).1.n.dot(ray.d) < 0.0;
    let expected = (first.is_finite() && front(id)).then_some(id);
    assert_eq!(scene.intersect(ray, 0.0).map(|hit| hit.surface), expected, "{ray:?}");
    t.is_finite()
}

/// Holds the shadow rays of the lanes to the scalar code for one segment; whether it was blocked.
fn assert_block_alike(surfaces: &[Surface], lanes: &RectangleLanes, segment: &Ray, to: u32) -> bool {
    let blocks = |(id, s): (u32, &Surface)| {
        is_rectangle(s) && id != segment.from && id != to && s.shape.intersect_flat(segment) < 1.0
    };
    let blocked = lanes.blocks(segment, to);
    assert_eq!(blocked, (0u32..).zip(surfaces).any(blocks), "{segment:?} to {to}");
    blocked
}

#[test]
fn the_cornell_box_looks_the_same() {
    let scene = SceneKind::CornellBox { resolution: 1 }.build();
    let (surfaces, lanes) = (scene.surfaces(), RectangleLanes::new(scene.surfaces()));
    // without the blocks' bottoms, which lie in the floor: between the two, rounding decides
    let on_floor = |s: &Surface| s.shape.direction().y < -0.5 && s.sample_area((0.5, 0.5)).0.y < -0.999;
    let seen: Vec<usize> = (0..surfaces.len()).filter(|&id| !on_floor(&surfaces[id])).collect();
    assert_eq!(seen.len(), surfaces.len() - 2);
    let (mut stream, mut hits) = (stream("cornell"), 0);
    for i in 0..100_000 {
        let id = seen[i % seen.len()];
        let (p, frame) = surfaces[id].sample_area(stream.u2());
        let d = GREY.bsdf.sample(Carried::Radiance, Directions::Uniform, &frame, DVec3::Z, stream.u2()).wi;
        hits += u32::from(assert_agree(&scene, &lanes, &Ray { o: p, d, from: id as u32 }));
        // along an axis: parallel to most planes, where distances are infinite
        let axis = DVec3::AXES[i % 3] * if i % 2 == 0 { 1.0 } else { -1.0 };
        if frame.n.dot(axis) > 0.1 {
            assert_agree(&scene, &lanes, &Ray { o: p, d: axis, from: id as u32 });
        }
    }
    assert!(hits > 50_000, "{hits} hits are too few to tell");
}

/// None, one, a group but one, a group, a group and one, and the same for what is held at once.
#[test]
fn any_number_of_rectangles_is_searched() {
    for count in [0, 1, 7, 8, 9, 31, 32, 33, 200] {
        let mut stream = stream(&count.to_string());
        let scene = rectangles(count, &mut stream);
        let (surfaces, lanes) = (scene.surfaces(), RectangleLanes::new(scene.surfaces()));
        let (mut hits, mut blocked) = (0, 0);
        for i in 0..10_000 {
            let free = Ray { o: point(&mut stream), d: direction(&mut stream), from: NOWHERE };
            hits += u32::from(assert_agree(&scene, &lanes, &free));
            if count == 0 {
                continue;
            }
            // from and to points of rectangles and disks
            let [from, to] = [i % surfaces.len(), (i / 7 + 1) % surfaces.len()];
            let [p, q] = [from, to].map(|id| surfaces[id].sample_area(stream.u2()).0);
            let segment = Ray { o: p, d: q - p, from: from as u32 };
            let leaving = Ray { d: segment.d.normalize(), ..segment };
            if from != to {
                hits += u32::from(assert_agree(&scene, &lanes, &leaving));
                blocked += u32::from(assert_block_alike(surfaces, &lanes, &segment, to as u32));
            }
        }
        assert!(count == 0 || hits > 500, "{count}: {hits} hits are too few to tell");
        assert!(count < 7 || blocked > 500, "{count}: {blocked} blocked are too few to tell");
    }
}
