//! Promise: a sampled point on an emitter comes with the density of its direction, and next-event estimation gives the
//! irradiance that closed forms give, for every shape of emitter, points included, and all ways of sampling it.
//!
//! Irradiances are means of 2^19 samples, held to SIGMAS standard errors: false alarm probability below 1e-9 for the
//! file. The interval reaches at most 5 % to each side (spheres cut by the horizon and sampled by area; 0.1 % to 2 %
//! for the rest), so that a factor off by 10 % is always seen. Solid angles and choices of emitter are integrals over
//! the unit square, without chance, and see one part in 10^5.

use furnace::estimator::{Ctx, Tally};
use furnace::sampling::Address;
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch, Triangle};
use furnace::scene::sky::SKY;
use furnace::scene::{
    LightSampling, Material, Pick, PointLight, Ray, Rgb, Scene, Sensor, Shape, Sky, Start, Surface,
};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

const WAYS: [LightSampling; 2] = [LightSampling::AREA, LightSampling::SOLID_ANGLE];
const SIGMAS: f64 = 7.0;
const SAMPLES: u32 = 1 << 19;

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The lights and, last, a small white plate at the origin, which reflects its irradiance divided by π.
fn scene(lights: &[(Shape, Rgb)], normal: DVec3) -> Scene {
    let (u, v) = normal.any_orthonormal_pair();
    let plate = Rectangle { center: DVec3::ZERO, half_u: u * 0.01, half_v: v * 0.01 };
    let mut surfaces: Vec<Surface> =
        lights.iter().map(|&(shape, le)| Surface::new(shape, Material::lambert(Rgb::ZERO, le))).collect();
    surfaces.push(Surface::new(Shape::Rectangle(plate), Material::lambert(Rgb::ONE, Rgb::ZERO)));
    Scene::new(surfaces, Sensor::Probe { origin: normal, direction: -normal })
}

/// A rectangle that looks down and aslant, and its corners.
const RECTANGLE: Rectangle =
    Rectangle { center: at(0.9, -0.4, 1.3), half_u: at(0.0, 0.7, 0.0), half_v: at(0.4, 0.0, 0.3) };

fn corners() -> [DVec3; 4] {
    let Rectangle { center, half_u, half_v } = RECTANGLE;
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(s, t)| center + s * half_u + t * half_v)
}

/// One half of it.
fn triangle() -> Shape {
    let [a, b, c, _] = corners();
    Shape::Triangle(Triangle { a, b, c })
}

fn disk(center: DVec3, radius: f64) -> Shape {
    Shape::Disk(Disk { center, normal: -DVec3::Z, radius })
}

fn sphere(center: DVec3, radius: f64) -> SpherePatch {
    SpherePatch { center, radius, axis: at(0.36, 0.48, 0.8), low: -1.0, high: 1.0, inward: false }
}

/// Irradiance on a plate at the origin from unit radiance, divided by π [Lambert 1760; theory C-i]: half the sum of the
/// angles that the edges subtend, each times the cosine between the plate's normal and that of the edge's plane.
fn polygon_factor(corners: &[DVec3], normal: DVec3) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let edge = |(a, b): (&DVec3, &DVec3)| a.angle_between(*b) * a.cross(*b).normalize().dot(normal);
    edges.map(edge).sum::<f64>().abs() / TAU
}

/// Solid angle of a convex polygon from the origin: its angles on the unit sphere beyond those in a plane [Girard].
fn polygon_solid_angle(corners: &[DVec3]) -> f64 {
    let n = corners.len();
    let angle = |i: usize| {
        let [before, here, after] = [corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]];
        here.cross(before).angle_between(here.cross(after))
    };
    (0..n).map(angle).sum::<f64>() - (n as f64 - 2.0) * PI
}

