//! Promise: what `experiment new` writes runs as it is, in seconds, and reaches a verdict; nothing is ever overwritten.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::Path;
use std::process::Output;

fn experiment(place: &Path, args: &str) -> Output {
    Command::new(cargo_bin!("experiment")).args(args.split(' ')).current_dir(place).output().unwrap()
}

#[track_caller]
fn succeeds(place: &Path, args: &str) -> String {
    let output = experiment(place, args);
    assert_eq!(output.status.code(), Some(0), "{args}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn it_runs_as_it_is() {
    let place = tempfile::tempdir().unwrap();
    let told = succeeds(place.path(), "new mine");
    assert!(told.contains("experiment plan mine") && told.contains("experiment mine"), "{told}");
    let text = fs::read_to_string(place.path().join("experiments/mine.toml")).unwrap();
    assert!(text.starts_with("#:schema schema.json\n"), "{text}");
    assert!(text.lines().filter(|line| line.starts_with('#')).count() > 10, "{text}");
    assert_eq!(
        fs::read_to_string(place.path().join("experiments/schema.json")).unwrap(),
        fs::read_to_string("experiments/schema.json").unwrap()
    );
    succeeds(place.path(), "plan mine");
    let table = succeeds(place.path(), "mine --quiet");
    assert_eq!(table.matches("PASS").count(), 4, "{table}");
}

#[test]
fn it_plans_and_keeps_to_the_schema_in_every_scene() {
    let place = tempfile::tempdir().unwrap();
    let refused = experiment(place.path(), "new x --scene nowhere");
    let refused = String::from_utf8(refused.stderr).unwrap();
    let scenes: Vec<&str> = refused.trim().rsplit_once("there are ").unwrap().1.split(", ").collect();
    assert!(scenes.len() > 30, "{refused}");
    let schema = serde_json::from_str(&fs::read_to_string("experiments/schema.json").unwrap()).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let mut written = Vec::new();
    for scene in scenes {
        let output = experiment(place.path(), &format!("new of_{scene} --scene {scene}"));
        let stderr = String::from_utf8(output.stderr).unwrap();
        if scene.ends_with("_point") {
            assert!(stderr.contains("nothing could be claimed; take another scene"), "{scene}: {stderr}");
            continue;
        }
        assert_eq!(output.status.code(), Some(0), "{scene}: {stderr}");
        written.push(scene);
        let text = fs::read_to_string(place.path().join(format!("experiments/of_{scene}.toml"))).unwrap();
        let table: toml::Table = toml::from_str(&text).unwrap();
        let json = serde_json::to_value(table).unwrap();
        assert!(validator.is_valid(&json), "{scene}: {:?}", validator.validate(&json).err());
        let plan = succeeds(place.path(), &format!("plan of_{scene}"));
        assert!(plan.contains(scene), "{scene}: {plan}");
    }
    succeeds(place.path(), &format!("new all --scene {}", written.join(" ")));
    succeeds(place.path(), "plan all");
    // one without and one with a known answer
    let table =
        succeeds(place.path(), "of_veach_mis --quiet") + &succeeds(place.path(), "of_disk_light --quiet");
    assert!(!table.contains("INCONCLUSIVE") && table.contains("PASS"), "{table}");
}

#[test]
fn nothing_is_overwritten() {
    let place = tempfile::tempdir().unwrap();
    succeeds(place.path(), "new mine");
    let file = place.path().join("experiments/mine.toml");
    fs::write(&file, "precious").unwrap();
    for args in ["new mine", "new mine.toml"] {
        let output = experiment(place.path(), args);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{args}");
        assert!(stderr.contains("experiments/mine.toml exists and will not be overwritten"), "{stderr}");
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
}

#[test]
fn names_that_could_not_be_called() {
    let place = tempfile::tempdir().unwrap();
    let long = "x".repeat(81);
    for name in
        ["list", "help", "completions", "../up", "a/b", "with space", ".hidden", "-x", "", "a.b", &long]
    {
        let mut command = Command::new(cargo_bin!("experiment"));
        let command = command.args(["new", "--", name]).current_dir(place.path());
        let stderr = String::from_utf8(command.assert().code(2).get_output().stderr.clone()).unwrap();
        assert!(stderr.contains("is a command") || stderr.contains("is no name"), "{name}: {stderr}");
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
}
