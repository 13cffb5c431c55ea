//! Promise: imports go downwards only, files and functions stay short, and what is sampled calls no function whose last
//! bit depends on the platform.
//!
//! Reads the sources as text: enough for code that rustfmt has laid out.

use std::fs;
use std::path::{Path, PathBuf};

/// A layer and all that it may name: bin -> report -> experiment -> { truth, stats, faults, fast }; faults -> truth; all
/// of them but stats -> estimator -> scene -> sampling. Binaries name the crate `furnace` and stand above all.
const LAYERS: [(&str, &[&str]); 9] = [
    ("sampling", &["sampling"]),
    ("scene", &["scene", "sampling"]),
    ("estimator", &["estimator", "scene", "sampling"]),
    ("fast", &["fast", "estimator", "scene", "sampling"]),
    ("truth", &["truth", "estimator", "scene", "sampling"]),
    ("faults", &["faults", "truth", "estimator", "scene", "sampling"]),
    ("stats", &["stats"]),
    ("experiment", &["experiment", "faults", "truth", "stats", "fast", "estimator", "scene", "sampling"]),
    ("report", &["report", "experiment", "faults", "truth", "stats", "estimator", "scene", "sampling"]),
];
const MAX_FILE: usize = 320;
const MAX_FUNCTION: usize = 60;

/// Methods of f64 (and of vectors) that call the platform's mathematics, or fuse a product and a sum. `libm::` has no
/// dot before its names.
const PLATFORM: [&str; 30] = [
    "sin",
    "cos",
    "tan",
    "sin_cos",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "ln_1p",
    "log",
    "log2",
    "log10",
    "powf",
    "powi",
    "cbrt",
    "hypot",
    "mul_add",
    "mul_sub",
    "approximate_recip",
    "to_int_precise",
    "angle_between",
    "rotate_towards",
    "slerp",
];

/// Every Rust file below `folder`, as a path from `src/`, with its text.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            files.push((path.strip_prefix(root()).unwrap().to_path_buf(), text));
        }
    }
    files.sort();
    files
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The layer of a file: its first folder, or the module that a file next to `lib.rs` is.
fn layer(path: &Path) -> String {
    path.components().next().unwrap().as_os_str().to_string_lossy().trim_end_matches(".rs").to_string()
}

/// Lines of code with their numbers: no comments, and no item that is compiled for unit tests only.
fn code(text: &str) -> Vec<(usize, &str)> {
    let (mut lines, mut skips) = (Vec::new(), false);
    for (number, line) in (1..).zip(text.lines()) {
        if line == "#[cfg(test)]" {
            skips = true;
        } else if skips {
            // up to the item's end, `}` or `;` in the first column's indentation
            skips = !(line == "}" || line.ends_with(';') && !line.starts_with(' '));
        } else if !line.trim_start().starts_with("//") {
            lines.push((number, line));
        }
    }
    lines
}

/// The module that each `crate::` of a line names. Several at once, `crate::{`, would hide from this: they come back
/// as an empty name, which no layer may use.
fn named(line: &str) -> impl Iterator<Item = &str> {
    let name = |rest: &str| rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    line.split("crate::").skip(1).map(move |rest| &rest[..name(rest)])
}

/// Whether a line names the crate from outside, `furnace::`; a module may end in that word.
fn names_the_crate(line: &str) -> bool {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices("furnace::").any(|(at, _)| !line[..at].ends_with(is_word))
}

#[test]
fn imports_go_downwards() {
    let mut wrong = Vec::new();
    for (path, text) in sources(&root()) {
        let layer = layer(&path);
        if layer == "bin" || layer == "lib" {
            continue;
        }
        let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| *name == layer) else {
            wrong.push(format!("{}: a new layer, which has no place in LAYERS", path.display()));
            continue;
        };
        // how many `super::` lead out of the layer: the folders above, and for a file that is no `mod.rs` itself
        let depth = path.components().count() - usize::from(path.ends_with("mod.rs"));
        for (number, line) in code(&text) {
            let out = line.contains(&"super::".repeat(depth.max(1)));
            if out || names_the_crate(line) || named(line).any(|name| !allowed.contains(&name)) {
                wrong.push(format!("{}:{number}: {}", path.display(), line.trim()));
            }
        }
    }
    assert!(wrong.is_empty(), "not downwards:\n{}", wrong.join("\n"));
}

