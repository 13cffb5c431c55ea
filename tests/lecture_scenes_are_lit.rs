//! Promise: the scenes of lectures are what they are named for. Different estimators find the same light in them, the
//! caustics are caustics, the light of `indirect` has been round a corner, a point is found by sampling only, the lens
//! blurs, what moves is blurred, and files can say all of it.
//!
//! Means over small images are compared: 27 pairs, each beyond LIMIT standard errors with a probability below 2e-8
//! (Student's t of some hundred degrees of freedom), so that false alarms of the file stay below 1e-6; and none passes
//! for being unknown.

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::estimator::{Estimator, Explicit, Heuristic, Implicit, Roulette, Rule, Technique};
use furnace::experiment::{Cell, sample};
use furnace::sampling::Address;
use furnace::scene::lecture::{Lecture, Source};
use furnace::scene::library::SceneKind;
use furnace::scene::{Carried, Directions, LightSampling, Ray, Rgb, Scene, Sensor};
use glam::DVec3;

const LIMIT: f64 = 6.0;
/// Wide, so that chance finds it.
const WIDE: Source = Source::Square { half: 0.3 };
const ROULETTE: Roulette = Roulette { rule: Rule::Throughput { floor: 0.1 }, from: 4, clamp: None };

fn explicit(technique: Technique) -> Estimator {
    let (lights, directions) = (LightSampling::SOLID_ANGLE, Directions::Cosine);
    Estimator::Explicit(Explicit { technique, lights, directions, roulette: ROULETTE })
}

fn implicit() -> Estimator {
    Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette: ROULETTE })
}

fn cell(lecture: Lecture, estimator: &Estimator, passes: u64) -> Cell {
    let address = Address::of(&["lecture_scenes_are_lit", &format!("{lecture:?} {estimator:?}")]);
    let cell = sample(&lecture.build(), estimator, &address, passes, passes / 128);
    assert_eq!(cell.invalid(), None, "{lecture:?}");
    cell
}

/// The image's mean and its standard error, by channel.
fn image(cell: &Cell) -> [(f64, f64); 3] {
    [0, 1, 2].map(|c| (cell.total[c].mean, cell.total[c].std_error().unwrap()))
}

/// The two find the same mean, each known to `known`, relative.
#[track_caller]
fn agree(lecture: Lecture, other: &Estimator, (passes, more): (u64, u64), known: f64) {
    let (one, two) = (cell(lecture, other, passes), cell(lecture, &implicit(), more));
    for ((mean, error), (value, other_error)) in image(&one).into_iter().zip(image(&two)) {
        println!("{lecture:?}: {mean} ± {error}, {value} ± {other_error}");
        assert!(mean > 0.0 && error < known * mean && other_error < known * mean);
        let t = (mean - value) / error.hypot(other_error);
        assert!(t.abs() < LIMIT, "{lecture:?}: {mean} ± {error}, by chance {value} ± {other_error}: {t}");
    }
}

#[test]
fn estimators_agree_on_caustics() {
    let light = explicit(Technique::Light);
    agree(Lecture::CausticGlass { source: WIDE, resolution: 8 }, &light, (4096, 16384), 0.02);
    agree(Lecture::CausticMirror { source: WIDE, resolution: 8 }, &light, (4096, 16384), 0.02);
}

#[test]
fn estimators_agree_on_the_rooms() {
    agree(Lecture::Indirect { resolution: 8 }, &explicit(Technique::Light), (8192, 131_072), 0.03);
    agree(Lecture::Smallpt { resolution: 6 }, &explicit(Technique::Light), (4096, 8192), 0.03);
}

/// What the plates mirror and what lights the room directly. Where in a pixel a ray falls makes most of the variance: the
/// smallest lamp is a bright dot in the smoothest plate.
#[test]
fn estimators_agree_on_the_plates() {
    let plates = Lecture::VeachMis { resolution: 8 };
    let first = |estimator: &Estimator, passes| {
        let cell = cell(plates, estimator, passes);
        [0, 1, 2].map(|c| (cell.bounces[1][c].mean, cell.bounces[1][c].std_error().unwrap()))
    };
    let by_both = first(&explicit(Technique::Both(Heuristic::Balance)), 32_768);
    for (name, estimator, passes) in
        [("chance", implicit(), 131_072), ("light", explicit(Technique::Light), 32_768)]
    {
        for ((a, e), (b, f)) in by_both.into_iter().zip(first(&estimator, passes)) {
            println!("{a} ± {e}, by {name} {b} ± {f}");
            assert!(e < 0.04 * a && f < 0.08 * b, "{a} ± {e}, by {name} {b} ± {f}");
            let t = (a - b) / e.hypot(f);
            assert!(t.abs() < LIMIT, "{a} ± {e}, by {name} {b} ± {f}: {t}");
        }
    }
}

#[test]
fn estimators_agree_behind_lens_and_shutter() {
    let light = explicit(Technique::Light);
    agree(Lecture::Dof { aperture: 0.08, resolution: 8 }, &light, (2048, 16384), 0.02);
    agree(Lecture::Motion { travel: 0.5, resolution: 8 }, &light, (2048, 32768), 0.03);
}

