//! Experiment files that a document shows, whole or in part.

use crate::console::Session;
use std::fs;
use std::process::Command;
use toml::{Table, Value};

/// What a part of a file does not say.
const REST: &str = r#"
question = "Does it work?"
samples = 64
scene = [{ cornell_box = { resolution = 4 } }]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

/// A part of a file, as the whole file that it would be part of: scenes, estimators and rules are those of its grid.
pub fn completed(part: &str) -> String {
    let mut whole: Table = part.parse().unwrap_or_else(|e| panic!("{e}"));
    for (key, value) in REST.parse::<Table>().unwrap() {
        whole.entry(key).or_insert(value);
    }
    let mut grid = Table::new();
    for key in ["scene", "estimator", "roulette"] {
        grid.insert(key.to_owned(), whole.remove(key).unwrap());
    }
    whole.entry("grid").or_insert(Value::Array(vec![Value::Table(grid)]));
    toml::to_string(&whole).unwrap()
}

/// Holds that the file is understood, and that something of it can be run; the name that it has in its first line.
pub fn plan(session: &Session<'_>, text: &str) -> String {
    let first = text.lines().next().unwrap();
    let named = first.strip_prefix("# experiments/").and_then(|rest| rest.strip_suffix(".toml"));
    let name = named.unwrap_or("shown").to_owned();
    fs::write(session.place.join(format!("experiments/{name}.toml")), text).unwrap();
    let (status, printed) = experiment(session, &["plan", &name]);
    assert!(status == 0 && printed.contains(" samples "), "{printed}\n{text}");
    name
}

/// Holds that the file is refused.
pub fn refused(session: &Session<'_>, text: &str) {
    let name = text.lines().next().and_then(|line| line.strip_prefix("# ")).expect("the file's name");
    fs::write(session.place.join(name), text).unwrap();
    let (status, printed) = experiment(session, &["plan", name]);
    assert_eq!(status, 2, "{printed}");
}

/// Holds that the file runs, with few samples, which may leave its claims open.
pub fn runs(session: &Session<'_>, text: &str) {
    let name = plan(session, text);
    let (status, printed) = experiment(session, &[&name, "--quick", "--quiet", "--out", "quick"]);
    assert!(status <= 1, "{printed}");
}

fn experiment(session: &Session<'_>, arguments: &[&str]) -> (i32, String) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_experiment"));
    let output = program.args(arguments).current_dir(session.place).output().unwrap();
    let printed = [output.stdout, output.stderr].concat();
    (output.status.code().unwrap(), String::from_utf8(printed).unwrap())
}
