//! Promise: a stored image that cannot be tested against is refused with what is wrong and where, never read with a
//! tolerance and never with a panic; in an experiment file the error stands at the name of the image, exit status 2.

use assert_cmd::{Command, cargo::cargo_bin};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes,
    WritableImage, f16,
};
use furnace::estimator::{Estimator, Implicit, Roulette, Rule};
use furnace::experiment::making;
use furnace::scene::library::SceneKind;
use furnace::scene::{Directions, Rgb};
use furnace::truth::layers::Layers;
use furnace::truth::{BadReference, Reference};
use std::fs;
use std::io::Cursor;

/// Means of 1 with errors of 0.1 in `size` x `size` pixels, but for what `change` does to channels of that name.
fn image(size: usize, change: impl Fn(&str, &mut Vec<f32>) -> bool) -> Vec<u8> {
    let mut layers = Layers::new(size, size);
    for (prefix, value) in [("", 1.0), ("std_error.", 0.1)] {
        for letter in ["R", "G", "B"] {
            let name = format!("{prefix}{letter}");
            let mut values = vec![value; size * size];
            if change(&name, &mut values) {
                layers.add(&name, values);
            }
        }
    }
    layers.bytes().unwrap()
}

fn good() -> Vec<u8> {
    image(8, |_, _| true)
}

/// Holds that these bytes are refused in these words.
#[track_caller]
fn refused(bytes: &[u8], words: &[&str]) {
    let error = Reference::read(bytes).expect_err("it should be refused").to_string();
    words.iter().for_each(|word| assert!(error.contains(word), "`{word}` is missing: {error}"));
}

#[test]
fn a_good_one_is_read() {
    let reference = Reference::read(&good()).unwrap();
    assert_eq!((reference.size, reference.mean[9]), (8, Rgb::ONE));
    assert!((reference.std_error[63] - Rgb::splat(0.1)).length() < 1e-7);
    assert!(reference.provenance.is_none() && reference.systematic == 0.0);
}

#[test]
fn variance_and_samples_stand_for_errors() {
    let mut layers = Layers::new(2, 2);
    layers.add_rgb("", &[Rgb::ONE; 4]);
    layers.add_rgb("variance.", &[Rgb::splat(4.0); 4]);
    layers.add("samples", vec![16.0, 64.0, 16.0, 16.0]);
    let reference = Reference::read(&layers.bytes().unwrap()).unwrap();
    assert_eq!(reference.std_error[..2], [Rgb::splat(0.5), Rgb::splat(0.25)]);
    assert_eq!(reference.df, 15.0);
}

#[test]
fn files_that_are_no_exr_or_not_whole() {
    refused(b"", &["cannot be read as OpenEXR"]);
    refused(b"P6 32 32 255 a picture of another kind", &["cannot be read as OpenEXR"]);
    let whole = good();
    for length in 0..whole.len() {
        let error = Reference::read(&whole[..length]);
        assert!(matches!(error, Err(BadReference::Unreadable(_))), "{length} of {} bytes", whole.len());
    }
}

#[test]
fn channels_that_are_missing_foreign_or_of_another_kind() {
    refused(&image(8, |name, _| name != "G" && name != "B"), &["lacks the channels G, B"]);
    refused(&image(8, |name, _| name != "std_error.B"), &["lacks the channels std_error.B"]);
    refused(&image(8, |name, _| !name.starts_with('s')), &["has no errors", "std_error.R G B"]);
    // errors of exactly zero everywhere are no errors
    let silent = |name: &str, values: &mut Vec<f32>| {
        values.iter_mut().filter(|_| name.starts_with('s')).for_each(|v| *v = 0.0);
        true
    };
    refused(&image(8, silent), &["has no errors"]);
    let mut foreign = Layers::new(2, 2);
    foreign.add_rgb("", &[Rgb::ONE; 4]);
    foreign.add_rgb("std_error.", &[Rgb::ONE; 4]);
    foreign.add("depth.Z", vec![1.0; 4]);
    foreign.add("A", vec![1.0; 4]);
    refused(&foreign.bytes().unwrap(), &["no part of a reference: A, depth.Z"]);
    let mut few = Layers::new(1, 1);
    few.add_rgb("", &[Rgb::ONE]);
    few.add_rgb("variance.", &[Rgb::ONE]);
    few.add("samples", vec![1.0]);
    refused(&few.bytes().unwrap(), &["samples = 1", "at least 2 samples"]);
}

fn picture(name: &str, samples: FlatSamples) -> Layer<AnyChannels<FlatSamples>> {
    let channels = ["R", "G", "B", "std_error.R", "std_error.G", "std_error.B"];
    let list = channels.into_iter().map(|c| AnyChannel::new(c, samples.clone())).collect();
    let attributes = LayerAttributes::named(name);
    Layer::new((2, 2), attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(list))
}

