//! Promise: whatever bytes a file has that the program reads, it is taken for what it says or refused with what is wrong
//! and where; never a panic, never a hang, never memory that a few bytes ask for. Here with what is stored in `corpus/`
//! (small real files, and what libFuzzer once found) and with the project's own files; `fuzz/run` makes up more.

mod targets;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use targets::TARGETS;

/// Longer than this nobody waits for a refusal; planning the largest experiment takes a third of a second.
const PATIENCE: Duration = Duration::from_secs(60);

fn here() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile_input_is_refused"))
}

/// The files of a folder of the project, those with this ending only, if one is given.
fn files(folder: &Path, ending: Option<&str>) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files
        .retain(|file| file.is_file() && ending.is_none_or(|e| file.extension().is_some_and(|has| has == e)));
    files.sort();
    files
}

fn run(name: &str, target: fn(&[u8]), files: &[PathBuf]) {
    assert!(!files.is_empty(), "{name} has no files");
    for file in files {
        eprintln!("{name}: {}", file.display()); // shown where a target panics
        let begun = Instant::now();
        target(&fs::read(file).unwrap());
        assert!(begun.elapsed() < PATIENCE, "{} takes {:?}", file.display(), begun.elapsed());
    }
}

#[test]
fn stored_input_is_taken_or_refused() {
    for (name, target) in TARGETS {
        run(name, target, &files(&here().join("corpus").join(name), None));
    }
}

#[test]
fn real_files_are_taken_or_refused() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, target) in TARGETS {
        match name {
            "experiment" | "scene" => run(name, target, &files(&root.join("experiments"), Some("toml"))),
            "reference" => run(name, target, &files(&root.join("references"), Some("exr"))),
            _ => {}
        }
    }
}

/// Real files with a byte changed, or cut off: what damaged disks and bad copies leave.
#[test]
fn damaged_files_are_taken_or_refused() {
    for (name, target) in TARGETS {
        for file in files(&here().join("corpus").join(name), None) {
            let whole = fs::read(&file).unwrap();
            let step = (whole.len() / 40).max(1);
            for at in (0..whole.len()).step_by(step) {
                target(&whole[..at]);
                for byte in [0, b'9', b'"', 0xff] {
                    let mut changed = whole.clone();
                    changed[at] = byte;
                    target(&changed);
                }
            }
        }
    }
}

#[test]
fn each_target_can_be_run_by_libfuzzer() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = fs::read_to_string(root.join("fuzz/Cargo.toml")).unwrap();
    let programs: Vec<_> = files(&root.join("fuzz/fuzz_targets"), Some("rs"));
    assert_eq!(programs.len(), TARGETS.len());
    for (name, _) in TARGETS {
        let text = fs::read_to_string(root.join(format!("fuzz/fuzz_targets/{name}.rs"))).unwrap();
        assert!(text.contains(&format!("targets::run(\"{name}\", bytes)")), "{name}: {text}");
        assert!(
            manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")),
            "{name} is not in fuzz/Cargo.toml"
        );
    }
}
