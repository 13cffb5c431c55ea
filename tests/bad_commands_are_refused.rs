//! Promise: what is typed wrongly is refused with exit status 2, one error and what would be right, before anything is
//! sampled or written.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const GOOD: &str = r#"question = "Is it refused?"
samples = 64
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

/// A folder with `experiments/NAME.toml` for each of the files.
fn place(files: &[(&str, &str)]) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    for (name, text) in files {
        fs::write(place.path().join(format!("experiments/{name}.toml")), text).unwrap();
    }
    place
}

/// Runs `experiment ARGS` and holds that it refuses, in these words, and writes nothing.
#[track_caller]
fn refuses(place: &TempDir, args: &str, words: &[&str]) {
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(args.split_whitespace()).current_dir(place.path()).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args}: {stderr}");
    assert!(stderr.starts_with("error: "), "{args}: {stderr}");
    assert_eq!(stderr.matches("error:").count(), 1, "{args}: {stderr}");
    for word in words {
        assert!(stderr.contains(word), "{args} should say `{word}`: {stderr}");
    }
    let entries: Vec<_> = fs::read_dir(place.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(entries, ["experiments"], "{args} wrote something");
}

#[test]
fn usage_errors() {
    let place = place(&[("x", GOOD)]);
    let cases: [(&str, &[&str]); 19] = [
        ("x --frob", &["unexpected argument '--frob'", "--help"]),
        ("x --sample 5", &["unexpected argument '--sample'", "'--samples'"]),
        ("x --samples", &["a value is required for '--samples <N>'"]),
        ("x --samples 0", &["invalid value '0' for '--samples <N>'", "not in 1.."]),
        ("x --samples -3", &["-3"]),
        ("x --samples 1e3", &["invalid value '1e3' for '--samples <N>'"]),
        ("x --seed -1", &["-1"]),
        ("x --jobs many", &["invalid value 'many' for '--jobs <N>'"]),
        ("x --format xml", &["invalid value 'xml'", "text, json, mitsuba"]),
        ("plan", &["<NAMES>"]),
        ("report", &["<NAMES>"]),
        ("merge", &["<FOLDERS>"]),
        ("status", &["<FOLDERS>"]),
        ("render", &["<SCENE>"]),
        ("reference", &["<SCENE>"]),
        ("reference furnace --until-error 0", &["invalid value '0'", "it lies inside (0, 1)"]),
        ("reference furnace --max-samples 1", &["invalid value '1'", "not in 2.."]),
        ("render cornell_box --spp 1", &["invalid value '1' for '--spp <SPP>'", "not in 2.."]),
        (
            "render cornell_box --resolution 0",
            &["invalid value '0' for '--resolution <RESOLUTION>'", "1..=4096"],
        ),
    ];
    cases.iter().for_each(|(args, words)| refuses(&place, args, words));
    let mut nothing = Command::new(cargo_bin!("experiment"));
    nothing.current_dir(place.path()).assert().code(2);
}

#[test]
fn names_that_nothing_has() {
    let sweep = place(&[("rr_sweep", GOOD), ("explosion", GOOD)]);
    refuses(&sweep, "rr_swep", &["no experiment called `rr_swep`", "did you mean `rr_sweep`?"]);
    refuses(&sweep, "plan explosoin", &["no experiment called `explosoin`", "did you mean `explosion`?"]);
    refuses(&sweep, "banana", &["no experiment called `banana`", "there are: explosion, rr_sweep"]);
    // a mistake in the last name must not cost the time of the first
    refuses(&sweep, "rr_sweep banana", &["no experiment called `banana`"]);
    refuses(&sweep, "missing.toml", &["cannot read missing.toml", "No such file"]);
    refuses(&sweep, "rr_sweep --format mitsuba", &["only `export` writes --format mitsuba"]);
    refuses(&sweep, "render kitchen", &["no scene `kitchen`", "there are cornell_box, cornell_empty"]);
    refuses(&sweep, "render furnace", &["furnace has no camera"]);
    refuses(&sweep, "render cornell_box -o x.png", &["x.png must end in .exr"]);
    refuses(&sweep, "reference kitchen", &["no scene `kitchen`", "furnace, furnace_box"]);
    refuses(&sweep, "reference cornell_box -o x.png", &["x.png must end in .exr"]);
    refuses(&sweep, "reference cornell_box --estimator bdpt", &["no estimator `bdpt`", "explicit, implicit"]);
    refuses(&sweep, "reference experiments/rr_sweep.toml:x", &["has no scene called `x`"]);
    refuses(&sweep, "reference none.toml:x", &["cannot read none.toml"]);
    refuses(&sweep, "render cornell_box --estimator bdpt", &["no estimator `bdpt`", "explicit, implicit"]);
    refuses(&place(&[]), "anything", &["there are none in the folder experiments/"]);
}

