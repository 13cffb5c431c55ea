//! Paths a second on one core, of each estimator in each scene, by the textbook and by the fast path; and how an
//! experiment's time grows with threads, samples and cells.
//!
//! Every value is written to the tally and folded into the block's moments, so that the compiler cannot drop the geometry
//! of a furnace, where radiance does not depend on where a ray goes. Rays a path are printed: rays a second are paths a
//! second times these. Time is that of the processor, so that others on the machine disturb little; only over threads is it
//! that of the clock on the wall.

use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use furnace::estimator::{Estimator, Explicit, Heuristic, Implicit, Roulette, Rule, Technique};
use furnace::experiment::cell::Block;
use furnace::experiment::core::fast_block_of;
use furnace::experiment::run::block_of;
use furnace::experiment::{Cell, Overrides, Plan, run_cell, verdict};
use furnace::fast::Fast;
use furnace::sampling::Address;
use furnace::scene::lecture::Lecture;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb, Scene};
use furnace::truth::gallery;
use std::hint::black_box;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

fn scenes() -> Vec<(&'static str, SceneKind)> {
    let (albedo, emission, view) = (Rgb::new(0.8, 0.5, 0.2), Rgb::ONE, View::Probe);
    let light = Patch { fraction: 0.1, albedo, emission };
    let wall = Patch { fraction: 0.9, albedo, emission: Rgb::ZERO };
    let mut all = vec![
        ("cornell_box", SceneKind::CornellBox { resolution: 256 }),
        ("furnace", SceneKind::Furnace { albedo, emission, view }),
        ("furnace_box", SceneKind::FurnaceBox { albedo, emission, view }),
        (
            "integrating_sphere",
            SceneKind::IntegratingSphere { patches: vec![light, wall], looks_at: 1, view },
        ),
        ("indirect", SceneKind::Lecture(Lecture::Indirect { resolution: 256 })),
    ];
    let lit = gallery::EXHIBITS.iter().filter(|exhibit| exhibit.name == "unequal_lights");
    all.extend(lit.map(|exhibit| (exhibit.name, exhibit.scene(exhibit.parameter.usual))));
    all
}

fn estimators() -> Vec<(&'static str, Estimator)> {
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    let explicit = |technique| Estimator::Explicit(Explicit { technique, lights, directions, roulette });
    vec![
        ("implicit", Estimator::Implicit(Implicit { directions, roulette })),
        ("light", explicit(Technique::Light)),
        ("direction", explicit(Technique::Direction)),
        ("both", explicit(Technique::Both(Heuristic::Balance))),
    ]
}

/// Few and short, for there are many.
fn brief<'a>(c: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = c.benchmark_group(name);
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(800));
    group
}

/// What this thread has had of the processor so far; no such account is kept but on Linux.
fn processor() -> Option<Duration> {
    // the kernel brings it up to date when a thread gives way
    std::thread::yield_now();
    let account = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    account.split(' ').next()?.parse().ok().map(Duration::from_nanos)
}

/// Processor time of so many runs.
fn time<R>(runs: u64, run: impl Fn() -> R) -> Duration {
    let (wall, before) = (Instant::now(), processor());
    for _ in 0..runs {
        black_box(run());
    }
    before.zip(processor()).map_or_else(|| wall.elapsed(), |(before, after)| after - before)
}

/// 65 536 paths.
fn block(scene: &Scene, estimator: &Estimator, fast: Option<&Fast<'_>>, address: &Address) -> Block {
    let (width, height) = scene.sensor.resolution();
    let realizations = 0..65_536 / u64::from(width * height);
    match fast {
        Some(Fast::Paths(paths)) => fast_block_of(
            scene,
            paths,
            &|number, pixel| address.narrow_stream(number, pixel),
            &[],
            realizations,
        ),
        _ => block_of(scene, estimator, &|number, pixel| address.stream(number, pixel), &[], realizations),
    }
}

fn paths(c: &mut Criterion) {
    for (scene_name, kind) in scenes() {
        let scene = kind.build();
        let mut group = brief(c, scene_name);
        group.throughput(Throughput::Elements(65_536));
        for (name, estimator) in estimators() {
            let address = Address::of(&["bench", scene_name, name]);
            let textbook = block(&scene, &estimator, None, &address);
            let rays = textbook.tally.rays as f64 / 65_536.0;
            eprintln!("{scene_name} {name}: {rays:.2} rays a path, mean {:.4}", textbook.total[0].mean);
            let fast = Fast::of(&scene, &estimator).ok();
            group.bench_function(BenchmarkId::new("textbook", name), |b| {
                b.iter_custom(|runs| time(runs, || block(&scene, &estimator, None, &address)))
            });
            if fast.is_some() {
                group.bench_function(BenchmarkId::new("fast", name), |b| {
                    b.iter_custom(|runs| time(runs, || block(&scene, &estimator, fast.as_ref(), &address)))
                });
            }
        }
    }
}

const BOX: &str = r#"question = "How long?"
core = "CORE"
samples = SAMPLES
[[grid]]
scene = [{ cornell_box = { resolution = 128 } }]
estimator = ["explicit"]
roulette = [{ throughput = { from = 5 } }]
"#;

const FURNACES: &str = r#"question = "How long?"
core = "CORE"
samples = 16_384
[[claim]]
unbiased = { alpha = 1e-3, margin = 0.02 }
[[grid]]
scene = [{ furnace = { albedo = 0.5 } }]
estimator = ["implicit"]
roulette = [{ constant = { q = [QS] } }]
"#;

/// All that an experiment does but its reports: from the file's text to verdicts.
fn experiment(text: &str) -> usize {
    let plan = Plan::new("x", Path::new("x.toml"), text, &Overrides::default()).expect("a valid experiment");
    let stop = AtomicBool::new(false);
    let whole = |_: &mut Cell| false;
    let cells: Vec<_> = plan.cells.iter().map(|cell| run_cell(cell, &stop, &|_| (), &whole)).collect();
    verdict::rows(&plan, &cells).len()
}

fn growth(c: &mut Criterion) {
    for core in ["textbook", "fast"] {
        let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let of_samples = |n: u32| BOX.replace("CORE", core).replace("SAMPLES", &n.to_string());

        let mut group = brief(c, &format!("growth, {core}"));
        group.throughput(Throughput::Elements(64 * 16_384));
        for threads in [1, 2] {
            let pool = pool(threads);
            group.bench_function(BenchmarkId::new("threads", threads), |b| {
                b.iter(|| pool.install(|| experiment(&of_samples(64))))
            });
        }
        let one = pool(1);
        for samples in [8, 32, 128] {
            group.throughput(Throughput::Elements(u64::from(samples) * 16_384));
            group.bench_function(BenchmarkId::new("samples a pixel", samples), |b| {
                b.iter_custom(|runs| one.install(|| time(runs, || experiment(&of_samples(samples)))))
            });
        }
        for cells in [4, 16, 64] {
            let qs: Vec<String> =
                (0..cells).map(|i| format!("{:.4}", 0.5 + 0.4 * f64::from(i) / 64.0)).collect();
            let text = FURNACES.replace("CORE", core).replace("QS", &qs.join(", "));
            group.throughput(Throughput::Elements(cells as u64));
            group.bench_function(BenchmarkId::new("cells", cells), |b| {
                b.iter_custom(|runs| one.install(|| time(runs, || experiment(&text))))
            });
        }
    }
}

criterion_group!(benches, paths, growth);
criterion_main!(benches);
