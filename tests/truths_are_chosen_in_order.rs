//! Promise: a right value is taken from a closed form, else from an independent renderer's image (a user's before ours),
//! else from an image of our own, and from that never for the kind of estimator that made it; rows say which.

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::estimator::{Estimator, Explicit, Implicit, Recursive, Roulette, Rule, Technique};
use furnace::experiment::making::{self, Goal};
use furnace::scene::library::{SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use furnace::truth::{Counted, Reference, Source, Truth};
use std::fs;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const ROULETTE: Roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 0, clamp: None };

fn estimators(roulette: Roulette) -> [Estimator; 3] {
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    [
        Estimator::Implicit(Implicit { directions, roulette }),
        Estimator::Explicit(Explicit { technique: Technique::Light, lights, directions, roulette }),
        Estimator::Recursive(Recursive { samples: 1, directions, roulette }),
    ]
}

fn cornell() -> SceneKind {
    SceneKind::CornellBox { resolution: 8 }
}

/// A scene without theory and without an image: the furnace's walls, written out.
fn written_out() -> SceneKind {
    let text = serde_json::json!({ "custom": { "primitives": [{
        "shape": { "sphere": { "center": [0.0, 0.0, 0.0], "radius": 1.0, "axis": [0.0, 0.0, 1.0],
            "low": -1.0, "high": 1.0, "inward": true } },
        "material": { "bsdf": { "lambert": { "albedo": [0.5, 0.5, 0.5] } }, "le": [1.0, 1.0, 1.0] } }],
        "sensor": { "probe": { "origin": [0.1, 0.2, 0.0], "direction": [0.0, 0.0, 1.0] } } } });
    serde_json::from_value(text).unwrap()
}

fn own(scene: &SceneKind, by: &Estimator) -> Arc<Reference> {
    let mut own = making::begin(scene, by, 1).unwrap();
    let goal = Goal { error: 0.0, most: 10_000 };
    making::extend(&mut own, &goal, &AtomicBool::new(false), &mut |_| ()).unwrap();
    Arc::new(own.reference().unwrap())
}

/// An image of another renderer, whose mean is 7.
fn given() -> Arc<Reference> {
    Arc::new(Reference {
        size: 4,
        mean: vec![Rgb::splat(7.0); 16],
        std_error: vec![Rgb::splat(0.1); 16],
        df: 31.0,
        systematic: 0.01,
        provenance: None,
    })
}

fn source(scene: &SceneKind, estimator: &Estimator, stored: &[Arc<Reference>]) -> Option<Source> {
    Truth::of(scene, estimator, stored).mean(0, Counted::All).map(|value| value.source)
}

#[test]
fn the_order() {
    let [implicit, explicit, _] = estimators(ROULETTE);
    let by_implicit = own(&written_out(), &implicit);
    let furnace = SceneKind::Furnace { albedo: Rgb::splat(0.5), emission: Rgb::ONE, view: View::Probe };
    let both = [by_implicit.clone(), given()];
    assert_eq!(source(&furnace, &explicit, &both), Some(Source::ClosedForm));
    assert_eq!(source(&written_out(), &explicit, &both), Some(Source::Independent));
    assert_eq!(source(&written_out(), &explicit, &both[..1]), Some(Source::Own));
    assert_eq!(source(&written_out(), &explicit, &[]), None);
    // a deterministic solution stands before all images, which speak of what it does not know
    let flush = |blocks| SceneKind::CornellFlush { tile: 2, blocks };
    assert_eq!(source(&flush(false), &explicit, &both), Some(Source::Deterministic));
    let blocks = Truth::of(&flush(true), &explicit, &both);
    let source_of = |counted| blocks.mean(0, counted).map(|value| value.source);
    assert_eq!(source_of(Counted::Only(1)), Some(Source::Deterministic));
    assert_eq!((source_of(Counted::Only(2)), source_of(Counted::All)), (None, Some(Source::Independent)));
    // the image that comes with the program stands between a user's and our own
    let embedded = Truth::of(&cornell(), &explicit, &both[..1]).mean(0, Counted::All).unwrap();
    assert_eq!(embedded.source, Source::Independent);
    assert!(embedded.value < 1.0);
    let users = Truth::of(&cornell(), &explicit, &both);
    assert_eq!(users.mean(0, Counted::All).unwrap().value, 7.0);
    let tile = users.tile(1, 2, 4, 0).unwrap();
    assert!((tile.std_error, tile.bound, tile.df) == (0.1, 0.07, 31.0));
}

