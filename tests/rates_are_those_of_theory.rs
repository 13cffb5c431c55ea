//! Promise: the exponent with which an error falls is found with an interval that holds; independent samples have -1 in
//! it, progressive photon mapping what theory has at the same numbers of maps; behind a point light a photon map has the
//! bias and the variance of its closed form; and a file that cannot show a rate is refused where it is wrong.

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::estimator::{DirectLight, Estimator, Gather, Implicit, Kernel, PhotonMap, Roulette, Rule};
use furnace::experiment::{Cell, CellPlan, Decline, Overrides, Plan, run_cell, sample, spec::ErrorKind};
use furnace::sampling::{Address, Stream};
use furnace::scene::Directions;
use furnace::stats::decay::{Estimate, Falling, Runs, exponent_of};
use furnace::truth::density::progressive::Shrinking;
use furnace::truth::gallery;
use furnace::truth::{ClosedForm, Counted, Known, Truth};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Sum of twelve uniform numbers, less six: nearly normal, variance 1.
fn normal(stream: &mut Stream) -> f64 {
    (0..12).map(|_| stream.u1()).sum::<f64>() - 6.0
}

/// Means of one run after 1, 2, 4, ... samples: sample i is `bias(i)` + `scale(i)` times a normal number.
fn running(
    stream: &mut Stream,
    marks: &[u64],
    bias: impl Fn(u64) -> f64,
    scale: impl Fn(u64) -> f64,
) -> Vec<f64> {
    let (mut sum, mut means) = (0.0, Vec::new());
    for i in 1..=*marks.last().unwrap() {
        sum += bias(i) + scale(i) * normal(stream);
        if marks.contains(&i) {
            means.push(sum / i as f64);
        }
    }
    means
}

/// How many of `times` intervals of 95 % miss `right`, for 64 runs.
fn misses(
    times: u64,
    marks: &[u64],
    falling: Falling,
    weights: &[f64],
    right: f64,
    one: impl Fn(&mut Stream) -> Vec<f64>,
) -> u64 {
    let address = Address::of(&["synthetic", &format!("{falling:?} {right}")]);
    let quantile = 1.998; // Student's t of 63 degrees of freedom
    let found = (0..times).filter(|&time| {
        let means: Vec<Vec<f64>> = (0..64).map(|run| one(&mut address.stream(time, run))).collect();
        let runs = Runs { marks, means: &means, truth: Some((0.0, 0.0)) };
        let Estimate { value, std_error } = runs.exponent(falling, weights).unwrap();
        (value - right).abs() > quantile * std_error
    });
    found.count() as u64
}

const MARKS: [u64; 7] = [1, 2, 4, 8, 16, 32, 64];
const FROM_4: [f64; 7] = [0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0];

/// 20 of 400 are expected; with 95 % confidence in each, more than 40 or fewer than 4 have a probability below 1e-4.
#[test]
fn intervals_hold_for_independent_samples() {
    let iid = |stream: &mut Stream| running(stream, &MARKS, |_| 0.0, |_| 1.0);
    for falling in [Falling::Variance, Falling::Mse] {
        let missed = misses(400, &MARKS, falling, &FROM_4, -1.0, iid);
        assert!((4..=40).contains(&missed), "{falling:?}: {missed} of 400");
    }
}

/// Samples whose scale grows as i^0.2 and whose bias falls as i^-0.1: variance n^-0.6 and bias n^-0.1, both exactly
/// known for finite n.
#[test]
fn intervals_hold_where_variance_and_bias_change() {
    let power = |i: u64, e: f64| libm::pow(i as f64, e);
    let one = |stream: &mut Stream| running(stream, &MARKS, |i| 3.0 * power(i, -0.1), |i| power(i, 0.2));
    let over = |n: u64, f: &dyn Fn(u64) -> f64| (1..=n).map(f).sum::<f64>();
    let variance = MARKS.map(|n| over(n, &|i| power(i, 0.4)) / (n * n) as f64);
    let bias = MARKS.map(|n| over(n, &|i| 3.0 * power(i, -0.1)) / n as f64);
    let mse: Vec<f64> = variance.iter().zip(bias).map(|(v, b)| v + b * b).collect();
    let all = [1.0; 7];
    for (falling, curve, weights) in [
        (Falling::Variance, &variance[..], FROM_4),
        (Falling::Mse, &mse[..], FROM_4),
        (Falling::Bias(1.0), &bias[..], all),
    ] {
        let right = exponent_of(&MARKS, curve, &weights).unwrap();
        let missed = misses(400, &MARKS, falling, &weights, right, one);
        assert!((4..=40).contains(&missed), "{falling:?} {right}: {missed} of 400");
    }
}

