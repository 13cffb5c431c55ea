//! Promise: where a journal cannot be written any more, the run ends with one error and exit status 2, and what was written
//! before is gone on from once it can.
#![cfg(target_os = "linux")]

use assert_cmd::cargo::cargo_bin;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const FILE: &str = r#"question = "Is there room?"
samples = 2_000_000
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = ["throughput"]
"#;

fn place() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), FILE).unwrap();
    place
}

fn start(place: &Path, args: &str) -> Child {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(args.split(' ')).current_dir(place).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// Exit status and standard error.
fn ended(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[track_caller]
fn refused(child: Child, words: &[&str]) {
    let (code, stderr) = ended(child);
    assert_eq!(code, Some(2), "{stderr}");
    assert_eq!(stderr.matches("error:").count(), 1, "{stderr}");
    words.iter().for_each(|word| assert!(stderr.contains(word), "it should say `{word}`: {stderr}"));
}

/// A file system in memory, unmounted at the end; `None` for who may not mount one.
struct Small(PathBuf);

impl Small {
    fn mount(folder: &Path, options: &str) -> Option<Self> {
        fs::create_dir_all(folder).unwrap();
        let mut mount = Command::new("mount");
        let done = mount.args(["-t", "tmpfs", "-o", options, "tmpfs"]).arg(folder).output();
        let mounted = done.is_ok_and(|out| out.status.success()).then(|| Small(folder.to_owned()));
        if mounted.is_none() {
            println!("skipped: mounting a small file system needs root");
        }
        mounted
    }
}

impl Drop for Small {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

#[test]
fn a_full_disk_loses_nothing() {
    let place = place();
    let folder = place.path();
    let Some(_small) = Small::mount(&folder.join("small"), "size=300k") else { return };
    let words = ["cannot write small/x.journal/1-of-1.journal", "No space left on device"];
    refused(start(folder, "x --quiet --out small"), &words);
    assert!(!folder.join("small/x").exists(), "a result of half a run");
    // what fitted is gone on from elsewhere
    fs::create_dir_all(folder.join("large/x.journal")).unwrap();
    let journal = "x.journal/1-of-1.journal";
    fs::copy(folder.join("small").join(journal), folder.join("large").join(journal)).unwrap();
    let (code, stderr) = ended(start(folder, "x --resume --out large"));
    assert_eq!(code, Some(0), "{stderr}");
    let kept = stderr.lines().find(|line| line.contains("blocks are in large/x.journal")).unwrap_or("0");
    let kept: u32 = kept.split(' ').next().unwrap().parse().unwrap();
    assert!(kept > 100, "{stderr}");
    assert_eq!(ended(start(folder, "x --quiet")).0, Some(0));
    let results = |out: &str| fs::read(folder.join(out).join("x/results.csv")).unwrap();
    assert!(results("large") == results("reports"), "another result");
}

#[test]
fn nothing_can_be_written_there() {
    let place = place();
    let Some(_small) = Small::mount(&place.path().join("fixed"), "size=300k,ro") else { return };
    refused(start(place.path(), "x --quiet --out fixed"), &["fixed", "Read-only file system"]);
    refused(start(place.path(), "x --quiet --out fixed --shard 1/2"), &["fixed", "Read-only file system"]);
}

#[test]
fn a_folder_that_vanishes_is_noticed() {
    let place = place();
    let file = FILE.replace("2_000_000", "2_000_000_000");
    fs::write(place.path().join("experiments/x.toml"), file).unwrap();
    let child = start(place.path(), "x --quiet");
    let folder = place.path().join("reports/x.journal");
    let begun = Instant::now();
    while !folder.join("1-of-1.journal").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no journal");
        std::thread::sleep(Duration::from_millis(10));
    }
    fs::remove_dir_all(&folder).unwrap();
    let gone = Instant::now();
    refused(child, &["cannot write", "1-of-1.journal: it was removed while it was written"]);
    assert!(gone.elapsed() < Duration::from_secs(20), "noticed after {:?}", gone.elapsed());
}
