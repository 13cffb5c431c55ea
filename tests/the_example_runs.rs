//! Promise: the example of a user's own estimator runs, reaches its verdicts, and is short.

use assert_cmd::Command;
use std::path::Path;

/// It ends with an error where a verdict is not the expected one. A full `cargo test` has built it by now.
#[test]
fn the_example_reaches_its_verdicts() {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--offline", "--example", "my_estimator", "--target-dir"]).arg(target);
    // the profile of this test: the dev profile has no debug assertions to know it by
    if std::env::current_exe().unwrap().components().any(|part| part.as_os_str() == "release") {
        cargo.arg("--release");
    }
    let output = cargo.current_dir(env!("CARGO_MANIFEST_DIR")).assert().success().get_output().stdout.clone();
    let output = String::from_utf8(output).unwrap();
    let verdicts: Vec<bool> = output.lines().map(|line| line.contains("PASS")).collect();
    assert_eq!(verdicts, [true, false, false], "{output}");
}

#[test]
fn an_own_estimator_takes_fewer_than_60_lines() {
    let lines = include_str!("../examples/my_estimator.rs").lines().count();
    assert!(lines < 60, "{lines} lines");
}
