//! Which core followed a cell's paths is said in CSV and page, whoever chose it; what has no fast path is done by the
//! textbook; both cores reach the same verdicts; and the fast one does not depend on threads either.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const FILE: &str = r#"
question = "Which core was it?"
samples = 20000

[[grid]]
scene = [
  { furnace = { albedo = [0.5, 0.3, 0.2] } },
  { cornell_box = { resolution = 4 } },
  { exhibit = { name = "mirror_light" } },
]
estimator = ["implicit", "explicit"]
roulette = [{ throughput = { floor = 0.05, from = 3 } }]

[[claim]]
unbiased = { scene = "furnace", alpha = 1e-6, margin = 0.05 }
"#;

fn place(core: &str) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), format!("{core}\n{FILE}")).unwrap();
    place
}

fn experiment(place: &Path, args: &[&str]) -> std::process::Output {
    Command::new(cargo_bin!("experiment")).current_dir(place).args(args).output().unwrap()
}

/// Scene and core of each row of means, and their verdicts.
fn rows(place: &Path) -> Vec<[String; 3]> {
    let mut reader = csv::Reader::from_path(place.join("reports/x/results.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|h| h == name).unwrap();
    let rows = reader.records().map(Result::unwrap).filter(|row| &row[at("estimand")] == "mean");
    rows.map(|row| ["scene", "core", "verdict"].map(|name| row[at(name)].to_owned())).collect()
}

fn check(place: &Path, fast: bool) {
    let rows = rows(place);
    assert_eq!(rows.len(), 18);
    for [scene, core, verdict] in rows {
        let has_fast_path = scene != "mirror_light";
        assert_eq!(core, if fast && has_fast_path { "fast" } else { "textbook" }, "{scene}");
        assert_eq!(verdict, if scene == "furnace" { "PASS" } else { "" });
    }
    let page = fs::read_to_string(place.join("reports/x/index.html")).unwrap();
    assert_eq!(page.contains("4 of 6 cells were sampled by the fast path"), fast);
    let timing = fs::read_to_string(place.join("reports/x/timing.csv")).unwrap();
    assert_eq!(timing.contains(&format!(",fast {},", furnace::fast::instruction_set())), fast);
}

#[test]
fn by_default_it_is_the_textbook() {
    let place = place("");
    assert!(experiment(place.path(), &["x"]).status.success());
    check(place.path(), false);
}

#[test]
fn the_file_and_the_command_line_choose() {
    let place = place("core = \"fast\"");
    assert!(experiment(place.path(), &["x", "--jobs", "1"]).status.success());
    check(place.path(), true);
    let once = fs::read(place.path().join("reports/x/results.csv")).unwrap();
    // what was stored knows its core
    assert!(experiment(place.path(), &["report", "x", "--core", "textbook"]).status.success());
    check(place.path(), true);
    assert!(experiment(place.path(), &["x", "--core", "textbook"]).status.success());
    check(place.path(), false);
    assert!(experiment(place.path(), &["x", "--core", "fast", "--jobs", "2"]).status.success());
    check(place.path(), true);
    assert_eq!(once, fs::read(place.path().join("reports/x/results.csv")).unwrap());
}

#[test]
fn another_core_is_refused() {
    let place = place("core = \"quick\"");
    let output = experiment(place.path(), &["x"]);
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    for part in ["experiments/x.toml:1", "quick", "textbook", "fast"] {
        assert!(told.contains(part), "{told}");
    }
    assert_eq!(experiment(place.path(), &["x", "--core", "quick"]).status.code(), Some(2));
}
