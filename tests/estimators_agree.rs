//! Estimators that find light in unlike ways must find the same light: bounce by bounce, in total, and that of an
//! independent renderer. Mistakes that a closed form in a symmetric scene cannot show (visibility, distances, cosines,
//! the choice among lights) differ between them.
//!
//! False alarms: about 1200 tests, each beyond [`LIMIT`] standard errors of both means with probability 1e-14 or less, as
//! only means are compared that are known to 5 %: light that is found by chance and rarely, as late bounces are by
//! implicit estimators, is no matter for a t test. Together 2e-11.

use furnace::estimator::{
    Estimate, Estimator, Explicit, Implicit, Property, Recursive, Roulette, Rule, Technique,
};
use furnace::experiment::{Cell, sample};
use furnace::sampling::Address;
use furnace::scene::camera::Camera;
use furnace::scene::geometry::{Disk, Rectangle, SpherePatch, Triangle};
use furnace::scene::library::{Primitive, SceneKind, Setting};
use furnace::scene::{Directions, LightSampling, Material, Rgb, Sensor, Shape};
use furnace::stats::Moments;
use furnace::truth::Reference;
use glam::DVec3;

const LIMIT: f64 = 10.0;
const BLOCKS: u64 = 128;

/// A mean with its standard error.
#[derive(Clone, Copy)]
struct Mean(f64, f64);

impl From<&Moments> for Mean {
    fn from(blocks: &Moments) -> Self {
        Mean(blocks.mean, blocks.std_error().unwrap())
    }
}

fn agree(what: &str, a: Mean, b: Mean) {
    for mean in [a, b] {
        assert!(mean.1 <= 0.05 * mean.0, "{what}: {} ± {} is too uncertain to be compared", mean.0, mean.1);
    }
    let t = (a.0 - b.0) / a.1.hypot(b.1);
    assert!(t.abs() <= LIMIT || a.0 == b.0, "{what}: {} ± {} and {} ± {}, t = {t}", a.0, a.1, b.0, b.1);
}

fn explicit(lights: LightSampling, directions: Directions, roulette: Roulette) -> Estimator {
    Estimator::Explicit(Explicit { technique: Technique::Light, lights, directions, roulette })
}

/// Throughput roulette bounds throughput whatever directions are drawn, so that variances are finite.
const THROUGHPUT: Roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 2, clamp: None };

fn unbiased() -> Vec<Estimator> {
    let mut all = Vec::new();
    for directions in [Directions::Cosine, Directions::Uniform] {
        all.push(Estimator::Implicit(Implicit { directions, roulette: THROUGHPUT }));
        all.push(explicit(LightSampling::AREA, directions, THROUGHPUT));
        all.push(explicit(LightSampling::SOLID_ANGLE, directions, THROUGHPUT));
    }
    all
}

fn clamped() -> Vec<Estimator> {
    let (roulette, directions) = (Roulette::depth_clamp(3), Directions::Cosine);
    vec![
        Estimator::Implicit(Implicit { directions, roulette }),
        Estimator::Recursive(Recursive { samples: 2, directions, roulette }),
        Estimator::Recursive(Recursive { samples: 3, directions, roulette }),
        explicit(LightSampling::SOLID_ANGLE, directions, roulette),
    ]
}

fn cells(scene: &SceneKind, estimators: Vec<Estimator>, passes: u64) -> Vec<(Estimator, Cell)> {
    let built = scene.build();
    let cell = |estimator: &Estimator| {
        let address = Address::of(&["estimators_agree", &format!("{scene:?} {estimator:?}")]);
        // light that is found by chance takes more samples; they cost less
        let passes = if matches!(estimator, Estimator::Implicit(_)) { 2 * passes } else { passes };
        let cell = sample(&built, estimator, &address, BLOCKS * passes, passes);
        assert_eq!(cell.invalid(), None);
        cell
    };
    estimators.into_iter().map(|e| (e, cell(&e))).collect()
}

/// The last bounce that an estimator finds often enough in a scene where next-event estimation finds those up to `last`.
fn reach(estimator: &Estimator, last: usize) -> usize {
    match (estimator, estimator.property()) {
        (Estimator::Implicit(e), _) => 1 + usize::from(e.directions == Directions::Cosine),
        (_, Property::Clamped { bounces }) => bounces as usize,
        (_, Property::Unbiased | Property::Consistent { .. }) => last,
    }
}

/// All pairs bounce by bounce, and in total where both leave out the same bounces.
fn all_pairs_agree(cells: &[(Estimator, Cell)], last: usize) {
    for (i, (one, a)) in cells.iter().enumerate() {
        for ((other, b), c) in cells[..i].iter().flat_map(|other| [0, 1, 2].map(|c| (other, c))) {
            for bounce in 0..=reach(one, last).min(reach(other, last)) {
                let what = format!("bounce {bounce}, channel {c} of {one:?} and {other:?}");
                agree(&what, (&a.bounces[bounce][c]).into(), (&b.bounces[bounce][c]).into());
            }
            if one.property() == other.property() {
                let what = format!("channel {c} of {one:?} and {other:?}");
                agree(&what, (&a.blocks[c]).into(), (&b.blocks[c]).into());
            }
        }
    }
}

