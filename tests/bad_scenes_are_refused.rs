//! Promise: a scene written primitive by primitive that cannot be, or that its estimator cannot light, is refused before
//! anything is sampled: exit status 2 and one error that says what would be right and where the scene is written.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const GOOD_SHAPE: &str = "{ sphere = { center = [0, 0, 0], radius = 1, inward = true } }";
const GOOD_SENSOR: &str = "{ probe = { origin = [0, 0, 0], direction = [0, 0, 1] } }";

/// What stands in the place of the good shape or sensor, and words of the message.
type Case = (&'static str, &'static str);

/// The scene stands on line 4.
fn file(shape: &str, emission: &str, sensor: &str, estimator: &str) -> String {
    let primitive = format!("{{ shape = {shape}, albedo = 0.5, emission = {emission} }}");
    let scene =
        format!("{{ primitives = {{ name = \"mine\", primitives = [{primitive}], sensor = {sensor} }} }}");
    format!(
        "question = \"Is it refused?\"\nsamples = 64\n[grid]\nscene = [{scene}]\n\
         estimator = [\"{estimator}\"]\nroulette = [\"albedo\"]\n"
    )
}

/// A folder that holds the experiment `x`.
fn place(text: &str) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), text).unwrap();
    place
}

/// Exit status and standard error of `experiment x`.
fn run(place: &Path) -> (Option<i32>, String) {
    let output = Command::new(cargo_bin!("experiment")).arg("x").current_dir(place).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

fn all_refused(cases: &[Case], text_of: impl Fn(&str) -> String) {
    let mut wrong = Vec::new();
    for (written, why) in cases {
        let place = place(&text_of(written));
        let (status, stderr) = run(place.path());
        // of a long line only the part around the mistake is shown
        let (start, end) = (&written[..written.len().min(20)], &written[written.len().saturating_sub(20)..]);
        let is_of_scene = stderr.contains("--> experiments/x.toml:4:10");
        let holds = status == Some(2)
            && stderr.matches("error:").count() == 1
            && stderr.contains(why)
            && stderr.contains("--> experiments/x.toml:4:")
            && (stderr.contains(start) || stderr.contains(end) || is_of_scene)
            && !place.path().join("reports").exists();
        if !holds {
            wrong.push(format!("{written}\nshould say `{why}` but exit status {status:?}:\n{stderr}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {} cases:\n\n{}", wrong.len(), cases.len(), wrong.join("\n\n"));
}

#[test]
fn the_good_scene_runs() {
    let (status, stderr) = run(place(&file(GOOD_SHAPE, "1", GOOD_SENSOR, "explicit")).path());
    assert_eq!(status, Some(0), "{stderr}");
}

#[test]
fn impossible_shapes_are_refused() {
    let cases = [
        ("{ sphere = { center = [0, 0, 0], radius = 0 } }", "a length is finite and positive"),
        ("{ sphere = { center = [0, 0, 0], radius = -1 } }", "a length is finite and positive"),
        ("{ sphere = { center = [0, 0, 0], radius = nan } }", "a length is finite and positive"),
        ("{ sphere = { center = [0, inf, 0], radius = 1 } }", "coordinates are finite"),
        ("{ sphere = { center = [0, 0], radius = 1 } }", "invalid length 2, expected an array of length 3"),
        ("{ sphere = { centre = [0, 0, 0], radius = 1 } }", "centre, available keys: center, radius, inward"),
        ("{ cube = { center = [0, 0, 0] } }", "expected one of `rectangle`, `triangle`, `disk`, `sphere`"),
        (
            "{ sphere_patch = { center = [0, 0, 0], radius = 1, axis = [0, 0, 1], low = 0.5, high = 0.5 } }",
            "-1 <= low < high <= 1",
        ),
        (
            "{ sphere_patch = { center = [0, 0, 0], radius = 1, axis = [0, 0, 1], low = 0.5, high = 0.1 } }",
            "-1 <= low < high <= 1",
        ),
        (
            "{ sphere_patch = { center = [0, 0, 0], radius = 1, axis = [0, 0, 1], low = nan, high = 1 } }",
            "-1 <= low < high <= 1",
        ),
        (
            "{ sphere_patch = { center = [0, 0, 0], radius = 1, axis = [0, 0, 0], low = 0, high = 1 } }",
            "a direction must not be the zero vector",
        ),
        (
            "{ rectangle = { center = [0, 0, 0], half_u = [1, 0, 0], half_v = [1, 1, 0] } }",
            "half_u and half_v of a rectangle must be perpendicular",
        ),
        (
            "{ rectangle = { center = [0, 0, 0], half_u = [1, 0, 0], half_v = [0, 0, 0] } }",
            "it must be finite and positive",
        ),
        ("{ rectangle = { center = [0, 0, 0], half_u = [nan, 0, 0], half_v = [0, 1, 0] } }", "finite"),
        ("{ triangle = { a = [0, 0, 0], b = [1, 1, 1], c = [2, 2, 2] } }", "it must be finite and positive"),
        ("{ triangle = { a = [0, 0, 0], b = [1, 0, 0], c = [inf, 1, 0] } }", "finite"),
        ("{ disk = { center = [0, 0, 0], normal = [0, 0, 1], radius = 0 } }", "finite and positive"),
        ("{ disk = { center = [0, 0, 0], normal = [0, 0, 0], radius = 1 } }", "must not be the zero vector"),
    ];
    all_refused(&cases, |shape| file(shape, "1", GOOD_SENSOR, "implicit"));
}

#[test]
fn shapes_that_are_nowhere_are_refused() {
    let cases = [
        ("{ rectangle = { center = [nan, 0, 0], half_u = [1, 0, 0], half_v = [0, 1, 0] } }", "finite"),
        ("{ disk = { center = [nan, 0, 0], normal = [0, 0, 1], radius = 1 } }", "finite"),
        ("{ disk = { center = [0, 0, 0], normal = [0, 0, 1], radius = -1 } }", "finite and positive"),
    ];
    all_refused(&cases, |shape| file(shape, "1", GOOD_SENSOR, "implicit"));
}

#[test]
fn impossible_sensors_are_refused() {
    let cases = [
        ("{ probe = { origin = [nan, 0, 0], direction = [0, 0, 1] } }", "coordinates are finite"),
        (
            "{ probe = { origin = [0, 0, 0], direction = [0, 0, 0] } }",
            "a direction must not be the zero vector",
        ),
        (
            "{ irradiance = { point = [0, 0, 0], normal = [0, 0, 0] } }",
            "a direction must not be the zero vector",
        ),
        (
            "{ camera = { origin = [0, 0, 0], direction = [0, 0, 1], up = [0, 0, -2], fov = 40, resolution = 4 } }",
            "a camera's up must not be parallel to its direction",
        ),
        (
            "{ camera = { origin = [0, 0, 0], direction = [0, 0, 1], up = [0, 1, 0], fov = 180, resolution = 4 } }",
            "a field of view lies inside (0, 180) degrees",
        ),
        (
            "{ camera = { origin = [0, 0, 0], direction = [0, 0, 1], up = [0, 1, 0], fov = 40, resolution = 0 } }",
            "a resolution lies in 1 to 4096 pixels",
        ),
        ("{ camera = { origin = [0, 0, 0], direction = [0, 0, 1] } }", "missing field `up`"),
        ("{ eye = { origin = [0, 0, 0] } }", "expected one of `probe`, `irradiance`, `parallel`, `camera`"),
    ];
    all_refused(&cases, |sensor| file(GOOD_SHAPE, "1", sensor, "implicit"));
}

#[test]
fn a_scene_without_light_is_refused_for_explicit_only() {
    all_refused(
        &[("emission = 0", "this scene has no light, and this estimator starts from lights; give a surface")],
        |_| file(GOOD_SHAPE, "0", GOOD_SENSOR, "explicit"),
    );
    let (status, stderr) = run(place(&file(GOOD_SHAPE, "0", GOOD_SENSOR, "implicit")).path());
    assert_eq!(status, Some(0), "{stderr}");
}

#[test]
fn a_scene_without_surfaces_is_refused() {
    let text = file(GOOD_SHAPE, "1", GOOD_SENSOR, "implicit");
    let (start, end) = (text.find("[{ shape").unwrap(), text.find("], sensor").unwrap());
    let text = format!("{}[{}", &text[..start], &text[end..]);
    all_refused(&[("primitives = []", "a scene needs at least one primitive")], |_| text.clone());
}

#[test]
fn impossible_metals_are_refused() {
    let cases = [
        ("{ glossy = { alpha = 0, eta = 1, k = 3 } }", "a roughness lies in [0.001, 1]"),
        ("{ glossy = { alpha = 1.5, eta = 1, k = 3 } }", "a roughness lies in [0.001, 1]"),
        ("{ glossy = { alpha = nan, eta = 1, k = 3 } }", "a roughness lies in [0.001, 1]"),
        ("{ glossy = { alpha = 0.1, eta = 0, k = 0 } }", "eta and k of a metal must not both be 0"),
        ("{ glossy = { alpha = 0.1, eta = -1, k = 3 } }", "a refractive index is finite and not negative"),
        ("{ glossy = { alpha = 0.1, eta = 1 } }", "missing field `k`"),
    ];
    all_refused(&cases, |bsdf| {
        file(GOOD_SHAPE, "0", GOOD_SENSOR, "implicit").replace("albedo = 0.5", &format!("bsdf = {bsdf}"))
    });
}
