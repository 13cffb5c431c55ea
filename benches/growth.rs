//! How the cost of a ray grows with the number of primitives: nanoseconds on one core for the closest hit and for a shadow
//! ray, of rays as paths make them, in rooms with ten to a hundred thousand balls; and what it takes to build these rooms.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use furnace::sampling::Address;
use furnace::scene::library::SceneKind;
use furnace::scene::{Carried, Directions, LightSampling, Ray, Scene};
use std::hint::black_box;

const COUNTS: [u32; 5] = [10, 100, 1000, 10_000, 100_000];
/// Few enough to stay in the cache beside what they meet.
const RAYS: usize = 16_384;
const RESOLUTION: u32 = 64;

fn room(count: u32) -> Scene {
    SceneKind::ManySpheres { count, resolution: RESOLUTION }.build()
}

/// The rays of paths with next-event estimation that end with probability 0.3 at each vertex, and their shadow rays, each
/// with the light's surface; in the order of the paths.
fn of_paths(scene: &Scene) -> (Vec<Ray>, Vec<(Ray, u32)>) {
    let address = Address::of(&["bench", "growth"]);
    let (mut rays, mut shadows) = (Vec::new(), Vec::new());
    for path in 0.. {
        if rays.len() >= RAYS && shadows.len() >= RAYS {
            break;
        }
        // pixels in an order without neighbours
        let pixel = (path * 1283 % u64::from(RESOLUTION * RESOLUTION)) as u32;
        let mut stream = address.stream(path, 0);
        let mut ray = scene.start((pixel % RESOLUTION, pixel / RESOLUTION), &mut stream).ray;
        loop {
            rays.push(ray);
            let Some(x) = scene.intersect(&ray, 0.0) else { break };
            let light = scene.sample_light(LightSampling::AREA, (x.p, 0.0), stream.u1(), stream.u2());
            if let Some(light) = light.filter(|light| x.frame.n.dot(light.to_light) > 0.0) {
                shadows.push((x.spawn(light.to_light), light.surface));
            }
            if stream.u1() < 0.3 {
                break;
            }
            let bsdf = &x.material.bsdf;
            ray = x.spawn(bsdf.sample(Carried::Radiance, Directions::Cosine, &x.frame, x.wo, stream.u2()).wi);
        }
    }
    rays.truncate(RAYS);
    shadows.truncate(RAYS);
    (rays, shadows)
}

fn growth(c: &mut Criterion) {
    for tree in [true, false] {
        let mut group = c.benchmark_group(if tree { "growth" } else { "growth without tree" });
        group.sample_size(30);
        group.throughput(Throughput::Elements(RAYS as u64));
        for count in COUNTS.into_iter().filter(|&count| tree || count <= 1000) {
            let scene = if tree { room(count) } else { room(count).without_tree() };
            let (rays, shadows) = of_paths(&scene);
            group.bench_function(BenchmarkId::new("closest hit", count), |b| {
                b.iter(|| rays.iter().filter(|ray| black_box(scene.intersect(ray, 0.0)).is_some()).count())
            });
            group.bench_function(BenchmarkId::new("shadow ray", count), |b| {
                b.iter(|| shadows.iter().filter(|(ray, to)| scene.visible(ray, 0.0, *to)).count())
            });
        }
    }
    let mut group = c.benchmark_group("growth");
    group.sample_size(10);
    for count in COUNTS {
        group.bench_function(BenchmarkId::new("built", count), |b| b.iter(|| room(count)));
    }
}

criterion_group!(benches, growth);
criterion_main!(benches);
