//! Promise: the help of every command shows examples, and each of them works as it is printed.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::process::Command as Shell;

/// A small file in the place of the experiments that examples name.
const SMALL: &str = r#"question = "Does it work?"
samples = 1024
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
plot = [{ bias = {} }]
[[grid]]
scene = ["furnace", { caustic_glass = { resolution = 2 } }]
estimator = ["implicit"]
roulette = [{ constant = { q = 0.9 } }]
"#;

fn help(args: &[&str]) -> String {
    let output = Command::new(cargo_bin!("experiment")).args(args).output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The commands that the help lists.
fn commands() -> Vec<String> {
    let help = help(&["--help"]);
    let listed = help.split("\nCommands:\n").nth(1).unwrap().lines();
    let names = listed.take_while(|line| !line.trim().is_empty());
    let names = names.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .filter(|name| name != "help")
        .collect()
}

/// The examples of a help text, a command line each.
fn examples(help: &str) -> Vec<String> {
    let shown = help.split("\nExamples:\n").nth(1).unwrap_or_default().lines();
    shown.map_while(|line| line.strip_prefix("  experiment ")).map(str::to_owned).collect()
}

/// What keeps an example short, beside what it says itself.
fn shortened(example: &str) -> &'static str {
    match example.split(' ').next().unwrap() {
        "render" => "--resolution 4",
        "reference" => "--resolution 4 --max-samples 8",
        _ => "",
    }
}

#[test]
fn every_command_has_some_and_they_work() {
    let commands = commands();
    assert_eq!(
        commands.join(" "),
        "list plan report merge status figure new render reference export slurm schema completions",
        "a command without a test"
    );
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    for name in ["rr_sweep", "caustics"] {
        fs::write(place.path().join(format!("experiments/{name}.toml")), SMALL).unwrap();
    }
    let program = cargo_bin!("experiment").display().to_string();
    let texts = std::iter::once(help(&["--help"])).chain(commands.iter().map(|name| help(&[name, "--help"])));
    let names = std::iter::once("").chain(commands.iter().map(String::as_str));
    for (name, text) in names.zip(texts) {
        let examples = examples(&text);
        assert!(!examples.is_empty(), "`{name}` shows no example:\n{text}");
        for example in examples {
            assert!(example.starts_with(name), "`{name}` shows another command: {example}");
            if example.contains("--scene") {
                fs::remove_file(place.path().join("experiments/my_question.toml")).unwrap();
            }
            let line = format!("'{program}' {example} {}", shortened(&example));
            let output = Shell::new("sh").args(["-c", &line]).current_dir(place.path()).output().unwrap();
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert!(matches!(output.status.code(), Some(0 | 1)), "{example}: {stderr}");
            assert!(!output.stdout.is_empty() || example.contains(" -o "), "{example} prints nothing");
        }
    }
    for file in ["out.exr", "out.png", "glass.exr", "box.xml", "references/own/cornell_box.exr"] {
        assert!(place.path().join(file).is_file(), "{file} was not written");
    }
}
