//! Promise: Ctrl-C, or a polite kill, keeps every finished cell beside an older complete result, which stays as it was;
//! the program says so and ends with exit status 130.
#![cfg(unix)]

use assert_cmd::cargo::cargo_bin;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The first cells take a moment, the last one minutes: long enough to be interrupted anywhere.
const FILE: &str = r#"question = "What is kept?"
samples = 1000
[[grid]]
scene = ["furnace"]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.5, 0.6] } }, "albedo"]
[[grid]]
scene = ["integrating_sphere"]
estimator = ["explicit"]
roulette = ["throughput"]
samples = 2_000_000_000
"#;

/// What the first column of rows like `x,furnace,implicit,constant,0.5,...` is about.
fn cells(csv: &Path) -> BTreeSet<String> {
    let mut reader = csv::Reader::from_path(csv).unwrap();
    reader.records().map(|row| row.unwrap().iter().skip(1).take(4).collect::<Vec<_>>().join(" ")).collect()
}

fn interrupted_by(signal: &str) {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    fs::create_dir(place.join("experiments")).unwrap();
    fs::write(place.join("experiments/x.toml"), FILE).unwrap();
    fs::create_dir_all(place.join("reports/x")).unwrap();
    for file in ["cells.json", "results.csv"] {
        fs::write(place.join("reports/x").join(file), "older and complete").unwrap();
    }

    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(["x", "--jobs", "2"]).current_dir(place).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut first = String::new();
    // after the third line only the long cell is left
    for _ in 0..3 {
        stderr.read_line(&mut first).unwrap();
    }
    assert!(first.starts_with("[1/4] furnace implicit constant q=0.5:"), "{first}");
    let sent = Instant::now();
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).unwrap();
    let output = child.wait_with_output().unwrap();

    assert_eq!(output.status.code(), Some(130), "{signal}: {rest}");
    assert!(sent.elapsed() < Duration::from_secs(5), "{signal} took {:?}", sent.elapsed());
    let message = "interrupted: 3 of 4 cells are finished and kept in reports/x-interrupted";
    assert!(rest.contains(message), "{rest}");
    let kept = place.join("reports/x-interrupted");
    let finished =
        ["furnace implicit constant 0.5", "furnace implicit constant 0.6", "furnace implicit albedo "];
    assert_eq!(cells(&kept.join("results.csv")), finished.map(str::to_owned).into());
    let page = fs::read_to_string(kept.join("index.html")).unwrap();
    assert!(page.contains("Interrupted: 3 of 4 cells finished."));
    for file in ["cells.json", "results.csv"] {
        assert_eq!(fs::read(place.join("reports/x").join(file)).unwrap(), b"older and complete");
    }
    let mut left: Vec<_> =
        fs::read_dir(place.join("reports")).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["x", "x-interrupted"], "unfinished files were left");
}

#[test]
fn ctrl_c_keeps_what_is_finished() {
    interrupted_by("-INT");
}

#[test]
fn a_polite_kill_keeps_what_is_finished() {
    interrupted_by("-TERM");
}
