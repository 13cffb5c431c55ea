//! Particles carry the lights' power: what falls on closed walls, and what the sensor sees of it, is what paths from the
//! eye find.

use furnace::estimator::{Ctx, Roulette, Rule, Tally, particles::Particles};
use furnace::sampling::{Address, Stream};
use furnace::scene::camera::{Camera, Lens};
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch};
use furnace::scene::{Bsdf, Directions, Material, PointLight, Ray, Rgb, Scene, Sensor, Shape, Sky, Surface};
use glam::DVec3;
use std::f64::consts::PI;

const FIVE_SIGMA: f64 = 5.0;
const BLACK: Rgb = Rgb::ZERO;
const LE: Rgb = Rgb::new(3.0, 5.0, 2.0);

fn sphere(center: DVec3, radius: f64, inward: bool) -> Shape {
    Shape::Sphere(SpherePatch { center, radius, axis: DVec3::Z, low: -1.0, high: 1.0, inward })
}

fn probe() -> Sensor {
    Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z }
}

/// Mean and standard error of `n` values.
fn mean(n: u64, mut value: impl FnMut(u64) -> f64) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for i in 0..n {
        let x = value(i);
        (sum, squares) = (sum + x, squares + x * x);
    }
    let mean = sum / n as f64;
    // rounding may leave less than nothing where all values are alike
    (mean, ((squares / n as f64 - mean * mean).max(0.0) / n as f64).sqrt())
}

fn agrees((mean, error): (f64, f64), right: f64, what: &str) {
    assert!(
        (mean - right).abs() < FIVE_SIGMA * error + 1e-9 * right,
        "{what}: {mean} ± {error}, not {right}"
    );
    assert!(error < 0.01 * right, "{what}: ± {error} of {right} could not tell");
}

/// Power that lands on black walls around lights of every kind is the power that they emit.
#[test]
fn all_that_is_emitted_lands() {
    let room = Surface::new(sphere(DVec3::new(0.1, 0.2, 0.0), 4.0, true), Material::lambert(BLACK, BLACK));
    let light = |shape| Surface::new(shape, Material::lambert(BLACK, LE));
    let rectangle = Shape::Rectangle(Rectangle {
        center: DVec3::new(0.5, 0.0, 0.3),
        half_u: DVec3::new(0.3, 0.0, 0.0),
        half_v: DVec3::new(0.0, 0.2, 0.0),
    });
    let disk = Shape::Disk(Disk { center: DVec3::new(-1.0, 0.3, 0.0), normal: DVec3::Y, radius: 0.7 });
    let ball = sphere(DVec3::new(0.0, -1.5, 0.0), 0.4, false);
    let point = PointLight { position: DVec3::new(0.2, 1.8, 0.1), intensity: LE };
    // no light sees the black back of another
    let cases = [
        (vec![light(rectangle)], None, PI * 4.0 * 0.3 * 0.2),
        (vec![light(disk)], None, PI * PI * 0.49),
        (vec![light(ball)], Some(point), PI * 4.0 * PI * 0.16 + 4.0 * PI),
    ];
    let particles = Particles { directions: Directions::Cosine, roulette: Roulette::unclamped(Rule::None) };
    let address = Address::of(&["power"]);
    for (lights, point, power) in cases {
        let surfaces = std::iter::once(room).chain(lights).collect();
        let scene = Scene::lit_by(surfaces, point.as_slice(), None, probe());
        for channel in 0..3 {
            let landed = mean(50_000, |i| {
                let mut tally = Tally::default();
                let mut sum = 0.0;
                particles.send(&mut Ctx::shared(&scene, address.stream(i, 0), &mut tally), &mut |_, _, p| {
                    sum += p.power[channel];
                });
                sum
            });
            agrees(landed, power * LE[channel], "power on black walls");
        }
    }
}

/// A sky sends through the scene what falls on a black ball there: π r² L per direction, times 4π directions.
#[test]
fn the_sky_sends_what_falls_on_a_ball() {
    let ball = Surface::new(sphere(DVec3::new(0.3, 0.2, 0.1), 0.5, false), Material::lambert(BLACK, BLACK));
    let far = Surface::new(sphere(DVec3::new(1.5, 0.2, 0.1), 0.1, false), Material::lambert(BLACK, BLACK));
    let up = DVec3::new(0.36, 0.48, 0.8);
    let skies =
        [(Sky::Uniform { radiance: LE }, 4.0 * PI), (Sky::Cosine { radiance: LE, exponent: 1.0, up }, PI)];
    for (sky, fluence) in skies {
        let scene = Scene::lit_by(vec![ball, far], &[], Some(sky), probe());
        let particles =
            Particles { directions: Directions::Cosine, roulette: Roulette::unclamped(Rule::None) };
        let address = Address::of(&["sky"]);
        let landed = mean(400_000, |i| {
            let mut tally = Tally::default();
            let mut sum = 0.0;
            particles.send(&mut Ctx::shared(&scene, address.stream(i, 0), &mut tally), &mut |_, x, p| {
                sum += if x.surface == 0 { p.power.x } else { 0.0 };
            });
            sum
        });
        // the small ball hides so little of the sky from the large one that one percent holds both
        let right = LE.x * fluence * PI * 0.25;
        assert!((landed.0 / right - 1.0).abs() < 0.012, "{landed:?}, not {right}");
    }
}

