//! Photons a second on one core: sent and stored, and gathered around what the eye sees, in the lecture's setting.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use furnace::estimator::{
    Ctx, DirectLight, Estimate, Estimator, Gather, Kernel, Last, LightTracing, PhotonMap, Roulette, Rule,
    Tally,
};
use furnace::fast::Fast;
use furnace::sampling::Address;
use furnace::scene::Directions;
use furnace::scene::library::SceneKind;
use std::hint::black_box;

const PHOTONS: u64 = 200_000;

fn map(gather: Gather) -> PhotonMap {
    PhotonMap {
        photons: PHOTONS,
        gather,
        kernel: Kernel::Box,
        direct: DirectLight::Photons,
        final_gather: 0,
        directions: Directions::Cosine,
        roulette: Roulette::unclamped(Rule::Albedo),
    }
}

fn photons(c: &mut Criterion) {
    let scene = SceneKind::CornellBox { resolution: 256 }.build();
    let address = Address::of(&["bench", "photons"]);
    let mut group = c.benchmark_group("photons");
    group.sample_size(10);
    group.throughput(Throughput::Elements(PHOTONS));
    group.bench_function("sent and stored", |b| {
        b.iter(|| {
            let mut tally = Tally::default();
            let mut cx = Ctx::shared(&scene, address.stream(0, 0), &mut tally);
            black_box(map(Gather::Within { radius: 0.05 }).begin(0, &mut cx)).len()
        })
    });
    let light = LightTracing {
        particles: PHOTONS,
        directions: Directions::Cosine,
        roulette: Roulette::unclamped(Rule::Albedo),
    };
    group.bench_function("light tracing", |b| {
        b.iter(|| {
            let mut tally = Tally::default();
            let mut cx = Ctx::shared(&scene, address.stream(0, 0), &mut tally);
            black_box(light.begin(0, &mut cx)).at(7).count()
        })
    });
    let stored = map(Gather::Within { radius: 0.05 });
    let Ok(Fast::Particles(fast)) = Fast::of(&scene, &Estimator::PhotonMap(stored)) else { unreachable!() };
    group.bench_function("sent and stored, fast path", |b| {
        b.iter(|| black_box(fast.map(&stored, 0, &address, &mut Tally::default())).len())
    });
    group.bench_function("light tracing, fast path", |b| {
        b.iter(|| black_box(fast.film(&light, &address, &mut Tally::default())).at(7).count())
    });
    group.finish();

    let mut group = c.benchmark_group("gathers");
    group.sample_size(10);
    let nearest = |k| Gather::Nearest { k, last: Last::LeftOut };
    let ways = [("k=50", nearest(50)), ("k=500", nearest(500)), ("r=0.02", Gather::Within { radius: 0.02 })];
    for (name, gather) in ways {
        let map = map(gather);
        let mut tally = Tally::default();
        let pass = map.begin(0, &mut Ctx::shared(&scene, address.stream(0, 0), &mut tally));
        eprintln!("{} photons stored", pass.len());
        // every fifth row
        group.throughput(Throughput::Elements(256 * 52));
        group.bench_function(BenchmarkId::new("eye rays", name), |b| {
            b.iter(|| {
                let mut tally = Tally::default();
                for y in (0..256).step_by(5) {
                    for x in 0..256 {
                        let mut stream = address.stream(1, u64::from(256 * y + x));
                        let start = scene.start((x, y), &mut stream);
                        map.estimate(&pass, start.ray, &mut Ctx::new(&scene, stream, &mut tally, &start));
                    }
                }
                tally.bounces[1]
            })
        });
    }
    group.finish();
}

criterion_group!(benches, photons);
criterion_main!(benches);
