//! Promise: photon maps and light tracing that cannot work are refused before anything is sampled, with exit status 2 and
//! one error that says what would be right; and where only some cells cannot, these are left out by name.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder that holds the experiment `x`, whose estimator stands on line 5.
fn place(scene: &str, estimator: &str) -> TempDir {
    let text = format!(
        "question = \"Is it refused?\"\nsamples = 64\n[grid]\nscene = [{scene}]\nestimator = [{estimator}]\n\
         roulette = [\"albedo\"]\n"
    );
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), text).unwrap();
    place
}

/// Exit status, standard output and standard error.
fn run(place: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(cargo_bin!("experiment")).args(arguments).current_dir(place).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

const FURNACE: &str = "\"furnace\"";

#[test]
fn impossible_estimators_are_refused() {
    let cases = [
        (
            "{ photon_map = { photons = 0, k = 5 } }",
            "0 is out of range: a map takes a whole number of photons",
        ),
        ("{ photon_map = { photons = 2.5, k = 2 } }", "2.5 is out of range: a map takes a whole number"),
        (
            "{ photon_map = { photons = 10, k = 11 } }",
            "k = 11 of 10 photons: more photons are to be gathered",
        ),
        ("{ photon_map = { photons = 10, k = 1 } }", "k is a whole number from 2"),
        (
            "{ photon_map = { photons = 10, radius = 0 } }",
            "0 is out of range: a radius is finite and above 0",
        ),
        ("{ photon_map = { photons = 10, radius = -1.0 } }", "-1 is out of range: a radius is finite"),
        ("{ photon_map = { photons = 10, radius = inf } }", "inf is out of range: a radius is finite"),
        ("{ photon_map = { photons = 10, radius = nan } }", "NaN is out of range: a radius is finite"),
        ("{ photon_map = { photons = 10 } }", "give k = 50, say, for the nearest photons, or a radius"),
        ("{ photon_map = { k = 5, radius = 1.0 } }", "by number (k) or by distance (radius), not by both"),
        (
            "{ photon_map = { k = 5, kernel = { cone = { c = 0.5 } } } }",
            "a cone's c is finite and at least 1",
        ),
        ("{ photon_map = { k = 5, kernel = \"gauss\" } }", "expected one of `box`, `cone`, `epanechnikov`"),
        ("{ photon_map = { k = 5, radios = 1 } }", "unknown field `radios`"),
        (
            "{ progressive = { radius = 1.0, alpha = 0, passes = 4 } }",
            "0 is out of range: alpha lies inside (0, 1)",
        ),
        (
            "{ progressive = { radius = 1.0, alpha = 1, passes = 4 } }",
            "1 is out of range: alpha lies inside (0, 1)",
        ),
        ("{ progressive = { radius = 1.0, passes = 0 } }", "at least 1 sample is needed"),
        (
            "{ progressive = { radius = 0.0, passes = 4 } }",
            "0 is out of range: a radius is finite and above 0",
        ),
        ("{ light_tracing = { particles = 0 } }", "0 is out of range: a map takes a whole number"),
    ];
    for (estimator, why) in cases {
        let place = place(FURNACE, estimator);
        let (status, _, stderr) = run(place.path(), &["x"]);
        assert_eq!(status, Some(2), "{estimator}\n{stderr}");
        assert!(stderr.contains(why), "{estimator} should say `{why}`:\n{stderr}");
        assert!(stderr.contains("experiments/x.toml:5:"), "{estimator}\n{stderr}");
        assert_eq!(stderr.matches("error:").count(), 1, "{stderr}");
        assert!(!place.path().join("reports").exists());
    }
}

#[test]
fn a_scene_without_matte_surfaces_keeps_no_photons() {
    let scene = "{ primitives = { name = \"mine\", sensor = { irradiance = { point = [0, 0, 0], normal = [0, 0, 1] } }, \
                 primitives = [{ shape = { sphere = { center = [0, 0, 0], radius = 1, inward = true } }, \
                 bsdf = { mirror = { reflectance = 0.5 } }, emission = 1 }] } }";
    let (status, _, stderr) = run(place(scene, "{ photon_map = { photons = 10, k = 5 } }").path(), &["x"]);
    assert_eq!(status, Some(2), "{stderr}");
    assert!(stderr.contains("photons lie on matte or glossy surfaces, and this scene has none"), "{stderr}");
}

#[test]
fn what_cannot_work_is_left_out_by_name() {
    let place = place(FURNACE, "\"implicit\", \"light_tracing\"");
    let why = "furnace light_tracing albedo";
    let (status, stdout, _) = run(place.path(), &["plan", "x"]);
    assert_eq!(status, Some(0));
    let line = stdout.lines().find(|line| line.starts_with(why)).expect("it is named");
    assert!(line.contains("left out: no particle meets a probe"), "{line}");
    let (_, stdout, _) = run(place.path(), &["x"]);
    assert!(stdout.contains(&format!("Left out is {why}")), "{stdout}");
    // and nothing is left where all is left out
    let alone = self::place(FURNACE, "\"light_tracing\"");
    let (status, _, stderr) = run(alone.path(), &["x"]);
    assert_eq!(status, Some(2), "{stderr}");
    assert!(stderr.contains("no particle meets a probe"), "{stderr}");
}
