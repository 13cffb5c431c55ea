//! Promise: `--save-baseline` keeps a run that later runs do not touch, and `--baseline` says what has changed since: nothing
//! where the bits are the same, what is there where something is; what cannot be compared is refused before anything is
//! sampled.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::process::Output;
use tempfile::TempDir;

const FILE: &str = r#"question = "What has changed?"
samples = 65_536
claim = [{ unbiased = { alpha = 1e-3, margin = 0.005 } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.5], emission = 1.0 } }]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.7, 0.9] } }]
[[grid]]
scene = [{ cornell_box = { resolution = 8 } }]
estimator = ["explicit"]
roulette = ["throughput"]
samples = 128
"#;

fn place(text: &str) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    write(&place, text);
    place
}

fn write(place: &TempDir, text: &str) {
    fs::write(place.path().join("experiments/x.toml"), text).unwrap();
}

fn run(place: &TempDir, args: &[&str]) -> Output {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(args).arg("--quiet").current_dir(place.path()).output().unwrap()
}

/// Runs `experiment ARGS`, which must be fine but for claims, and gives its standard output.
#[track_caller]
fn experiment(place: &TempDir, args: &[&str]) -> String {
    let output = run(place, args);
    assert!(output.status.code() < Some(2), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[track_caller]
fn refuses(place: &TempDir, args: &[&str], words: &[&str]) {
    let output = run(place, args);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
    assert_eq!(stderr.matches("error:").count(), 1, "{args:?}: {stderr}");
    for word in words {
        assert!(stderr.contains(word), "{args:?} should say `{word}`: {stderr}");
    }
}

/// (cell, quantity, channel, finding) of each row of `baseline.csv`.
fn findings(place: &TempDir) -> Vec<[String; 4]> {
    let mut reader = csv::Reader::from_path(place.path().join("reports/x/baseline.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let columns = ["cell", "quantity", "channel", "finding"].map(column);
    reader.records().map(|record| columns.map(|c| record.as_ref().unwrap()[c].to_owned())).collect()
}

#[track_caller]
fn finding(findings: &[[String; 4]], cell: &str, quantity: &str, channel: &str) -> String {
    let found = findings.iter().find(|f| f[0].contains(cell) && f[1] == quantity && f[2] == channel);
    found.unwrap_or_else(|| panic!("no {quantity} {channel} of {cell}"))[3].clone()
}

#[test]
fn the_same_run_is_identical_and_a_report_of_it_too() {
    let place = place(FILE);
    experiment(&place, &["x", "--save-baseline", "main"]);
    let kept = place.path().join("reports/.baselines/main/x.json");
    let before = fs::read(&kept).unwrap();
    // one line is of the run
    let page = || {
        let page = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
        page.lines().filter(|line| !line.contains("id=\"run\"")).collect::<String>()
    };
    let alone = page();
    for args in [&["x", "--baseline", "main"][..], &["report", "x", "--baseline", "main"]] {
        let said = experiment(&place, args);
        assert!(said.contains("Against the baseline main (furnace "), "{said}");
        assert_eq!(said.matches("identical, bit for bit").count(), 3, "{said}");
        let findings = findings(&place);
        assert_eq!(findings.len(), 3 * 10);
        assert!(findings.iter().all(|f| f[3] == "identical, bit for bit"));
        let with = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
        assert!(with.contains("identical, bit for bit"));
    }
    // without a comparison, nothing is left of one
    experiment(&place, &["report", "x"]);
    assert!(page() == alone);
    assert!(!place.path().join("reports/x/baseline.csv").exists());
    assert!(fs::read(&kept).unwrap() == before);
    // kept from what is stored, it is the same
    experiment(&place, &["report", "x", "--save-baseline", "again"]);
    assert!(fs::read(place.path().join("reports/.baselines/again/x.json")).unwrap() == before);
}

#[test]
fn another_seed_changes_nothing() {
    let place = place(FILE);
    experiment(&place, &["x", "--save-baseline", "main"]);
    let said = experiment(&place, &["x", "--baseline", "main", "--seed", "2"]);
    assert!(!said.contains("share random numbers"), "{said}");
    for [cell, quantity, channel, finding] in findings(&place) {
        let quiet = ["no change detected", "not known"].contains(&finding.as_str());
        assert!(quiet, "{cell} {quantity} {channel}: {finding}");
    }
    let known = findings(&place).iter().filter(|f| f[3] == "no change detected").count();
    assert!(known >= 25, "{known} of 30 are known");
}

#[test]
fn what_has_changed_is_found() {
    let place = place(FILE);
    experiment(&place, &["x", "--save-baseline", "main"]);
    // a hundredth more is reflected in red, and nothing has changed in green and blue
    write(&place, &FILE.replace("[0.8, 0.5, 0.5]", "[0.808, 0.5, 0.5]"));
    let said = experiment(&place, &["x", "--baseline", "main", "--seed", "2"]);
    assert!(said.contains("mean changed"), "{said}");
    let found = findings(&place);
    assert_eq!(finding(&found, "q=0.9", "mean", "R"), "changed");
    assert_eq!(finding(&found, "q=0.9", "mean", "G"), "no change detected");
    assert_eq!(finding(&found, "q=0.9", "rays", ""), "no change detected");
    // as if the rule that is called q = 0.7 had meant another one: the same mean, with less noise and more rays
    write(&place, &FILE.replace("q = [0.7, 0.9]", "q = 0.5"));
    experiment(&place, &["x", "--save-baseline", "q"]);
    let kept = place.path().join("reports/.baselines/q/x.json");
    let text = fs::read_to_string(&kept).unwrap();
    assert!(text.contains("q=0.5"));
    fs::write(&kept, text.replace("q=0.5", "q=0.7")).unwrap();
    write(&place, &FILE.replace("q = [0.7, 0.9]", "q = 0.7"));
    experiment(&place, &["x", "--baseline", "q", "--seed", "2"]);
    let found = findings(&place);
    assert_eq!(finding(&found, "furnace", "mean", "G"), "no change detected");
    assert_eq!(finding(&found, "furnace", "variance", "G"), "improved");
    assert_eq!(finding(&found, "furnace", "rays", ""), "regressed");
    // the variance of red was infinite at q = 0.5
    assert_eq!(finding(&found, "furnace", "variance", "R"), "not known");
}

#[test]
fn cells_that_only_one_run_has_are_named_and_shared_numbers_are_told() {
    let place = place(FILE);
    experiment(&place, &["x", "--save-baseline", "main", "--filter", "furnace"]);
    write(&place, &FILE.replace("[0.7, 0.9]", "[0.7, 0.8]"));
    let args = ["x", "--baseline", "main", "--samples", "1024", "--format", "json"];
    let said: serde_json::Value = serde_json::from_str(&experiment(&place, &args)).unwrap();
    let said = &said["baseline"];
    assert_eq!(said["only_in_baseline"].as_array().unwrap().len(), 1);
    assert!(said["only_in_baseline"][0].as_str().unwrap().contains("q=0.9"));
    assert_eq!(said["only_in_this_run"].as_array().unwrap().len(), 2);
    assert_eq!(said["cells"].as_array().unwrap().len(), 1);
    assert_eq!(
        (said["cells"][0]["samples_before"].as_u64(), said["cells"][0]["samples"].as_u64()),
        (Some(65_536), Some(1024))
    );
    assert_eq!(said["shares_random_numbers"], true);
    let said = experiment(&place, &["report", "x", "--baseline", "main"]);
    assert!(said.contains("Only in the baseline: ") && said.contains("Only in this run: "), "{said}");
    assert!(said.contains("share random numbers"), "{said}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let place = place(FILE);
    let none = ["has no baseline called `main`", "--save-baseline main"];
    refuses(&place, &["x", "--baseline", "main"], &none);
    assert!(!place.path().join("reports").exists(), "something was written");
    for name in ["../main", "a/b", "a\\b", "..", ".hidden", "", "-x", "a b", "é", &"x".repeat(101)] {
        for option in ["--save-baseline", "--baseline"] {
            let args = ["x", &format!("{option}={name}")];
            refuses(&place, &args, &[&format!("`{name}` cannot be the name of a baseline")]);
        }
    }
    refuses(&place, &["x", "--claims", "--baseline", "main"], &["cannot be used with"]);
    assert!(!place.path().join("reports").exists(), "something was written");
    experiment(&place, &["x", "--save-baseline", "one", "--samples", "64"]);
    experiment(&place, &["report", "x", "--save-baseline", "two"]);
    refuses(&place, &["x", "--baseline", "main"], &["`main`; there are: one, two"]);
    let kept = place.path().join("reports/.baselines/one/x.json");
    let text = fs::read_to_string(&kept).unwrap();
    fs::write(&kept, &text[..text.len() / 2]).unwrap();
    refuses(&place, &["x", "--baseline", "one"], &["x.json is damaged"]);
    fs::write(&kept, text.replace("\"schema\": 1", "\"schema\": 2")).unwrap();
    refuses(&place, &["x", "--baseline", "one"], &["has the layout 2, not 1"]);
}
