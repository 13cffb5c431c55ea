//! Promise: the density that `light_pdf` states for an emitter hit by chance is the one that `sample_light` states for a
//! sampled point of it, for every shape of emitter, moving or not, every way of sampling and any number of lights; and
//! it is a density: over all directions it integrates to 1.
//!
//! Nothing here is statistical: random numbers choose examples, and integrals are sums over equal cells.

use furnace::sampling::{Address, Stream, warp};
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch, Triangle};
use furnace::scene::sky::SKY;
use furnace::scene::{
    Bsdf, LightSampling, Material, Pick, PointLight, Points, Ray, Rgb, Scene, Sensor, Shape, Sky, Surface,
};
use glam::DVec3;

const SENSOR: Sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn ways() -> impl Iterator<Item = LightSampling> {
    [Points::Area, Points::SolidAngle]
        .into_iter()
        .flat_map(|points| [Pick::Power, Pick::Uniform].map(|pick| LightSampling { points, pick }))
}

fn stream(name: &str) -> Stream {
    Address::of(&["hits_have_the_density_of_samples", name]).stream(0, 0)
}

fn sphere(center: DVec3, radius: f64, (low, high): (f64, f64), inward: bool) -> Shape {
    Shape::Sphere(SpherePatch { center, radius, axis: at(0.36, 0.48, 0.8), low, high, inward })
}

/// Every shape, with what it emits and how it moves; none of one colour or size with another.
fn emitters() -> Vec<(Shape, Rgb, DVec3)> {
    let (center, half_u, half_v) = (at(0.9, -0.4, 1.3), at(0.0, 0.7, 0.0), at(0.4, 0.0, 0.3));
    let rectangle = Shape::Rectangle(Rectangle { center, half_u, half_v });
    let low = Shape::Rectangle(Rectangle { center: -center, half_u, half_v: -half_v });
    let triangle =
        Shape::Triangle(Triangle { a: at(-2.0, 0.3, 1.5), b: at(-1.0, 1.6, 1.2), c: at(0.1, 0.4, 2.0) });
    let disk = Shape::Disk(Disk { center: at(0.2, 2.0, 0.1), normal: at(0.0, -0.8, -0.6), radius: 0.6 });
    let (rest, moves) = (DVec3::ZERO, at(0.3, -0.5, 0.4));
    vec![
        (rectangle, Rgb::new(1.0, 2.0, 0.5), rest),
        (low, Rgb::new(0.1, 0.0, 0.3), moves),
        (triangle, Rgb::new(4.0, 0.1, 3.0), rest),
        (triangle, Rgb::new(0.2, 0.0, 0.7), at(0.1, -0.2, 1.5)),
        (disk, Rgb::new(0.2, 0.4, 2.0), rest),
        (disk, Rgb::ONE, at(-2.0, 0.7, 0.2)),
        (sphere(at(-0.8, -0.9, 0.6), 0.4, (-1.0, 1.0), false), Rgb::new(0.7, 0.7, 0.1), rest),
        (sphere(at(0.6, 0.3, -1.4), 0.5, (-0.3, 0.6), false), Rgb::splat(0.3), rest),
        (sphere(at(0.0, 0.1, 0.0), 5.0, (0.2, 0.9), true), Rgb::splat(0.01), rest),
    ]
}

fn surfaces() -> Vec<Surface> {
    let of = |(shape, le, velocity): (Shape, Rgb, DVec3)| {
        Surface::moving(shape, Material::lambert(Rgb::splat(0.5), le), velocity)
    };
    let mut all: Vec<Surface> = emitters().into_iter().map(of).collect();
    // two that do not emit, one before all and one between, so that surfaces and emitters count apart
    let dark = Material::lambert(Rgb::splat(0.5), Rgb::ZERO);
    all.insert(3, Surface::new(sphere(at(0.0, 0.0, -0.4), 0.2, (-1.0, 1.0), false), dark));
    all.insert(0, Surface::new(sphere(at(1.9, 1.0, 0.0), 0.3, (-1.0, 1.0), false), dark));
    all
}