/// A sphere at distance H radii, the angle between its direction and the normal given by its cosine; above the horizon
/// or cut by it [theory C-ii].
fn sphere_factor(h: f64, cos: f64) -> f64 {
    let sin = (1.0 - cos * cos).sqrt();
    if cos >= 1.0 / h {
        return cos / (h * h);
    }
    let x = (h * h - 1.0).sqrt();
    let y = -x * cos / sin;
    let rest = sin * (1.0 - y * y).sqrt();
    (cos * libm::acos(y) - x * rest) / (PI * h * h) + libm::atan(rest / x) / PI
}

/// Mean and standard error of the radiance that the plate reflects: its irradiance divided by π.
fn direct(scene: &Scene, how: LightSampling, name: &str) -> (Rgb, Rgb) {
    let Sensor::Probe { origin, direction } = scene.sensor else { unreachable!() };
    let plate = scene.intersect(&Ray { o: origin * 0.05, d: direction, from: NOWHERE }, 0.0).unwrap();
    let mut tally = Tally::default();
    let stream = Address::of(&["lights", name, &format!("{how:?}")]).stream(0, 0);
    let start =
        Start { ray: Ray { o: origin, d: direction, from: NOWHERE }, response: 1.0, time: 0.0, pixel: 0 };
    let mut cx = Ctx::new(scene, stream, &mut tally, &start);
    let (mut sum, mut squares) = (Rgb::ZERO, Rgb::ZERO);
    for _ in 0..SAMPLES {
        let radiance = cx.direct(&plate, how).map_or(Rgb::ZERO, |light| light.radiance);
        (sum, squares) = (sum + radiance, squares + radiance * radiance);
    }
    let (n, mean) = (f64::from(SAMPLES), sum / f64::from(SAMPLES));
    (mean, ((squares / n - mean * mean).max(Rgb::ZERO) / n).map(f64::sqrt))
}

/// `factors` are the irradiances of unit radiance divided by π.
fn assert_irradiance(name: &str, lights: &[(Shape, Rgb)], normal: DVec3, factors: &[f64]) {
    let truth: Rgb = lights.iter().zip(factors).map(|((_, le), f)| *le * *f).sum();
    for how in WAYS {
        let (mean, error) = direct(&scene(lights, normal), how, name);
        let width = SIGMAS * error + 1e-12 * truth; // the latter for rounding, where nothing varies
        assert!((width / truth).max_element() < 0.05, "{name} {how:?}: too wide to tell: {}", width / truth);
        assert!(((mean - truth).abs() - width).max_element() < 0.0, "{name} {how:?}: {mean} {truth} {width}");
    }
}

#[test]
fn irradiance_of_each_shape_is_lamberts() {
    let (up, aslant, le) = (DVec3::Z, at(0.48, -0.36, 0.8), Rgb::new(3.0, 0.5, 1.0));
    let (h, radius, a) = (1.4, 0.8, 0.9);
    for normal in [up, aslant] {
        let (four, three) = (polygon_factor(&corners(), normal), polygon_factor(&corners()[..3], normal));
        assert_irradiance("rectangle", &[(Shape::Rectangle(RECTANGLE), le)], normal, &[four]);
        assert_irradiance("triangle", &[(triangle(), le)], normal, &[three]);
    }
    let square = radius * radius;
    assert_irradiance("disk", &[(disk(up * h, radius), le)], up, &[square / (square + h * h)]);
    // parallel, its axis at distance a
    let q = a * a + h * h + square;
    let beside = 0.5 * (1.0 - (q - 2.0 * square) / (q * q - 4.0 * a * a * square).sqrt());
    assert_irradiance("disk beside", &[(disk(at(0.0, a, h), radius), le)], up, &[beside]);
    // far above the horizon, cut by it above and below the middle
    for center in [at(0.3, -0.5, 1.1), at(1.4, 0.0, 0.2), at(-1.0, 1.0, -0.05)] {
        let f = sphere_factor(center.length() / 0.5, center.z / center.length());
        assert_irradiance("sphere", &[(Shape::Sphere(sphere(center, 0.5)), le)], up, &[f]);
    }
}

