//! What single precision does to the mean: the same paths by the fast path and by the textbook, their difference relative
//! to the mean, with its standard error. Not a benchmark of time; here because it takes minutes.

use furnace::estimator::{Ctx, Estimate, Estimator, Explicit, Heuristic, Roulette, Rule, Tally, Technique};
use furnace::fast::{Fast, PathTracer};
use furnace::sampling::Address;
use furnace::scene::lecture::Lecture;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb, Scene};
use furnace::truth::gallery;
use rayon::prelude::*;

const BATCH: u64 = 1 << 14;

fn scenes() -> Vec<(&'static str, SceneKind)> {
    let (albedo, emission, view) = (Rgb::new(0.8, 0.5, 0.2), Rgb::ONE, View::Probe);
    let light = Patch { fraction: 0.1, albedo, emission };
    let wall = Patch { fraction: 0.9, albedo, emission: Rgb::ZERO };
    let mut all = vec![
        ("cornell_box", SceneKind::CornellBox { resolution: 128 }),
        ("cornell_empty", SceneKind::CornellEmpty { resolution: 128 }),
        ("cornell_flush", SceneKind::CornellFlush { tile: 2, blocks: true }),
        ("furnace", SceneKind::Furnace { albedo, emission, view }),
        ("furnace_box", SceneKind::FurnaceBox { albedo, emission, view }),
        (
            "integrating_sphere",
            SceneKind::IntegratingSphere { patches: vec![light, wall], looks_at: 1, view },
        ),
        ("indirect", SceneKind::Lecture(Lecture::Indirect { resolution: 128 })),
        ("dof", SceneKind::Lecture(Lecture::Dof { aperture: 0.08, resolution: 128 })),
    ];
    for exhibit in gallery::EXHIBITS {
        all.push((exhibit.name, exhibit.scene(exhibit.parameter.usual)));
    }
    all
}

/// Sum of the values, of the differences, and of their squares.
fn batch(
    scene: &Scene,
    estimator: &Estimator,
    fast: &PathTracer<'_>,
    address: &Address,
    batch: u64,
) -> [f64; 3] {
    let (width, height) = scene.sensor.resolution();
    let pixels = u64::from(width * height);
    let starts = || {
        (batch * BATCH..(batch + 1) * BATCH).map(|path| {
            let pixel = path % pixels;
            let mut stream = address.narrow_stream(path / pixels, pixel);
            let (x, y) = (pixel % u64::from(width), pixel / u64::from(width));
            (scene.start((x as u32, y as u32), &mut stream), stream)
        })
    };
    let (mut set_out, mut values) = (starts(), Vec::new());
    fast.trace(&mut Tally::default(), &mut || set_out.next(), &mut |tally| values.push(tally.value));
    let mut sums = [0.0; 3];
    for ((start, stream), value) in starts().zip(values) {
        let mut tally = Tally::default();
        let pass = estimator.begin(0, &mut Ctx::shared(scene, stream.clone(), &mut Tally::default()));
        estimator.estimate(&pass, start.ray, &mut Ctx::new(scene, stream, &mut tally, &start));
        let difference = (value - tally.value).element_sum();
        sums = [sums[0] + tally.value.element_sum(), sums[1] + difference, sums[2] + difference * difference];
    }
    sums
}

fn main() {
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    let explicit = |technique| Estimator::Explicit(Explicit { technique, lights, directions, roulette });
    let wanted: Vec<String> = std::env::args().skip(1).filter(|arg| arg != "--bench").collect();
    for (scene_name, kind) in scenes() {
        if !wanted.is_empty() && !wanted.iter().any(|name| name == scene_name) {
            continue;
        }
        let scene = kind.build();
        for (name, technique) in [
            ("light", Technique::Light),
            ("direction", Technique::Direction),
            ("both", Technique::Both(Heuristic::Balance)),
        ] {
            let estimator = explicit(technique);
            let fast = match Fast::of(&scene, &estimator) {
                Ok(Fast::Paths(paths)) => paths,
                Ok(Fast::Particles(_)) => unreachable!("it is a path tracer"),
                Err(why) => {
                    println!("{scene_name}: no fast path: {why}");
                    break;
                }
            };
            let address = Address::of(&["rounding", scene_name, name]);
            let batches = 256;
            let sums: Vec<[f64; 3]> =
                (0..batches).into_par_iter().map(|b| batch(&scene, &estimator, &fast, &address, b)).collect();
            let [sum, difference, squares] =
                sums.iter().fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
            println!("{scene_name} {name}: {:+.1e} ± {:.1e}", difference / sum, squares.sqrt() / sum);
        }
    }
}
