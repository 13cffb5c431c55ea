//! The most efficient constant q, found by a search over closed forms, against the formulas of the theory, B and C-iv.
//! A golden-section search near a flat maximum resolves half the digits of an f64, so 1e-6 is asked for.

use furnace::estimator::{Estimator, Explicit, Implicit, Pick, Roulette, Rule, Technique};
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use furnace::truth::optimum::efficiency;
use furnace::truth::{Optimum, best_constant_q};

/// What a search replaces; it must not matter.
const IGNORED: Roulette = Roulette { rule: Rule::Albedo, from: 2, clamp: Some(3) };

fn implicit(directions: Directions) -> Estimator {
    Estimator::Implicit(Implicit { directions, roulette: IGNORED })
}

fn explicit() -> Estimator {
    let (lights, directions) = (LightSampling::Area, Directions::Cosine);
    Estimator::Explicit(Explicit {
        lights,
        directions,
        roulette: IGNORED,
        technique: Technique::Light,
        pick: Pick::Power,
    })
}

fn furnace(albedo: Rgb) -> SceneKind {
    SceneKind::Furnace { albedo, emission: Rgb::new(3.0, 1.0, 0.2), view: View::Probe }
}

/// One light patch on the fraction `f` of a sphere of one albedo.
fn one_light(albedo: Rgb, f: f64, looks_at: usize) -> SceneKind {
    let wall = Patch { fraction: 1.0 - f, albedo, emission: Rgb::ZERO };
    let light = Patch { fraction: f, albedo, emission: Rgb::new(3.0, 1.0, 0.2) };
    SceneKind::IntegratingSphere { patches: vec![wall, light], looks_at, view: View::Probe }
}

#[track_caller]
fn near(got: f64, printed: f64, tolerance: f64) {
    assert!((got - printed).abs() <= tolerance, "{got} instead of {printed}");
}

#[track_caller]
fn is(found: Optimum, best: f64, infinite_up_to: f64) {
    near(found.best.expect("an interior optimum"), best, 1e-6);
    near(found.infinite_up_to, infinite_up_to, 1e-12);
}

/// q* = rho^2 + S - sqrt(S (S + rho^2 - 1)), S = (1 - rho)(1 - rho + 2 f rho)/f; always above rho, and infinite
/// variance up to rho^2. Each channel has an optimum of its own.
#[test]
fn one_light_in_an_integrating_sphere() {
    for f in [0.001, 0.05, 0.3] {
        for albedo in [Rgb::new(0.5, 0.3, 0.8), Rgb::new(0.9, 0.6, 0.15)] {
            for (looks_at, c) in [0, 1].into_iter().flat_map(|j| [0, 1, 2].map(|c| (j, c))) {
                let rho = albedo[c];
                let s = (1.0 - rho) * (1.0 - rho + 2.0 * f * rho) / f;
                let best = rho * rho + s - (s * (s + rho * rho - 1.0)).sqrt();
                assert!(best > rho);
                let scene = one_light(albedo, f, looks_at);
                is(best_constant_q(&scene, &implicit(Directions::Cosine), c).unwrap(), best, rho * rho);
            }
        }
    }
}

/// A light so small that the limit holds: q* = (1 + rho^2)/2 up to terms of the order of f.
#[test]
fn a_very_small_light() {
    let scene = one_light(Rgb::splat(0.6), 1e-7, 0);
    is(best_constant_q(&scene, &implicit(Directions::Cosine), 0).unwrap(), 0.68, 0.36);
}

/// In a sphere of several materials the variance is infinite up to q = <rho^2> (K = <rho^2/q> >= 1), channel by channel.
#[test]
fn infinite_variance_begins_where_k_is_one() {
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let patches = vec![
        patch(0.3, Rgb::new(0.9, 0.5, 0.3), Rgb::ZERO),
        patch(0.5, Rgb::new(0.3, 0.2, 0.8), Rgb::new(5.0, 1.0, 0.2)),
        patch(0.2, Rgb::ZERO, Rgb::ONE),
    ];
    let mean_square = |c: usize| patches.iter().map(|p| p.fraction * p.albedo[c] * p.albedo[c]).sum::<f64>();
    let scene =
        SceneKind::IntegratingSphere { patches: patches.clone(), looks_at: 0, view: View::Irradiance };
    for (estimator, c) in
        [implicit(Directions::Cosine), explicit()].into_iter().flat_map(|e| [0, 1, 2].map(|c| (e, c)))
    {
        near(best_constant_q(&scene, &estimator, c).unwrap().infinite_up_to, mean_square(c), 1e-12);
    }
}

/// q* = (4 - 2 sqrt(1 - rho^2))/3, and infinite variance up to 4 rho^2/3.
#[test]
fn uniform_directions_in_the_furnace() {
    let albedo = Rgb::new(0.2, 0.5, 0.8);
    for c in 0..3 {
        let rho = albedo[c];
        let best = (4.0 - 2.0 * (1.0 - rho * rho).sqrt()) / 3.0;
        let found = best_constant_q(&furnace(albedo), &implicit(Directions::Uniform), c).unwrap();
        is(found, best, 4.0 / 3.0 * rho * rho);
    }
}

/// Where all that varies is the roulette itself, the best roulette is none: Var x cost falls with q up to 1.
#[test]
fn the_furnace_has_no_optimum() {
    let albedo = Rgb::new(0.2, 0.5, 0.9);
    for (estimator, c) in
        [implicit(Directions::Cosine), explicit()].into_iter().flat_map(|e| [0, 1, 2].map(|c| (e, c)))
    {
        let found = best_constant_q(&furnace(albedo), &estimator, c).unwrap();
        assert_eq!(found.best, None);
        near(found.infinite_up_to, albedo[c] * albedo[c], 1e-12);
    }
}

/// Var x cost = m^2 rho^2 / (q - rho^2) for implicit, and 2 rho^2 times that for explicit.
#[test]
fn efficiency_is_the_inverse_of_variance_times_rays() {
    let (albedo, le) = (Rgb::new(0.2, 0.5, 0.9), Rgb::new(3.0, 1.0, 0.2));
    for c in 0..3 {
        let rho = albedo[c];
        for q in [0.03, 0.2, 0.24, 0.26, 0.8, 0.82, 0.99] {
            let m = le[c] / (1.0 - rho);
            let implicit_cost = m * m * rho * rho / (q - rho * rho);
            for (estimator, cost) in
                [(implicit(Directions::Cosine), implicit_cost), (explicit(), 2.0 * rho * rho * implicit_cost)]
            {
                let got = efficiency(&furnace(albedo), &estimator, c, q).unwrap();
                let printed = if q > rho * rho { 1.0 / cost } else { 0.0 };
                near(got, printed, 1e-10 * printed);
            }
        }
    }
}

/// No answer rather than a wrong one where there is no closed form.
#[test]
fn unknown_is_said() {
    let cornell = SceneKind::CornellBox { resolution: 8 };
    assert_eq!(best_constant_q(&cornell, &implicit(Directions::Cosine), 0), None);
    let sphere = one_light(Rgb::splat(0.5), 0.1, 0);
    assert_eq!(best_constant_q(&sphere, &implicit(Directions::Uniform), 0), None);
}
