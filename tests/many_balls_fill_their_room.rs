//! Promise: `many_spheres` is what it is said to be, for any number of balls: as many as asked for, none touching another
//! or the walls, always filling the same part of the same cube; implicit and explicit path tracing find the same light
//! there; and files can ask for it, but not for an impossible number of balls.
//!
//! Six means are compared, each beyond LIMIT standard errors with a probability below 2e-8.

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::estimator::{Estimator, Explicit, Implicit, Roulette, Rule, Technique};
use furnace::experiment::sample;
use furnace::sampling::Address;
use furnace::scene::geometry::SpherePatch;
use furnace::scene::library::SceneKind;
use furnace::scene::many_spheres::COUNTS;
use furnace::scene::{Directions, LightSampling, Shape};
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;

const LIMIT: f64 = 6.0;

fn balls(count: u32) -> Vec<SpherePatch> {
    let scene = SceneKind::ManySpheres { count, resolution: 4 }.build();
    let ball = |shape: &Shape| if let Shape::Sphere(ball) = shape { Some(*ball) } else { None };
    scene.surfaces().iter().filter_map(|s| ball(&s.shape)).collect()
}

#[test]
fn no_ball_touches_another() {
    for count in (10..=130).chain([342, 343, 344, 999, 1000, 1001, 4096, 10_000, 99_999, 100_000]) {
        let balls = balls(count);
        assert_eq!(balls.len(), count as usize);
        let radius = balls[0].radius;
        let filled = 4.0 / 3.0 * PI * radius.powi(3) * f64::from(count) / 8.0;
        assert!((filled - 4.0 / 81.0 * PI).abs() < 1e-12, "{count} fill {filled}");
        // cells as large as a ball: those that touch are in the same or in neighbouring ones
        let cell = |p: DVec3| (p / (2.0 * radius)).floor().as_i64vec3();
        let mut cells: HashMap<glam::I64Vec3, Vec<DVec3>> = HashMap::new();
        for ball in &balls {
            assert!(ball.radius == radius && !ball.inward);
            assert!((ball.center - DVec3::new(0.0, 1.1, 0.0)).abs().max_element() + radius < 1.0 + 1e-12);
            cells.entry(cell(ball.center)).or_default().push(ball.center);
        }
        for ball in &balls {
            let around = (0..27).map(|k| cell(ball.center) + glam::I64Vec3::new(k % 3, k / 3 % 3, k / 9) - 1);
            let near = around.filter_map(|key| cells.get(&key)).flatten();
            let touching = near.filter(|center| center.distance(ball.center) <= 2.0 * radius).count();
            assert_eq!(touching, 1, "{count}: one is the ball itself");
        }
    }
}

#[test]
fn estimators_agree_among_them() {
    let directions = Directions::Cosine;
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (technique, lights) = (Technique::Light, LightSampling::AREA);
    let estimators = [
        Estimator::Implicit(Implicit { directions, roulette }),
        Estimator::Explicit(Explicit { technique, lights, directions, roulette }),
    ];
    for count in [10, 5000] {
        let scene = SceneKind::ManySpheres { count, resolution: 8 }.build();
        let cells = estimators.map(|estimator| {
            let address = Address::of(&["many_balls", &format!("{count} {estimator:?}")]);
            let cell = sample(&scene, &estimator, &address, 2048, 16);
            assert_eq!(cell.invalid(), None);
            cell
        });
        for channel in 0..3 {
            let [(a, e), (b, f)] =
                cells.each_ref().map(|c| (c.total[channel].mean, c.total[channel].std_error().unwrap()));
            assert!(a > 0.0 && e < 0.03 * a && f < 0.03 * b, "{count}: {a} ± {e}, {b} ± {f}");
            assert!((a - b).abs() < LIMIT * e.hypot(f), "{count}: {a} ± {e}, {b} ± {f}");
        }
    }
}

/// `experiment plan` of a file with this scene on line 4.
fn plan(scene: &str) -> (Option<i32>, String, String) {
    let place = tempfile::tempdir().unwrap();
    let text = format!(
        "question = \"Is it planned?\"\nsamples = 64\n[grid]\nscene = [{scene}]\n\
         estimator = [\"explicit\"]\nroulette = [\"throughput\"]\n"
    );
    std::fs::write(place.path().join("x.toml"), text).unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(["plan", "x.toml"]).current_dir(place.path()).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn files_say_how_many() {
    let (status, stdout, stderr) = plan(
        "\"many_spheres\", { many_spheres = { count = 12, resolution = 4 } }, \
         { many_spheres = { count = [10, 100_000] } }",
    );
    assert_eq!((status, stderr.as_str()), (Some(0), ""));
    for label in ["many_spheres explicit", "many_spheres(count=12)", "count=10 ", "count=100000"] {
        assert!(stdout.contains(label), "{label} is not in\n{stdout}");
    }
}

#[test]
fn impossible_numbers_are_refused() {
    assert_eq!(COUNTS, 10..=100_000);
    let wanted = "a number of balls is a whole number from 10 to 100000";
    for (scene, why) in [
        ("{ many_spheres = { count = 9 } }", wanted),
        ("{ many_spheres = { count = 100001 } }", wanted),
        ("{ many_spheres = { count = [10, 12.5] } }", wanted),
        ("{ many_spheres = { count = -10 } }", wanted),
        ("{ many_spheres = { count = nan } }", wanted),
        ("{ many_spheres = { count = [] } }", "an empty list leaves nothing to run"),
        ("{ many_spheres = { count = \"many\" } }", "expected a number, or a list of numbers"),
        ("{ many_spheres = { number = 10 } }", "number"),
        ("{ many_spheres = { resolution = 0 } }", "a resolution lies in 1 to 4096 pixels"),
    ] {
        let (status, _, stderr) = plan(scene);
        assert_eq!(status, Some(2), "{scene}");
        let told = stderr.contains(why) && stderr.contains("--> x.toml:4:") && stderr.contains(scene);
        assert!(told && stderr.matches("error:").count() == 1, "{scene}: {stderr}");
    }
}
