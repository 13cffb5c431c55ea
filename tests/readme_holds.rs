//! What the README shows works as shown.

use std::process::Command;

fn block(kind: &str) -> String {
    let readme = include_str!("../README.md");
    let start = readme.find(&format!("```{kind}\n")).expect("the README has this block") + kind.len() + 4;
    readme[start..].split("```").next().expect("the block ends").to_owned()
}

#[test]
fn exactly_two_commands_follow_the_clone() {
    assert_eq!(
        block("sh").lines().collect::<Vec<_>>(),
        ["cargo run --bin experiment rr_sweep", "cargo test"]
    );
}

#[test]
fn the_experiment_file_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("shown.toml");
    std::fs::write(&file, block("toml")).unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_experiment"))
        .arg(&file)
        .args(["--quick", "--quiet", "--out"])
        .arg(folder.path())
        .output()
        .unwrap();
    // so few samples may leave the claim open, but nothing may be wrong
    assert!(run.status.code().is_some_and(|code| code <= 1), "{}", String::from_utf8_lossy(&run.stderr));
    let table = String::from_utf8_lossy(&run.stdout).into_owned();
    assert!(table.contains("by solid angle") && !table.contains("FAIL"), "{table}");
}
