//! Promise: a fault differs from the sound estimator that it claims to be by its mistake and by nothing else.

use furnace::estimator::{
    Ctx, Estimate, Estimator, Explicit, Heuristic, Implicit, Roulette, Rule, Tally, Technique,
};
use furnace::faults::{self, Effect, Fault, Faulty, SOUND};
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use furnace::truth::gallery::EXHIBITS;

/// Scenes that between them have all that a mistake can be made with.
fn scenes() -> Vec<SceneKind> {
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let patches = vec![
        patch(0.6, Rgb::new(0.7, 0.5, 0.4), Rgb::ZERO),
        patch(0.4, Rgb::new(0.2, 0.6, 0.5), Rgb::new(1.0, 2.0, 0.5)),
    ];
    let (albedo, emission) = (Rgb::new(0.7, 0.5, 0.3), Rgb::new(1.0, 2.0, 0.5));
    let mut scenes = vec![
        SceneKind::Furnace { albedo, emission, view: View::Probe },
        SceneKind::FurnaceBox { albedo, emission, view: View::Irradiance },
        SceneKind::IntegratingSphere { patches, looks_at: 0, view: View::Probe },
        SceneKind::CornellBox { resolution: 4 },
        SceneKind::CornellFlush { tile: 1, blocks: true },
    ];
    scenes.extend(EXHIBITS.iter().map(|e| e.scene(e.parameter.usual)));
    scenes
}

/// Estimators that a fault can claim to be.
fn claims() -> Vec<Estimator> {
    let rules = [
        Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 1, clamp: None },
        Roulette { rule: Rule::Constant { q: 0.7 }, from: 0, clamp: Some(12) },
        Roulette { rule: Rule::Constant { q: 1.2 }, from: 0, clamp: Some(5) },
        Roulette::depth_clamp(5),
    ];
    let mut claims = Vec::new();
    for roulette in rules {
        for directions in [Directions::Cosine, Directions::Uniform] {
            claims.push(Estimator::Implicit(Implicit { directions, roulette }));
            for (technique, lights) in [
                (Technique::Light, LightSampling::AREA),
                (Technique::Light, LightSampling::SOLID_ANGLE),
                (Technique::Both(Heuristic::Balance), LightSampling::AREA),
                (Technique::Both(Heuristic::Power), LightSampling::SOLID_ANGLE),
            ] {
                claims.push(Estimator::Explicit(Explicit { technique, lights, directions, roulette }));
            }
        }
    }
    claims
}

/// What one realization yields, bits and all.
fn tally(kind: &SceneKind, estimator: &impl Estimate, realization: u64) -> Vec<u64> {
    let scene = kind.build();
    let mut tally = Tally::default();
    let mut stream = Address::of(&["faults"]).stream(realization, 3);
    let start = scene.start((1, 1), &mut stream);
    estimator.estimate(start.ray, &mut Ctx::new(&scene, stream, &mut tally, &start));
    let values = tally.bounces.iter().chain([&tally.value]).flat_map(|v| v.to_array().map(f64::to_bits));
    values.chain([tally.rays, tally.non_finite, tally.negative]).collect()
}

#[test]
fn without_a_mistake_it_is_the_sound_estimator() {
    for kind in scenes() {
        for estimator in claims() {
            let faulty = Faulty { fault: &SOUND, estimator };
            for realization in 0..24 {
                let (sound, same) =
                    (tally(&kind, &estimator, realization), tally(&kind, &faulty, realization));
                assert_eq!(sound, same, "{estimator:?} in {kind:?}, {realization}");
            }
        }
    }
}

#[test]
fn names_are_names() {
    let names: Vec<&str> = faults::all().map(|fault| fault.name).collect();
    for (i, name) in names.iter().enumerate() {
        assert!(!names[..i].contains(name), "{name} twice");
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '_'), "{name}");
        assert_eq!(faults::find(name).map(|fault: &Fault| fault.name), Some(*name));
    }
    assert!(faults::find("roulette_of").is_none());
    assert_eq!(
        faults::unknown("roulette_of"),
        "there is no fault `roulette_of`; did you mean `roulette_off`?"
    );
    assert!(faults::unknown("x").starts_with("there is no fault `x`; there are: emission_counted_twice, "));
    assert_eq!(faults::all().filter(|fault| fault.effect == Effect::Equivalent).count(), 3);
}