#[test]
fn half_precision_and_several_pictures() {
    let mut half = Cursor::new(Vec::new());
    let samples = FlatSamples::F16(vec![f16::ONE; 4]);
    Image::from_layer(picture("half", samples)).write().to_buffered(&mut half).unwrap();
    refused(half.get_ref(), &["channel R is not of 32-bit"]);
    let mut two = Cursor::new(Vec::new());
    let layers = ["beauty", "albedo"].map(|name| picture(name, FlatSamples::F32(vec![1.0; 4])));
    let image = Image::from_layers(ImageAttributes::with_size((2, 2)), layers.to_vec());
    image.write().to_buffered(&mut two).unwrap();
    refused(two.get_ref(), &["holds 2 pictures"]);
}

#[test]
fn pixels_that_no_mean_or_error_can_be() {
    for (channel, value, told) in [
        ("R", f32::NAN, "R = NaN"),
        ("B", f32::INFINITY, "B = inf"),
        ("G", -0.5, "G = -0.5"),
        ("std_error.G", -1.0, "std_error.G = -1"),
        ("std_error.R", f32::NAN, "std_error.R = NaN"),
    ] {
        let change = |name: &str, values: &mut Vec<f32>| {
            if name == channel {
                values[3 * 8 + 5] = value;
            }
            true
        };
        refused(&image(8, change), &["column 5, row 3", told, "a finite number, not below 0"]);
    }
}

#[test]
fn shapes_that_do_not_fit() {
    let mut wide = Layers::new(4, 2);
    wide.add_rgb("", &[Rgb::ONE; 8]);
    refused(&wide.bytes().unwrap(), &["4 x 2 pixels", "a square"]);
    let reference = |size| Reference::read(&image(size, |_, _| true)).unwrap();
    assert!(reference(8).fits(128, 4).is_ok() && reference(1).fits(1, 4).is_ok());
    let error = reference(6).fits(128, 4).unwrap_err().to_string();
    assert!(error.contains("6 x 6 pixels") && error.contains("128 x 128") && error.contains("4 x 4 tiles"));
    assert!(reference(8).fits(1, 4).is_err(), "a probe is one pixel");
}

const FILE: &str = r#"question = "Is it refused?"
samples = 64
reference = [
  { scene = "cornell_box", file = "good.exr", systematic = 1e-3 },
]
[grid]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

/// Exit status and standard error of running `text` beside some images.
fn run(text: &str) -> (Option<i32>, String) {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("experiments");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("x.toml"), text).unwrap();
    fs::write(folder.join("good.exr"), good()).unwrap();
    fs::write(folder.join("six.exr"), image(6, |_, _| true)).unwrap();
    fs::write(folder.join("blind.exr"), image(8, |name, _| !name.starts_with('s'))).unwrap();
    fs::write(folder.join("cut.exr"), &good()[..400]).unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(["x", "--quiet"]).current_dir(place.path()).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn errors_stand_where_the_file_names_the_image() {
    assert_eq!(run(FILE), (Some(0), String::new()));
    let line = "  { scene = \"cornell_box\", file = \"good.exr\", systematic = 1e-3 },\n";
    let cases: [(&str, &str, &[&str]); 8] = [
        ("good.exr", "none.exr", &["4:35", "cannot read experiments/none.exr"]),
        ("good.exr", "cut.exr", &["4:35", "cannot be read as OpenEXR"]),
        ("good.exr", "blind.exr", &["4:35", "has no errors"]),
        ("good.exr", "six.exr", &["4:35", "6 x 6 pixels", "16 x 16 pixels"]),
        ("\"cornell_box\"", "\"kitchen\"", &["4:13", "no scene is called `kitchen`; there are: cornell_box"]),
        ("1e-3", "-1", &["4:60", "a relative error lies in [0, 1)"]),
        ("systematic", "systemic", &["4:47", "did you mean `systematic`?"]),
        (line, &[line, line].concat(), &["5:13", "has a reference already"]),
    ];
    for (old, new, words) in cases {
        let (status, stderr) = run(&FILE.replacen(old, new, 1));
        assert_eq!(status, Some(2), "{new}: {stderr}");
        assert!(stderr.contains("experiments/x.toml:") && !stderr.contains("panicked"), "{new}: {stderr}");
        words.iter().for_each(|word| assert!(stderr.contains(word), "{new}: `{word}` is missing: {stderr}"));
    }
}

#[test]
fn one_of_another_size_is_not_continued() {
    let scene = SceneKind::CornellEmpty { resolution: 8 };
    let directions = Directions::Cosine;
    let roulette = Roulette::unclamped(Rule::Constant { q: 0.5 });
    let estimator = Estimator::Implicit(Implicit { directions, roulette });
    let wanted = making::begin(&scene, &estimator, 1).unwrap();
    let mut other = wanted.clone();
    (other.size, other.mean, other.m2) = (4, vec![Rgb::ONE; 16], vec![Rgb::ONE; 16]);
    other.provenance.samples = 2;
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("own.exr");
    making::save(&path, &other).unwrap();
    let error = making::resume(&path, wanted).unwrap_err().to_string();
    assert!(error.contains("it has 4 pixels along each edge, not 8"), "{error}");
}
