//! Promise: no sample exceeds the bound that evidence for "too dark" rests on, in any scene, with any estimator and rule,
//! in total or of one bounce; and the bound is not so large that it is of no use where the largest value is known.

use furnace::estimator::{BINS, Ctx, Estimate, Estimator, Roulette, Rule, Tally};
use furnace::sampling::Address;
use furnace::scene::Rgb;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::truth::{Counted, bound, gallery};

const PATHS: u64 = 512;

fn rules() -> Vec<Roulette> {
    let rule = |rule| Roulette { rule, from: 0, clamp: Some(10) };
    vec![
        Roulette::depth_clamp(3),
        rule(Rule::Constant { q: 0.6 }),
        Roulette { rule: Rule::Constant { q: 0.9 }, from: 2, clamp: Some(9) },
        Roulette { rule: Rule::Constant { q: 1.3 }, from: 0, clamp: Some(5) },
        rule(Rule::Albedo),
        Roulette { rule: Rule::Albedo, from: 3, clamp: Some(12) },
        rule(Rule::Throughput { floor: 0.05 }),
        Roulette { rule: Rule::Throughput { floor: 0.3 }, from: 2, clamp: Some(9) },
    ]
}

fn scenes() -> Vec<SceneKind> {
    let albedo = Rgb::new(0.8, 0.5, 0.2);
    let patch = |fraction, albedo: f64, emission| Patch { fraction, albedo: Rgb::splat(albedo), emission };
    let patches = vec![
        patch(0.1, 0.3, Rgb::new(6.0, 3.0, 1.0)),
        patch(0.2, 0.0, Rgb::new(0.5, 2.0, 4.0)),
        patch(0.7, 0.7, Rgb::ZERO),
    ];
    let mut scenes = vec![
        SceneKind::Furnace { albedo, emission: Rgb::new(1.0, 2.0, 0.5), view: View::Probe },
        SceneKind::Furnace { albedo, emission: Rgb::ONE, view: View::Irradiance },
        SceneKind::FurnaceBox { albedo, emission: Rgb::ONE, view: View::Probe },
        SceneKind::IntegratingSphere { patches, looks_at: 2, view: View::Probe },
    ];
    scenes.extend(gallery::EXHIBITS.iter().map(|exhibit| exhibit.scene(exhibit.parameter.usual)));
    scenes
}

/// Largest contributions of a path, by bin of bounces and in all.
fn largest(kind: &SceneKind, estimator: &Estimator) -> [Rgb; BINS + 1] {
    let scene = kind.build();
    let address = Address::of(&["bounds", &format!("{kind:?} {estimator:?}")]);
    let mut largest = [Rgb::ZERO; BINS + 1];
    for path in 0..PATHS {
        let (mut tally, mut stream) = (Tally::default(), address.stream(path, 0));
        let start = scene.start((0, 0), &mut stream);
        estimator.estimate(
            &furnace::estimator::Pass::Nothing,
            start.ray,
            &mut Ctx::new(&scene, stream, &mut tally, &start),
        );
        for (largest, value) in largest.iter_mut().zip(tally.bounces.into_iter().chain([tally.value])) {
            *largest = largest.max(value);
        }
    }
    largest
}

#[test]
fn by_any_path() {
    let (mut checked, mut unbounded) = (0, 0);
    for kind in scenes() {
        for estimator in rules().into_iter().flat_map(Estimator::catalogue) {
            let bins = (0..BINS as u32)
                .map(|k| if k + 1 < BINS as u32 { Counted::Only(k) } else { Counted::From(k) });
            let bounds: Vec<[Option<f64>; 3]> = bins
                .chain([Counted::All])
                .map(|counted| [0, 1, 2].map(|c| bound::of(&kind, &estimator, c, counted)))
                .collect();
            if bounds.iter().flatten().all(Option::is_none) {
                unbounded += 1;
                continue;
            }
            for (bin, (largest, bound)) in largest(&kind, &estimator).into_iter().zip(bounds).enumerate() {
                for (c, bound) in bound.into_iter().enumerate().filter_map(|(c, b)| Some((c, b?))) {
                    let seen = largest[c];
                    assert!(
                        seen <= bound * (1.0 + 1e-9),
                        "{kind:?} {estimator:?} bin {bin} {c}: {seen} {bound}"
                    );
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 20_000 && unbounded > 100, "{checked} {unbounded}");
}

/// In a furnace the largest values are those of the paths that survive.
#[test]
fn and_is_tight_where_the_largest_value_is_known() {
    let (albedo, emission) = (Rgb::new(0.8, 0.5, 0.2), Rgb::new(1.0, 2.0, 0.5));
    let kind = SceneKind::Furnace { albedo, emission, view: View::Probe };
    let roulette = Roulette::unclamped(Rule::Constant { q: 0.9 });
    let close = |a: Option<f64>, b: f64| assert!((a.unwrap() / b - 1.0).abs() < 1e-9, "{a:?} {b}");
    let estimators = Estimator::catalogue(roulette);
    let implicit = estimators[0];
    assert!(matches!(implicit, Estimator::Implicit(_)));
    for c in 0..3 {
        let ratio = albedo[c] / 0.9;
        close(bound::of(&kind, &implicit, c, Counted::Only(3)), emission[c] * ratio * ratio * ratio);
        close(bound::of(&kind, &implicit, c, Counted::All), emission[c] / (1.0 - ratio));
    }
    // at q = 0.7 the red channel's weights grow without end
    let growing = implicit.with_roulette(Roulette::unclamped(Rule::Constant { q: 0.7 }));
    assert_eq!(bound::of(&kind, &growing, 0, Counted::All), None);
    assert!(bound::of(&kind, &growing, 1, Counted::All).is_some());
}
