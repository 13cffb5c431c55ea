//! The documents, and what stands in them between fences.

use std::fs;
use std::path::{Path, PathBuf};

/// A block of code.
pub struct Fence {
    /// What stands behind its first fence.
    pub kind: String,
    /// What stands within.
    pub text: String,
    /// The line of its first fence, from 1.
    pub line: usize,
}

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All documents of the repository, relative to it.
pub fn documents() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap().map(Result::unwrap) {
            let path = folder.join(entry.file_name());
            let name = entry.file_name().into_string().unwrap();
            if name.starts_with('.') || ["target", "reports"].contains(&name.as_str()) {
                continue;
            }
            if entry.file_type().unwrap().is_dir() {
                folders.push(path);
            } else if name.ends_with(".md") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

pub fn read(document: &Path) -> String {
    fs::read_to_string(root().join(document)).unwrap()
}

/// Splits a text into its code blocks and its prose.
pub fn split(text: &str) -> (Vec<Fence>, String) {
    let (mut fences, mut prose) = (Vec::<Fence>::new(), String::new());
    let mut open = false;
    for (i, line) in text.lines().enumerate() {
        match (line.strip_prefix("```"), open) {
            (Some(kind), false) => {
                fences.push(Fence { kind: kind.trim().to_owned(), text: String::new(), line: i + 1 });
                open = true;
            }
            (Some(_), true) => open = false,
            (None, true) => fences.last_mut().unwrap().text.extend([line, "\n"]),
            (None, false) => prose.extend([line, "\n"]),
        }
    }
    assert!(!open, "the last code block does not end");
    (fences, prose)
}

/// Where links of prose lead; not those within `code`.
pub fn links(prose: &str) -> Vec<String> {
    let text: String = prose.split('`').step_by(2).collect();
    let starts = text.match_indices("](").map(|(at, _)| at + 2);
    starts.map(|at| text[at..].split(')').next().unwrap().to_owned()).collect()
}