#[test]
fn tasks_that_cannot_be() {
    let place = place(&[("x", GOOD), ("wrong", "question = 1")]);
    let cases: [(&str, &[&str]); 18] = [
        ("slurm", &["<NAME>", "--tasks"]),
        ("slurm x", &["--tasks <N>"]),
        ("slurm x --tasks 0", &["invalid value '0' for '--tasks <N>'", "not in 1.."]),
        ("slurm x --tasks 64", &["--tasks 64: x can be divided into 32 parts at most"]),
        ("slurm x --tasks 2 --set seeds=4", &["x is a study", "cannot be divided"]),
        ("slurm y --tasks 2", &["no experiment called `y`"]),
        ("slurm wrong --tasks 2", &["experiments/wrong.toml:1:12", "invalid type: integer `1`"]),
        ("slurm x --tasks 2 --filter nowhere", &["no cell of x has `nowhere` in its label"]),
        ("slurm x --tasks 2 --set sed=1", &["unknown field `sed`"]),
        ("slurm x --tasks 2 --time soon", &["invalid value 'soon' for '--time <LIMIT>'", "H:M:S", "D-H"]),
        ("slurm x --tasks 2 --time 1-2:3:4:5", &["invalid value '1-2:3:4:5'"]),
        ("slurm x --tasks 2 --time 1", &["invalid value '1' for '--time <LIMIT>'", "two minutes at least"]),
        ("slurm x --tasks 2 --mem 2Q", &["invalid value '2Q' for '--mem <SIZE>'", "2G"]),
        ("slurm x --tasks 2 --partition a;b", &["invalid value 'a;b' for '--partition <NAME>'"]),
        ("slurm x --tasks 2 --sbatch=qos", &["an option of sbatch begins with -"]),
        ("slurm x --tasks 2 --sbatch=-a1-9", &["-a is said here already"]),
        ("slurm x --tasks 2 --jobs 3", &["a task's threads are --cpus"]),
        ("slurm x --tasks 2 --baseline main", &["main"]),
    ];
    cases.iter().for_each(|(args, words)| refuses(&place, args, words));
    refuses(&place, "slurm x --tasks 2 --out a\\b", &["Slurm takes no \\ "]);
}

const COMMANDS: [&str; 13] = [
    "list",
    "plan",
    "report",
    "merge",
    "status",
    "new",
    "render",
    "reference",
    "export",
    "slurm",
    "schema",
    "completions",
    "help",
];

#[test]
fn an_experiment_named_like_a_command() {
    for name in COMMANDS {
        let place = place(&[(name, GOOD)]);
        let words = format!("experiments/{name}.toml: `{name}` is a command; rename the file");
        refuses(&place, &format!("experiments/{name}.toml"), &[&words]);
        refuses(&place, "list", &[&words]);
    }
}