fn sky() -> Sky {
    Sky::Cosine { radiance: Rgb::new(0.02, 0.01, 0.03), exponent: 1.5, up: at(0.48, 0.6, -0.64) }
}

const POINTS: [PointLight; 2] = [
    PointLight { position: at(0.4, -1.3, 0.2), intensity: Rgb::new(0.3, 0.2, 0.9) },
    PointLight { position: at(-1.4, 0.3, -0.7), intensity: Rgb::new(0.0, 0.8, 0.0) },
];

#[test]
fn a_sampled_point_hit_by_chance_has_the_same_density() {
    let surfaces = surfaces();
    let lit = surfaces.iter().filter(|s| s.material.le != Rgb::ZERO).count();
    let scenes = [
        Scene::new(surfaces.clone(), SENSOR),
        Scene::lit_by(surfaces.clone(), &[], Some(sky()), SENSOR),
        Scene::lit_by(surfaces.clone(), &POINTS, Some(sky()), SENSOR),
    ];
    assert_eq!([0, 1, 2].map(|i| scenes[i].light_count()), [lit, lit + 1, lit + 3]);
    let mut stream = stream("same");
    for (scene, how) in scenes.iter().flat_map(|scene| ways().map(move |how| (scene, how))) {
        let mut compared = vec![0u32; surfaces.len() + 1];
        for _ in 0..150_000 {
            let p = 2.0 * at(stream.u1(), stream.u1(), stream.u1()) - 1.0;
            let (time, u) = (stream.u1(), stream.u1());
            let Some(light) = scene.sample_light(how, (p, time), u, stream.u2()) else { continue };
            let Some(pdf) = light.pdf else { continue };
            let ray = Ray { o: p, d: light.to_light / light.distance, from: NOWHERE };
            let Some(hit) = scene.intersect(&ray, time) else { continue };
            if hit.surface != light.surface {
                continue; // something stands between
            }
            let stated = scene.light_pdf(how, &ray, &hit, time);
            let cos = hit.frame.n.dot(hit.wo);
            // the density per area is divided by the cosine, which rounding of the direction moves
            let tolerance = 1e-13 / (cos * cos * light.distance.min(1.0));
            assert!((stated.0 / pdf.0 - 1.0).abs() < tolerance, "{how:?} {hit:?}: {stated:?} {pdf:?}");
            assert!((light.weight * pdf.0 - 1.0).abs() < 1e-14 && light.le.abs_diff_eq(hit.le, 1e-12));
            compared[(hit.surface as usize).min(surfaces.len())] += 1;
        }
        let expected = |(id, &n): (usize, &u32)| match surfaces.get(id) {
            Some(s) if s.material.le == Rgb::ZERO => n == 0,
            None if scene.light_count() == lit => n == 0,
            _ => n > 100,
        };
        assert!(compared.iter().enumerate().all(expected), "{how:?}: {compared:?} are too few to tell");
    }
}

