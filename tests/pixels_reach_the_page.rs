//! Promise: the page carries the pixels of the EXR files bit by bit, whatever their values, with standard errors to 3 %,
//! in little room; an EXR file that is missing, damaged or of another size is refused when a report is rebuilt.

use assert_cmd::{Command, cargo::cargo_bin};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use furnace::experiment::pixels::Pixels;
use furnace::report::images;
use furnace::report::raster::{CODES, Raster};
use furnace::scene::Rgb;
use furnace::truth::Reference;
use furnace::truth::layers::Layers;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What a page says of the pixels of a picture.
struct Unpacked {
    /// Bits of the means.
    mean: [Vec<u32>; 3],
    std_error: [Vec<f64>; 3],
}

/// As the page's script does it.
fn unpack(bytes: &[u8], count: usize) -> Unpacked {
    assert_eq!(bytes.len(), 18 * count);
    let byte = |plane: usize, i: usize| bytes[plane * count + i];
    let mut mean = [vec![0_u32; count], vec![0; count], vec![0; count]];
    let mut codes = [vec![0_u16; count], vec![0; count], vec![0; count]];
    for c in 0..3 {
        for i in 0..count {
            let word = u32::from_le_bytes([0, 1, 2, 3].map(|plane| byte(4 * c + plane, i)));
            mean[c][i] = word.wrapping_add(if c == 0 { 0 } else { mean[c - 1][i] });
            let before = if c > 0 { codes[c - 1][i] } else { i.checked_sub(1).map_or(0, |i| codes[0][i]) };
            let folded = u16::from_le_bytes([byte(12 + c, i), byte(15 + c, i)]);
            let difference = if folded.is_multiple_of(2) { folded / 2 } else { !(folded / 2) };
            codes[c][i] = before.wrapping_add(difference);
        }
    }
    let error = |code: u16| match code {
        0 => 0.0,
        0xFFFF => f64::NAN,
        _ => ((f64::from(code) - 1801.0) / 12.0).exp2(),
    };
    Unpacked { mean, std_error: codes.map(|codes| codes.into_iter().map(error).collect()) }
}

/// Holds what was unpacked against an EXR file.
#[track_caller]
fn agrees(unpacked: &Unpacked, exr: &[u8], size: (usize, usize)) {
    let layers = Layers::read_sized(exr, size).unwrap();
    let channel = |name: String| layers.channel(&name).unwrap();
    for (c, letter) in ["R", "G", "B"].into_iter().enumerate() {
        let bits: Vec<u32> = channel(letter.to_owned()).iter().map(|v| v.to_bits()).collect();
        assert_eq!(unpacked.mean[c], bits, "{letter}");
        let spread = channel(format!("variance.{letter}")).iter().zip(channel("samples".to_owned()));
        for (i, (variance, n)) in spread.enumerate() {
            let (right, found) = ((variance / n).sqrt(), unpacked.std_error[c][i]);
            match right.is_finite() {
                false => assert!(found.is_nan(), "{letter} {i}: {found}, not {right}"),
                true if right == 0.0 => assert_eq!(found, 0.0, "{letter} {i}"),
                true => assert!(
                    (found / f64::from(right) - 1.0).abs() < 0.03,
                    "{letter} {i}: {found}, not {right}"
                ),
            }
        }
    }
}

/// Five by three pixels with all that a number can be.
fn odd() -> Pixels {
    let values = [0.0, -0.0, 1.0, -2.5, 1e-40, 3e38, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.1, 7e-5];
    let at = |i: usize| values[i % values.len()];
    let mean = (0..15).map(|i| Rgb::new(at(i), at(3 * i + 1), at(7 * i + 2))).collect();
    let m2 = (0..15).map(|i| Rgb::new(0.001 * i as f64, at(i).abs(), 1e-9)).collect();
    Pixels { width: 5, height: 3, n: 9, mean, m2 }
}

#[test]
fn every_value_survives() {
    let exr = images::exr(&odd(), None).unwrap();
    let raster = Raster::read(&exr, (5, 3)).unwrap();
    assert_eq!((raster.width, raster.height, raster.samples), (5, 3, 9));
    let unpacked = unpack(&raster.packed(), 15);
    agrees(&unpacked, &exr, (5, 3));
    // the odd ones are there at all
    let red = unpacked.mean[0].iter().map(|&bits| f32::from_bits(bits));
    assert_eq!(red.clone().filter(|v| v.is_nan()).count(), 1);
    assert_eq!(red.filter(|v| v.is_infinite()).count(), 2);
}

#[test]
fn codes_are_fine_and_reach_far() {
    // all that single precision can hold
    let error: Vec<f32> = (0..4000).map(|i| (127.9 - f64::from(i) * 0.0692).exp2() as f32).collect();
    assert!(error[3999] > 0.0 && error[3999] < 1e-44);
    let std_error = [error.clone(), error.clone(), error.clone()];
    let raster = Raster { width: 4000, height: 1, mean: std_error.clone(), std_error, samples: 2 };
    let found = unpack(&raster.packed(), 4000);
    let off =
        (0..4000).map(|i| (found.std_error[1][i] / f64::from(error[i]) - 1.0).abs()).fold(0.0, f64::max);
    let coarseness = (0.5 / CODES).exp2() - 1.0;
    assert!(off < 1.01 * coarseness && coarseness < 0.03, "off by {off}");
}