/// Emitters of different size, shape and colour, none in front of another, add up.
#[test]
fn unequal_emitters_add_up_and_are_picked_by_their_power() {
    let ball = sphere(at(-0.8, 0.9, 0.6), 0.4);
    let lights = [
        (Shape::Rectangle(RECTANGLE), Rgb::new(1.0, 2.0, 0.5)),
        (disk(DVec3::Z * 2.5, 0.5), Rgb::new(4.0, 0.1, 3.0)),
        (Shape::Sphere(ball), Rgb::new(0.2, 0.4, 2.0)),
    ];
    let of_ball = sphere_factor(ball.center.length() / 0.4, ball.center.normalize().z);
    let factors = [polygon_factor(&corners(), DVec3::Z), 0.25 / (0.25 + 6.25), of_ball];
    assert_irradiance("three", &lights, DVec3::Z, &factors);

    // how many of equally spaced numbers pick each: its share of area x emission, but for one at each end
    const PICKS: u32 = 100_000;
    let power = lights.map(|(shape, le)| shape.area() * le.element_sum());
    let (scene, mut picked) = (scene(&lights, DVec3::Z), [0u32; 3]);
    for i in 0..PICKS {
        let u = (f64::from(i) + 0.5) / f64::from(PICKS);
        let sample = scene.sample_light(LightSampling::SOLID_ANGLE, (DVec3::ZERO, 0.0), u, (0.3, 0.6));
        picked[sample.unwrap().surface as usize] += 1;
    }
    for (picked, power_of_one) in picked.into_iter().zip(power) {
        let share = f64::from(PICKS) * power_of_one / power.iter().sum::<f64>();
        assert!((f64::from(picked) - share).abs() <= 1.0, "{picked} {share}");
    }
}

/// The mean of 1 / pdf over the points that send light is the solid angle of the visible part, by the midpoint rule.
#[test]
fn the_mean_of_one_over_pdf_is_the_solid_angle() {
    const CELLS: u32 = 600;
    let (up, ball) = (DVec3::Z, sphere(at(0.3, -0.5, 1.1), 0.5));
    // a cap, seen along its axis: its rim is a disk; and a belt, seen from a point of the axis within the sphere
    let cap = SpherePatch { center: up * 2.0, axis: -up, low: 0.6, high: 1.0, ..ball };
    let belt = SpherePatch { center: up * 0.3, axis: up, low: -0.2, high: 0.7, radius: 1.5, inward: true };
    let rim = |s: &SpherePatch, z: f64| {
        let height = s.center.z + s.axis.z * z * s.radius;
        height / (height * height + s.radius * s.radius * (1.0 - z * z)).sqrt()
    };
    let cases = [
        (Shape::Rectangle(RECTANGLE), polygon_solid_angle(&corners())),
        (triangle(), polygon_solid_angle(&corners()[..3])),
        (disk(up * 1.4, 0.8), TAU * (1.0 - 1.4 / (1.4f64 * 1.4 + 0.64).sqrt())),
        (Shape::Sphere(ball), TAU * (1.0 - (1.0 - 0.25 / ball.center.length_squared()).sqrt())),
        (Shape::Sphere(cap), TAU * (1.0 - rim(&cap, 0.6))),
        (Shape::Sphere(belt), TAU * (rim(&belt, 0.7) - rim(&belt, -0.2))),
    ];
    for (how, (shape, exact)) in WAYS.into_iter().flat_map(|how| cases.map(|case| (how, case))) {
        let scene = scene(&[(shape, Rgb::ONE)], up);
        let cell = |i: u32| (f64::from(i) + 0.5) / f64::from(CELLS);
        let mut sum = 0.0;
        for v in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (cell(i), cell(j)))) {
            let Some(sample) = scene.sample_light(how, (DVec3::ZERO, 0.0), 0.5, v) else { continue };
            let ratio = sample.to_light.length() / sample.distance;
            assert!((ratio - 1.0).abs() < 1e-15 && sample.le == Rgb::ONE);
            sum += 1.0 / sample.pdf.unwrap().0;
        }
        let mean = sum / f64::from(CELLS * CELLS);
        assert!((mean / exact - 1.0).abs() < 1e-5, "{how:?} {shape:?}: {mean} {exact}");
    }
}

