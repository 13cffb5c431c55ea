//! Promise: at any moment of the exposure a scene that moves is the scene in which everything stands where it is then:
//! for rays, for shadow rays and for light that is sampled; and moments are uniform over the exposure.
//!
//! Random numbers choose examples, but for one chi-square (false alarm probability 1e-9) and a mean of 2^16 paths, held
//! to 7 standard errors (3e-12).

mod chi_square;

use chi_square::assert_follows;
use furnace::estimator::{Ctx, Estimate, Explicit, Roulette, Tally, Technique};
use furnace::sampling::{Address, Stream, warp};
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch, Triangle};
use furnace::scene::{
    Directions, LightSampling, Material, Pick, Points, Ray, Rgb, Scene, Sensor, Shape, Surface,
};
use glam::DVec3;

const SENSOR: Sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn stream(name: &str) -> Stream {
    Address::of(&["motion_is_seen_at_its_time", name]).stream(0, 0)
}

/// Flat shapes and their ways, one at rest, and a ball.
fn shapes() -> Vec<(Shape, DVec3)> {
    let (center, half_u, half_v) = (at(0.9, -0.4, 1.3), at(0.0, 0.7, 0.0), at(0.4, 0.0, 0.3));
    let rectangle = Shape::Rectangle(Rectangle { center, half_u, half_v });
    let other = Shape::Rectangle(Rectangle { center: -center, half_u, half_v: -half_v });
    let triangle =
        Shape::Triangle(Triangle { a: at(-2.0, 0.3, 1.5), b: at(-1.0, 1.6, 1.2), c: at(0.1, 0.4, 2.0) });
    let disk = Shape::Disk(Disk { center: at(0.2, 1.5, 0.1), normal: at(0.0, -0.8, -0.6), radius: 0.9 });
    let (low, high) = (-1.0, 1.0);
    let ball =
        SpherePatch { center: at(-0.4, -0.5, 0.3), radius: 0.4, axis: DVec3::Z, low, high, inward: false };
    vec![
        (rectangle, at(-2.0, 0.5, -1.0)),
        (other, DVec3::ZERO),
        (triangle, at(0.7, -1.2, -1.5)),
        (disk, at(0.3, -2.0, 0.4)),
        (Shape::Sphere(ball), DVec3::ZERO),
    ]
}

/// The shape that far away.
fn moved(shape: Shape, way: DVec3) -> Shape {
    match shape {
        Shape::Rectangle(r) => Shape::Rectangle(Rectangle { center: r.center + way, ..r }),
        Shape::Triangle(t) => Shape::Triangle(Triangle { a: t.a + way, b: t.b + way, c: t.c + way }),
        Shape::Disk(d) => Shape::Disk(Disk { center: d.center + way, ..d }),
        Shape::Sphere(s) => Shape::Sphere(SpherePatch { center: s.center + way, ..s }),
    }
}

fn material(i: usize) -> Material {
    Material::lambert(Rgb::splat(0.5), Rgb::new(1.0, i as f64, 0.5))
}

fn moving() -> Scene {
    let surface = |(i, (shape, velocity))| Surface::moving(shape, material(i), velocity);
    Scene::new(shapes().into_iter().enumerate().map(surface).collect(), SENSOR)
}

/// The same scene, standing as it is at `time`.
fn standing(time: f64) -> Scene {
    let surface = |(i, (shape, velocity))| Surface::new(moved(shape, velocity * time), material(i));
    Scene::new(shapes().into_iter().enumerate().map(surface).collect(), SENSOR)
}

const TIMES: [f64; 5] = [0.0, 0.25, 0.4, 0.77, 1.0 - f64::EPSILON];

/// A point of the cube [-2, 2]³.
fn point(stream: &mut Stream) -> DVec3 {
    2.0 * (2.0 * at(stream.u1(), stream.u1(), stream.u1()) - 1.0)
}

