//! Scenes and estimators that have a fast path, and paths followed by both.

use furnace::estimator::{Ctx, Estimate, Estimator, Roulette, Rule, Tally};
use furnace::fast::PathTracer;
use furnace::sampling::Address;
use furnace::scene::camera::Camera;
use furnace::scene::geometry::{Disk, Rectangle, Triangle};
use furnace::scene::lecture::Lecture;
use furnace::scene::library::{Patch, Primitive, SceneKind, Setting, View};
use furnace::scene::{Material, PointLight, Rgb, Scene, Sensor, Shape};
use furnace::truth::gallery::EXHIBITS;
use glam::DVec3;

/// What one path has come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    pub value: Rgb,
    pub rays: u64,
}

/// Termination rules of every kind, splitting among them.
pub fn rules() -> [(&'static str, Roulette); 6] {
    [
        ("none, 4 bounces", Roulette::depth_clamp(4)),
        ("constant 0.7", Roulette::unclamped(Rule::Constant { q: 0.7 })),
        ("constant 1.6, 5 bounces", Roulette { rule: Rule::Constant { q: 1.6 }, from: 0, clamp: Some(5) }),
        ("constant 3, 3 bounces", Roulette { rule: Rule::Constant { q: 3.0 }, from: 1, clamp: Some(3) }),
        ("albedo", Roulette { rule: Rule::Albedo, from: 1, clamp: Some(20) }),
        ("throughput", Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 2, clamp: None }),
    ]
}

/// Every scene of the library, small, and some that are here to have all kinds of surfaces and lights.
pub fn scenes() -> Vec<(String, SceneKind)> {
    let (albedo, emission) = (Rgb::new(0.8, 0.5, 0.2), Rgb::new(1.0, 0.5, 2.0));
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let patches = vec![
        patch(0.1, albedo, emission),
        patch(0.4, Rgb::new(0.2, 0.9, 0.5), Rgb::ZERO),
        patch(0.5, albedo, Rgb::ZERO),
    ];
    let mut all = vec![
        ("cornell_box".to_owned(), SceneKind::CornellBox { resolution: 24 }),
        ("cornell_empty".to_owned(), SceneKind::CornellEmpty { resolution: 24 }),
        ("cornell_flush".to_owned(), SceneKind::CornellFlush { tile: 2, blocks: true }),
        ("mixed".to_owned(), SceneKind::Custom(mixed(false))),
        ("mixed with a point light".to_owned(), SceneKind::Custom(mixed(true))),
        ("indirect".to_owned(), SceneKind::Lecture(Lecture::Indirect { resolution: 24 })),
        ("dof".to_owned(), SceneKind::Lecture(Lecture::Dof { aperture: 0.08, resolution: 24 })),
        ("motion".to_owned(), SceneKind::Lecture(Lecture::Motion { travel: 0.5, resolution: 8 })),
        ("smallpt".to_owned(), SceneKind::Lecture(Lecture::Smallpt { resolution: 6 })),
    ];
    for view in [View::Probe, View::Irradiance] {
        let patches = patches.clone();
        all.push((format!("furnace {view:?}"), SceneKind::Furnace { albedo, emission, view }));
        all.push((format!("furnace_box {view:?}"), SceneKind::FurnaceBox { albedo, emission, view }));
        all.push((format!("sphere {view:?}"), SceneKind::IntegratingSphere { patches, looks_at: 2, view }));
    }
    let exhibits = EXHIBITS.iter().map(|e| (e.name.to_owned(), e.scene(e.parameter.usual)));
    all.into_iter().chain(exhibits).collect()
}

