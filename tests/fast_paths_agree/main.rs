//! The fast path does what the textbook does: from the same narrow streams each path has the same value and the same rays,
//! to the rounding of single precision, for every estimator, rule and scene that it is offered for; all instruction sets
//! give the same bits; and what a path does depends on no other path.
//!
//! Rounding: values agree to [`ROUNDING`], but for a path that meets another surface by it, at an edge, or leaves through
//! one; of those there are at most [`ASTRAY`]. `cargo bench --bench rounding` measures what that does to the mean.

mod common;
mod particles;

use common::{Told, fast, rules, scenes, textbook};
use furnace::estimator::{Estimator, Recursive, Roulette, Rule};
use furnace::experiment::core::fast_block_of;
use furnace::experiment::run::block_of;
use furnace::fast::{Fast, Level, PathTracer};
use furnace::sampling::Address;
use furnace::scene::Directions;
use furnace::scene::Scene;
use furnace::scene::library::SceneKind;
use rayon::prelude::*;

/// Relative; cosines near the horizon have few digits.
const ROUNDING: f64 = 1e-3;
/// Fraction of paths: 8 times the largest that was seen with 8,192 paths an estimator (2.3e-4, in dof).
const ASTRAY: f64 = 2e-3;
/// Where lamps are flat and oblique, rounding makes the textbook trace shadow rays from a lamp to itself, in vain.
const IN_VAIN: [&str; 7] =
    ["disk_light", "polygon_light", "hidden_light", "turned_light", "dome", "pixel_edge", "lens_edge"];

fn path_tracers(roulette: Roulette) -> Vec<Estimator> {
    let recursive = |e: &Estimator| matches!(e, Estimator::Recursive(_));
    Estimator::catalogue(roulette).into_iter().filter(|e| !recursive(e)).collect()
}

/// The fast path of an estimator, where there is one.
fn path_tracer<'a>(scene: &'a Scene, estimator: &Estimator) -> Option<PathTracer<'a>> {
    match Fast::of(scene, estimator) {
        Ok(Fast::Paths(paths)) => Some(paths),
        Ok(Fast::Particles(_)) => panic!("{estimator:?} is a path tracer"),
        Err(_) => None,
    }
}

fn same_value(a: &Told, b: &Told) -> bool {
    (a.value - b.value).abs().max_element() <= ROUNDING * a.value.max_element()
}

#[test]
fn path_by_path() {
    const PATHS: u64 = 1024;
    let offered = scenes().into_par_iter().filter_map(|(name, kind)| {
        let scene = kind.build();
        let first = path_tracers(Roulette::depth_clamp(1))[0];
        path_tracer(&scene, &first)?;
        for (rule, roulette) in rules() {
            let (mut paths, mut astray, mut other_rays) = (0, 0, 0);
            for estimator in path_tracers(roulette) {
                let lanes = path_tracer(&scene, &estimator).expect("one estimator was accepted, so all are");
                let reference = textbook(&scene, &estimator, &name, PATHS);
                let told = fast(&scene, &lanes, &name, PATHS);
                assert_eq!(reference.len(), told.len());
                let mut difference = 0.0;
                for (a, b) in reference.iter().zip(&told) {
                    paths += 1;
                    other_rays += u64::from(a.rays != b.rays);
                    match same_value(a, b) {
                        true => {
                            difference +=
                                (b.value - a.value).element_sum() / a.value.element_sum().max(1e-300)
                        }
                        false => astray += 1,
                    }
                }
                let difference = difference / PATHS as f64;
                assert!(difference.abs() <= 2e-6, "{name} {rule} {estimator:?}: {difference} on average");
            }
            let most = (ASTRAY * paths as f64) as u64;
            assert!(astray <= most, "{name} {rule}: {astray} of {paths} paths have another value");
            let most = if IN_VAIN.contains(&name.as_str()) { paths / 50 } else { most };
            assert!(other_rays <= most, "{name} {rule}: {other_rays} of {paths} paths have other rays");
        }
        Some(name)
    });
    let offered: Vec<String> = offered.collect();
    let not_offered: Vec<String> =
        scenes().into_iter().map(|(name, _)| name).filter(|name| !offered.contains(name)).collect();
    let expected = [
        "motion",
        "smallpt",
        "uniform_sky",
        "sky_over_plane",
        "mirror_light",
        "metal_light",
        "mirror_furnace",
        "glass_ball",
        "clear_slab",
        "water_floor",
        "pool_caustic",
        "moving_edge",
        "rising_light",
    ];
    assert_eq!(not_offered, expected);
}