#[test]
fn rays_meet_what_is_there_then() {
    let (moving, mut stream) = (moving(), stream("rays"));
    for time in TIMES {
        let (standing, mut met, mut blocked) = (standing(time), [0; 5], 0);
        for i in 0..20_000 {
            let d = warp::sphere_band(-1.0, 1.0, stream.u2());
            // from free space or from one of the surfaces, where it is
            let from = i % 6;
            let o = match shapes().get(from as usize) {
                Some(_) => standing.surfaces()[from as usize].sample_area(stream.u2()).0,
                None => point(&mut stream),
            };
            let from = if from < 5 { from } else { NOWHERE };
            let to = (i * 7 + 1) % 5;
            let target = standing.surfaces()[to as usize].sample_area(stream.u2()).0;
            let d = if i % 4 == 0 { d } else { (target - o).normalize() };
            let ray = Ray { o, d, from };
            let (hit, exact) = (moving.intersect(&ray, time), standing.intersect(&ray, time));
            assert_eq!(hit.map(|h| h.surface), exact.map(|h| h.surface), "{time} {ray:?}");
            if let (Some(a), Some(b)) = (hit, exact) {
                // a grazing ray magnifies rounding
                let tolerance = 1e-14 / b.frame.n.dot(b.wo);
                assert!((a.p - b.p).length() < tolerance && a.frame.n.abs_diff_eq(b.frame.n, 1e-12));
                met[a.surface as usize] += 1;
            }
            let shadow = Ray { d: target - o, ..ray };
            if to != from {
                let clear = standing.visible(&shadow, time, to);
                assert_eq!(moving.visible(&shadow, time, to), clear, "{time} {shadow:?} to {to}");
                blocked += u32::from(!clear);
            }
        }
        assert!(met.into_iter().all(|n| n > 100) && blocked > 1000, "{met:?} {blocked} are too few to tell");
    }
}

/// A rectangle flies past a ray: it is hit while it is there, and never before or after.
#[test]
fn a_passing_rectangle_is_hit_while_it_passes() {
    let shape =
        Shape::Rectangle(Rectangle { center: at(-2.0, 0.1, 0.0), half_u: DVec3::X * 0.5, half_v: DVec3::Y });
    let scene = Scene::new(vec![Surface::moving(shape, material(1), DVec3::X * 4.0)], SENSOR);
    let down = Ray { o: at(0.0, 0.3, 2.0), d: -DVec3::Z, from: NOWHERE };
    let shadow = Ray { d: at(0.0, 0.0, -4.0), ..down };
    for i in 0..1000 {
        let time = (f64::from(i) + 0.5) / 1000.0;
        let there = (4.0 * time - 2.0).abs() <= 0.5;
        assert_eq!(scene.intersect(&down, time).is_some(), there, "{time}");
        assert_eq!(scene.visible(&shadow, time, NOWHERE), !there, "{time}");
    }
}

#[test]
fn light_is_sampled_where_the_emitter_is_then() {
    let (moving, mut stream) = (moving(), stream("lights"));
    for (points, pick) in [Points::Area, Points::SolidAngle]
        .into_iter()
        .flat_map(|points| [Pick::Power, Pick::Uniform].map(|pick| (points, pick)))
    {
        let (how, mut compared) = (LightSampling { points, pick }, [0; 5]);
        for time in TIMES {
            let standing = standing(time);
            for _ in 0..5_000 {
                let (p, u, v) = (point(&mut stream), stream.u1(), stream.u2());
                let [a, b] = [&moving, &standing].map(|scene| scene.sample_light(how, (p, time), u, v));
                assert_eq!(a.is_some(), b.is_some(), "{time} {p} {u} {v:?}");
                let (Some(a), Some(b)) = (a, b) else { continue };
                assert_eq!((a.surface, a.le), (b.surface, b.le));
                let (ratio, distance) = (a.pdf.unwrap().0 / b.pdf.unwrap().0, b.distance);
                // an emitter seen from the side, or very near, magnifies rounding
                let normal = standing.surfaces()[b.surface as usize].at(p + b.to_light).1.n;
                let cos = normal.dot(b.to_light) / distance;
                let tolerance = 1e-13 / (cos * distance.min(1.0)).powi(2);
                assert!((a.to_light - b.to_light).length() < tolerance, "{how:?} {time}: {a:?} {b:?}");
                assert!((ratio - 1.0).abs() < tolerance, "{how:?} {time}: {a:?} {b:?}");
                compared[a.surface as usize] += 1;
                // it lies there: the way to it ends on that surface, unless something stands before
                let ray = Ray { o: p, d: a.to_light / a.distance, from: NOWHERE };
                let Some(hit) = moving.intersect(&ray, time).filter(|hit| hit.surface == a.surface) else {
                    continue;
                };
                assert!((hit.p - p - a.to_light).length() < tolerance, "{how:?} {time}: {hit:?} {a:?}");
                let stated = moving.light_pdf(how, &ray, &hit, time).0 / a.pdf.unwrap().0;
                assert!((stated - 1.0).abs() < tolerance, "{how:?} {time}: {stated}");
            }
        }
        assert!(compared.into_iter().all(|n| n > 100), "{how:?}: {compared:?} are too few to tell");
    }
}

