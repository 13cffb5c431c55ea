//! Where theory knows of no noise, every single sample is right to rounding, bounce by bounce. No statistics here, so
//! nothing can hide in them: a bias of 1e-11 fails.

use furnace::estimator::{
    BINS, Ctx, Estimate, Estimator, Explicit, Implicit, Recursive, Roulette, Rule, Tally, Technique,
};
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use std::f64::consts::PI;

/// Unequal in every channel, so that a mixed-up channel shows; one channel is black.
const ALBEDO: Rgb = Rgb::new(0.83, 0.4, 0.0);
const EMISSION: Rgb = Rgb::new(0.7, 2.0, 5.0);
const LIGHT_SAMPLINGS: [LightSampling; 2] = [LightSampling::AREA, LightSampling::SOLID_ANGLE];
/// Few are enough: each must be exact by itself.
const SAMPLES: u64 = 2_000;

fn furnaces(view: View) -> [SceneKind; 2] {
    let (albedo, emission) = (ALBEDO, EMISSION);
    [SceneKind::Furnace { albedo, emission, view }, SceneKind::FurnaceBox { albedo, emission, view }]
}

fn implicit(roulette: Roulette) -> Estimator {
    Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette })
}

fn explicit(lights: LightSampling, roulette: Roulette) -> Estimator {
    Estimator::Explicit(Explicit {
        technique: Technique::Light,
        lights,
        directions: Directions::Cosine,
        roulette,
    })
}

/// Calls `check` with one sample after the other.
fn each_sample(scene: &SceneKind, estimator: &Estimator, check: impl Fn(&Tally)) {
    let scene = scene.build();
    for realization in 0..SAMPLES {
        let mut tally = Tally::default();
        let mut stream = Address::of(&["furnace_is_exact_per_bounce"]).stream(realization, 0);
        let start = scene.start((0, 0), &mut stream);
        estimator.estimate(
            &furnace::estimator::Pass::Nothing,
            start.ray,
            &mut Ctx::new(&scene, stream, &mut tally, &start),
        );
        assert_eq!((tally.non_finite, tally.negative, tally.runaway), (0, 0, 0));
        check(&tally);
    }
}

#[track_caller]
fn close(got: Rgb, right: Rgb) {
    let near = (0..3).all(|c| (got[c] - right[c]).abs() <= 1e-12 * right[c]);
    assert!(near, "{got} instead of {right}");
}

/// `response` x Le rho^k for each bounce k up to the clamp, nothing beyond, and the sum of all in total.
#[track_caller]
fn is_geometric_series(tally: &Tally, clamp: u32, response: f64) {
    let term =
        |k: u32| response * EMISSION * Rgb::from_array(ALBEDO.to_array().map(|rho| rho.powi(k as i32)));
    let sum = |from: u32| (from..=clamp).map(term).sum::<Rgb>();
    for bounce in 0..BINS as u32 - 1 {
        close(tally.bounces[bounce as usize], if bounce <= clamp { term(bounce) } else { Rgb::ZERO });
    }
    close(tally.bounces[BINS - 1], sum(BINS as u32 - 1));
    close(tally.value, sum(0));
}

#[test]
fn one_random_walk_has_no_noise() {
    for (view, response) in [(View::Probe, 1.0), (View::Irradiance, PI)] {
        for scene in furnaces(view) {
            for clamp in [0, 1, 2, 5, 8, 13] {
                each_sample(&scene, &implicit(Roulette::depth_clamp(clamp)), |tally| {
                    is_geometric_series(tally, clamp, response);
                    assert_eq!(tally.rays, u64::from(clamp) + 1); // p segments cost p rays
                });
            }
        }
    }
}

#[test]
fn n_samples_at_each_vertex_have_no_noise() {
    for (view, response) in [(View::Probe, 1.0), (View::Irradiance, PI)] {
        for scene in furnaces(view) {
            for (samples, depth) in [(1, 9), (2, 5), (3, 3), (5, 1), (4, 0)] {
                let roulette = Roulette::depth_clamp(depth);
                let e = Recursive { samples, directions: Directions::Cosine, roulette };
                each_sample(&scene, &Estimator::Recursive(e), |tally| {
                    is_geometric_series(tally, depth, response);
                    let rays: u64 = (0..=depth).map(|k| u64::from(samples).pow(k)).sum();
                    assert_eq!(tally.rays, rays);
                });
            }
        }
    }
}

