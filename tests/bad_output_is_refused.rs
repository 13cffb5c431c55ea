//! Promise: where results cannot be written, or where what is stored cannot be read, this is said at once and in one
//! error with exit status 2; nobody's files are overwritten, and an older result stays as it was, byte for byte.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

const GOOD: &str = r#"question = "Can it be written?"
samples = 64
[grid]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

fn place() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), GOOD).unwrap();
    place
}

fn experiment(place: &Path, args: &[&str]) -> Output {
    Command::new(cargo_bin!("experiment")).args(args).current_dir(place).output().unwrap()
}

#[track_caller]
fn refuses(place: &Path, args: &[&str], words: &[&str]) {
    let output = experiment(place, args);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
    assert_eq!(stderr.matches("error:").count(), 1, "{args:?}: {stderr}");
    assert!(!stderr.contains("panicked"), "{args:?}: {stderr}");
    for word in words {
        assert!(stderr.contains(word), "{args:?} should say `{word}`: {stderr}");
    }
}

/// Every file below a folder, hidden ones too, with its bytes.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.push((path.display().to_string(), Vec::new()));
            all.extend(contents(&path));
        } else {
            all.push((path.display().to_string(), fs::read(&path).unwrap()));
        }
    }
    all.sort();
    all
}

/// A folder in which `x` has run.
fn place_with_result() -> TempDir {
    let place = place();
    let output = experiment(place.path(), &["x", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    place
}

#[test]
fn folders_that_cannot_be_written() {
    let place = place();
    fs::write(place.path().join("file"), "a regular file").unwrap();
    refuses(place.path(), &["x", "--out", "file/below"], &["cannot create the output folder file/below"]);
    refuses(place.path(), &["x", "--out", "file"], &["cannot create the output folder file"]);
    if cfg!(target_os = "linux") {
        refuses(place.path(), &["x", "--out", "/proc"], &["cannot write to the output folder /proc"]);
        refuses(place.path(), &["x", "--out", "/proc/new"], &["cannot create the output folder /proc/new"]);
    }
    refuses(
        place.path(),
        &["render", "cornell_box", "--spp", "2", "--resolution", "16", "-o", "file/out.exr"],
        &["cannot write file/out.exr"],
    );
    assert_eq!(fs::read(place.path().join("file")).unwrap(), b"a regular file");
}

#[test]
fn folders_that_hold_other_files() {
    let place = place();
    fs::create_dir_all(place.path().join("reports/x")).unwrap();
    fs::write(place.path().join("reports/x/thesis.tex"), "three years of work").unwrap();
    let before = contents(place.path());
    refuses(place.path(), &["x"], &["reports/x exists and holds no results", "choose another --out"]);
    assert_eq!(contents(place.path()), before);
    // nothing is in the way of an empty folder
    fs::remove_file(place.path().join("reports/x/thesis.tex")).unwrap();
    assert_eq!(experiment(place.path(), &["x"]).status.code(), Some(0));
}

#[test]
fn stored_cells_that_are_damaged() {
    let place = place_with_result();
    let cells = place.path().join("reports/x/cells.json");
    let good = fs::read_to_string(&cells).unwrap();
    let damaged: [(&str, String); 5] = [
        ("EOF while parsing", good[..good.len() / 2].to_owned()),
        ("EOF while parsing", String::new()),
        ("missing field `version`", "{}".to_owned()),
        ("invalid type: null, expected f64", good.replacen("\"mean\":", "\"mean\":null,\"was\":", 1)),
        ("holds other cells than x plans now; run the experiment again", good.replace("albedo", "other")),
    ];
    for (why, text) in damaged {
        fs::write(&cells, text).unwrap();
        let before = contents(place.path());
        refuses(place.path(), &["report", "x"], &["reports/x/cells.json", why]);
        assert_eq!(contents(place.path()), before, "{why}");
    }
}

#[test]
fn stored_cells_that_lack_what_is_reported() {
    let place = place_with_result();
    let cells = place.path().join("reports/x/cells.json");
    let good: serde_json::Value = serde_json::from_str(&fs::read_to_string(&cells).unwrap()).unwrap();
    for list in ["bounces", "tiles"] {
        let mut short = good.clone();
        short["cells"][0][list].as_array_mut().unwrap().truncate(1);
        fs::write(&cells, short.to_string()).unwrap();
        let before = contents(place.path());
        refuses(place.path(), &["report", "x"], &["reports/x/cells.json is damaged"]);
        assert_eq!(contents(place.path()), before, "{list}");
    }
}

#[test]
fn reports_of_what_has_not_run() {
    let place = place();
    refuses(place.path(), &["report", "x"], &["cannot read reports/x/cells.json"]);
    let place = place_with_result();
    fs::remove_file(place.path().join("reports/x/run.json")).unwrap();
    let before = contents(place.path());
    refuses(place.path(), &["report", "x"], &["cannot read reports/x/run.json"]);
    assert_eq!(contents(place.path()), before);
}

/// A file system of few bytes, unmounted at the end.
#[cfg(target_os = "linux")]
struct Small(std::path::PathBuf);

#[cfg(target_os = "linux")]
impl Small {
    fn mount(folder: &Path, size: usize) -> Option<Self> {
        fs::create_dir(folder).unwrap();
        let size = format!("size={size}");
        let mut mount = std::process::Command::new("mount");
        let done = mount.args(["-t", "tmpfs", "-o", &size, "tmpfs"]).arg(folder).output();
        done.is_ok_and(|out| out.status.success()).then(|| Small(folder.to_owned()))
    }
}

#[cfg(target_os = "linux")]
impl Drop for Small {
    fn drop(&mut self) {
        let _ = std::process::Command::new("umount").arg(&self.0).status();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk() {
    let place = place_with_result();
    let size: usize = contents(&place.path().join("reports")).iter().map(|(_, bytes)| bytes.len()).sum();
    let out = place.path().join("small");
    // enough for the older result, not for a second one beside it
    let Some(_small) = Small::mount(&out, size * 3 / 2) else {
        println!("skipped: mounting a small file system needs root");
        return;
    };
    let first = experiment(place.path(), &["x", "--out", "small"]);
    assert_eq!(first.status.code(), Some(0), "{}", String::from_utf8_lossy(&first.stderr));
    let before = contents(&out);
    refuses(place.path(), &["x", "--out", "small", "--quiet"], &["cannot write", "No space left on device"]);
    assert_eq!(contents(&out), before, "the older result was touched, or unfinished files were left");
    refuses(place.path(), &["report", "x", "--out", "small"], &["No space left on device"]);
    assert_eq!(contents(&out), before);
}
