//! Light tracing finds what path tracing finds, bounce by bounce, wherever both can look; and what only particles find
//! has its closed form.

use furnace::estimator::{
    BINS, Estimator, Explicit, Implicit, LightTracing, Property, Roulette, Rule, Technique,
};
use furnace::experiment::Cell;
use furnace::experiment::run::sample;
use furnace::sampling::Address;
use furnace::scene::library::{SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb, Scene};

fn light_tracing(particles: u64, roulette: Roulette) -> Estimator {
    Estimator::LightTracing(LightTracing { particles, directions: Directions::Cosine, roulette })
}

fn cell(scene: &Scene, estimator: &Estimator, samples: u64, block: u64) -> Cell {
    let name = format!("{estimator:?}");
    sample(scene, estimator, &Address::of(&["light tracing", &name]), samples, block)
}

/// Within five standard errors, in total and per bounce, with errors small enough to notice six percent of the whole.
fn agree(a: &Cell, b: &Cell) {
    for channel in 0..3 {
        let whole = a.blocks[channel].mean;
        for bin in 0..=BINS {
            let of =
                |cell: &Cell| if bin == BINS { cell.blocks[channel] } else { cell.bounces[bin][channel] };
            let (a, b) = (of(a), of(b));
            let error = a.std_error().unwrap().hypot(b.std_error().unwrap());
            let slack = 5.0 * error + 1e-12 * whole;
            assert!((a.mean - b.mean).abs() <= slack, "{channel} {bin}: {} {} ± {error}", a.mean, b.mean);
            assert!(slack < 0.06 * whole, "{channel} {bin}: {error} of {whole} could not tell");
        }
    }
}

#[test]
fn in_the_cornell_box() {
    let scene = SceneKind::CornellBox { resolution: 8 }.build();
    let roulette = Roulette::unclamped(Rule::Albedo);
    let explicit = Estimator::Explicit(Explicit {
        technique: Technique::Light,
        lights: LightSampling::AREA,
        directions: Directions::Cosine,
        roulette,
    });
    agree(&cell(&scene, &explicit, 20_000, 100), &cell(&scene, &light_tracing(64, roulette), 20_000, 100));
}

/// A tile of the flush box is seen by parallel rays.
#[test]
fn by_parallel_rays() {
    let scene = SceneKind::CornellFlush { tile: 3, blocks: true }.build();
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.1 }, from: 2, clamp: Some(4) };
    let explicit = Estimator::Explicit(Explicit {
        technique: Technique::Light,
        lights: LightSampling::AREA,
        directions: Directions::Cosine,
        roulette,
    });
    agree(&cell(&scene, &explicit, 400_000, 4000), &cell(&scene, &light_tracing(20, roulette), 60_000, 600));
}

/// In a furnace every bounce has its closed form, and a plate is lit from everywhere.
#[test]
fn on_a_plate_in_a_furnace() {
    let (albedo, emission) = (Rgb::new(0.8, 0.5, 0.2), Rgb::new(1.0, 0.5, 2.0));
    let scene = SceneKind::Furnace { albedo, emission, view: View::Irradiance }.build();
    let roulette = Roulette::unclamped(Rule::Constant { q: 0.7 });
    let implicit = Estimator::Implicit(Implicit { directions: Directions::Uniform, roulette });
    let estimator = light_tracing(3, roulette);
    assert_eq!(furnace::estimator::Estimate::property(&estimator), Property::Unbiased);
    agree(&cell(&scene, &implicit, 1_000_000, 10_000), &cell(&scene, &estimator, 400_000, 4000));
}

/// Splitting sends copies, each with its share.
#[test]
fn with_splitting() {
    let scene = SceneKind::CornellBox { resolution: 8 }.build();
    let one = Roulette { rule: Rule::Constant { q: 1.0 }, from: 0, clamp: Some(3) };
    let many = Roulette { rule: Rule::Constant { q: 1.6 }, ..one };
    let of = |roulette| cell(&scene, &light_tracing(64, roulette), 20_000, 100);
    agree(&of(one), &of(many));
}