/// The sensor's importance, summed over a surface, is what its rays find there: both are ∫∫ dω dA of the same sensor.
#[test]
fn connections_are_the_adjoint_of_rays() {
    let plate = |half: f64| Rectangle {
        center: DVec3::new(0.2, 0.1, -1.3),
        half_u: DVec3::new(half, 0.0, 0.1 * half),
        half_v: DVec3::new(0.0, half, 0.0),
    };
    let (origin, forward) = (DVec3::new(0.1, -0.2, 0.9), DVec3::new(0.1, 0.05, -1.0).normalize());
    let camera = Camera::pinhole(origin, forward, DVec3::Y, 40.0, (3, 2));
    let lens = Camera { lens: Some(Lens { radius: 0.3, focus: 1.7 }), ..camera };
    let parallel = Sensor::Parallel {
        center: DVec3::new(0.1, 0.0, 0.8),
        direction: DVec3::new(0.2, 0.1, -1.0).normalize(),
        half_u: DVec3::new(0.3, 0.0, 0.0),
        half_v: DVec3::new(0.0, 0.2, 0.1),
    };
    let irradiance = Sensor::Irradiance { point: DVec3::new(0.0, 0.0, -0.2), normal: DVec3::NEG_Z, on: None };
    let address = Address::of(&["adjoint"]);
    for (name, sensor) in [
        ("pinhole", Sensor::Camera(camera)),
        ("lens", Sensor::Camera(lens)),
        ("parallel", parallel),
        ("irradiance", irradiance),
    ] {
        let rectangle = plate(1.7);
        let surface = Surface::new(Shape::Rectangle(rectangle), Material::lambert(Rgb::ONE, BLACK));
        let scene = Scene::new(vec![surface], sensor);
        let (width, height) = sensor.resolution();
        for pixel in 0..width * height {
            let (x, y) = (pixel % width, pixel / width);
            // a pattern on the plate, so that places are not confused
            let shine = |p: DVec3| 2.0 + (5.0 * p.x).sin() + (7.0 * p.y).cos();
            let seen = mean(300_000, |i| {
                let start = scene.start((x, y), &mut address.stream(i, u64::from(pixel)));
                scene.intersect(&start.ray, 0.0).map_or(0.0, |hit| shine(hit.p))
            });
            let sent = mean(300_000, |i| {
                let mut stream: Stream = address.stream(i, 1000);
                let (p, frame) = surface.sample_area(stream.u2());
                let Some(way) = sensor.connect(p, stream.u2()).filter(|way| way.pixel == pixel) else {
                    return 0.0;
                };
                assert!(scene.visible(&Ray { o: p, d: way.to_sensor, from: 0 }, 0.0, NOWHERE));
                shine(p) * frame.n.dot(way.wo).max(0.0) * way.importance * surface.shape.area()
            });
            let error = (seen.1 * seen.1 + sent.1 * sent.1).sqrt();
            assert!((seen.0 - sent.0).abs() < FIVE_SIGMA * error, "{name} {pixel}: {seen:?} {sent:?}");
            assert!(error < 0.02 * seen.0, "{name} {pixel}: {error} of {seen:?} could not tell");
        }
    }
}

/// Power goes through glass without the factor that radiance takes on.
#[test]
fn glass_keeps_the_power_of_particles() {
    let glass = Surface::new(
        sphere(DVec3::new(0.2, 0.1, 0.0), 1.0, false),
        Material { bsdf: Bsdf::Dielectric { ior: 1.5 }, le: BLACK },
    );
    let room = Surface::new(sphere(DVec3::ZERO, 3.0, true), Material::lambert(BLACK, BLACK));
    // inside of the ball, away from its centre
    let point = PointLight { position: DVec3::new(0.5, 0.3, 0.1), intensity: LE };
    let scene = Scene::lit_by(vec![glass, room], &[point], None, probe());
    let particles = Particles { directions: Directions::Cosine, roulette: Roulette::unclamped(Rule::Albedo) };
    let address = Address::of(&["glass"]);
    let n = 50_000;
    let mut sum = 0.0;
    for i in 0..n {
        let mut tally = Tally::default();
        let mut cx = Ctx::shared(&scene, address.stream(i, 0), &mut tally);
        particles.send(&mut cx, &mut |_, _, p| sum += p.power.x);
    }
    // every particle gets out of this ball, as none meets its wall above the critical angle for ever
    let right = 4.0 * PI * LE.x;
    assert!((sum / n as f64 / right - 1.0).abs() < 1e-3, "{} of {right}", sum / n as f64);
}
