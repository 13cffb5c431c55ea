//! Promise: Ctrl-C, or a polite kill, keeps every finished cell beside an older complete result, which stays as it was;
//! the program says so and ends with exit status 130 or 143.
#![cfg(unix)]

use assert_cmd::cargo::cargo_bin;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

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
    reader.records().map(|row| row.unwrap().iter().skip(1).take(5).collect::<Vec<_>>().join(" ")).collect()
}

/// A folder with the experiment and an older, complete result of it.
fn place() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path();
    fs::create_dir(place.join("experiments")).unwrap();
    fs::write(place.join("experiments/x.toml"), FILE).unwrap();
    fs::create_dir_all(place.join("reports/x")).unwrap();
    for file in ["cells.json", "results.csv"] {
        fs::write(place.join("reports/x").join(file), "older and complete").unwrap();
    }
    folder
}

/// Exit status and standard error of a run that gets `signal` after its third line, when only the long cell is left.
fn interrupted_by(signal: &str, place: &Path) -> (Option<i32>, String) {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(["x", "--jobs", "2"]).current_dir(place).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut text = String::new();
    for _ in 0..3 {
        stderr.read_line(&mut text).unwrap();
    }
    let sent = Instant::now();
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    stderr.read_to_string(&mut text).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(sent.elapsed() < Duration::from_secs(5), "{signal} took {:?}", sent.elapsed());
    (output.status.code(), text)
}

fn keeps_what_is_finished(signal: &str, code: i32) {
    let folder = place();
    let place = folder.path();
    let (status, stderr) = interrupted_by(signal, place);
    assert_eq!(status, Some(code), "{signal}: {stderr}");
    assert!(stderr.starts_with("[1/4] furnace implicit constant q=0.5:"), "{stderr}");
    let message = "interrupted: 3 of 4 cells are finished and kept in reports/x-interrupted";
    assert!(stderr.contains(message), "{stderr}");

    let kept = place.join("reports/x-interrupted");
    let finished = [
        "furnace implicit constant textbook 0.5",
        "furnace implicit constant textbook 0.6",
        "furnace implicit albedo textbook ",
    ];
    assert_eq!(cells(&kept.join("results.csv")), finished.map(str::to_owned).into());
    let page = fs::read_to_string(kept.join("index.html")).unwrap();
    assert!(page.contains("Interrupted: 3 of 4 cells finished."));
    for file in ["cells.json", "results.csv"] {
        assert_eq!(fs::read(place.join("reports/x").join(file)).unwrap(), b"older and complete");
    }
    let mut left: Vec<_> =
        fs::read_dir(place.join("reports")).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["index.html", "x", "x-interrupted", "x.journal"], "unfinished files were left");
}

#[test]
fn ctrl_c_keeps_what_is_finished() {
    keeps_what_is_finished("-INT", 130);
}

#[test]
fn a_polite_kill_keeps_what_is_finished() {
    keeps_what_is_finished("-TERM", 143);
}

#[test]
fn a_folder_of_other_files_is_not_replaced() {
    let place = place();
    let other = place.path().join("reports/x-interrupted");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("thesis.tex"), "three years of work").unwrap();
    interrupted_by("-INT", place.path());
    assert_eq!(fs::read(other.join("thesis.tex")).unwrap(), b"three years of work");
}
