//! Promise: every line of `--format json` is an object that follows the committed schema, and holds what the table and the
//! page say.

use assert_cmd::{Command, cargo::cargo_bin};
use jsonschema::Validator;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const RUN: &str = r#"question = "What does it print?"
samples = 20_000
faults = true
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
[grid]
scene = ["furnace", { cornell_box = { resolution = 4 } }]
estimator = ["implicit", "light_tracing", { fault = { name = "survivors_not_weighted" } }]
roulette = [{ constant = { q = [0.6, 0.8] } }]
samples = 2_000
"#;

const STUDY: &str = r#"question = "How often is it found?"
samples = 2_048
faults = true
seeds = 4
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
null = [{ law = { rare = { p = 0.01 } }, samples = 100, runs = 20, level = [0.1, 0.01] }]
[grid]
scene = ["furnace"]
estimator = ["implicit", { fault = { name = "survivors_not_weighted" } }]
roulette = [{ constant = { q = 0.6 } }]
"#;

fn place() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/run.toml"), RUN).unwrap();
    fs::write(place.path().join("experiments/study.toml"), STUDY).unwrap();
    place
}

fn validator() -> Validator {
    let text = fs::read_to_string("docs/result.schema.json").unwrap();
    jsonschema::validator_for(&serde_json::from_str(&text).unwrap()).unwrap()
}

/// The objects that a command prints, each of which follows the schema.
#[track_caller]
fn objects(place: &Path, args: &str, codes: &[i32]) -> Vec<Value> {
    let mut command = Command::new(cargo_bin!("experiment"));
    let output =
        command.args(args.split(' ')).args(["--format", "json"]).current_dir(place).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(codes.contains(&output.status.code().unwrap()), "{args}: {stderr}");
    let validator = validator();
    let object = |line: &str| {
        let object: Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{args}: {e}: {line}"));
        let errors: Vec<String> =
            validator.iter_errors(&object).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{args}: {errors:?}");
        object
    };
    String::from_utf8(output.stdout).unwrap().lines().map(object).collect()
}

#[test]
fn the_committed_schema_is_the_one_that_is_printed() {
    let printed = Command::new(cargo_bin!("experiment")).args(["schema", "result"]).output().unwrap().stdout;
    let hint = "cargo run --bin experiment schema result > docs/result.schema.json";
    assert!(fs::read("docs/result.schema.json").unwrap() == printed, "it is another; make it anew: {hint}");
}

#[test]
fn all_commands_follow_it() {
    let place = place();
    let kinds = |objects: &[Value]| objects.iter().map(|o| o["kind"].clone()).collect::<Vec<_>>();
    assert_eq!(kinds(&objects(place.path(), "list", &[0])), ["listed", "listed"]);
    assert_eq!(kinds(&objects(place.path(), "plan run study --margin 0.1", &[0])), ["plan", "plan"]);
    assert_eq!(kinds(&objects(place.path(), "run study", &[0, 1])), ["run", "study"]);
    assert_eq!(kinds(&objects(place.path(), "report run study", &[0, 1])), ["run", "study"]);
    assert_eq!(kinds(&objects(place.path(), "run study --claims", &[0, 1])), ["run", "study"]);
}

#[test]
fn an_object_says_what_the_table_says() {
    let place = place();
    let [run] = &objects(place.path(), "run --seed 5", &[0, 1])[..] else { panic!("one object") };
    assert_eq!((run["schema"].as_u64(), run["seed"].as_u64()), (Some(2), Some(5)));
    assert_eq!(run["question"], "What does it print?");
    assert_eq!(run["error_probability"], 1e-3);
    // light tracing needs an image; particles cannot hit a probe
    assert_eq!(run["left_out"].as_array().unwrap().len(), 2);
    let cells = run["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 10);
    let table = fs::read(place.path().join(run["results"].as_str().unwrap())).unwrap();
    let mut reader = csv::Reader::from_reader(&table[..]);
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let mut passed = 0;
    for row in &rows {
        let is_fault = row[column("estimator")].starts_with("survivors_not_weighted");
        passed += usize::from(&row[column("verdict")] == "PASS" && !is_fault);
        if &row[column("estimand")] != "mean" {
            continue;
        }
        let same = |cell: &&Value| {
            ["scene", "estimator", "roulette"].iter().all(|key| cell[*key] == row[column(key)])
                && cell["params"]["q"].as_f64() == row[column("q")].parse().ok()
        };
        let cell = cells.iter().find(same).unwrap();
        let channels = cell["channels"].as_array().unwrap();
        let channel = channels.iter().find(|c| c["channel"] == row[column("channel")]).unwrap();
        for (key, name) in
            [("mean", "mean"), ("bias", "bias"), ("truth", "truth"), ("std_error", "std_error")]
        {
            assert_eq!(channel[key].as_f64(), row[column(name)].parse().ok(), "{key} of {}", cell["cell"]);
        }
        assert_eq!(channel["verdict"].as_str().unwrap_or(""), &row[column("verdict")], "{}", cell["cell"]);
        assert_eq!(cell["fault"].is_null(), !is_fault);
        let label = cell["cell"].as_str().unwrap();
        assert!(cell["replay"].as_str().unwrap().contains(label), "{}", cell["replay"]);
    }
    assert_eq!(run["counts"]["PASS"].as_u64(), Some(passed as u64));
    assert!(place.path().join(run["page"].as_str().unwrap()).is_file());
    // what writes nothing names no files, and says its seed in the object
    let [claims] = &objects(place.path(), "run --claims", &[0, 1])[..] else { panic!("one object") };
    assert!(claims["page"].is_null() && claims["results"].is_null() && claims["seed"].is_u64());
}

#[test]
fn the_schema_can_refuse() {
    let place = place();
    let validator = validator();
    for args in ["run --quick", "study --quick", "plan run", "list"] {
        let object = objects(place.path(), args, &[0, 1]).remove(0);
        for key in object.as_object().unwrap().keys() {
            let mut less = object.clone();
            less.as_object_mut().unwrap().remove(key);
            assert!(!validator.is_valid(&less), "{args}: `{key}` may be missing");
        }
        for (key, other) in [("schema", 1.into()), ("kind", "walk".into()), ("cells", "many".into())] {
            let mut wrong = object.clone();
            wrong[key] = other;
            assert!(!validator.is_valid(&wrong), "{args}: a wrong `{key}` is taken");
        }
    }
}

#[test]
fn what_has_no_objects_says_so() {
    let place = place();
    for args in [
        "render cornell_box",
        "reference furnace",
        "new x",
        "slurm x --tasks 2",
        "completions bash",
        "schema",
    ] {
        let mut command = Command::new(cargo_bin!("experiment"));
        let command = command.args(args.split(' ')).args(["--format", "json"]).current_dir(place.path());
        let stderr = command.assert().code(2).get_output().stderr.clone();
        let stderr = String::from_utf8(stderr).unwrap();
        assert!(
            stderr.contains("--format json is for runs, `list`, `plan`, `report`, `merge` and `figure`"),
            "{args}: {stderr}"
        );
    }
}