/// The back of a flat emitter sends nothing, nor does a sphere towards its inside.
#[test]
fn backs_are_dark() {
    let flat = [Shape::Rectangle(RECTANGLE), triangle(), disk(DVec3::Z, 0.8)];
    let ball = (Shape::Sphere(sphere(DVec3::Z * 3.0, 0.5)), at(0.1, 0.2, 3.1));
    for (shape, eye) in flat.map(|shape| (shape, at(1.1, -0.3, 4.0))).into_iter().chain([ball]) {
        let scene = scene(&[(shape, Rgb::ONE)], DVec3::Z);
        let dark = |how| scene.sample_light(how, (eye, 0.0), 0.5, (0.4, 0.7)).is_none();
        assert!(WAYS.into_iter().all(dark), "{shape:?}");
    }
}

const UNIFORM: LightSampling = LightSampling { pick: Pick::Uniform, ..LightSampling::AREA };

/// How many of equally spaced numbers pick each light: surfaces in their order, then points, then the sky.
fn picks(scene: &Scene, how: LightSampling, points: &[PointLight]) -> Vec<u32> {
    const PICKS: u32 = 100_000;
    let (surfaces, mut picked) = (scene.surfaces().len(), vec![0; scene.surfaces().len() + points.len() + 1]);
    for i in 0..PICKS {
        let u = (f64::from(i) + 0.5) / f64::from(PICKS);
        let light = scene.sample_light(how, (DVec3::ZERO, 0.0), u, (0.3, 0.6)).unwrap();
        let is_it = |p: &PointLight| (p.position - light.to_light).length() < 1e-12;
        picked[match light.surface {
            SKY => surfaces + points.len(),
            NOWHERE => surfaces + points.iter().position(is_it).unwrap(),
            surface => surface as usize,
        }] += 1;
    }
    picked
}

/// Power, up to a factor π: area x radiance, 4 x intensity, and what the sky sends through a sphere around the scene.
#[test]
fn emitters_of_all_kinds_are_picked_by_power_or_alike() {
    let points = [
        PointLight { position: at(0.4, -1.3, 0.2), intensity: Rgb::new(0.3, 0.2, 0.9) },
        PointLight { position: at(-1.4, 0.3, 0.7), intensity: Rgb::new(0.0, 0.8, 0.0) },
    ];
    let lights = [(Shape::Rectangle(RECTANGLE), Rgb::new(1.0, 2.0, 0.5)), (disk(DVec3::Z, 0.8), Rgb::ONE)];
    let surfaces = scene(&lights, DVec3::Z).surfaces().to_vec();
    let sky = Sky::Cosine { radiance: Rgb::new(0.2, 0.1, 0.3), exponent: 2.0, up: DVec3::Z };
    let scene = Scene::lit_by(surfaces.clone(), &points, Some(sky), scene(&lights, DVec3::Z).sensor);
    let bounds = surfaces.iter().map(|s| s.shape.bounds());
    let (low, high) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap();
    let squared = 0.25 * (high - low).length_squared();
    let mut power: Vec<f64> = surfaces.iter().map(|s| s.shape.area() * s.material.le.element_sum()).collect();
    power.extend(points.map(|p| 4.0 * p.intensity.element_sum()));
    power.push(squared * 0.6 * TAU / 3.0);
    let total: f64 = power.iter().sum();
    let uniform = power.iter().map(|&p| if p > 0.0 { 0.2 } else { 0.0 }).collect::<Vec<f64>>();
    let by_power: Vec<f64> = power.iter().map(|p| p / total).collect();
    for (how, shares) in [(UNIFORM, uniform), (LightSampling::AREA, by_power)] {
        let picked = picks(&scene, how, &points);
        for (&picked, share) in picked.iter().zip(shares) {
            assert!((f64::from(picked) - 1e5 * share).abs() <= 1.0, "{how:?}: {picked} {share}");
        }
    }
    assert_eq!(scene.light_count(), 5);
}