/// On a sphere cos cos' / d² is the same for all pairs of points, so that a light sample has no noise either.
#[test]
fn light_samples_on_the_sphere_have_no_noise() {
    for (view, response) in [(View::Probe, 1.0), (View::Irradiance, PI)] {
        let [sphere, _] = furnaces(view);
        for lights in LIGHT_SAMPLINGS {
            for clamp in [0, 1, 2, 5, 8, 13] {
                each_sample(&sphere, &explicit(lights, Roulette::depth_clamp(clamp)), |tally| {
                    is_geometric_series(tally, clamp, response);
                    // a camera ray; then a shadow ray each bounce and a continued ray each bounce but the last
                    assert_eq!(tally.rays, 2 * u64::from(clamp).max(1) - u64::from(clamp == 0));
                });
            }
        }
    }
}

/// The first `from` bounces are certain, so roulette must not touch them; with next-event estimation one more.
#[test]
fn bounces_before_the_roulette_have_no_noise() {
    let term = |k: u32| EMISSION * Rgb::from_array(ALBEDO.to_array().map(|rho| rho.powi(k as i32)));
    let [sphere, cube] = furnaces(View::Probe);
    let rules = [Rule::Constant { q: 0.3 }, Rule::Albedo, Rule::Throughput { floor: 0.05 }];
    for rule in rules {
        for from in [0, 2, 4] {
            let roulette = Roulette { rule, from, clamp: None };
            for (scene, estimator, certain) in [
                (&sphere, implicit(roulette), from),
                (&cube, implicit(roulette), from),
                (&sphere, explicit(LightSampling::AREA, roulette), from + 1),
            ] {
                each_sample(scene, &estimator, |tally| {
                    (0..=certain).for_each(|k| close(tally.bounces[k as usize], term(k)));
                });
            }
        }
    }
}

/// With q = albedo throughput stays 1: a sample is Le times the number of vertices, and each vertex cost one ray.
#[test]
fn survival_with_the_albedo_counts_vertices() {
    let (albedo, emission, view) = (Rgb::splat(0.75), EMISSION, View::Probe);
    let roulettes = [Rule::Albedo, Rule::Throughput { floor: 0.01 }].map(Roulette::unclamped);
    for roulette in roulettes {
        for scene in
            [SceneKind::Furnace { albedo, emission, view }, SceneKind::FurnaceBox { albedo, emission, view }]
        {
            each_sample(&scene, &implicit(roulette), |tally| {
                close(tally.value, EMISSION * tally.rays as f64)
            });
        }
    }
}

/// A sphere with one light patch between a wall and a black port; the light reflects `light_albedo`.
fn one_light(light_albedo: Rgb, looks_at: usize) -> (SceneKind, Vec<Patch>) {
    let wall = Patch { fraction: 0.55, albedo: Rgb::new(0.6, 0.3, 0.9), emission: Rgb::ZERO };
    let light = Patch { fraction: 0.15, albedo: light_albedo, emission: EMISSION };
    let port = Patch { fraction: 0.3, albedo: Rgb::ZERO, emission: Rgb::ZERO };
    let patches = vec![wall, light, port];
    (SceneKind::IntegratingSphere { patches: patches.clone(), looks_at, view: View::Probe }, patches)
}

/// One light: a light sample is rho f Le exactly. What is seen directly is Le exactly, once, and not again with the
/// first light sample, whatever the emitter reflects and whichever estimator asks.
#[test]
fn one_light_patch_is_counted_once() {
    for light_albedo in [Rgb::ZERO, Rgb::new(0.3, 0.0, 0.6), Rgb::splat(0.9)] {
        for looks_at in 0..3 {
            let (scene, patches) = one_light(light_albedo, looks_at);
            let seen = patches[looks_at];
            let direct = seen.albedo * 0.15 * EMISSION;
            for lights in LIGHT_SAMPLINGS {
                each_sample(&scene, &explicit(lights, Roulette::depth_clamp(0)), |tally| {
                    close(tally.value, seen.emission);
                });
                each_sample(&scene, &explicit(lights, Roulette::depth_clamp(1)), |tally| {
                    close(tally.bounces[0], seen.emission);
                    close(tally.bounces[1], direct);
                    close(tally.value, seen.emission + direct);
                });
                let unclamped = Roulette::unclamped(Rule::Constant { q: 0.6 });
                each_sample(&scene, &explicit(lights, unclamped), |tally| {
                    close(tally.bounces[0], seen.emission);
                    close(tally.bounces[1], direct);
                });
            }
            each_sample(&scene, &implicit(Roulette::depth_clamp(2)), |tally| {
                close(tally.bounces[0], seen.emission);
                // by chance the next vertex is on the light or not, and nothing else
                let next = tally.bounces[1];
                close(next, if next == Rgb::ZERO { Rgb::ZERO } else { seen.albedo * EMISSION });
            });
        }
    }
}
