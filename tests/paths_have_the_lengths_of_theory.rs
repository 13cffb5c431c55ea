//! Promise: the law of path lengths is that of a simulation of nothing but patches and coins, and of the renderer; a walk
//! that starts its roulette one bounce late is refuted, whose mean and variance may look right.

use furnace::estimator::{Estimate, Estimator, Explicit, Implicit, Property, Roulette, Rule, Technique};
use furnace::experiment::sample;
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use furnace::stats::law;
use furnace::truth::ClosedForm;

const MOST: usize = 63;

fn sphere() -> SceneKind {
    let patch = |fraction, albedo: [f64; 3], emission| {
        let [r, g, b] = albedo;
        Patch { fraction, albedo: Rgb::new(r, g, b), emission }
    };
    let patches = vec![
        patch(0.15, [0.3, 0.5, 0.2], Rgb::ONE),
        patch(0.1, [0.0; 3], Rgb::new(0.0, 2.0, 1.0)),
        patch(0.75, [0.8, 0.6, 0.7], Rgb::ZERO),
    ];
    SceneKind::IntegratingSphere { patches, looks_at: 2, view: View::Probe }
}

fn furnace() -> SceneKind {
    SceneKind::Furnace { albedo: Rgb::new(0.8, 0.5, 0.2), emission: Rgb::ONE, view: View::Probe }
}

fn implicit(roulette: Roulette) -> Estimator {
    Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette })
}

fn explicit(technique: Technique, roulette: Roulette) -> Estimator {
    let lights = LightSampling::AREA;
    Estimator::Explicit(Explicit { technique, lights, directions: Directions::Cosine, roulette })
}

fn law_of(scene: &SceneKind, estimator: &Estimator) -> Vec<f64> {
    ClosedForm::of(scene, estimator).unwrap().lengths(MOST).unwrap()
}

#[test]
fn known_laws() {
    let q = 0.7_f64;
    let constant = Roulette::unclamped(Rule::Constant { q });
    let implicit_law = law_of(&furnace(), &implicit(constant));
    let explicit_law = law_of(&furnace(), &explicit(Technique::Light, constant));
    for k in 1..30 {
        let geometric = q.powi(k - 1) * (1.0 - q);
        assert!((implicit_law[k as usize] - geometric).abs() < 1e-15);
        // a shadow ray at each vertex
        assert!((explicit_law[2 * k as usize] - geometric).abs() < 1e-15);
        assert_eq!(explicit_law[2 * k as usize - 1], 0.0);
    }
    // the first two bounces are certain, the fifth is the last that is counted
    let late =
        law_of(&furnace(), &implicit(Roulette { rule: Rule::Constant { q }, from: 2, clamp: Some(5) }));
    let expected = [0.0, 0.0, 0.0, 1.0 - q, q * (1.0 - q), q * q * (1.0 - q), q * q * q];
    late.iter().zip(expected).for_each(|(a, b)| assert!((a - b).abs() < 1e-15, "{late:?}"));
    let sums: f64 = law_of(&sphere(), &implicit(Roulette::unclamped(Rule::Albedo))).iter().sum();
    assert!((sums - 1.0).abs() < 1e-6);
}

#[test]
fn the_renderer_obeys() {
    let rules = [
        Roulette::unclamped(Rule::Constant { q: 0.6 }),
        Roulette { rule: Rule::Constant { q: 0.8 }, from: 2, clamp: None },
        Roulette::unclamped(Rule::Albedo),
        Roulette { rule: Rule::Albedo, from: 1, clamp: Some(4) },
    ];
    for scene in [furnace(), sphere()] {
        for roulette in rules {
            for estimator in [
                implicit(roulette),
                explicit(Technique::Light, roulette),
                explicit(Technique::Both(Default::default()), roulette),
            ] {
                let address = Address::of(&["lengths", &format!("{scene:?} {estimator:?}")]);
                let cell = sample(&scene.build(), &estimator, &address, 65_536, 4096);
                let law = law_of(&scene, &estimator);
                let fit = law::goodness(&cell.lengths, &law);
                let p = fit.map_or(1.0, |fit| fit.p);
                assert!(p > 1e-6, "{estimator:?} in {scene:?}: p = {p}");
                assert!(law::log_e_value(&cell.lengths, &law) < 1e6_f64.ln());
            }
        }
    }
}

/// An implicit walk whose roulette starts one bounce late.
struct Late(Implicit);

impl Estimate for Late {
    type Pass = ();

    fn begin(&self, _: u64, _: &mut furnace::estimator::Ctx<'_>) {}

    fn estimate(&self, (): &(), ray: furnace::scene::Ray, cx: &mut furnace::estimator::Ctx<'_>) {
        let roulette = Roulette { from: self.0.roulette.from + 1, ..self.0.roulette };
        Implicit { roulette, ..self.0 }.estimate(&(), ray, cx);
    }

    fn property(&self) -> Property {
        self.0.property()
    }
}

#[test]
fn a_late_start_is_refuted() {
    let roulette = Roulette::unclamped(Rule::Constant { q: 0.9 });
    let claimed = Implicit { directions: Directions::Cosine, roulette };
    let cell = sample(&furnace().build(), &Late(claimed), &Address::of(&["late"]), 16_384, 4096);
    let law = law_of(&furnace(), &Estimator::Implicit(claimed));
    assert!(law::log_e_value(&cell.lengths, &law) > 1e9_f64.ln());
}