fn cornell(scene: SceneKind) {
    let stored = Reference::of(&scene).unwrap().image();
    let (unbiased, clamped) = (cells(&scene, unbiased(), 1), cells(&scene, clamped(), 1));
    for (estimator, cell) in &unbiased {
        for c in 0..3 {
            let right = Mean(stored.mean[c], stored.std_error[c]);
            agree(&format!("{estimator:?} and the reference"), (&cell.blocks[c]).into(), right);
        }
    }
    for (_, cell) in &clamped {
        assert!(cell.bounces[4..].iter().flatten().all(|late| late.mean == 0.0 && late.m2 == 0.0));
    }
    let all: Vec<_> = unbiased.into_iter().chain(clamped).collect();
    all_pairs_agree(&all, 5);
}

#[test]
fn in_the_cornell_box() {
    cornell(SceneKind::CornellBox { resolution: 32 });
}

#[test]
fn in_the_empty_cornell_box() {
    cornell(SceneKind::CornellEmpty { resolution: 32 });
}

/// A room of two walls and a floor, with a light of every shape, of unequal sizes, colours and albedos: a rectangle, a
/// disk that is tilted, a triangle, a whole sphere, and a disk that turns its black back to the walls. A reflecting
/// sphere casts shadows, and a panel has all lights at its back. Nothing that shines touches anything, so that the
/// variance is finite for area sampling too.
fn odd_lights() -> SceneKind {
    let at = DVec3::new;
    let one = |shape, albedo, emission| Primitive {
        shape,
        material: Material::lambert(albedo, emission),
        velocity: DVec3::ZERO,
    };
    let wall = |center, half_u, half_v| Shape::Rectangle(Rectangle { center, half_u, half_v });
    let ball = |center, radius| {
        Shape::Sphere(SpherePatch { center, radius, axis: DVec3::Z, low: -1.0, high: 1.0, inward: false })
    };
    let disk =
        |center, normal: DVec3, radius| Shape::Disk(Disk { center, normal: normal.normalize(), radius });
    let (a, b, c) = (at(-1.5, 2.2, 0.4), at(-1.2, 1.4, 0.9), at(-0.4, 2.0, 0.3));
    let primitives = vec![
        one(wall(at(0.0, 0.0, 0.0), 2.0 * DVec3::Z, 2.0 * DVec3::X), Rgb::new(0.8, 0.7, 0.5), Rgb::ZERO),
        one(wall(at(0.0, 1.5, -1.2), 2.0 * DVec3::X, 1.5 * DVec3::Y), Rgb::new(0.3, 0.6, 0.8), Rgb::ZERO),
        one(wall(at(-2.0, 1.5, 0.0), 1.5 * DVec3::Y, 2.0 * DVec3::Z), Rgb::new(0.7, 0.2, 0.2), Rgb::ZERO),
        one(wall(at(-0.4, 0.4, 1.4), 0.5 * DVec3::X, 0.3 * DVec3::Y), Rgb::new(0.9, 0.8, 0.7), Rgb::ZERO),
        one(ball(at(0.4, 0.6, 0.1), 0.5), Rgb::new(0.6, 0.6, 0.9), Rgb::ZERO),
        one(
            wall(at(0.6, 2.3, 0.2), 0.5 * DVec3::X, 0.4 * DVec3::Z),
            Rgb::new(0.5, 0.1, 0.3),
            at(3.0, 2.0, 0.5),
        ),
        one(disk(at(1.3, 1.1, -0.5), at(-1.0, 0.2, 0.3), 0.45), Rgb::ZERO, at(0.4, 4.0, 1.0)),
        one(Shape::Triangle(Triangle { a, b, c }), Rgb::splat(0.4), at(1.0, 0.2, 6.0)),
        one(ball(at(-0.9, 0.5, 0.5), 0.25), Rgb::new(0.2, 0.7, 0.2), at(2.0, 3.0, 4.0)),
        one(disk(at(-0.3, 1.2, -0.7), DVec3::Z, 0.3), Rgb::splat(0.5), at(5.0, 0.3, 0.1)),
    ];
    let eye = at(1.2, 1.6, 4.5);
    let camera = Camera::pinhole(eye, at(-0.1, 1.0, 0.0) - eye, DVec3::Y, 45.0, (16, 16));
    SceneKind::Custom(Setting { primitives, points: Vec::new(), sky: None, sensor: Sensor::Camera(camera) })
}

#[test]
fn among_lights_of_every_shape() {
    all_pairs_agree(&cells(&odd_lights(), unbiased(), 6), 3);
}
