//! Promise: a run that was killed at any moment goes on to the result of an undisturbed one, byte for byte; so do its parts,
//! on any number of threads, put together. Nobody else writes where a run writes, and none goes on from another one.
#![cfg(unix)]

use assert_cmd::cargo::cargo_bin;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A second of work: probes, of which some end early, and images.
const FILE: &str = r#"question = "What survives?"
samples = 262_144
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05, scene = "furnace" } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }, "integrating_sphere"]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.5, 0.7] } }, "throughput"]
[[grid]]
scene = [{ cornell_box = { resolution = 32 } }]
estimator = ["explicit", "implicit"]
roulette = ["throughput"]
samples = 300
"#;

fn place(file: &str) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), file).unwrap();
    place
}

fn command(place: &Path, args: &str) -> Command {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(args.split_whitespace()).current_dir(place).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[track_caller]
fn run(place: &Path, args: &str, code: i32) -> String {
    let Output { status, stderr, .. } = command(place, args).output().unwrap();
    let stderr = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(code), "{args}: {stderr}");
    stderr
}

#[track_caller]
fn refuses(place: &Path, args: &str, words: &[&str]) {
    let stderr = run(place, args, 2);
    assert_eq!(stderr.matches("error:").count(), 1, "{args}: {stderr}");
    words.iter().for_each(|word| assert!(stderr.contains(word), "{args} should say `{word}`: {stderr}"));
}

/// Results and images of a report, with their names.
fn results(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let kept = files.filter(|path| path.extension().is_some_and(|e| e == "csv" || e == "exr"));
    let mut kept: Vec<_> = kept
        .filter(|path| path.file_name().is_some_and(|name| name != "timing.csv"))
        .map(|path| (path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap()))
        .collect();
    kept.sort();
    assert!(kept.len() >= 3, "results.csv and two images");
    kept
}

/// What an undisturbed run leads to, and how long it takes.
fn undisturbed(file: &str) -> (Vec<(PathBuf, Vec<u8>)>, Duration) {
    let place = place(file);
    let start = Instant::now();
    run(place.path(), "x --quiet", 0);
    (results(&place.path().join("reports/x")), start.elapsed())
}

