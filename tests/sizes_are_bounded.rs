//! Promise: a file of a few bytes cannot ask for all memory or for ever: what is too large is refused before anything is
//! made of it, with the limit and, where it is written in one place, the line; and large uses that make sense go on working.

use furnace::experiment::{Error, Overrides, Plan, file, plan};
use furnace::truth::{BadReference, Reference};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

const GOOD: &str = r#"question = "How much is too much?"
samples = 1024
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

fn planned(text: &str, overrides: &Overrides) -> Result<Plan, Error> {
    Plan::new("large", Path::new("large.toml"), text, overrides)
}

/// The good file with lines in the place of those of their keys, or at its top.
fn with(lines: &[String]) -> String {
    let key = |line: &str| line.split('=').next().unwrap().trim().to_owned();
    lines.iter().fold(GOOD.to_owned(), |text, line| {
        match text.lines().find(|old| old.contains('=') && key(old) == key(line)) {
            Some(old) => text.replacen(old, line, 1),
            None => format!("{line}\n{text}"),
        }
    })
}

fn numbers(count: usize, of: impl Fn(usize) -> String) -> String {
    format!("[{}]", (0..count).map(of).collect::<Vec<_>>().join(","))
}

/// Holds that a file is refused at once, in these words.
#[track_caller]
fn refused(lines: &[String], words: &[&str]) {
    let begun = Instant::now();
    let error = planned(&with(lines), &Overrides::default()).expect_err("it should be refused").to_string();
    words.iter().for_each(|word| assert!(error.contains(word), "`{word}` is missing: {error}"));
    assert!(error.len() < 6000, "{} bytes of error", error.len());
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
}

fn line(text: &str) -> Vec<String> {
    vec![text.to_owned()]
}

fn depths(count: usize) -> String {
    numbers(count, |i| (i % 1000).to_string())
}

#[test]
fn combinations() {
    let sweep = depths(1000);
    let recursive = format!(
        "estimator = [{{ recursive = {{ samples = {}, depth = {sweep} }} }}]",
        numbers(1000, |i| (i + 1).to_string())
    );
    refused(&[recursive], &["large.toml:5:14", "make 1000000 cells", "at most 100000"]);
    let radii = numbers(100, |i| format!("0.{i:03}1"));
    let photons = numbers(100, |i| (i + 1).to_string());
    let map = format!(
        "estimator = [{{ photon_map = {{ photons = {photons}, radius = {} }} }}]",
        numbers(1001, |i| format!("0.{i:05}1"))
    );
    refused(&[map], &["large.toml:5:14", "make 100100 cells", "at most 100000"]);
    let progressive = format!(
        "estimator = [{{ progressive = {{ photons = {photons}, radius = {radii}, alpha = {radii}, passes = 4 }} }}]"
    );
    refused(&[progressive], &["large.toml:5:14", "make 1000000 cells", "at most 100000"]);
    let clamp = format!("roulette = [{{ depth_clamp = {{ bounces = {sweep} }} }}]");
    let many = format!("estimator = [{{ recursive = {{ samples = 1, depth = {} }} }}]", depths(101));
    refused(&[clamp, many], &["large.toml:4:9", "make 101000 cells", "at most 100000"]);
    let lists = vec![format!("{{ depth_clamp = {{ bounces = {} }} }}", depths(60_000)); 2].join(", ");
    refused(&[format!("roulette = [{lists}]")], &["large.toml:6:", "make 120000 cells"]);
}

#[test]
fn lists() {
    let sweep = format!("roulette = [{{ depth_clamp = {{ bounces = {} }} }}]", depths(100_001));
    refused(&[sweep], &["large.toml:6:", "a list of 100001 is out of range: at most 100000 numbers"]);
    let tables = |key: &str, table: &str| vec![format!("{key} = [{}]", vec![table; 1001].join(","))];
    let words = ["large.toml:1:", "a list of 1001 tables is out of range: at most 1000"];
    refused(&tables("claim", "{ cost = { alpha = 0.1, margin = 0.1 } }"), &words);
    refused(&tables("plot", "{ bias = {} }"), &words);
    refused(&tables("reference", "{ scene = \"furnace\", file = \"x.exr\" }"), &words);
    let law = "law = { rare = { p = 0.1 } }, samples = 10, runs = 10";
    refused(&tables("null", &format!("{{ {law}, level = 0.1 }}")), &words);
    let level = numbers(101, |i| format!("0.{:03}", i + 1));
    refused(
        &[format!("null = [{{ {law}, level = {level} }}]")],
        &["large.toml:1:", "a list of 101 is out of range"],
    );
    let patches = vec!["{ fraction = 1e-6, albedo = 0.1 }"; 101].join(",");
    let sphere = format!("scene = [{{ integrating_sphere = {{ patches = [{patches}] }} }}]");
    refused(&[sphere], &["large.toml:4:10", "a sphere of 101 patches; at most 100"]);
}

