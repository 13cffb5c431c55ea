//! Promise: what the documents show works as shown, every link leads somewhere, and the guide tells every key of experiment
//! files.
//!
//! What becomes of a code block follows from the word behind its fence:
//!
//! - `rust` is compiled and run by the tests of documentation (`src/lib.rs` names the chapter);
//! - `toml` is an experiment file, which runs with `--quick`; `# experiments/NAME.toml` in its first line names it, so that
//!   commands can use it. `toml part` is part of one, whose whole is planned; `toml wrong` is refused;
//! - `console`: `$ experiment ...` is run and prints what is shown; other commands must exist; see `console.rs`;
//! - `json` has the form of what the last command printed;
//! - `sh` are the commands of the README that `.ci/run` runs;
//! - `text` is for pictures made of letters, and holds no command.

mod console;
mod fences;
mod part;

use console::Session;
use fences::{documents, links, read, root, split};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A folder with references, and with those experiments that a text names.
fn place(text: &str) -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    for folder in ["experiments", "references"] {
        fs::create_dir(place.path().join(folder)).unwrap();
        for entry in fs::read_dir(root().join(folder)).unwrap().map(Result::unwrap) {
            let name = entry.file_name().into_string().unwrap();
            let is_named = name.strip_suffix(".toml").is_none_or(|name| text.contains(name));
            if entry.file_type().unwrap().is_file() && is_named {
                fs::copy(entry.path(), place.path().join(folder).join(name)).unwrap();
            }
        }
    }
    place
}

/// Does with each code block of a document what its kind asks for.
fn holds(document: &str) {
    let text = read(Path::new(document));
    let (fences, _) = split(&text);
    let commands: String = fences.iter().filter(|f| f.kind == "console").map(|f| f.text.as_str()).collect();
    let place = place(&commands);
    let mut session =
        Session { place: place.path(), patched: String::new(), status: 0, printed: String::new() };
    for fence in fences {
        println!("{document}:{}", fence.line); // shown where it fails
        match fence.kind.as_str() {
            "rust" => {
                let includes = read(Path::new("src/lib.rs"));
                assert!(includes.contains(&format!("include_str!(\"../{document}\")")), "it is not compiled");
            }
            "toml" => part::runs(&session, &fence.text),
            "toml part" => drop(part::plan(&session, &part::completed(&fence.text))),
            "toml wrong" => part::refused(&session, &fence.text),
            "console" => console::run(&mut session, &fence.text),
            "json" => has_form(&parse(&fence.text), &parse(&session.printed)),
            "sh" => assert_eq!(
                document, "README.md",
                "`sh` is for the README's two commands; see readme_holds.rs"
            ),
            "text" => {
                let is_command =
                    |line: &str| ["$ ", "experiment ", "cargo "].iter().any(|c| line.starts_with(c));
                assert!(!fence.text.lines().any(is_command), "a command belongs to a `console`");
            }
            kind => panic!("no rule tells what to do with `{kind}`"),
        }
    }
}