#[test]
fn changes_that_cannot_be() {
    let place = place(&[("x", GOOD)]);
    let cases: [(&str, &[&str]); 8] = [
        ("x --set seed", &["expected path=value", "--> --set:1:1\n  |\n1 | seed\n  | ^^^^\n"]),
        (
            "x --set grid.scene.5=1",
            &["there is no element 5; the list has 1", "1 | grid.scene.5=1\n  |            ^\n"],
        ),
        ("x --set samples.a=1", &["`a` is not inside a table or list", "1 | samples.a=1\n  |         ^\n"]),
        ("x --set grid.scene.x=1", &["`x` is not inside a table or list"]),
        ("x --set sed=1", &["unknown field `sed`", "did you mean `seed`?", "1 | sed=1\n  | ^^^\n"]),
        ("x --set samples=0", &["at least 1 sample is needed", "1 | samples=0\n  |         ^\n"]),
        ("x --set samples=lots", &["invalid type: string \"lots\"", "1 | samples=lots\n  |         ^^^^\n"]),
        ("x --set grid.roulette=[]", &["an empty list of termination rules leaves nothing to run"]),
    ];
    cases.iter().for_each(|(args, words)| refuses(&place, args, words));
    let there = "no cell of x has `nowhere` in its label; there are:\n  furnace implicit albedo\n";
    refuses(&place, "x --filter nowhere", &[there]);
}

#[test]
fn grids_without_cells_and_cells_of_one_name() {
    let head = "question = \"Is it refused?\"\nsamples = 64\n";
    let empty = place(&[("x", &format!("{head}grid = []\n"))]);
    refuses(&empty, "x", &["experiments/x.toml", "an empty list of grids leaves nothing to run"]);
    let twice = GOOD.replace("[\"furnace\"]", "[\"furnace\", { furnace = { albedo = 0.3 } }]");
    refuses(&place(&[("x", &twice)]), "x", &["two cells are both called `furnace implicit albedo`"]);
    refuses(
        &place(&[("x", &format!("{head}[grid]\n"))]),
        "x",
        &["experiments/x.toml:3:1", "missing field `scene`"],
    );
}

#[test]
fn a_recursion_out_of_proportion() {
    let recursion = |n: u32, depth: u32, samples: u64| {
        let estimator = format!("{{ recursive = {{ samples = {n}, depth = {depth} }} }}");
        let text = GOOD.replace("\"implicit\"", &estimator).replace("\"albedo\"", "\"none\"");
        place(&[("x", &text.replace("samples = 64", &format!("samples = {samples}")))])
    };
    let start = Instant::now();
    // 4^10 is a million rays a sample: a million samples take a day
    let long = recursion(4, 10, 1_000_000);
    refuses(
        &long,
        "x",
        &[
            "recursive(n=4 depth=10) none",
            "e12 rays",
            "hours on one core",
            "lower n, depth or samples",
            "--force",
        ],
    );
    let mut forced = Command::new(cargo_bin!("experiment"));
    forced.args(["plan", "x", "--force"]).current_dir(long.path()).assert().success();
    // 16^16 rays in one sample: no walk may be that long, whoever forces it
    let endless = recursion(16, 16, 2);
    for args in ["x", "x --force", "plan x --force"] {
        refuses(
            &endless,
            args,
            &["one sample would trace", "rays", "a walk is cut at 67108864", "lower n or depth"],
        );
    }
    refuses(&recursion(1000, 1000, 2), "x --force", &["one sample would trace inf rays"]);
    assert!(start.elapsed() < Duration::from_secs(5), "a refusal must not cost time");
}

#[test]
fn more_than_can_be_counted() {
    refuses(&place(&[("x", GOOD)]), "x --samples 18446744073709551615", &["samples"]);
    let text = GOOD.replace("\"albedo\"", "{ constant = { q = 0.5, from = 4294967295 } }");
    refuses(&place(&[("x", &text)]), "x", &["4294967295 is out of range", "0 to 1000"]);
}

/// The text that `--set` makes is not the file: its lines are not those a reader finds there.
#[test]
fn changes_do_not_move_the_place_of_an_error() {
    let text = format!("# three\n# lines of\n# comment\n{}", GOOD.replace("furnace", "furnac"));
    refuses(
        &place(&[("x", &text)]),
        "x --set seed=2",
        &["experiments/x.toml:7:10", "did you mean `furnace`?"],
    );
}