/// One point light: I cos / d² exactly, every time; nothing through what stands between, or from below the plate.
#[test]
fn one_point_light_has_no_variance() {
    let (normal, intensity) = (at(0.48, -0.36, 0.8), Rgb::new(3.0, 0.5, 1.0));
    let blocker = |center| (Shape::Sphere(sphere(center, 0.05)), Rgb::ZERO);
    let position = at(0.9, -0.4, 1.3);
    let seen = intensity * (normal.dot(position) / position.length().powi(3));
    // beside the way, behind the light, in the way
    let blockers = [(at(-0.9, 0.4, 1.3), seen), (1.2 * position, seen), (0.6 * position, Rgb::ZERO)];
    let cases = blockers.map(|(center, exact)| (position, center, exact)).into_iter();
    for (position, center, exact) in cases.chain([(-position, 2.0 * position, Rgb::ZERO)]) {
        let plates = scene(&[blocker(center)], normal);
        let light = PointLight { position, intensity };
        let scene = Scene::lit_by(plates.surfaces().to_vec(), &[light], None, plates.sensor);
        let Sensor::Probe { origin, direction } = scene.sensor else { unreachable!() };
        let ray = Ray { o: origin * 0.01, d: direction, from: NOWHERE };
        let plate = scene.intersect(&ray, 0.0).unwrap();
        let mut tally = Tally::default();
        let stream = Address::of(&["lights", "point"]).stream(0, 0);
        let start = Start { ray, response: 1.0, time: 0.0, pixel: 0 };
        let mut cx = Ctx::new(&scene, stream, &mut tally, &start);
        for how in WAYS.into_iter().chain([UNIFORM]).cycle().take(300) {
            let direct = cx.direct(&plate, how);
            assert!(direct.is_none_or(|light| light.pdf.is_none()), "a point has no density");
            let radiance = direct.map_or(Rgb::ZERO, |light| light.radiance);
            assert!((radiance * PI - exact).abs().max_element() < 1e-14, "{how:?}: {radiance} {exact}");
        }
    }
}

/// Several points, and a surface: their irradiances add up however they are picked.
#[test]
fn point_lights_add_up() {
    let points = [
        PointLight { position: at(0.9, -0.4, 1.3), intensity: Rgb::new(0.3, 0.2, 0.9) },
        PointLight { position: at(-1.4, 0.3, 0.7), intensity: Rgb::new(0.1, 0.8, 0.2) },
    ];
    let plates = scene(&[(disk(DVec3::Z * 2.5, 0.5), Rgb::new(4.0, 1.0, 3.0))], DVec3::Z);
    let scene = Scene::lit_by(plates.surfaces().to_vec(), &points, None, plates.sensor);
    let of_points: Rgb =
        points.iter().map(|p| p.intensity * p.position.z / p.position.length().powi(3)).sum();
    let exact = of_points / PI + Rgb::new(4.0, 1.0, 3.0) * (0.25 / (0.25 + 6.25));
    for how in WAYS.into_iter().chain([UNIFORM]) {
        let (mean, error) = direct(&scene, how, "points");
        assert!((SIGMAS * error / exact).max_element() < 0.02, "{how:?}: too wide to tell: {error}");
        let width = SIGMAS * error + 1e-12 * exact;
        assert!(((mean - exact).abs() - width).max_element() < 0.0, "{how:?}: {mean} {exact} {width}");
    }
}