fn near_wall(offset: f64) -> furnace::scene::library::SceneKind {
    gallery::find("point_near_wall").unwrap().scene(offset)
}

fn map(gather: Gather) -> PhotonMap {
    PhotonMap {
        photons: 30,
        gather,
        kernel: Kernel::Box,
        direct: DirectLight::Photons,
        final_gather: 0,
        directions: Directions::Cosine,
        roulette: Roulette::unclamped(Rule::Constant { q: 0.75 }),
    }
}

fn close(what: &str, measured: f64, error: f64, right: f64) {
    assert!((measured - right).abs() <= 5.0 * error, "{what}: {measured} ± {error}, by theory {right}");
}

/// Mean and variance of one map, per bounce and in all, with and without sampled direct light.
#[test]
fn a_map_behind_a_point_light_has_its_closed_form() {
    for (offset, radius, direct) in [
        (0.5, 0.65, DirectLight::Photons),
        (0.8, 0.4, DirectLight::Photons),
        (0.5, 0.65, DirectLight::Sampled),
    ] {
        let (kind, map) = (near_wall(offset), PhotonMap { direct, ..map(Gather::Within { radius }) });
        let estimator = Estimator::PhotonMap(map);
        let address = Address::of(&["near wall", &format!("{map:?} {offset}")]);
        let cell = sample(&kind.build(), &estimator, &address, 60_000, 600);
        let closed = ClosedForm::of(&kind, &estimator).unwrap();
        for channel in 0..3 {
            let total = &cell.total[channel];
            let right = closed.blurred(channel, Counted::All).unwrap();
            close("mean", total.mean, total.std_error().unwrap(), right);
            // the blur is there to be seen
            let blur = closed.truth(channel, Counted::All) - right;
            let seen = blur > 10.0 * total.std_error().unwrap();
            assert_eq!(seen, direct == DirectLight::Photons, "{blur}");
            let variance = closed.central(channel, Counted::All, 2).value().unwrap();
            close("variance", total.variance().unwrap(), total.variance_std_error().unwrap(), variance);
            for bounce in [1, 2, 3] {
                let blocks = &cell.bounces[bounce][channel];
                let right = closed.blurred(channel, Counted::Only(bounce as u32)).unwrap();
                close("bounce", blocks.mean, blocks.std_error().unwrap() + 1e-12, right);
            }
            if direct == DirectLight::Photons {
                let once = closed.central(channel, Counted::Only(1), 2).value().unwrap();
                let blocks = &cell.bounces[1][channel];
                // block means of 600 maps
                close(
                    "once",
                    600.0 * blocks.variance().unwrap(),
                    600.0 * blocks.variance_std_error().unwrap(),
                    once,
                );
            }
        }
        let rays = closed.rays();
        if let Some(rays) = rays {
            close("rays", cell.cost.mean, cell.cost.std_error().unwrap(), rays);
        }
    }
}

/// A cell as the bench runs it: blocks of `run` realizations.
fn traced(
    kind: &furnace::scene::library::SceneKind,
    estimator: &Estimator,
    runs: u64,
    run: u64,
) -> (CellPlan, Cell) {
    let text = format!(
        "question = \"?\"\nsamples = {}\nruns = {runs}\n[grid]\nscene = [\"furnace\"]\nestimator = [\"implicit\"]\nroulette = [\"albedo\"]\n",
        runs * run
    );
    let plan = Plan::new("x", Path::new("x.toml"), &text, &Overrides::default()).unwrap();
    let mut cell_plan = plan.cells[0].clone();
    (cell_plan.scene, cell_plan.estimator) = (kind.clone(), *estimator);
    cell_plan.streams = Vec::new();
    let cell = run_cell(&cell_plan, &AtomicBool::new(false), &|_| (), &|_| false).unwrap();
    (cell_plan, cell)
}