#[test]
fn references_come_to_the_grid_of_the_picture() {
    let mean = (0..64).map(|i| Rgb::splat(f64::from(i % 8))).collect();
    let reference = Reference {
        size: 8,
        mean,
        std_error: vec![Rgb::splat(0.5); 64],
        df: 31.0,
        systematic: 0.0,
        provenance: None,
    };
    // finer than the picture, as fine, coarser, and with no divisor but 4
    for (picture, blocks) in [(4, 4), (8, 8), (16, 8), (12, 4)] {
        let raster = Raster::of_reference(&reference, (picture, picture)).unwrap();
        assert_eq!((raster.width, raster.height), (blocks, blocks));
        let edge = 8 / blocks;
        let right = |i: usize| (edge * (i % blocks)) as f32 + (edge - 1) as f32 / 2.0;
        assert!((0..blocks * blocks).all(|i| raster.mean[2][i] == right(i)), "{picture}");
        assert!(raster.std_error[0].iter().all(|&error| error == 0.5 / edge as f32), "{picture}");
    }
    assert!(Raster::of_reference(&reference, (8, 6)).is_none(), "references are square");
}

const FILE: &str = "question = \"Are the pixels on the page?\"\nsamples = 16\n[grid]\nscene = [{ cornell_box = { \
    resolution = 128 } }, { smallpt = {} }]\nestimator = [\"explicit\"]\nroulette = [\"albedo\"]\n";

fn run() -> (TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), FILE).unwrap();
    Command::new(cargo_bin!("experiment"))
        .args(["x", "--quiet"])
        .current_dir(place.path())
        .assert()
        .success();
    let folder = place.path().join("reports/x");
    (place, folder)
}

fn block<'a>(page: &'a str, id: &str) -> &'a str {
    let start = page.find(&format!("id=\"{id}\">")).unwrap_or_else(|| panic!("no {id}")) + id.len() + 6;
    page[start..].split("</script>").next().unwrap()
}

fn inflate(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    ZlibDecoder::new(&STANDARD.decode(text).unwrap()[..]).read_to_end(&mut bytes).unwrap();
    bytes
}

#[test]
fn a_page_has_the_pixels_of_its_files() {
    let (_place, folder) = run();
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    let all: serde_json::Value = serde_json::from_slice(&inflate(block(&page, "viewer-data"))).unwrap();
    let pictures = all["pictures"].as_array().unwrap();
    assert_eq!(pictures.len(), 2);
    for (i, picture) in pictures.iter().enumerate() {
        let size = ["width", "height"].map(|side| picture[side].as_u64().unwrap() as usize);
        let exr = fs::read(folder.join(format!("{}.exr", picture["name"].as_str().unwrap()))).unwrap();
        let text = block(&page, &format!("viewer-picture-{i}"));
        // a dozen of 128 x 128 pixels in 3 MB
        assert!(text.len() < 250_000, "{} bytes", text.len());
        agrees(&unpack(&inflate(text), size[0] * size[1]), &exr, (size[0], size[1]));
    }
    assert!(pictures[0]["reference"] == 0 && pictures[1]["reference"].is_null());
    let reference = unpack(&inflate(block(&page, "viewer-reference-0")), 32 * 32);
    let stored = Layers::read(include_bytes!("../references/cornell_box_32x32.exr")).unwrap();
    let green: Vec<u32> = stored.channel("G").unwrap().iter().map(|v| v.to_bits()).collect();
    assert_eq!(reference.mean[1], green);
    assert!(!page.contains("data:image/png"), "PNG files lie beside the page");
}

/// Rebuilds the report, which must be refused with all of `words` in one sentence.
#[track_caller]
fn refused(place: &Path, words: &[&str]) {
    let output =
        Command::new(cargo_bin!("experiment")).args(["report", "x"]).current_dir(place).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(words.iter().all(|word| told.contains(word)), "{told}");
    assert_eq!(told.trim().lines().count(), 1, "{told}");
}

#[test]
fn files_that_are_not_of_the_run_are_refused() {
    let (place, folder) = run();
    let file = folder.join("cornell_box_explicit_albedo.exr");
    let name = file.file_name().unwrap().to_str().unwrap();
    let whole = fs::read(&file).unwrap();
    fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    refused(place.path(), &[name, "OpenEXR", "run the experiment again"]);
    fs::write(&file, images::exr(&odd(), None).unwrap()).unwrap();
    refused(place.path(), &[name, "5 x 3", "128 x 128", "run the experiment again"]);
    fs::remove_file(&file).unwrap();
    refused(place.path(), &["cannot read", name]);
    fs::write(&file, &whole).unwrap();
    Command::new(cargo_bin!("experiment")).args(["report", "x"]).current_dir(place.path()).assert().success();
}
