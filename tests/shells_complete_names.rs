//! Promise: shells complete commands, options, and the names of experiments and scenes.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::process::Command as Shell;
use tempfile::TempDir;

fn place() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    for name in ["rr_sweep", "rr_other", "explosion"] {
        fs::write(place.path().join(format!("experiments/{name}.toml")), "question = \"?\"").unwrap();
    }
    place
}

/// What is offered for the last of these words.
fn offered(place: &TempDir, words: &[&str]) -> Vec<String> {
    let mut command = Command::new(cargo_bin!("experiment"));
    command
        .env("COMPLETE", "bash")
        .env("_CLAP_IFS", "\n")
        .env("_CLAP_COMPLETE_INDEX", words.len().to_string());
    command.args(["--", "experiment"]).args(words).current_dir(place.path());
    let output = command.assert().success().get_output().stdout.clone();
    String::from_utf8(output).unwrap().lines().map(|line| line.trim().to_owned()).collect()
}

#[test]
fn names_are_offered() {
    let place = place();
    assert_eq!(offered(&place, &["rr"]), ["rr_other", "rr_sweep"]);
    for command in ["plan", "report", "slurm"] {
        assert_eq!(offered(&place, &[command, "ex"]), ["explosion"], "{command}");
    }
    assert_eq!(offered(&place, &["rep"]), ["report"]);
    assert_eq!(offered(&place, &["render", "veach"]), ["veach_mis"]);
    assert_eq!(offered(&place, &["new", "x", "--scene", "glass"]), ["glass_ball"]);
    assert_eq!(offered(&place, &["render", "smallpt", "--estimator", "im"]), ["implicit"]);
    assert_eq!(offered(&place, &["x", "--core", "f"]), ["fast"]);
    assert!(offered(&place, &["experiments/r"]).iter().any(|path| path == "experiments/rr_sweep.toml"));
}

#[test]
fn every_shell_gets_a_script() {
    let place = place();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let mut command = Command::new(cargo_bin!("experiment"));
        let output = command.args(["completions", shell]).current_dir(place.path()).assert().success();
        let script = String::from_utf8(output.get_output().stdout.clone()).unwrap();
        assert!(script.contains("COMPLETE") && script.contains("experiment"), "{shell}: {script}");
    }
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(["completions", "tcsh"]).assert().code(2);
    let stderr = String::from_utf8(output.get_output().stderr.clone()).unwrap();
    assert!(stderr.contains("possible values: bash, elvish, fish, powershell, zsh"), "{stderr}");
}

#[test]
fn bash_completes_with_its_script() {
    let place = place();
    let program = cargo_bin!("experiment").display().to_string();
    let line = format!(
        "source <('{program}' completions bash); COMP_WORDS=(experiment rr_s); COMP_CWORD=1; \
         _clap_complete_experiment experiment rr_s experiment; echo ${{COMPREPLY[@]}}"
    );
    let output = Shell::new("bash").args(["-c", &line]).current_dir(place.path()).output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert_eq!(stdout.trim(), "rr_sweep", "{}", String::from_utf8_lossy(&output.stderr));
}