/// A rectangle, a triangle, a disk and two spheres between lights of three shapes, seen by a camera.
fn mixed(with_point: bool) -> Setting {
    let matt = |r, g, b| Material::lambert(Rgb::new(r, g, b), Rgb::ZERO);
    let lamp = |le: f64| Material::lambert(Rgb::splat(0.3), Rgb::splat(le));
    let still = |shape, material| Primitive { shape, material, velocity: DVec3::ZERO };
    let v = DVec3::new;
    let ball = |center, radius, low| {
        let (axis, high) = (v(0.6, 0.0, 0.8), 1.0);
        Shape::Sphere(furnace::scene::geometry::SpherePatch {
            center,
            radius,
            axis,
            low,
            high,
            inward: false,
        })
    };
    let floor = Rectangle { center: v(0.1, 0.0, 0.2), half_u: v(0.0, 0.0, 3.0), half_v: v(3.0, 0.0, 0.0) };
    let sail = Triangle { a: v(-2.0, 0.1, -1.5), b: v(2.0, 0.2, -1.6), c: v(0.2, 3.0, -1.2) };
    let plate = Disk { center: v(1.5, 0.7, 0.3), normal: v(-0.6, 0.8, 0.0), radius: 0.8 };
    let over = Disk { center: v(0.0, 3.5, 0.5), normal: v(0.0, -1.0, 0.0), radius: 0.7 };
    let side = Triangle { a: v(-2.5, 1.0, 1.0), b: v(-2.5, 1.0, -0.5), c: v(-2.4, 2.5, 0.2) };
    let camera = Camera::pinhole(v(0.3, 1.4, 5.0), v(-0.05, -0.1, -1.0), DVec3::Y, 50.0, (24, 24));
    let point = PointLight { position: v(-0.8, 2.2, 1.9), intensity: Rgb::new(3.0, 2.0, 1.0) };
    Setting {
        primitives: vec![
            still(Shape::Rectangle(floor), matt(0.7, 0.6, 0.5)),
            still(Shape::Triangle(sail), matt(0.2, 0.7, 0.3)),
            still(Shape::Disk(plate), matt(0.8, 0.2, 0.2)),
            still(ball(v(-0.9, 0.6, 0.2), 0.6, -1.0), matt(0.5, 0.5, 0.9)),
            still(ball(v(0.4, 0.5, 0.9), 0.5, -0.3), matt(0.9, 0.9, 0.4)),
            still(Shape::Disk(over), lamp(6.0)),
            still(Shape::Triangle(side), lamp(4.0)),
            still(ball(v(2.2, 2.4, -0.4), 0.3, -1.0), lamp(9.0)),
        ],
        points: if with_point { vec![point] } else { Vec::new() },
        sky: None,
        sensor: Sensor::Camera(camera),
    }
}

/// The narrow streams of paths, of which number `i` measures pixel `i` modulo the pixels.
fn starts<'a>(
    scene: &'a Scene,
    seed: &str,
    paths: u64,
) -> impl Iterator<Item = (furnace::scene::Start, furnace::sampling::Stream)> + 'a {
    let address = Address::of(&["fast paths agree", seed]);
    let (width, height) = scene.sensor.resolution();
    let pixels = u64::from(width * height);
    (0..paths).map(move |path| {
        let pixel = path % pixels;
        let mut stream = address.narrow_stream(path / pixels, pixel);
        let at = ((pixel % u64::from(width)) as u32, (pixel / u64::from(width)) as u32);
        (scene.start(at, &mut stream), stream)
    })
}

/// Paths by the estimator itself.
pub fn textbook(scene: &Scene, estimator: &Estimator, seed: &str, paths: u64) -> Vec<Told> {
    let mut told = Vec::new();
    for (start, stream) in starts(scene, seed, paths) {
        let mut tally = Tally::default();
        let pass = estimator.begin(0, &mut Ctx::shared(scene, stream.clone(), &mut Tally::default()));
        estimator.estimate(&pass, start.ray, &mut Ctx::new(scene, stream, &mut tally, &start));
        told.push(Told { value: tally.value, rays: tally.rays });
    }
    told
}

/// The same paths by the fast path.
pub fn fast(scene: &Scene, fast: &PathTracer<'_>, seed: &str, paths: u64) -> Vec<Told> {
    let mut starts = starts(scene, seed, paths);
    let (mut told, mut rays) = (Vec::new(), 0);
    fast.trace(&mut Tally::default(), &mut || starts.next(), &mut |tally| {
        told.push(Told { value: tally.value, rays: tally.rays - rays });
        rays = tally.rays;
    });
    told
}