#[test]
fn progressive_photon_mapping_has_the_rates_of_theory() {
    for alpha in [0.5, 0.8] {
        let (kind, passes) = (near_wall(0.5), 128);
        let estimator = Estimator::PhotonMap(map(Gather::Shrinking { radius: 0.65, alpha, passes }));
        let (plan, cell) = traced(&kind, &estimator, 512, passes);
        let truth = Truth::of(&kind, &estimator, &[]);
        for channel in 0..3 {
            let decline = Decline::of(&plan, &cell, &truth, channel).unwrap();
            for (error, theory) in decline.errors().iter().zip(&decline.theory) {
                let (bias, variance) = (error.bias.unwrap(), error.variance);
                close("bias", bias.value, bias.std_error, theory.bias.unwrap());
                close("variance", variance.value, variance.std_error, theory.variance.value().unwrap());
                let mse = error.mse.unwrap();
                close("mse", mse.value, mse.std_error, theory.mse().unwrap());
            }
            for (kind, late) in [
                (ErrorKind::Variance, -alpha),
                (ErrorKind::Bias, alpha - 1.0),
                (ErrorKind::Mse, -alpha.min(2.0 - 2.0 * alpha)),
            ] {
                let fall = decline.fall(kind);
                let (measured, exact) = (fall.measured.unwrap(), fall.exact.unwrap());
                close(&format!("{kind:?} {alpha}"), measured.value, measured.std_error, exact);
                assert!(measured.std_error < 0.06, "{kind:?}: {measured:?}");
                assert!((exact - late).abs() < 0.2, "{kind:?}: {exact} and {late}");
                assert_eq!((fall.late, fall.unfit), (Some(late), None));
            }
        }
    }
}

/// What is summed pass by pass is what the closed sums over passes are, where each pass has a / r² + b.
#[test]
fn sums_over_passes_agree() {
    let kind = furnace::scene::library::SceneKind::Furnace {
        albedo: furnace::scene::Rgb::new(0.7, 0.5, 0.2),
        emission: furnace::scene::Rgb::ONE,
        view: furnace::scene::library::View::Probe,
    };
    let alpha = 2.0 / 3.0;
    let at = |gather| ClosedForm::of(&kind, &Estimator::PhotonMap(map(gather))).unwrap();
    let within = |radius: f64| at(Gather::Within { radius }).central(1, Counted::All, 2).value().unwrap();
    // a and b from two radii
    let (one, two) = (within(0.3), within(0.6));
    let a = (one - two) / (1.0 / 0.09 - 1.0 / 0.36);
    let b = one - a / 0.09;
    let shrinking = at(Gather::Shrinking { radius: 0.5, alpha, passes: 1000 });
    for n in [1, 2, 10, 1000] {
        let right = Shrinking { first: 0.5, alpha }.variance(n, a, b);
        let Known::Value(sum) = shrinking.after(1, n).variance else { panic!("known") };
        assert!((sum / right - 1.0).abs() < 1e-9, "{n}: {sum} {right}");
        assert_eq!(shrinking.after(1, n).bias, Some(0.0));
    }
}

#[test]
fn independent_paths_have_minus_one_and_infinite_variance_no_rate() {
    let kind = furnace::scene::library::SceneKind::Furnace {
        albedo: furnace::scene::Rgb::new(0.8, 0.5, 0.2),
        emission: furnace::scene::Rgb::ONE,
        view: furnace::scene::library::View::Probe,
    };
    let implicit = |q| {
        let roulette = Roulette::unclamped(Rule::Constant { q });
        Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette })
    };
    let of = |estimator: Estimator, channel: usize| {
        let (plan, cell) = traced(&kind, &estimator, 256, 256);
        let truth = Truth::of(&kind, &estimator, &[]);
        Decline::of(&plan, &cell, &truth, channel).unwrap()
    };
    let fine = of(implicit(0.9), 0);
    for kind in [ErrorKind::Variance, ErrorKind::Mse] {
        let fall = fine.fall(kind);
        let measured = fall.measured.unwrap();
        close(&format!("{kind:?}"), measured.value, measured.std_error, -1.0);
        assert_eq!((fall.exact, fall.late, fall.unfit), (Some(-1.0), Some(-1.0), None));
    }
    assert_eq!(fine.fall(ErrorKind::Bias).measured, None, "there is no bias that could fall");
    let infinite = of(implicit(0.5), 0).fall(ErrorKind::Variance);
    assert!(infinite.unfit.unwrap().contains("infinite variance"));
    assert!(infinite.measured.unwrap().value > -0.9, "visibly slower");
}

const GOOD: &str = r#"question = "Is it refused?"
seed = 1
samples = 2048
runs = 16
claim = [{ rate = { alpha = 1e-3, margin = 0.5 } }]
plot = [{ convergence = { scene = "furnace" } }]
[grid]
scene = ["furnace"]
estimator = [{ progressive = { photons = 100, radius = 0.5, passes = 128 } }]
roulette = ["albedo"]
"#;