/// Follows a path from the eye until it ends; the kinds of its vertices, `D` or `S`, and the light that the last one
/// emits, weighted.
fn walk(scene: &Scene, mut ray: Ray, stream: &mut furnace::sampling::Stream, see: &mut dyn FnMut(&str, Rgb)) {
    const Q: f64 = 0.8;
    let (mut beta, mut kinds) = (Rgb::ONE, String::new());
    while let Some(x) = scene.intersect(&ray, 0.0) {
        see(&kinds, beta * x.le);
        if stream.u1() >= Q || x.albedo() == Rgb::ZERO {
            return;
        }
        let bsdf = x.material.bsdf;
        kinds.push(if bsdf.is_dirac() { 'S' } else { 'D' });
        let s = bsdf.sample(Carried::Radiance, Directions::Cosine, &x.frame, x.wo, stream.u2());
        (ray, beta) = (x.spawn(s.wi), beta * s.weight / Q);
    }
}

/// Share of the light in an image, all channels added, that came by L S+ D E.
fn caustic_share(scene: &Scene, name: &str, passes: u64) -> f64 {
    let address = Address::of(&["lecture_scenes_are_lit", name]);
    let (width, height) = scene.sensor.resolution();
    let (mut all, mut caustic) = (0.0, 0.0);
    for pass in 0..passes {
        for pixel in 0..u64::from(width * height) {
            let mut stream = address.stream(pass, pixel);
            let (x, y) = (pixel as u32 % width, pixel as u32 / width);
            let ray = scene.start((x, y), &mut stream).ray;
            walk(scene, ray, &mut stream, &mut |kinds, light| {
                all += light.element_sum();
                let mirrors = kinds.strip_prefix('D').unwrap_or("");
                if !mirrors.is_empty() && mirrors.bytes().all(|kind| kind == b'S') {
                    caustic += light.element_sum();
                }
            });
        }
    }
    caustic / all
}

/// Shares of the whole image, and of what a probe shows that looks at the brightest place.
#[test]
fn caustics_are_caustics() {
    let glass = Lecture::CausticGlass { source: WIDE, resolution: 16 };
    let mirror = Lecture::CausticMirror { source: WIDE, resolution: 16 };
    let spots = [DVec3::new(-0.05, 0.0, 0.18), DVec3::new(0.5, 0.0, -0.2)];
    for ((lecture, least), spot) in [(glass, (0.015, 0.9)), (mirror, (0.01, 0.4))].into_iter().zip(spots) {
        let mut scene = lecture.build();
        let whole = caustic_share(&scene, &format!("{lecture:?}"), 2000);
        let Sensor::Camera(camera) = scene.sensor else { panic!("a camera") };
        // from close above, for the ball not to stand in the way
        let origin = spot + DVec3::new(0.0, 0.05, 0.05);
        scene.sensor = Sensor::Probe { origin, direction: (spot - origin).normalize() };
        let bright = caustic_share(&scene, &format!("{lecture:?} spot"), 400_000);
        println!("{lecture:?}: {whole} of the image of {} pixels, {bright} in the spot", camera.width);
        assert!(whole > least.0 && bright > least.1, "{lecture:?}: {whole} {bright}");
    }
}

#[test]
fn only_sampling_finds_a_point() {
    for lecture in [
        Lecture::CausticGlass { source: Source::Point, resolution: 8 },
        Lecture::CausticMirror { source: Source::Point, resolution: 8 },
    ] {
        let sampled = image(&cell(lecture, &explicit(Technique::Light), 256));
        assert!(sampled.iter().all(|&(mean, error)| mean > 0.0 && error < 0.25 * mean), "{sampled:?}");
        assert_eq!(image(&cell(lecture, &implicit(), 256)), [(0.0, 0.0); 3]);
    }
}

/// Nothing that the camera sees is a lamp or sees one: all light has been scattered twice, and nearly half of it more
/// than three times.
#[test]
fn the_indirect_room_is_lit_round_a_corner() {
    let cell = cell(Lecture::Indirect { resolution: 16 }, &explicit(Technique::Light), 4096);
    let all: f64 = (0..3).map(|c| cell.total[c].mean).sum();
    let share: Vec<f64> =
        cell.bounces.iter().map(|bin| bin.iter().map(|b| b.mean).sum::<f64>() / all).collect();
    println!("{share:.4?}");
    assert_eq!(share[..2], [0.0, 0.0]);
    assert!(share[3..].iter().sum::<f64>() > 0.3, "{share:?}");
}

