//! Promise: the files of a run are the same bytes for any number of threads and at each repetition; a cell's numbers
//! depend on that cell and the seed alone, and only paired streams give two cells the same random numbers.

use assert_cmd::{Command, cargo::cargo_bin};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const FILE: &str = r#"question = "Does chance depend on anything but the seed?"
samples = 6400
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }, "integrating_sphere"]
estimator = ["implicit", "explicit"]
roulette = [{ constant = { q = [0.5, 0.7] } }, "throughput"]
[[grid]]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["explicit"]
roulette = ["throughput"]
samples = 130
"#;

/// Drawing takes longer than sampling here: only where files are compared.
const PLOT: &str = r#"plot = [{ bias = {} }, { over = { parameter = "q", show = ["variance"] } }]"#;

/// Runs `text` with `options` and gives its files by name.
fn run(text: &str, options: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let place: TempDir = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), text).unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.arg("x").args(options).current_dir(place.path()).output().unwrap();
    // few samples: that claims are held is no promise here
    assert!(output.status.code() < Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    files(&place.path().join("reports/x"))
}

/// The files of a folder, without what tells of machine and time: these differ from run to run.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: BTreeMap<String, Vec<u8>> = entries
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap()))
        .collect();
    files.remove("timing.csv").unwrap();
    let mut cells: serde_json::Value = serde_json::from_slice(&files["cells.json"]).unwrap();
    cells.as_object_mut().unwrap().remove("seconds").unwrap();
    files.insert("cells.json".to_owned(), cells.to_string().into_bytes());
    files.remove("run.json").unwrap();
    let page = String::from_utf8(files["index.html"].clone()).unwrap();
    let of_run: Vec<&str> = page.lines().filter(|line| line.contains("id=\"run\"")).collect();
    assert_eq!(of_run.len(), 1, "one line of the page is of the run");
    files.insert("index.html".to_owned(), page.replace(of_run[0], "").into_bytes());
    files
}

/// Rows of `results.csv` by cell: scene, estimator, rule, q. What follows from how many questions are asked in all (the
/// intervals and verdicts) is left out.
fn numbers(files: &BTreeMap<String, Vec<u8>>) -> BTreeMap<[String; 4], Vec<String>> {
    let mut reader = csv::Reader::from_reader(&files["results.csv"][..]);
    let header = reader.headers().unwrap().clone();
    let get = |row: &csv::StringRecord, name: &str| {
        header.iter().position(|h| h == name).map_or_else(String::new, |i| row[i].to_owned())
    };
    let mut cells: BTreeMap<[String; 4], Vec<String>> = BTreeMap::new();
    for row in reader.records() {
        let row = row.unwrap();
        let key = ["scene", "estimator", "roulette", "q"].map(|name| get(&row, name));
        let measured =
            ["estimand", "bounce", "channel", "samples", "mean", "std_error", "variance", "truth", "bias"];
        cells.entry(key).or_default().push(measured.map(|name| get(&row, name)).join(","));
    }
    cells
}

#[test]
fn any_number_of_threads_writes_the_same_files() {
    let file = format!("{PLOT}\n{FILE}");
    let once = run(&file, &["--jobs", "1"]);
    for ending in ["results.csv", ".svg", ".png", ".exr", "index.html", "cells.json"] {
        assert!(once.keys().any(|name| name.ends_with(ending)), "no {ending} in {:?}", once.keys());
    }
    for jobs in ["1", "2", "7"] {
        let again = run(&file, &["--jobs", jobs]);
        assert!(again.keys().eq(once.keys()), "--jobs {jobs}: other files");
        for (name, bytes) in &once {
            assert!(again[name] == *bytes, "--jobs {jobs}: {name} differs");
        }
    }
}

#[test]
fn a_further_cell_changes_no_other() {
    let before = numbers(&run(FILE, &[]));
    // in front of the others, so that each cell gets another number
    let more = FILE
        .replace("q = [0.5, 0.7]", "q = [0.3, 0.5, 0.7]")
        .replace("[\"implicit\"", "[{ implicit = { directions = \"uniform\" } }, \"implicit\"");
    let after = numbers(&run(&more, &[]));
    assert!(after.len() > before.len());
    for (cell, rows) in &before {
        assert_eq!(after.get(cell), Some(rows), "{cell:?}");
    }
}

#[test]
fn another_seed_changes_every_cell() {
    let (one, two) = (numbers(&run(FILE, &["--seed", "1"])), numbers(&run(FILE, &["--seed", "2"])));
    assert!(one.keys().eq(two.keys()));
    for (cell, rows) in &one {
        assert_ne!(*rows, two[cell], "{cell:?}");
    }
    // the option does what the file's own seed does
    assert_eq!(two, numbers(&run(&format!("seed = 2\n{FILE}"), &[])));
}

/// In a furnace of one albedo, q = albedo and a constant q of the same value are one rule under two names.
#[test]
fn paired_streams_give_equivalent_rules_the_same_numbers() {
    let file = |streams: &str| {
        format!(
            "question = \"?\"\nsamples = 6400\nstreams = \"{streams}\"\n[grid]\n\
             scene = [{{ furnace = {{ albedo = 0.5 }} }}]\nestimator = [\"implicit\"]\n\
             roulette = [{{ constant = {{ q = [0.5, 0.6] }} }}, \"albedo\"]\n"
        )
    };
    for (streams, equal) in [("paired", true), ("independent", false)] {
        let cells = numbers(&run(&file(streams), &[]));
        let rows = |rule: &str, q: &str| &cells[&["furnace", "implicit", rule, q].map(str::to_owned)];
        assert_eq!(rows("constant", "0.5") == rows("albedo", ""), equal, "{streams}");
        assert_ne!(rows("constant", "0.6"), rows("albedo", ""), "{streams}");
    }
}