#[test]
fn work_and_memory() {
    refused(&line("seeds = 1_000_001"), &["large.toml:1:9", "1000001 is out of range", "10^6"]);
    let law =
        "null = [{ law = { rare = { p = 0.1 } }, samples = 10_000_000, runs = 10_000_000, level = 0.1 }]";
    refused(&line(law), &["rare p=0.1 is sampled 1.0e14 times", "--force"]);
    let scene = "scene = [{ cornell_box = { resolution = 64 } }]".to_owned();
    for (estimator, words) in [
        ("{ photon_map = { photons = 100_000_000, k = 10 } }", "100000000 photons may land"),
        ("{ light_tracing = { particles = 100_000_000 } }", "100000000 particles may land"),
    ] {
        let estimator = format!("estimator = [{estimator}]");
        refused(&[scene.clone(), estimator], &["large.toml:5:14", words, "at most 1e8"]);
    }
    let images = "scene = [{ cornell_box = { resolution = 4096 } }]".to_owned();
    let clamps = format!("roulette = [{{ depth_clamp = {{ bounces = {} }} }}]", depths(9));
    let few = "samples = 4".to_owned();
    refused(&[images, clamps, few], &["images of 150994944 pixels", "7 GB", "--force"]);
    let balls = numbers(45, |i| (100_000 - i).to_string());
    let rooms = format!("scene = [{{ many_spheres = {{ count = {balls}, resolution = 1 }} }}]");
    refused(&[rooms], &["large.toml:4:10", "at most 4000000 are allowed in one file"]);
    // 10^15 samples of 10^6 seeds are more than a whole number of 64 bits
    refused(
        &["samples = 1_000_000_000_000_000".to_owned(), "seeds = 1_000_000".to_owned()],
        &["e21 rays", "--force"],
    );
}

#[test]
fn scenes_that_cells_keep_a_copy_of() {
    let ball = "{ shape = { sphere = { center = [0, 0, 0], radius = 1, inward = true } }, albedo = 0.5, emission = 1 }";
    let sensor = "{ probe = { origin = [0, 0, 0], direction = [0, 0, 1] } }";
    let balls = vec![ball; 1001].join(",");
    let scene = format!(
        "scene = [{{ primitives = {{ name = \"balls\", primitives = [{balls}], sensor = {sensor} }} }}]"
    );
    let many =
        format!("roulette = [{{ constant = {{ q = {} }} }}]", numbers(4000, |i| format!("0.1{i:04}1")));
    refused(&[scene, many], &["large.toml:4:10", "cells keep a copy of 4004000 surfaces", "at most 4000000"]);
}

#[test]
fn names_and_lines_of_any_length() {
    let long = "x".repeat(2_000_000);
    refused(&[format!("{long} = 1")], &["large.toml:1:1", "unknown field `xxx", "(and more)"]);
    // two long names in one message must not be compared with each other either
    refused(&[format!("\"{long}`, `{long}\" = 1")], &["large.toml:1:1", "unknown field"]);
    refused(&[format!("core = \"{long}\"")], &["large.toml:1:8", "(and more)"]);
    refused(&[format!("{}seed = -1", " ".repeat(100_000))], &["large.toml:1:100008", "seed = -1", "^"]);
    let deep = format!("seed = {}1{}", "[".repeat(100_000), "]".repeat(100_000));
    refused(&[deep], &["large.toml:1:"]);
}

