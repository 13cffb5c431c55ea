//! Promise: where the truth's own error exceeds half of the margin, nothing is shown to be right: the verdict is
//! INCONCLUSIVE and the note says that the truth is the reason. A difference beyond all errors is still FAIL.

use furnace::experiment::{Estimand, Overrides, Plan, Row, run_cell, verdict};
use furnace::scene::Rgb;
use furnace::stats::Verdict;
use furnace::truth::layers::Layers;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A furnace written out, so that theory does not know it: radiance 2, and here without noise to speak of.
const FILE: &str = r#"question = "Is the truth good enough?"
samples = 65536
reference = [{ scene = "closed", file = "truth.exr" }]
claim = [{ unbiased = { alpha = 1e-3, margin = 0.01 } }]
[grid]
estimator = ["implicit"]
roulette = [{ constant = { q = 0.7 } }]
[[grid.scene]]
[grid.scene.primitives]
name = "closed"
sensor = { probe = { origin = [0.1, 0.2, 0], direction = [0, 0, 1] } }
primitives = [{ shape = { sphere = { center = [0, 0, 0], radius = 1, inward = true } }, albedo = 0.5, emission = 1 }]
"#;

/// The row of the mean, judged against a truth of this value and standard error.
fn judged(mean: f64, std_error: f64) -> Row {
    let place = tempfile::tempdir().unwrap();
    let mut truth = Layers::new(1, 1);
    truth.add_rgb("", &[Rgb::splat(mean)]);
    truth.add_rgb("std_error.", &[Rgb::splat(std_error)]);
    fs::write(place.path().join("truth.exr"), truth.bytes().unwrap()).unwrap();
    let file = place.path().join("x.toml");
    let plan = Plan::new("x", Path::new(&file), FILE, &Overrides::default()).unwrap();
    let cell = run_cell(&plan.cells[0], &AtomicBool::new(false), &|_| (), &|_| false);
    let rows = verdict::rows(&plan, &[cell]);
    rows.into_iter().find(|r| r.estimand == Estimand::Mean && r.channel == Some(0)).unwrap()
}

/// Three questions share alpha = 1e-3: the truth's error is t(31, 1 - 1e-3 / 6) = 4.02 standard errors, half of the
/// margin is 0.01.
#[test]
fn half_of_the_margin_is_the_limit() {
    let good = judged(2.0, 0.01 / 4.2);
    assert_eq!(good.verdict, Some(Verdict::Pass), "{}", good.note);
    assert!(!good.note.contains("truth is the reason"), "{}", good.note);
    let inexact = judged(2.0, 0.01 / 3.8);
    assert_eq!(inexact.verdict, Some(Verdict::Inconclusive), "{}", inexact.note);
    assert!(inexact.note.contains("the truth is the reason: its own error of 1.0"), "{}", inexact.note);
    assert!(inexact.note.contains("half of the margin 2.000e-2"), "{}", inexact.note);
    assert!(inexact.ci.is_some() && inexact.mde.is_some(), "what was measured is still told");
}

#[test]
fn a_difference_beyond_all_errors_still_fails() {
    let wrong = judged(3.0, 0.05);
    assert_eq!(wrong.verdict, Some(Verdict::Fail), "{}", wrong.note);
}

#[test]
fn rows_state_the_error() {
    let row = judged(2.0, 0.25);
    assert_eq!((row.truth, row.truth_error, row.truth_bound), (Some(2.0), Some(0.25), Some(0.0)));
    assert_eq!(row.source, "independent renderer");
}