/// What is sampled in earnest cannot be switched to a fault: nothing but the layers that choose estimators names them.
#[test]
fn faults_are_chosen_from_above() {
    let chooses = ["faults", "experiment", "report", "bin", "lib"];
    let mut wrong = Vec::new();
    for (path, text) in sources(&root()) {
        if chooses.contains(&layer(&path).as_str()) {
            continue;
        }
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let names = |line: &str| line.split(|c| !is_word(c)).any(|word| word == "faults" || word == "Faulty");
        wrong.extend(
            code(&text)
                .into_iter()
                .filter(|(_, line)| names(line))
                .map(|(n, _)| format!("{}:{n}", path.display())),
        );
    }
    assert!(wrong.is_empty(), "names faults: {}", wrong.join(", "));
}

#[test]
fn files_and_functions_are_short() {
    let mut long = Vec::new();
    for (path, text) in sources(&root()) {
        let lines: Vec<&str> = text.lines().collect();
        if lines.len() > MAX_FILE {
            long.push(format!("{}: {} lines", path.display(), lines.len()));
        }
        for (start, line) in lines.iter().enumerate() {
            let (indent, words) = line.split_at(line.len() - line.trim_start().len());
            // `fn name(`; a field of type `fn(` is none
            let before: Vec<&str> = words.split('(').next().unwrap().split_whitespace().collect();
            let is_function = before.iter().rev().skip(1).any(|word| *word == "fn");
            if !is_function || words.starts_with("//") || words.ends_with(['}', ';']) {
                continue;
            }
            // the first line after it that closes at its own indentation
            let end = lines[start..].iter().position(|line| line.strip_prefix(indent) == Some("}"));
            let length = end.map_or(0, |end| end + 1);
            if length > MAX_FUNCTION {
                long.push(format!("{}:{}: {length} lines: {words}", path.display(), start + 1));
            }
        }
    }
    assert!(long.is_empty(), "too long:\n{}", long.join("\n"));
}

#[test]
fn sampling_calls_no_platform_mathematics() {
    let mut wrong = Vec::new();
    for (path, text) in sources(&root()) {
        if !["sampling", "scene", "estimator", "fast", "faults"].contains(&layer(&path).as_str()) {
            continue;
        }
        for (number, line) in code(&text) {
            let calls =
                |name: &&str| line.contains(&format!(".{name}(")) || line.contains(&format!("f64::{name}"));
            if PLATFORM.iter().any(calls) {
                wrong.push(format!("{}:{number}: {}", path.display(), line.trim()));
            }
        }
    }
    assert!(wrong.is_empty(), "not the same on every platform:\n{}", wrong.join("\n"));
}

#[test]
fn scripts_of_the_page_define_every_name_once() {
    // all of them share one scope, in which a second function would silently take the place of the first
    let mut seen: Vec<(String, PathBuf)> = Vec::new();
    for entry in fs::read_dir("src/report/page/script").unwrap() {
        let path = entry.unwrap().path();
        for line in fs::read_to_string(&path).unwrap().lines() {
            let line = line.strip_prefix("async ").unwrap_or(line);
            let Some(rest) = ["function ", "const ", "let "].iter().find_map(|word| line.strip_prefix(word))
            else {
                continue;
            };
            let name: String =
                rest.chars().take_while(|c| c.is_alphanumeric() || "_$".contains(*c)).collect();
            let other = seen.iter().find(|(known, _)| *known == name).map(|(_, other)| other);
            assert!(
                other.is_none(),
                "{name} is defined in {} and in {}",
                path.display(),
                other.unwrap().display()
            );
            seen.push((name, path.clone()));
        }
    }
    assert!(seen.len() > 50, "scripts are not read: {} names", seen.len());
}
