//! Paths and rays per second on one core. Every value is written to the tally and folded into the block's moments, so
//! that the compiler cannot drop the geometry of a furnace, where radiance does not depend on where a ray goes.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use furnace::estimator::{Estimator, Explicit, Implicit, Roulette, Rule, Technique};
use furnace::experiment::run::block_of;
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use std::hint::black_box;

fn scenes() -> Vec<(&'static str, SceneKind, u64)> {
    let (albedo, emission, view) = (Rgb::new(0.8, 0.5, 0.2), Rgb::ONE, View::Probe);
    let light = Patch { fraction: 0.1, albedo, emission };
    let wall = Patch { fraction: 0.9, albedo, emission: Rgb::ZERO };
    let patches = vec![light, wall];
    vec![
        ("cornell_box", SceneKind::CornellBox { resolution: 256 }, 1),
        ("furnace", SceneKind::Furnace { albedo, emission, view }, 65_536),
        ("furnace_box", SceneKind::FurnaceBox { albedo, emission, view }, 65_536),
        ("integrating_sphere", SceneKind::IntegratingSphere { patches, looks_at: 1, view }, 65_536),
    ]
}

fn estimators() -> Vec<(&'static str, Estimator)> {
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    vec![
        (
            "explicit",
            Estimator::Explicit(Explicit { technique: Technique::Light, lights, directions, roulette }),
        ),
        ("implicit", Estimator::Implicit(Implicit { directions, roulette })),
    ]
}

fn paths(c: &mut Criterion) {
    let mut group = c.benchmark_group("paths");
    group.sample_size(20);
    for (scene_name, kind, realizations) in scenes() {
        let scene = kind.build();
        let (width, height) = scene.sensor.resolution();
        let paths = realizations * u64::from(width * height);
        for (name, estimator) in estimators() {
            let address = Address::of(&["bench", scene_name, name]);
            let draw = |number, pixel| address.stream(number, pixel);
            let run = || block_of(&scene, &estimator, &draw, &[], 0..realizations);
            let block = run();
            let rays = block.tally.rays as f64 / paths as f64;
            eprintln!("{scene_name} {name}: {rays:.3} rays a path, mean {:.5}", block.total[0].mean);
            group.throughput(Throughput::Elements(paths));
            group.bench_function(BenchmarkId::new(name, scene_name), |b| {
                b.iter(|| black_box(run()).tally.rays)
            });
        }
    }
    group.finish();
}

criterion_group!(benches, paths);
criterion_main!(benches);
