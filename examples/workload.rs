//! A fixed workload on one thread, to be measured from outside: `benches/compare.sh` and `benches/instructions.sh` run it.
//!
//!     cargo run --release --example workload -- WORKLOAD CORE REALIZATIONS [FIRST [RESOLUTION [FILE]]]
//!
//! Prints one line: CPU seconds of the sampling alone (Linux; 0 elsewhere), paths, rays, instruction set. FILE takes six
//! little-endian doubles a pixel, row by row: the mean of its samples and their variance, by channel.

#![forbid(unsafe_code)]

use furnace::estimator::{
    Ctx, DirectLight, Estimate, Estimator, Explicit, Gather, Heuristic, Implicit, Kernel, Last, PhotonMap,
    Roulette, Rule, Tally, Technique,
};
use furnace::experiment::core::fast_block_of;
use furnace::experiment::run::block_of;
use furnace::fast::{Fast, Level, instruction_set};
use furnace::sampling::Address;
use furnace::scene::library::{SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb, Scene};
use std::error::Error;
use std::hint::black_box;

/// Photons of one realization of `photons`.
const PHOTONS: u64 = 10_000;

/// A scene and what measures it.
fn workload(name: &str, resolution: u32) -> Result<(SceneKind, Estimator), String> {
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    let explicit = |technique| Estimator::Explicit(Explicit { technique, lights, directions, roulette });
    let (albedo, emission) = (Rgb::new(0.8, 0.5, 0.2), Rgb::ONE);
    let cornell = SceneKind::CornellBox { resolution };
    Ok(match name {
        "light" => (cornell, explicit(Technique::Light)),
        "both" => (cornell, explicit(Technique::Both(Heuristic::Power))),
        "implicit" => (cornell, Estimator::Implicit(Implicit { directions, roulette })),
        "furnace" => (
            SceneKind::Furnace { albedo, emission, view: View::Probe },
            Estimator::Implicit(Implicit { directions, roulette }),
        ),
        "photons" => {
            let map = PhotonMap {
                photons: PHOTONS,
                gather: Gather::Nearest { k: 50, last: Last::LeftOut },
                kernel: Kernel::Box,
                direct: DirectLight::Photons,
                final_gather: 0,
                directions,
                roulette: Roulette::unclamped(Rule::Albedo),
            };
            (cornell, Estimator::PhotonMap(map))
        }
        _ => return Err(format!("no workload {name}: light, both, implicit, furnace, photons")),
    })
}

/// CPU time of this thread so far, in seconds.
fn cpu_seconds() -> f64 {
    // the kernel brings its account up to date when a thread gives way
    std::thread::yield_now();
    let account = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    account.split(' ').next().and_then(|nanoseconds| nanoseconds.parse::<f64>().ok()).unwrap_or(0.0) * 1e-9
}

/// Sends photons out and stores them; the number of their rays.
fn emit(scene: &Scene, map: &impl Estimate, address: &Address, realizations: std::ops::Range<u64>) -> u64 {
    let mut tally = Tally::default();
    for realization in realizations {
        let stream = address.stream(realization, 0);
        black_box(map.begin(realization, &mut Ctx::shared(scene, stream, &mut tally)));
    }
    tally.rays
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [name, core, realizations, rest @ ..] = &args[..] else {
        return Err("WORKLOAD CORE REALIZATIONS [FIRST [RESOLUTION [FILE]]]".into());
    };
    let first: u64 = rest.first().map_or(Ok(0), |text| text.parse())?;
    let resolution = rest.get(1).map_or(Ok(256), |text| text.parse())?;
    let (kind, estimator) = workload(name, resolution)?;
    let scene = kind.build();
    let realizations = first..first + realizations.parse::<u64>()?;
    let address = Address::of(&["workload", name]);
    let (width, height) = scene.sensor.resolution();
    let count = realizations.end - first;
    let (samples, photons) = (count * u64::from(width * height), count * PHOTONS);

    let fast = Fast::of(&scene, &estimator)?;
    let avx2 = || Level::new().as_avx2().map(Level::Avx2).ok_or("no AVX2 here");
    let fast = match (core.as_str(), fast) {
        ("textbook", _) => None,
        ("fast", fast) => Some(fast),
        ("fast_avx2", Fast::Paths(paths)) => Some(Fast::Paths(paths.on(avx2()?))),
        ("fast_avx2", Fast::Particles(particles)) => Some(Fast::Particles(particles.on(avx2()?))),
        _ => return Err(format!("no core {core}: textbook, fast, fast_avx2").into()),
    };

    let before = cpu_seconds();
    let (paths, rays, block) = match (&estimator, &fast) {
        (Estimator::PhotonMap(map), None) => (photons, emit(&scene, map, &address, realizations), None),
        (_, Some(Fast::Particles(map))) => (photons, emit(&scene, map, &address, realizations), None),
        (_, None) => {
            let draw = |number, pixel| address.stream(number, pixel);
            let block = block_of(&scene, &estimator, &draw, &[], realizations);
            (samples, block.tally.rays, Some(block))
        }
        (_, Some(Fast::Paths(paths))) => {
            let draw = |number, pixel| address.narrow_stream(number, pixel);
            let block = fast_block_of(&scene, paths, &draw, &[], realizations);
            (samples, block.tally.rays, Some(block))
        }
    };
    println!("{:.6} {paths} {rays} {}", cpu_seconds() - before, instruction_set());

    if let (Some(file), Some(block)) = (rest.get(2), block) {
        let pixels = &block.pixels;
        let degrees = (pixels.n.max(2) - 1) as f64;
        let values = pixels.mean.iter().zip(&pixels.m2).flat_map(|(mean, m2)| {
            [mean.to_array(), (*m2 / degrees).to_array()].into_iter().flatten().flat_map(f64::to_le_bytes)
        });
        std::fs::write(file, values.collect::<Vec<u8>>())?;
    }
    Ok(())
}