/// Numbers in 0..1 that differ from run to run: promises are about any moment.
fn chance() -> impl FnMut() -> f64 {
    let mut state =
        std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_nanos() as u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Kills a run after a time, if it has not ended before; whether it had to.
fn killed(mut child: Child, after: Duration) -> bool {
    std::thread::sleep(after);
    child.kill().unwrap();
    child.wait_with_output().unwrap().status.signal() == Some(9)
}

/// `FURNACE_KILLS=200` tries as often as that.
#[test]
fn killed_runs_go_on_to_the_same_result() {
    let rounds = std::env::var("FURNACE_KILLS").map_or(8, |n| n.parse().expect("a number"));
    let (right, time) = undisturbed(FILE);
    let (mut chance, mut kills) = (chance(), 0);
    for round in 0..rounds {
        let place = place(FILE);
        // up to three in a row, on other numbers of threads
        for _ in 0..1 + round % 3 {
            let threads = 1 + (chance() * 3.0) as u32;
            let child = command(place.path(), &format!("x --quiet --jobs {threads}")).spawn().unwrap();
            kills += u32::from(killed(child, time.mul_f64(chance())));
        }
        run(place.path(), "x --quiet", 0);
        assert!(results(&place.path().join("reports/x")) == right, "round {round}: another result");
    }
    println!("{rounds} runs, {kills} kills");
    assert!(kills >= rounds / 2, "hardly any was killed");
}

#[test]
fn shards_and_threads_lead_to_the_same_result() {
    let (right, _) = undisturbed(FILE);
    for shards in [1, 2, 3, 16] {
        let place = place(FILE);
        for shard in 1..=shards {
            let threads = [1, 2, 7][shard % 3];
            run(place.path(), &format!("x --quiet --jobs {threads} --shard {shard}/{shards}"), 0);
        }
        assert!(!place.path().join("reports/x").exists(), "a part is no result");
        run(place.path(), "merge reports/x.journal --quiet", 0);
        assert!(results(&place.path().join("reports/x")) == right, "{shards} shards: another result");
    }
    for threads in [1, 2, 7] {
        let place = place(FILE);
        run(place.path(), &format!("x --quiet --jobs {threads}"), 0);
        assert!(results(&place.path().join("reports/x")) == right, "{threads} threads: another result");
    }
}

#[test]
fn merging_names_what_does_not_fit() {
    let place = place(FILE);
    let folder = place.path();
    for shard in ["1/3", "2/3", "3/3"] {
        run(folder, &format!("x --quiet --shard {shard}"), 0);
    }
    let journal = |name: &str| folder.join("reports/x.journal").join(name);
    // a gap
    fs::rename(journal("2-of-3.journal"), folder.join("kept")).unwrap();
    let stderr = run(folder, "merge reports/x.journal", 75);
    let label = "furnace implicit constant q=0.5: 21 of 64: block 1, block 4, block 7";
    assert!(stderr.contains("blocks are missing") && stderr.contains(label), "{stderr}");
    assert!(!folder.join("reports/x").exists(), "something was written");
    // from two folders, with what both have
    fs::create_dir(folder.join("other")).unwrap();
    fs::rename(folder.join("kept"), folder.join("other/2-of-3.journal")).unwrap();
    fs::copy(journal("1-of-3.journal"), folder.join("other/1-of-3.journal")).unwrap();
    let stderr = run(folder, "merge reports/x.journal other", 0);
    assert!(
        stderr.contains("lines are in two journals, with the same numbers: first block 0 of"),
        "{stderr}"
    );
    // with other numbers
    let other = folder.join("elsewhere");
    let command = "x --quiet --seed 2 --shard 1/3 --out elsewhere";
    run(folder, command, 0);
    refuses(
        folder,
        "merge reports/x.journal elsewhere/x.journal",
        &["are of different runs: the seed is 2 there and 1 here"],
    );
    fs::write(other.join("x.journal/1-of-3.journal"), forged(&fs::read(journal("1-of-3.journal")).unwrap()))
        .unwrap();
    let words = [
        "block 0 of `furnace implicit constant q=0.5` in",
        "other numbers",
        "reports/x.journal/1-of-3.journal (line 2)",
        "elsewhere/x.journal/1-of-3.journal (line 2)",
    ];
    refuses(folder, "merge reports/x.journal elsewhere/x.journal", &words);
    refuses(folder, "merge experiments", &["experiments holds no journals"]);
    refuses(folder, "merge nowhere", &["cannot read nowhere"]);
}

/// A journal whose first line of blocks says something else, with a checksum that is right.
fn forged(journal: &[u8]) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> =
        journal.split_inclusive(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    let line = &mut lines[1];
    let place = line.len() - 40;
    line[place] ^= 64;
    assert!(!b"\n\x1b".contains(&line[place]));
    let sum = format!("{:08x}", crc32fast::hash(&line[8..line.len() - 1]));
    line[..8].copy_from_slice(sum.as_bytes());
    lines.concat()
}

/// A run that takes minutes, when its first cell is in the journal.
fn long_run(place: &Path) -> Child {
    fs::write(place.join("experiments/long.toml"), FILE.replace("300", "3_000_000")).unwrap();
    let child = command(place, "long --quiet --jobs 1").spawn().unwrap();
    let journal = place.join("reports/long.journal/1-of-1.journal");
    let start = Instant::now();
    while fs::metadata(&journal).map_or(0, |file| file.len()) < 100_000 {
        assert!(start.elapsed() < Duration::from_secs(60), "no journal");
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

#[test]
fn nobody_else_writes_there_until_it_ends() {
    let place = place(FILE);
    let child = long_run(place.path());
    let words =
        ["reports/long.journal/1-of-1.journal: another process is writing it", "choose another --out"];
    refuses(place.path(), "long --fresh", &words);
    let output = command(place.path(), "status reports/long.journal").output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.starts_with("1/1: running, "), "{stdout}");
    assert!(killed(child, Duration::ZERO));
    // the lock went with it
    let child = command(place.path(), "long --quiet").spawn().unwrap();
    assert!(killed(child, Duration::from_secs(2)), "it was refused");
    let output = command(place.path(), "status reports/long.journal").output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.starts_with("1/1: stopped, "), "{stdout}");
}

#[test]
fn none_goes_on_from_another_run() {
    let place = place(FILE);
    assert!(killed(long_run(place.path()), Duration::ZERO));
    let folder = place.path();
    let journal = folder.join("reports/long.journal/1-of-1.journal");
    let before = fs::read(&journal).unwrap();
    let file = folder.join("experiments/long.toml");
    let text = fs::read_to_string(&file).unwrap();
    let is = "1-of-1.journal is of another run: ";
    refuses(
        folder,
        "long --seed 2",
        &[is, "the seed is 1 there and 2 here; --fresh starts over, --out keeps both"],
    );
    refuses(folder, "long --filter furnace", &[is, "the number of cells is 8 there and 3 here"]);
    refuses(folder, "long --core fast", &[is, "is another, after other options"]);
    fs::write(&file, text.replace("0.8, 0.5", "0.8, 0.6")).unwrap();
    let line = "line 5 of the file was `scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }, \"integrating_sphere\"]`";
    refuses(folder, "long --resume", &[is, "`furnace implicit constant q=0.5` is another: ", line]);
    fs::write(&file, text.replace("[0.5, 0.7]", "[0.5, 0.75]")).unwrap();
    refuses(folder, "long", &[is, "a cell is furnace implicit constant q=0.7 there"]);
    assert_eq!(fs::read(&journal).unwrap(), before, "it was touched");
    let header = String::from_utf8_lossy(&before).lines().next().unwrap().to_owned();
    for (key, why) in [("version", "the version of this program is"), ("sources", "built from other sources")]
    {
        let at = header.find(&format!("\"{key}\":\"")).unwrap() + key.len() + 4;
        let mut other = before.clone();
        other[at] ^= 1;
        let end = header.len();
        let sum = format!("{:08x}", crc32fast::hash(&other[8..end]));
        other[..8].copy_from_slice(sum.as_bytes());
        fs::write(&journal, &other).unwrap();
        fs::write(&file, &text).unwrap();
        refuses(folder, "long", &[is, why]);
    }
    refuses(folder, "x --resume", &["there is no reports/x.journal/1-of-1.journal to go on from"]);
    // what has come to its end is replaced, as its report is
    run(folder, "x --quiet", 0);
    let stderr = run(folder, "x --seed 2 --quiet", 0);
    assert!(stderr.contains("starts over: the seed is 1 there and 2 here"), "{stderr}");
    // what changes no sample is no other run
    fs::write(folder.join("experiments/x.toml"), FILE.replace("What survives?", "What else?")).unwrap();
    let stderr = run(folder, "x --seed 2", 0);
    assert!(stderr.contains("blocks are in reports/x.journal/1-of-1.journal already"), "{stderr}");
}