/// The line that takes the place of the one with the same key, the text under the caret, words of the message.
const REFUSED: [(&str, &str, &str); 14] = [
    ("runs = 7", "7", "a whole number of runs from 8 to 10^6; fewer give no interval"),
    ("runs = 16.5", "16.5", "invalid type: floating point `16.5`"),
    ("runs = 60", "60", "60 runs do not divide 2048 samples; take 2040 samples, say"),
    ("runs = 256", "256", "fewer than 16 for a run, which show no rate; take 4096 samples, or fewer runs"),
    ("seed = 1\nseeds = 9", "", "a study (`seeds`) repeats its cells itself; leave `runs` out"),
    (
        "estimator = [{ progressive = { photons = 10, radius = 0.3, passes = 100 } }]",
        "{ progressive = { photons = 10, radius = 0.3, passes = 100 } }",
        "a picture has passes = 100; take passes = 128, or 1600 samples",
    ),
    (
        "estimator = [{ progressive = { photons = 10, radius = 0.3, passes = 128, alpha = 1.0 } }]",
        "1.0",
        "alpha lies inside (0, 1)",
    ),
    (
        "estimator = [{ progressive = { photons = 10, radius = 0.3, passes = 128, alpha = [0.5, 0] } }]",
        "[0.5, 0]",
        "0 is out of range: alpha lies inside (0, 1)",
    ),
    ("claim = [{ rate = { alpha = 0, margin = 0.5 } }]", "0", "it lies inside (0, 1)"),
    ("claim = [{ rate = { alpha = 0.1, margin = 1.5 } }]", "1.5", "it lies inside (0, 1)"),
    ("claim = [{ rate = { alpha = 0.1 } }]", "", "missing field `margin`"),
    ("plot = [{ convergence = { scene = \"furnac\" } }]", "\"furnac\"", "names the scene `furnac`"),
    (
        "plot = [{ convergence = { scene = \"furnace\", show = [\"byas\"] } }]",
        "\"byas\"",
        "did you mean `bias`?",
    ),
    (
        "runs_are_left_out = 0",
        "{ alpha = 1e-3, margin = 0.5 }",
        "no cell of this claim is cut into some; add `runs = 256`, say",
    ),
];

fn run(place: &Path, text: &str, args: &[&str]) -> std::process::Output {
    fs::create_dir_all(place.join("experiments")).unwrap();
    fs::write(place.join("experiments/x.toml"), text).unwrap();
    Command::new(cargo_bin!("experiment")).args(args).current_dir(place).output().unwrap()
}

#[test]
fn what_shows_no_rate_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for (line, at, why) in REFUSED {
        let key =
            if line.starts_with("runs_are") { "runs =" } else { line.split_inclusive(" =").next().unwrap() };
        let with = if line.starts_with("runs_are") { "answer = \"\"" } else { line };
        let replace = |good: &str| if good.starts_with(key) { with.to_owned() } else { good.to_owned() };
        let text: String = GOOD.lines().map(|good| replace(good) + "\n").collect();
        let output = run(place.path(), &text, &["x"]);
        let said = String::from_utf8(output.stderr).unwrap();
        let under = at.is_empty() || said.trim_end().ends_with(&"^".repeat(at.chars().count()));
        let placed = said.contains("--> experiments/x.toml:");
        if output.status.code() != Some(2)
            || !said.contains(why)
            || !under
            || !placed
            || !output.stdout.is_empty()
        {
            wrong.push(format!("{line}: {said}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn rates_are_reported_and_judged() {
    let place = tempfile::tempdir().unwrap();
    let output = run(place.path(), GOOD, &["x"]);
    assert!(output.status.code() < Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let mut reader = csv::Reader::from_path(place.path().join("reports/x/results.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let rates: Vec<_> =
        rows.iter().filter(|row| row.iter().any(|field| field.starts_with("rate_"))).collect();
    // no bias in a furnace: mean squared error and variance, in three channels
    assert_eq!(rates.len(), 6);
    assert!(rates.iter().all(|row| row.iter().any(|f| ["PASS", "FAIL", "INCONCLUSIVE"].contains(&f))));
    let mut reader = csv::Reader::from_path(place.path().join("reports/x/convergence.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let (n, variance, theory) = (column("n"), column("variance"), column("theory_variance"));
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 3 * 8, "after 1, 2, ..., 128 maps");
    assert_eq!((&rows[0][n], &rows[7][n]), ("1", "128"));
    assert!(rows.iter().all(|row| row[variance].parse::<f64>().unwrap() > 0.0 && !row[theory].is_empty()));
    let drawn = fs::read_dir(place.path().join("reports/x")).unwrap();
    let mut names = drawn.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    assert!(names.any(|name| name.ends_with("convergence.svg")), "no figure");
    // fewer runs, not shorter ones
    let output = run(place.path(), GOOD, &["x", "--quick"]);
    assert!(output.status.code() < Some(2));
    let text = fs::read_to_string(place.path().join("reports/x/convergence.csv")).unwrap();
    assert!(text.contains(",R,8,128,"), "{text}");
}