#[test]
fn moments_are_uniform_and_cost_one_number() {
    const CELLS: usize = 256;
    let (scene, mut stream) = (moving(), stream("time"));
    let (mut counts, mut lost) = (vec![0; CELLS], 0);
    for _ in 0..1 << 16 {
        let mut again = stream.clone();
        let time = scene.start((0, 0), &mut stream).time;
        again.u1();
        assert_eq!(stream, again, "a moment takes one number after those of the sensor");
        match counts.get_mut((time * CELLS as f64) as usize) {
            Some(count) if (0.0..1.0).contains(&time) => *count += 1,
            _ => lost += 1,
        }
    }
    assert_follows("moments", &counts, lost, &[1.0 / CELLS as f64; CELLS], 1e-9);
}

/// All of a path happens at one moment: a blind moves together with the lamp behind it, and never hides it from the
/// plate below, though it would at any other moment; a blind that follows a half exposure later would.
#[test]
fn a_path_happens_at_one_moment() {
    let small = |center: DVec3, front: f64| {
        Shape::Rectangle(Rectangle { center, half_u: DVec3::X * 0.1, half_v: DVec3::Y * 0.1 * front })
    };
    let way = DVec3::X * 2.0;
    let lamp = Surface::moving(small(at(-1.0, 0.0, 2.0), -1.0), Material::lambert(Rgb::ZERO, Rgb::ONE), way);
    let dark = Material::lambert(Rgb::ZERO, Rgb::ZERO);
    let plate = Surface::moving(small(at(-1.0, 0.0, 0.0), 1.0), Material::lambert(Rgb::ONE, Rgb::ZERO), way);
    // beside the lamp, so that it hides it only from a plate that lags or leads
    let blinds = [-1.0, 1.0].map(|s| Surface::moving(small(at(-1.0 + 0.4 * s, 0.0, 1.0), 1.0), dark, way));
    let sensor = Sensor::Parallel {
        center: at(0.0, 0.0, 0.5),
        direction: -DVec3::Z,
        half_u: DVec3::X * 1.2,
        half_v: DVec3::Y * 0.1,
    };
    let scene = Scene::new([vec![lamp, plate], blinds.to_vec()].concat(), sensor);
    let alone = Scene::new(vec![lamp, plate], sensor);
    let estimator = Explicit {
        technique: Technique::Light,
        lights: LightSampling::AREA,
        directions: Directions::Cosine,
        roulette: Roulette::depth_clamp(1),
    };
    let address = Address::of(&["motion_is_seen_at_its_time", "path"]);
    let value = |scene: &Scene, i: u64| {
        let mut stream = address.stream(i, 0);
        let (mut tally, start) = (Tally::default(), scene.start((0, 0), &mut stream));
        estimator.estimate(&(), start.ray, &mut Ctx::new(scene, stream, &mut tally, &start));
        tally.value.x
    };
    let (mut lit, mut sum, n) = (0u32, 0.0, 1u64 << 16);
    for i in 0..n {
        let (one, other) = (value(&scene, i), value(&alone, i));
        assert_eq!(one, other, "path {i}");
        lit += u32::from(one > 0.0);
        sum += one;
    }
    // the plate fills 0.2 of the sensor's 2.4 at every moment
    let share = 0.2 / 2.4;
    let deviation = (f64::from(lit) - share * n as f64) / (n as f64 * share * (1.0 - share)).sqrt();
    assert!(deviation.abs() < 7.0, "{lit} paths of {n} are lit: {deviation} standard deviations");
    // radiance / π x solid angle, nearly: the lamp is straight above the plate
    let mean = sum / f64::from(lit);
    assert!((mean / (0.04 / 4.0 / std::f64::consts::PI) - 1.0).abs() < 0.02, "{mean}");
}
