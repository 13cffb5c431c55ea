//! Promise: every experiment in `experiments/` can be planned and is listed with its question; a scene written primitive
//! by primitive runs without recompiling; one image can be rendered.

use assert_cmd::{Command, cargo::cargo_bin};
use predicates::str::contains;
use std::fs;
use std::path::Path;

const SHAPES: &str = r#"question = "Does a scene of every shape and sensor run?"
samples = 6400
[grid]
estimator = ["implicit", "explicit"]
roulette = ["albedo"]
"#;

/// Every shape once, in front of a wall; the disk is the light.
const PRIMITIVES: &str = r#"
primitives.primitives = [
  { shape = { rectangle = { center = [0, 0, -1], half_u = [3, 0, 0], half_v = [0, 3, 0] } }, albedo = [0.7, 0.5, 0.3] },
  { shape = { disk = { center = [0, 0, 3], normal = [0, 0, -2], radius = 1 } }, emission = [5, 4, 3] },
  { shape = { sphere = { center = [1, 0, 0], radius = 0.5 } }, albedo = 0.8 },
  { shape = { sphere_patch = { center = [-1, 0, 0], radius = 0.5, axis = [0, 0, 1], low = 0.2, high = 1 } }, albedo = 0.6 },
  { shape = { triangle = { a = [0, 1, 0], b = [1, 1, 0], c = [0, 2, 0] } }, albedo = 0.4, emission = 1 },
]
"#;

const SENSORS: [(&str, &str); 3] = [
    ("by probe", "{ probe = { origin = [0, 0, 2], direction = [0.1, 0.2, -1] } }"),
    ("by plate", "{ irradiance = { point = [0, 0, 0], normal = [0, 0, 1] } }"),
    (
        "by camera",
        "{ camera = { origin = [0, 0, 2.5], direction = [0, 0, -1], up = [0, 1, 0], fov = 60, resolution = 8 } }",
    ),
];

fn experiment() -> Command {
    Command::new(cargo_bin!("experiment"))
}

#[test]
fn every_experiment_plans_and_is_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let list = experiment().arg("list").current_dir(root).assert().success().get_output().stdout.clone();
    let list = String::from_utf8(list).unwrap();
    let mut count = 0;
    for entry in fs::read_dir(root.join("experiments")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap();
        let file: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
        let question = file["question"].as_str().unwrap();
        assert!(question.trim().ends_with('?'), "{name} asks nothing: {question}");
        assert!(list.contains(&format!("{name}: {question}\n")), "{name} is not listed:\n{list}");
        let mut plan = experiment();
        plan.args(["plan", name]).current_dir(root).assert().success().stdout(contains(question)).stderr("");
        count += 1;
    }
    assert!(count >= 4);
    assert_eq!(list.matches(" core-seconds").count(), count);
}

#[test]
fn scenes_written_out_in_the_file_run() {
    let place = tempfile::tempdir().unwrap();
    let scene = |(name, sensor): &(&str, &str)| {
        format!("[[grid.scene]]\nprimitives.name = \"{name}\"\nprimitives.sensor = {sensor}\n{PRIMITIVES}")
    };
    let text = SHAPES.to_owned() + &SENSORS.iter().map(scene).collect::<String>();
    fs::write(place.path().join("own.toml"), text).unwrap();
    experiment().args(["own.toml", "--quick"]).current_dir(place.path()).assert().success();
    let mut reader = csv::Reader::from_path(place.path().join("reports/own/results.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for (name, _) in SENSORS {
        for estimator in ["implicit", "explicit"] {
            // scene, estimator, estimand; the mean follows four columns later
            let lit = |row: &csv::StringRecord| {
                (&row[1], &row[2], &row[5]) == (name, estimator, "mean")
                    && row[9].parse::<f64>().unwrap() > 0.0
            };
            assert_eq!(
                rows.iter().filter(|row| lit(row)).count(),
                3,
                "{name}, {estimator}: not lit in three channels"
            );
        }
    }
    let image = place.path().join("reports/own/by_camera_explicit_albedo.exr");
    assert!(image.is_file());
}

#[test]
fn an_image_is_rendered() {
    let place = tempfile::tempdir().unwrap();
    let mut render = experiment();
    render.args(["render", "cornell_box", "--spp", "2", "--resolution", "16", "-o", "small.exr"]);
    render.current_dir(place.path()).assert().success().stdout("small.exr and small.png\n");
    let exr = fs::read(place.path().join("small.exr")).unwrap();
    assert_eq!(exr[..4], [0x76, 0x2f, 0x31, 0x01], "not an EXR file");
    let png = fs::read(place.path().join("small.png")).unwrap();
    assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n", "not a PNG file");
}

#[test]
fn an_image_is_not_replaced_by_its_preview() {
    let place = tempfile::tempdir().unwrap();
    let mut render = experiment();
    render.args(["render", "cornell_box", "--spp", "2", "--resolution", "16", "-o", "out.png"]);
    render.current_dir(place.path()).assert().code(2).stderr(contains(".exr"));
}