/// Every instruction set that this machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ]
    .into_iter()
    .flatten()
    .collect();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    vec![best]
}

#[test]
fn all_instruction_sets_give_the_same_bits() {
    let levels = levels();
    let splitting = Roulette { rule: Rule::Constant { q: 1.6 }, from: 0, clamp: Some(5) };
    for (name, kind) in scenes() {
        let scene = kind.build();
        for estimator in path_tracers(splitting).into_iter().chain(path_tracers(rules()[5].1)) {
            let Some(lanes) = path_tracer(&scene, &estimator) else { continue };
            let bits = |level: &Level| -> Vec<([u64; 3], u64)> {
                let told = fast(&scene, &lanes.on(*level), &name, 128);
                told.iter().map(|t| (t.value.to_array().map(f64::to_bits), t.rays)).collect()
            };
            let first = bits(&levels[0]);
            for level in &levels[1..] {
                assert_eq!(first, bits(level), "{name} {estimator:?}: {level:?} and {:?}", levels[0]);
            }
        }
    }
}

#[test]
fn a_path_does_not_depend_on_its_neighbours() {
    for (name, kind) in scenes().into_iter().take(5) {
        let scene = kind.build();
        for (rule, roulette) in rules() {
            for estimator in path_tracers(roulette) {
                let lanes = path_tracer(&scene, &estimator).unwrap();
                let many = fast(&scene, &lanes, &name, 200);
                for few in [1, 15, 16, 17] {
                    assert_eq!(many[..few], fast(&scene, &lanes, &name, few as u64), "{name} {rule}");
                }
            }
        }
    }
}

#[test]
fn blocks_are_made_of_the_same_realizations() {
    let (_, throughput) = rules()[5];
    for (name, kind) in scenes() {
        let scene = kind.build();
        let estimator = path_tracers(throughput)[1];
        let Some(lanes) = path_tracer(&scene, &estimator) else { continue };
        let address = Address::of(&["blocks", &name]);
        let draw = |realization, pixel| address.narrow_stream(realization, pixel);
        let (width, height) = scene.sensor.resolution();
        let realizations = if width * height > 1 { 3..6 } else { 100..1100 };
        let slow = block_of(&scene, &estimator, &draw, &[], realizations.clone());
        let quick = fast_block_of(&scene, &lanes, &draw, &[], realizations);
        assert_eq!(slow.cost.n, quick.cost.n);
        assert_eq!(slow.pixels.n, quick.pixels.n);
        let near = |a: f64, b: f64| (a - b).abs() <= 0.02 * a.abs();
        for c in 0..3 {
            assert!(near(slow.total[c].mean, quick.total[c].mean), "{name}");
            assert!(near(slow.total[c].m2, quick.total[c].m2) || slow.total[c].m2 < 1e-12, "{name}");
        }
        assert!(near(slow.cost.mean, quick.cost.mean) || IN_VAIN.contains(&name.as_str()), "{name}");
        let same = slow.pixels.mean.iter().zip(&quick.pixels.mean);
        let astray = same.filter(|(a, b)| (**a - **b).abs().max_element() > 1e-2 * a.max_element()).count();
        assert!(astray <= 3, "{name}: {astray} pixels differ");
        for (bin, (a, b)) in slow.tally.bounces.iter().zip(&quick.tally.bounces).enumerate() {
            assert!((*a - *b).abs().max_element() <= 0.02 * a.max_element(), "{name} bounce {bin}");
        }
    }
}

#[test]
fn what_has_no_fast_path_says_why() {
    let scene = SceneKind::CornellBox { resolution: 4 }.build();
    let directions = Directions::Cosine;
    let recursive = Recursive { samples: 2, directions, roulette: Roulette::depth_clamp(1) };
    let why = Fast::of(&scene, &Estimator::Recursive(recursive)).err();
    assert_eq!(why, Some("the estimator has no fast path"));
    let why = |wanted: &str| {
        let kind = scenes().into_iter().find(|(name, _)| name == wanted).unwrap().1;
        Fast::of(&kind.build(), &path_tracers(Roulette::depth_clamp(1))[0]).err()
    };
    assert_eq!(why("motion"), Some("something moves"));
    assert_eq!(why("uniform_sky"), Some("there is a sky"));
    assert_eq!(why("mirror_light"), Some("not all surfaces are matt"));
}