/// Of the lights that a point sees whole, the density integrates to their share of the choice.
#[test]
fn the_density_integrates_to_one() {
    const CELLS: u32 = 1200;
    // each seen from the origin whole: nothing before it, its front turned here
    let shapes: Vec<(Shape, Rgb, DVec3)> = [0, 5, 6].into_iter().map(|i| emitters()[i]).collect();
    let of = |&(shape, le, velocity): &(Shape, Rgb, DVec3)| {
        Surface::moving(shape, Material::lambert(Rgb::ZERO, le), velocity)
    };
    let flat = Scene::new(shapes.iter().map(of).collect(), SENSOR);
    // nothing hides a part of the sky but a ball that emits
    let ball =
        Scene::lit_by(vec![of(&emitters()[6])], &[], Some(Sky::Uniform { radiance: Rgb::ONE }), SENSOR);
    let cell = |i: u32| (f64::from(i) + 0.5) / f64::from(CELLS);
    for how in ways() {
        let (mut of_flat, mut of_ball, mut of_sky) = (0.0, 0.0, 0.0);
        for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
            let ray =
                Ray { o: DVec3::ZERO, d: warp::sphere_band(-1.0, 1.0, (cell(i), cell(j))), from: NOWHERE };
            if let Some(hit) = flat.intersect(&ray, 0.7) {
                of_flat += flat.light_pdf(how, &ray, &hit, 0.7).0;
            }
            let hit = ball.intersect(&ray, 0.7).expect("sky");
            let pdf = ball.light_pdf(how, &ray, &hit, 0.7).0;
            if hit.is_sky() { of_sky += pdf } else { of_ball += pdf }
        }
        let solid_angle = 4.0 * std::f64::consts::PI / f64::from(CELLS * CELLS);
        let total = of_flat * solid_angle;
        // area sampling of the ball gives half of its points to the side that is not seen
        let hidden = match (how.points, how.pick) {
            (Points::SolidAngle, _) => 0.0,
            (Points::Area, Pick::Uniform) => hidden_share() / 3.0,
            (Points::Area, Pick::Power) => hidden_share() * power_share(&shapes),
        };
        assert!((total + hidden - 1.0).abs() < 3e-3, "{how:?}: {total} {hidden}");
        if how == (LightSampling { points: Points::SolidAngle, pick: Pick::Uniform }) {
            assert!((of_ball * solid_angle - 0.5).abs() < 2e-3, "{of_ball}");
            let covered = 0.5 * (1.0 - (1.0 - 0.16 / at(-0.8, -0.9, 0.6).length_squared()).sqrt());
            assert!((of_sky * solid_angle - 0.5 * (1.0 - covered)).abs() < 1e-3, "{of_sky}");
        }
    }
}

/// The part of the ball's area that the origin does not see: all but a cap.
fn hidden_share() -> f64 {
    0.5 * (1.0 + 0.4 / at(-0.8, -0.9, 0.6).length())
}

/// The last light's share of the power.
fn power_share(shapes: &[(Shape, Rgb, DVec3)]) -> f64 {
    let power = |(shape, le, _): &(Shape, Rgb, DVec3)| shape.area() * le.element_sum();
    power(shapes.last().unwrap()) / shapes.iter().map(power).sum::<f64>()
}

/// What does not emit has no density, nor has the back of what emits.
#[test]
fn what_cannot_be_sampled_has_no_density() {
    let mut surfaces = surfaces();
    let front = Surface::new(
        Shape::Rectangle(Rectangle { center: at(0.0, 0.0, -2.8), half_u: DVec3::X, half_v: DVec3::Y }),
        Material { bsdf: Bsdf::Dielectric { ior: 1.5 }, le: Rgb::ONE },
    );
    surfaces.push(front);
    let clear = surfaces.len() as u32 - 1;
    let scene = Scene::lit_by(surfaces, &POINTS, None, SENSOR);
    let mut met = [0; 3];
    let mut stream = stream("none");
    for how in ways() {
        for _ in 0..30_000 {
            let o = 4.0 * (2.0 * at(stream.u1(), stream.u1(), stream.u1()) - 1.0);
            let ray = Ray { o, d: warp::sphere_band(-1.0, 1.0, stream.u2()), from: NOWHERE };
            let Some(hit) = scene.intersect(&ray, 0.5) else { continue };
            let pdf = scene.light_pdf(how, &ray, &hit, 0.5).0;
            let behind = hit.frame.n.dot(hit.wo) < 0.0;
            let emits = scene.surfaces()[hit.surface as usize].material.le != Rgb::ZERO && !behind;
            assert_eq!((pdf > 0.0, hit.le != Rgb::ZERO), (emits, emits), "{how:?} {hit:?}: {pdf}");
            assert!(pdf >= 0.0 && (!behind || hit.surface == clear));
            met[usize::from(emits) + 2 * usize::from(behind)] += 1;
        }
    }
    assert!(met.into_iter().all(|n| n > 100), "{met:?} are too few to tell");
    // no sky
    let ray = Ray { o: DVec3::ZERO, d: DVec3::Z, from: NOWHERE };
    let lit = Scene::lit_by(Vec::new(), &[], Some(sky()), SENSOR);
    let hit = lit.intersect(&ray, 0.0).unwrap();
    assert_eq!((hit.surface, scene.light_pdf(LightSampling::AREA, &ray, &hit, 0.0).0), (SKY, 0.0));
}