/// The image of smallpt is 4 : 3, and its rays start between the front wall and the room.
#[test]
fn smallpt_is_wide_and_looks_through_its_front_wall() {
    for (rows, columns) in [(768, 1024), (96, 128), (3, 4), (4, 5), (1, 1)] {
        let scene = Lecture::Smallpt { resolution: rows }.build();
        assert_eq!(scene.sensor.resolution(), (columns, rows));
        let mut stream = Address::of(&["smallpt"]).stream(0, 0);
        let Sensor::Camera(camera) = scene.sensor else { panic!("a camera") };
        for (x, y) in [(0, 0), (columns - 1, 0), (0, rows - 1), (columns - 1, rows - 1)] {
            let ray = scene.start((x, y), &mut stream).ray;
            let depth = (ray.o - camera.origin).dot(camera.forward);
            assert!((depth - 130.0).abs() < 1e-9 && ray.o.z < 170.0, "{ray:?}");
            assert!(((ray.o - camera.origin).normalize() - ray.d).length() < 1e-12);
            assert!(scene.intersect(&ray, 0.0).is_some());
        }
        // square pixels
        let aspect = f64::from(columns) / f64::from(rows);
        assert!((camera.right.length() / camera.up.length() - aspect).abs() < 1e-12);
    }
}

/// Light that is connected to a camera passes as far as its rays start, and no nearer.
#[test]
fn a_near_plane_hides_what_is_before_it_from_both_sides() {
    let scene = Lecture::Smallpt { resolution: 12 }.build();
    let Sensor::Camera(camera) = scene.sensor else { panic!("a camera") };
    let seen = scene.sensor.connect(DVec3::new(40.0, 30.0, 60.0), (0.5, 0.5)).expect("it is in the picture");
    let end = DVec3::new(40.0, 30.0, 60.0) + seen.to_sensor;
    assert!(((end - camera.origin).dot(camera.forward) - camera.near).abs() < 1e-9);
    assert!(scene.sensor.connect(camera.origin + 129.0 * camera.forward, (0.5, 0.5)).is_none());
}

/// A larger lens and a longer way smear the picture: neighbouring pixels differ less.
#[test]
fn lens_and_shutter_blur() {
    let roughness = |lecture: Lecture| {
        let pixels = cell(lecture, &explicit(Technique::Light), 256).pixels;
        let (w, h) = (pixels.width as usize, pixels.height as usize);
        let step = |i: usize| (pixels.mean[i] - pixels.mean[i + 1]).length_squared();
        (0..w * h).filter(|i| i % w + 1 < w).map(step).sum::<f64>()
    };
    let dof = |aperture| roughness(Lecture::Dof { aperture, resolution: 32 });
    let motion = |travel| roughness(Lecture::Motion { travel, resolution: 32 });
    assert!(dof(0.3) < 0.7 * dof(0.001), "{} {}", dof(0.3), dof(0.001));
    assert!(motion(0.5) < 0.9 * motion(0.0), "{} {}", motion(0.5), motion(0.0));
    assert!(SceneKind::Lecture(Lecture::Motion { travel: 0.5, resolution: 4 }).build().surfaces()[3].moves());
}

// -------------------------------------------------------------------------------------------------------- from files

fn plan(scenes: &str) -> (Option<i32>, String, String) {
    let place = tempfile::tempdir().unwrap();
    let text = format!(
        "question = \"Is it planned?\"\nsamples = 64\n[grid]\nscene = [{scenes}]\n\
         estimator = [\"explicit\"]\nroulette = [\"throughput\"]\n"
    );
    std::fs::write(place.path().join("x.toml"), text).unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(["plan", "x.toml"]).current_dir(place.path()).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn files_name_them_with_their_parameters() {
    let (status, stdout, stderr) = plan(
        r#""caustic_glass", { caustic_glass = { light = [0.01, 0.1], resolution = 64 } },
        { caustic_mirror = { point = true } }, "indirect", { smallpt = { resolution = 12 } }, "veach_mis",
        { dof = { aperture = 0.2 } }, { motion = { travel = [0, 1] } }"#,
    );
    assert_eq!((status, stderr.as_str()), (Some(0), ""));
    for label in [
        "caustic_glass ",
        "light=0.01",
        "caustic_mirror_point",
        "indirect",
        "smallpt",
        "veach_mis",
        "dof(aperture=0.2)",
        "travel=1",
    ] {
        assert!(stdout.contains(label), "{label} is not in\n{stdout}");
    }
}

#[test]
fn impossible_parameters_are_refused() {
    for (scene, why) in [
        ("{ caustic_glass = { light = 0 } }", "half the edge of the light lies in [0.0001, 0.3]"),
        ("{ caustic_glass = { light = 0.02, point = true } }", "a point light has no extent"),
        ("{ caustic_mirror = { light = [0.1, 0.5] } }", "half the edge of the light lies in [0.0001, 0.3]"),
        ("{ caustic_mirror = { size = 0.1 } }", "size"),
        ("{ smallpt = { resolution = 4000 } }", "lies in 1 to 3072 rows of pixels"),
        ("{ indirect = { resolution = 0 } }", "a resolution lies in 1 to 4096 pixels"),
        ("{ dof = { aperture = 0 } }", "the radius of the lens lies in (0, 0.5]"),
        ("{ motion = { travel = -1 } }", "the board goes between 0 and 1"),
    ] {
        let (status, _, stderr) = plan(scene);
        assert_eq!(status, Some(2), "{scene}");
        let told = stderr.contains(why) && stderr.contains("--> x.toml:4:") && stderr.contains(scene);
        assert!(told && stderr.matches("error:").count() == 1, "{scene}: {stderr}");
    }
}