#[test]
fn an_own_reference_never_judges_its_own_kind() {
    let scene = written_out();
    let other = Roulette { rule: Rule::Constant { q: 0.6 }, from: 3, clamp: None };
    for (i, maker) in estimators(ROULETTE).into_iter().enumerate() {
        let reference = [own(&scene, &maker)];
        for roulette in [ROULETTE, other] {
            for (j, judged) in estimators(roulette).iter().enumerate() {
                // one that branches waits for chance as one that does not
                let (i, j) = (i % 2, j % 2);
                let truth = Truth::of(&scene, judged, &reference);
                assert_eq!(truth.mean(0, Counted::All).is_some(), i != j, "{judged:?}");
                assert_eq!(truth.reference().is_some(), i != j);
                assert_eq!(truth.expected(0, Counted::All).is_some(), i != j);
                assert_eq!(truth.refused().is_some(), i == j);
            }
        }
    }
    // of two, the one by the other kind
    let [implicit, explicit, recursive] = estimators(other);
    let two = [own(&scene, &implicit), own(&scene, &explicit)];
    let maker = |judged: &Estimator| {
        let truth = Truth::of(&scene, judged, &two);
        truth.reference().unwrap().provenance.as_ref().unwrap().estimator
    };
    assert_eq!((maker(&implicit), maker(&explicit), maker(&recursive)), (explicit, implicit, explicit));
}

#[test]
fn a_stored_image_knows_no_bounces_and_expects_nothing_of_a_clamp() {
    let [_, explicit, _] = estimators(ROULETTE);
    let truth = Truth::of(&cornell(), &explicit, &[]);
    assert!(truth.mean(0, Counted::Only(1)).is_none() && truth.mean(0, Counted::All).is_some());
    let clamped = Truth::of(&cornell(), &estimators(Roulette::depth_clamp(3))[1], &[]);
    assert!(clamped.mean(0, Counted::All).is_some() && clamped.expected(0, Counted::All).is_none());
}

const FILE: &str = r#"question = "Who judges whom?"
samples = 65536
claim = [{ unbiased = { alpha = 1e-3, margin = 0.2 } }]
REFERENCE
[grid]
estimator = ["implicit", "explicit"]
roulette = ["throughput"]
[[grid.scene]]
[grid.scene.primitives]
name = "floor"
sensor = { probe = { origin = [0, -2, 1], direction = [0, 2, -1] } }
primitives = [
  { shape = { rectangle = { center = [0, 0, 0], half_u = [2, 0, 0], half_v = [0, 2, 0] } }, albedo = [0.8, 0.5, 0.2] },
  { shape = { rectangle = { center = [0.3, 0.2, 1.5], half_u = [0, 0.4, 0], half_v = [0.4, 0, 0] } }, emission = 5 },
]
"#;

#[test]
fn rows_say_who_judged() {
    let place = tempfile::tempdir().unwrap();
    let experiment = |args: &str| {
        let mut command = Command::new(cargo_bin!("experiment"));
        command.args(args.split_whitespace()).current_dir(place.path()).output().unwrap()
    };
    let reference = "reference = [{ scene = \"floor\", file = \"references/own/floor.exr\" }]";
    fs::write(place.path().join("x.toml"), FILE.replace("REFERENCE", reference)).unwrap();
    let output = experiment("reference x.toml:floor --until-error 3e-3 --estimator explicit");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let output = experiment("x.toml --quiet");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stdout));
    let mut reader = csv::Reader::from_path(place.path().join("reports/x/results.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let mut seen = Vec::new();
    for row in reader.records().map(Result::unwrap).filter(|row| &row[column("estimand")] == "mean") {
        let told = |name: &str| row[column(name)].to_owned();
        if told("estimator") == "implicit" {
            assert_eq!((told("truth_source").as_str(), told("verdict").as_str()), ("own reference", "PASS"));
            assert!(told("truth_error").parse::<f64>().unwrap() > 0.0);
        } else {
            assert_eq!((told("truth_source"), told("verdict")), (String::new(), String::new()));
            assert!(told("note").contains("made by `explicit`, which it cannot judge"), "{}", told("note"));
        }
        seen.push(told("estimator"));
    }
    assert_eq!(seen.len(), 6);
}