fn parse(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Holds that what is shown has the keys and kinds of values that there really are; it may leave some out.
fn has_form(shown: &Value, real: &Value) {
    match (shown, real) {
        (Value::Object(shown), Value::Object(real)) => shown.iter().for_each(|(key, value)| {
            has_form(value, real.get(key).unwrap_or_else(|| panic!("there is no key `{key}`: {real:?}")));
        }),
        (Value::Array(shown), Value::Array(real)) => {
            shown.iter().zip(real).for_each(|(shown, real)| has_form(shown, real));
            assert!(shown.len() <= real.len(), "so many there are not: {shown:?}");
        }
        _ => assert_eq!(std::mem::discriminant(shown), std::mem::discriminant(real), "{shown} for {real}"),
    }
}

macro_rules! hold {
    ($($name:ident: $document:literal,)*) => {
        $(#[test] fn $name() { holds($document) })*

        #[test]
        fn every_document_is_held() {
            let held: BTreeSet<&str> = BTreeSet::from([$($document),*]);
            let there = documents();
            assert_eq!(held, there.iter().map(|path| path.to_str().unwrap()).collect());
        }
    };
}

hold! {
    readme: "README.md",
    contributing: "CONTRIBUTING.md",
    changelog: "CHANGELOG.md",
    experiments: "experiments/README.md",
    references_readme: "references/README.md",
    summary: "docs/src/SUMMARY.md",
    first_run: "docs/src/first_run.md",
    page: "docs/src/page.md",
    verdict: "docs/src/verdict.md",
    experiment_files: "docs/src/experiment_files.md",
    scenes: "docs/src/scenes.md",
    estimators: "docs/src/estimators.md",
    references: "docs/src/references.md",
    own_estimator: "docs/src/own_estimator.md",
    mistakes: "docs/src/mistakes.md",
    baselines: "docs/src/baselines.md",
    figures: "docs/src/figures.md",
    ci: "docs/src/ci.md",
    resume: "docs/src/resume.md",
    cluster: "docs/src/cluster.md",
    json: "docs/src/json.md",
    input: "docs/src/input.md",
    verdicts: "docs/src/verdicts.md",
    performance: "docs/src/performance.md",
    scale: "docs/src/scale.md",
    cornell_flush: "docs/src/cornell_flush.md",
    glossary: "docs/src/glossary.md",
}

#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    for document in documents() {
        let (_, prose) = split(&read(&document));
        for link in links(&prose) {
            let file = link.split('#').next().unwrap();
            if file.is_empty() || link.starts_with("https://") {
                continue;
            }
            let folder = root().join(&document).parent().unwrap().to_owned();
            assert!(folder.join(file).exists(), "{}: {link} leads nowhere", document.display());
            count += 1;
        }
    }
    assert!(count > 50, "only {count} links are found");
}

#[test]
fn every_chapter_is_in_the_summary() {
    let summary = links(&read(Path::new("docs/src/SUMMARY.md")));
    for document in documents() {
        let Ok(chapter) = document.strip_prefix("docs/src") else { continue };
        let chapter = chapter.to_str().unwrap();
        assert!(chapter == "SUMMARY.md" || summary.iter().any(|link| link == chapter), "{chapter}");
    }
}

/// Names of keys and of values that can be chosen, mistakes apart: those are for the catalogue to tell.
fn names(schema: &Value, found: &mut BTreeSet<String>) {
    if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
        found.extend(properties.keys().cloned());
    }
    let chosen =
        schema.get("enum").and_then(Value::as_array).into_iter().flatten().chain(schema.get("const"));
    let chosen = chosen.filter_map(Value::as_str).map(str::to_owned);
    found.extend(chosen.filter(|name| furnace::faults::find(name).is_none()));
    match schema {
        Value::Object(parts) => parts.values().for_each(|part| names(part, found)),
        Value::Array(parts) => parts.iter().for_each(|part| names(part, found)),
        _ => {}
    }
}

#[test]
fn every_key_of_experiment_files_is_told() {
    let mut keys = BTreeSet::new();
    names(&parse(&read(Path::new("experiments/schema.json"))), &mut keys);
    assert!(keys.len() > 150, "{keys:?}");
    let chapters = ["experiment_files", "scenes", "estimators", "references"];
    let text: String = chapters.iter().map(|name| read(Path::new(&format!("docs/src/{name}.md")))).collect();
    let told: BTreeSet<&str> = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
    let missing: Vec<&String> = keys.iter().filter(|key| !told.contains(key.as_str())).collect();
    assert!(missing.is_empty(), "the guide does not tell {missing:?}");
}

/// Every experiment stands in the README's table, and the table names no other.
#[test]
fn the_readme_lists_every_experiment() {
    let readme = read(Path::new("README.md"));
    let table = readme.split("| experiment | question | found |\n").nth(1).expect("a table of experiments");
    let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
    let listed: BTreeSet<String> =
        rows.map(|row| row.split('`').nth(1).expect("a name").to_owned()).collect();
    let files = fs::read_dir(root().join("experiments")).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    assert_eq!(listed, files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect());
}
