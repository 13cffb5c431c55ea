//! Whatever the program reads from outside, one function a kind: each takes any bytes, and panics where a promise about them
//! is broken. The tests call them with what is stored in `corpus/`, and libFuzzer with what it makes up (`fuzz/`).

mod journal;
mod results;
mod scene;
mod stored_image;
mod written;

use furnace::experiment::{Error, Overrides, Plan};
use std::path::Path;

/// A kind of input: its name, which is that of its folder in `corpus/`, and its function.
pub type Target = (&'static str, fn(&[u8]));

/// All of them. A new kind of file is added here, as a file in `fuzz/fuzz_targets`, and as a `[[bin]]` of `fuzz/Cargo.toml`.
pub const TARGETS: [Target; 10] = [
    ("experiment", written::experiment),
    ("scene", scene::scene),
    ("set", written::set),
    ("cells", results::cells),
    ("run", results::run),
    ("study", results::study),
    ("summary", results::summary),
    ("baseline", results::baseline),
    ("journal", journal::journal),
    ("reference", stored_image::reference),
];

/// Runs the target of this name.
#[allow(dead_code, reason = "libFuzzer has one target a program, the tests have them all")]
pub fn run(name: &str, bytes: &[u8]) {
    let (_, target) = TARGETS.iter().find(|(of, _)| *of == name).expect("a target of this name");
    target(bytes);
}

/// The folder in which all files of the targets are said to lie; there is none.
const NOWHERE: &str = "/nowhere/experiments";

/// A small experiment, to which results belong.
const SMALL: &str = include_str!("../small.toml");

fn small() -> Plan {
    let file = Path::new(NOWHERE).join("small.toml");
    Plan::new("small", &file, SMALL, &Overrides::default()).expect("the small experiment is sound")
}

/// Holds that an error says where: by the file's name, or for what is wrong between the lines of a file by the experiment's.
fn says_where(error: &Error, file: &Path) {
    let text = error.to_string();
    assert!(!text.is_empty() && text.len() < 20_000, "an error of {} bytes", text.len());
    match error {
        Error::Input(place) => {
            assert!(place.line >= 1 && place.column >= 1 && place.length <= place.text.chars().count() + 1);
        }
        _ => {
            let stem = file.file_stem().expect("files have names").to_string_lossy();
            assert!(text.contains(&*stem), "{text}");
        }
    }
}