#[test]
fn what_is_large_and_makes_sense() {
    let q = numbers(120, |i| format!("0.{:03}", 100 + i));
    let depth = depths(100);
    let grid = [
        format!("roulette = [{{ constant = {{ q = {q}, clamp = 9 }} }}]"),
        format!("estimator = [{{ recursive = {{ samples = 1, depth = {depth} }} }}]"),
        "claim = [{ unbiased = { alpha = 1e-3, margin = 0.1 } }]".to_owned(),
    ];
    let begun = Instant::now();
    assert_eq!(planned(&with(&grid), &Overrides::default()).unwrap().cells.len(), 12_000);
    assert!(begun.elapsed() < Duration::from_secs(120), "{:?}", begun.elapsed());
    let whole = |lines: &[&str]| {
        let lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        planned(&with(&lines), &Overrides::default()).map(drop).unwrap_or_else(|e| panic!("{e}"));
    };
    whole(&["scene = [{ cornell_box = { resolution = 4096 } }]", "samples = 4"]);
    whole(&["scene = [{ many_spheres = { count = 100_000 } }]"]);
    whole(&["scene = [\"cornell_box\"]", "estimator = [{ photon_map = { photons = 5_000_000, k = 50 } }]"]);
    let force = Overrides { force: true, ..Overrides::default() };
    let images = "scene = [{ cornell_box = { resolution = 4096 } }]".to_owned();
    let clamps = format!("roulette = [{{ depth_clamp = {{ bounces = {} }} }}]", depths(9));
    assert_eq!(planned(&with(&[images, clamps]), &force).unwrap().cells.len(), 9);
}

/// The parts of an EXR header: an attribute each.
fn attribute(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
    let length = (value.len() as u32).to_le_bytes();
    [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &length[..], value].concat()
}

/// A header without pixels, of so many channels and `edge` x `edge` pixels.
fn promise(channels: usize, edge: i32) -> Vec<u8> {
    let mut list = Vec::new();
    for i in 0..channels {
        list.extend(format!("c{i:04}\0").into_bytes());
        list.extend([2u32, 0, 1, 1].iter().flat_map(|v| v.to_le_bytes())); // single precision, each pixel
    }
    list.push(0);
    let window: Vec<u8> = [0, 0, edge - 1, edge - 1].iter().flat_map(|v: &i32| v.to_le_bytes()).collect();
    let one = 1f32.to_le_bytes();
    [
        &[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0][..],
        &attribute("channels", "chlist", &list),
        &attribute("compression", "compression", &[3]),
        &attribute("dataWindow", "box2i", &window),
        &attribute("displayWindow", "box2i", &window),
        &attribute("lineOrder", "lineOrder", &[0]),
        &attribute("pixelAspectRatio", "float", &one),
        &attribute("screenWindowCenter", "v2f", &[0; 8]),
        &attribute("screenWindowWidth", "float", &one),
        &[0],
    ]
    .concat()
}

#[test]
fn images_that_promise_more_than_they_hold() {
    let words = |channels: usize, edge: i32| match Reference::read(&promise(channels, edge)) {
        Err(BadReference::Unreadable(why)) => why,
        Err(other) => other.to_string(),
        Ok(_) => panic!("it is read"),
    };
    assert!(words(16, 4096).contains("promises 1073741824 bytes of pixels"), "{}", words(16, 4096));
    assert!(words(65, 8).contains("65 channels, and at most 64"), "{}", words(65, 8));
    assert!(words(1, 4097).contains("at most 4096 pixels along each edge"), "{}", words(1, 4097));
    assert!(words(1, i32::MAX).contains("window"), "{}", words(1, i32::MAX));
    // without its pixels a small one is not whole
    assert!(!words(6, 8).contains("promises"), "{}", words(6, 8));
}

#[test]
fn files_are_files_and_not_too_large() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("some.toml");
    fs::write(&path, [b'#'; 1000]).unwrap();
    assert_eq!(file::bytes(&path, 1000).unwrap().len(), 1000);
    let error = file::bytes(&path, 999).unwrap_err().to_string();
    assert!(error.contains("1000 bytes, and at most 999 are read"), "{error}");
    let folder = file::bytes(place.path(), 1000).unwrap_err().to_string();
    assert!(folder.contains("a folder, and no file"), "{folder}");
    fs::write(&path, b"question = \"\xff\"").unwrap();
    let error = file::text(&path, 1000).unwrap_err().to_string();
    assert!(error.contains("no UTF-8 text from byte 12 on"), "{error}");
    if cfg!(unix) {
        let device = file::bytes(Path::new("/dev/zero"), 1000).unwrap_err().to_string();
        assert!(device.contains("a device, a pipe or a socket"), "{device}");
    }
}

/// The largest file that is read at all is read in memory that a small machine has.
#[test]
fn the_largest_file_is_parsed() {
    let rule = "{ constant = { q = 0.5 } },";
    let count = file::WRITTEN as usize / rule.len();
    let text = with(&[format!("roulette = [{}]", rule.repeat(count))]);
    let error = plan::cells(Path::new("large.toml"), &text).map(drop).unwrap_err().to_string();
    assert!(error.contains("and an experiment has at most 100000"), "{error}");
}
