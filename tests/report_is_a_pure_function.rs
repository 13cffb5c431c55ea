//! Promise: `experiment report` rebuilds what a run wrote, byte for byte and without sampling; names stay text wherever
//! they appear; the page needs no network; the CSV has the promised columns and its numbers read back.

use assert_cmd::{Command, cargo::cargo_bin};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const FILE: &str = r#"question = "Is a report a pure function of <what> is stored?"
samples = 20_000
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
plot = [{ bias = {} }, { over = { parameter = "q", show = ["variance"] } }]
[[grid]]
scene = ["furnace"]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.5, 0.7] } }, { depth_clamp = { bounces = 1 } }]
[[grid]]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["explicit"]
roulette = ["throughput"]
samples = 130
"#;

const COLUMNS: &str = "experiment, scene, estimator, roulette, q, estimand, bounce, channel, samples, mean, std_error, \
     variance, truth, truth_error, bias, ci_low, ci_high, e_value, mde, verdict, rays_per_sample, efficiency";

fn place(text: &str) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), text).unwrap();
    place
}

/// Runs `experiment ARGS`, which must be fine but for claims, and gives its standard output.
#[track_caller]
fn experiment(place: &TempDir, args: &[&str]) -> String {
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(args).current_dir(place.path()).output().unwrap();
    assert!(output.status.code() < Some(2), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Whether the only script is the page's own: all other elements of that name carry data, in letters that mean nothing.
fn has_only_its_own_script(page: &str) -> bool {
    let page = page.to_lowercase();
    let is_data = |after: &&str| after.starts_with(" type=\"application/");
    let (data, scripts): (Vec<&str>, Vec<&str>) = page.split("<script").skip(1).partition(is_data);
    let words = |data: &&str| {
        data.split('>').nth(1).is_some_and(|text| !text.trim_end_matches("</script").contains('<'))
    };
    scripts.len() == 1 && scripts[0].starts_with(">\"use strict\"") && data.iter().all(words)
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    entries.map(|path| (name(&path), fs::read(&path).unwrap())).collect()
}

/// Runs with `options`, destroys all that a report is made of, and holds that `report` brings it back.
#[track_caller]
fn rebuilds_after(options: &[&str]) {
    let place = place(FILE);
    experiment(&place, &[&["x"], options].concat());
    let folder = place.path().join("reports/x");
    let before = files(&folder);
    for name in before.keys().filter(|name| name.ends_with(".svg") || *name == "results.csv") {
        fs::write(folder.join(name), "damaged").unwrap();
    }
    fs::write(folder.join("index.html"), "damaged").unwrap();
    let start = Instant::now();
    experiment(&place, &["report", "x"]);
    assert!(start.elapsed() < Duration::from_secs(5), "a report must not sample");
    let after = files(&folder);
    assert!(after.keys().eq(before.keys()));
    for (name, bytes) in &before {
        assert!(after[name] == *bytes, "{name} differs");
    }
}

#[test]
fn a_report_rebuilds_every_file() {
    rebuilds_after(&[]);
}

#[test]
fn a_report_rebuilds_what_options_changed() {
    rebuilds_after(&["--seed", "5"]);
    rebuilds_after(&["--samples", "1000"]);
}

#[test]
fn a_report_samples_nothing() {
    let place = place(FILE);
    experiment(&place, &["x"]);
    // a day's work, were it sampled
    fs::write(place.path().join("experiments/x.toml"), FILE.replace("20_000", "5_000_000_000")).unwrap();
    let mut before = files(&place.path().join("reports/x"));
    experiment(&place, &["report", "x"]);
    let mut after = files(&place.path().join("reports/x"));
    // the page tells the plan's samples: see `a_report_rebuilds_what_options_changed`
    assert!(before.remove("index.html").is_some() && after.remove("index.html").is_some());
    assert!(after == before);
}

#[test]
fn the_page_needs_no_network_and_says_the_verdicts() {
    let place = place(FILE);
    experiment(&place, &["x"]);
    let page = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
    for attribute in ["src=\"", "href=\"", "url("] {
        for target in page.split(attribute).skip(1) {
            let target = &target[..target.len().min(40)];
            assert!(!target.contains("://") && !target.starts_with("//"), "{attribute}{target}");
        }
    }
    for word in ["PASS", "FAIL", "INCONCLUSIVE", "INVALID", "Verdicts", "&lt;what&gt;"] {
        assert!(page.contains(word), "no {word}");
    }
    assert!(!page.contains("<what>"));
    assert!(has_only_its_own_script(&page));
}

#[test]
fn the_csv_has_the_promised_columns_and_reads_back() {
    let place = place(FILE);
    experiment(&place, &["x"]);
    let mut reader = csv::Reader::from_path(place.path().join("reports/x/results.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let rest: Vec<&str> = header.iter().filter(|name| COLUMNS.split(", ").any(|c| c == *name)).collect();
    assert_eq!(rest.join(", "), COLUMNS);
    let stored = fs::read_to_string(place.path().join("reports/x/cells.json")).unwrap();
    let stored: serde_json::Value = serde_json::from_str(&stored).unwrap();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let mut cell = 0;
    for row in reader.records().map(Result::unwrap) {
        for name in ["mean", "std_error", "variance", "truth", "bias", "efficiency"] {
            let text = &row[column(name)];
            assert!(
                text.is_empty() || format!("{:?}", text.parse::<f64>().unwrap()) == text,
                "{name}: {text}"
            );
        }
        let lights = if &row[column("estimand")] == "mean" { &["green", "yellow", "red"][..] } else { &[""] };
        assert!(lights.contains(&&row[column("guard")]), "{row:?}");
        assert_eq!(row[column("guard")].is_empty(), row[column("guard_note")].is_empty(), "{row:?}");
        // the very number that is stored
        if &row[column("estimand")] == "mean" && &row[column("channel")] == "R" {
            let mean = stored["cells"][cell]["total"][0]["mean"].as_f64().unwrap();
            assert_eq!(row[column("mean")].parse::<f64>().unwrap().to_bits(), mean.to_bits());
            cell += 1;
        }
    }
    assert_eq!(cell, 4);
}

#[test]
fn json_is_an_object_a_line() {
    let place = place(FILE);
    fs::copy(place.path().join("experiments/x.toml"), place.path().join("experiments/y.toml")).unwrap();
    for args in [&["x", "y", "--quick"][..], &["report", "x", "y"]] {
        let stdout = experiment(&place, &[args, &["--format", "json"]].concat());
        let objects: Vec<serde_json::Value> =
            stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let names: Vec<&str> = objects.iter().map(|o| o["experiment"].as_str().unwrap()).collect();
        assert_eq!(names, ["x", "y"]);
        assert_eq!(objects[0]["cells"].as_array().unwrap().len(), 4);
    }
}

#[test]
fn hostile_names_stay_text() {
    let hostile = [
        "<script>alert(1)</script>",
        "\" onload=\"alert(1)",
        "a, \"quoted\" name",
        "two\nlines",
        "../../outside",
        "/tmp/absolute",
        "&lt;b&gt; 100 % 'x' \u{fc}\u{1F600}",
    ];
    for name in hostile {
        let quoted = serde_json::to_string(name).unwrap();
        let text = format!(
            "question = {quoted}\nsamples = 20\nplot = [{{ bars = {{ scene = {quoted} }} }}, {{ bias = {{}} }}]\n\
             [grid]\nestimator = [\"implicit\"]\nroulette = [\"albedo\"]\n[[grid.scene]]\nprimitives.name = {quoted}\n\
             primitives.primitives = [{{ shape = {{ sphere = {{ center = [0, 0, 0], radius = 1, inward = true }} }}, \
             albedo = 0.5, emission = 1 }}]\nprimitives.sensor = {{ camera = {{ origin = [0, 0, 0], \
             direction = [0, 0, 1], up = [0, 1, 0], fov = 40, resolution = 4 }} }}\n"
        );
        let place = place(&text);
        experiment(&place, &["x", "--quiet"]);
        let entries = |folder: &Path| fs::read_dir(folder).unwrap().count();
        assert_eq!(entries(place.path()), 2, "{name}: something lies outside");
        // the overview of all reports and the journal beside the report
        assert_eq!(entries(&place.path().join("reports")), 3, "{name}: something lies outside");
        let folder = place.path().join("reports/x");
        assert!(files(&folder).keys().any(|file| file.ends_with(".exr")), "{name}: no image");
        let page = fs::read_to_string(folder.join("index.html")).unwrap();
        let overview = fs::read_to_string(place.path().join("reports/index.html")).unwrap();
        for page in [&page, &overview] {
            let is_escaped = has_only_its_own_script(page) && !page.contains("\" onload=");
            assert!(is_escaped, "{name}: not escaped in the page");
        }
        let mut reader = csv::Reader::from_path(folder.join("results.csv")).unwrap();
        assert!(reader.records().all(|row| &row.unwrap()[1] == name), "{name}: does not read back");
    }
}
