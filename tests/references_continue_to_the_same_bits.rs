//! Promise: a reference of our own that is stopped and continued has the bytes of one that was not, for any number of
//! threads; it is not continued as that of another scene, estimator or seed; what is stored is whole at any time.

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::truth::{BadReference, Own, Reference};
use std::fs;
use std::path::Path;
use std::process::Output;

fn reference(place: &Path, args: &str) -> Output {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.arg("reference").args(args.split_whitespace()).current_dir(place).output().unwrap()
}

#[track_caller]
fn made(place: &Path, args: &str, status: i32) -> Vec<u8> {
    let output = reference(place, &format!("{args} --quiet"));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{args}: {stderr}");
    let path = String::from_utf8(output.stdout).unwrap();
    fs::read(place.join(path.split(": ").next().unwrap())).unwrap()
}

#[test]
fn stopping_and_going_on_changes_no_bit() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    // several waves of 64 blocks of 16 and of 4096 realizations
    for (scene, [few, some, all]) in [
        ("cornell_box --resolution 16", [100, 1500, 4000]),
        ("integrating_sphere --estimator implicit", [5000, 300_000, 600_000]),
    ] {
        let whole = format!("{scene} --until-error 1e-9 --max-samples {all} -o whole.exr");
        let whole = made(place, &whole, 1);
        // neither at whole waves, nor with as many threads
        let parts = format!("{scene} --until-error 1e-9 -o parts.exr --max-samples");
        let first = made(place, &format!("{parts} {few} --jobs 1"), 1);
        let second = made(place, &format!("{parts} {some} --jobs 3"), 1);
        let last = made(place, &format!("{parts} {all} --jobs 2"), 1);
        assert!(first != second && second != last);
        assert!(last == whole, "{scene}: other bytes");
        // nothing is left to do: nothing is touched
        let before = fs::metadata(place.join("parts.exr")).unwrap().modified().unwrap();
        assert!(made(place, &format!("{parts} {all}"), 1) == whole);
        assert_eq!(fs::metadata(place.join("parts.exr")).unwrap().modified().unwrap(), before);
        for file in ["parts.exr", "whole.exr"] {
            fs::remove_file(place.join(file)).unwrap();
        }
    }
}

/// Where the error is reached must not depend on where someone stopped before.
#[test]
fn the_error_is_reached_at_the_same_sample() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let scene = "cornell_empty --resolution 16";
    let error = |bytes: &[u8]| Own::read(bytes).unwrap().relative_error();
    let wave = made(place, &format!("{scene} --until-error 1e-9 --max-samples 1024 -o wave.exr"), 1);
    // within the second wave: there the error is already small enough, but nobody looks
    let goal = format!("{scene} --until-error {}", 0.9 * error(&wave));
    let part = made(place, &format!("{goal} --max-samples 1500 -o parts.exr"), 1);
    assert!(error(&part) < 0.9 * error(&wave), "the part must be good enough, or this shows nothing");
    let whole = made(place, &format!("{goal} -o whole.exr"), 0);
    assert!(made(place, &format!("{goal} -o parts.exr"), 0) == whole);
    assert_eq!(Own::read(&whole).unwrap().provenance.samples, 2048);
}

#[test]
fn what_is_stored_is_read_back_exactly() {
    let place = tempfile::tempdir().unwrap();
    let bytes = made(place.path(), "furnace --max-samples 10 --until-error 1e-9 --estimator implicit", 1);
    assert!(place.path().join("references/own/furnace.exr").exists());
    let own = Own::read(&bytes).unwrap();
    assert_eq!(own.bytes().unwrap(), bytes);
    assert_eq!((own.size, own.mean.len(), own.provenance.samples), (1, 1, 4096));
    let (mean, error) = (own.mean[0], own.relative_error());
    let reference = Reference::read(&bytes).unwrap();
    assert_eq!((reference.image().mean, reference.df), (mean, 4095.0));
    let relative = reference.image().std_error / mean;
    assert!((relative.max_element() - error).abs() < 1e-15);
    // 1 / (1 - 1/2)
    assert!((mean.x - 2.0).abs() < 5.0 * relative.x * mean.x, "{mean}");
}

#[test]
fn another_reference_is_not_continued() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let bytes = made(place, "cornell_box --resolution 8 --max-samples 9 --until-error 1e-9 -o x.exr", 1);
    for (args, word) in [
        ("cornell_empty --resolution 8", "made for the scene"),
        ("cornell_box --resolution 16", "made for the scene"),
        ("cornell_box --resolution 8 --estimator implicit", "made for the estimator"),
        ("cornell_box --resolution 8 --seed 2", "made for the seed 1, not 2"),
    ] {
        let output = reference(place, &format!("{args} -o x.exr"));
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args}: {stderr}");
        assert!(stderr.contains("x.exr cannot be continued") && stderr.contains(word), "{args}: {stderr}");
    }
    // a file of a later program, a picture of no known origin, and one that is cut off
    let later = replaced(&bytes, b"\"format\":1,", b"\"format\":2,");
    assert!(
        matches!(Own::read(&later), Err(BadReference::Provenance(why)) if why.contains("format is 2, not 1"))
    );
    let unknown = replaced(&bytes, b"furnace\0", b"anneals\0");
    for broken in [&later, &unknown, &bytes[..bytes.len() / 2].to_vec(), &b"thesis".to_vec()] {
        fs::write(place.join("x.exr"), broken).unwrap();
        let output = reference(place, "cornell_box --resolution 8 -o x.exr");
        assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(fs::read(place.join("x.exr")).unwrap() == *broken, "it was overwritten");
    }
}

fn replaced(bytes: &[u8], old: &[u8], new: &[u8]) -> Vec<u8> {
    let at = bytes.windows(old.len()).position(|w| w == old).unwrap();
    [&bytes[..at], new, &bytes[at + old.len()..]].concat()
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_finished() {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let args = "cornell_box --resolution 16 --until-error 1e-9 -o x.exr";
    let before = made(place, &format!("{args} --max-samples 8"), 1);
    let mut command = Command::new(cargo_bin!("experiment"));
    command.arg("reference").args(args.split_whitespace()).current_dir(place);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut line = String::new();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    stderr.read_line(&mut line).unwrap();
    assert!(line.contains("samples, relative standard error"), "{line}");
    assert!(fs::read(place.join("x.exr")).unwrap() == before, "the old file is whole until the end");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let samples = Own::read(&fs::read(place.join("x.exr")).unwrap()).unwrap().provenance.samples;
    assert!(samples > Own::read(&before).unwrap().provenance.samples);
    assert_eq!(fs::read_dir(place).unwrap().count(), 1, "unfinished files were left");
    let args = args.replace("x.exr", "whole.exr");
    let whole = made(place, &format!("{args} --max-samples {samples}"), 1);
    assert!(fs::read(place.join("x.exr")).unwrap() == whole);
}
