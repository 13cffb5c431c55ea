//! Promise: whatever is wrong in an experiment file is refused before anything is sampled: exit status 2, one error that
//! says what would be right, with file, line, column and the offending line, and older results as they were.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::Path;

/// A file in which all is well; each case replaces one of its lines.
const GOOD: &str = r#"question = "Is it refused?"
seed = 1
samples = 64
claim = [{ unbiased = { alpha = 1e-3, margin = 0.01 } }]
plot = [{ bias = {} }]
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = ["albedo"]
"#;

/// What is wrong: the line that takes the place of the one with the same key, the text under the caret, and words of
/// the message.
type Case = (&'static str, &'static str, &'static str);

const KEYS_AND_TYPES: [Case; 17] = [
    ("sed = 7", "sed", "unknown field `sed`, expected one of `question`, `answer`, `seed`"),
    ("sed = 7", "sed", "did you mean `seed`?"),
    ("scene = [{ furnace = { albdo = 0.5 } }]", "albdo", "did you mean `albedo`?"),
    ("scene = [\"furnac\"]", "\"furnac\"", "did you mean `furnace`?"),
    (
        "scene = [\"kitchen\"]",
        "\"kitchen\"",
        "expected one of `furnace`, `furnace_box`, `integrating_sphere`",
    ),
    ("estimator = [\"explicti\"]", "\"explicti\"", "did you mean `explicit`?"),
    ("roulette = [{ constnt = { q = 0.5 } }]", "constnt", "did you mean `constant`?"),
    (
        "roulette = [{ constant = { p = 0.5 } }]",
        "p",
        "unknown field `p`, expected one of `q`, `from`, `clamp`",
    ),
    ("claim = [{ unbaised = { alpha = 0.1, margin = 0.1 } }]", "unbaised", "did you mean `unbiased`?"),
    ("plot = [{ over = { parameter = \"q\", show = [\"byas\"] } }]", "\"byas\"", "did you mean `bias`?"),
    ("streams = \"shared\"", "\"shared\"", "expected `independent` or `paired`"),
    ("samples = \"many\"", "\"many\"", "invalid type: string \"many\""),
    ("seed = 1.5", "1.5", "invalid type: floating point `1.5`"),
    (
        "scene = [{ furnace = { albedo = true } }]",
        "true",
        "expected a number, or three numbers [red, green, blue]",
    ),
    (
        "scene = [{ furnace = { albedo = [0.1, 0.2] } }]",
        "[0.1, 0.2]",
        "2 numbers; expected a number, or three",
    ),
    ("scene = \"furnace\"", "\"furnace\"", "invalid type: string \"furnace\", expected a sequence"),
    ("samples = 64 64", "64 64", "string values must be quoted"),
];

/// What has to do with estimators that make mistakes.
const FAULTS: [Case; 4] = [
    (
        "estimator = [{ fault = { name = \"roulette_off\" } }]",
        "{ fault = { name = \"roulette_off\" } }",
        "estimators with a mistake are for files that say `faults = true`",
    ),
    ("seeds = 0", "0", "a whole number of seeds from 1 to 10^6"),
    ("claim = [{ length = { alpha = 1.5 } }]", "1.5", "it lies inside (0, 1)"),
    (
        "claim = [{ independent = { margin = 0.1 } }]",
        "margin",
        "unknown field `margin`, expected `scene` or `alpha`",
    ),
];

const NUMBERS: [Case; 33] = [
    ("block = 10", "10", "a whole number of paths from 64 to 2^30"),
    ("samples = 0", "0", "at least 1 sample is needed"),
    ("samples = -5", "-5", "at least 1 sample is needed"),
    ("max_samples = 0", "0", "at least 1 sample is needed"),
    ("seed = -1", "-1", "expected u64"),
    ("scene = [{ furnace = { albedo = 1.5 } }]", "1.5", "an albedo lies in [0, 1]"),
    ("scene = [{ furnace = { albedo = -0.1 } }]", "-0.1", "an albedo lies in [0, 1]"),
    ("scene = [{ furnace = { albedo = nan } }]", "nan", "an albedo lies in [0, 1]"),
    (
        "scene = [{ furnace = { albedo = [0.5, inf, 0.5] } }]",
        "[0.5, inf, 0.5]",
        "inf is out of range: an albedo",
    ),
    ("scene = [{ furnace = { emission = -1 } }]", "-1", "emitted radiance is finite and not negative"),
    ("scene = [{ furnace = { emission = inf } }]", "inf", "emitted radiance is finite and not negative"),
    ("scene = [{ furnace = { emission = [1, 1, nan] } }]", "[1, 1, nan]", "emitted radiance is finite"),
    ("scene = [{ integrating_sphere = { light_fraction = 0 } }]", "0", "lies inside (0, 1)"),
    ("scene = [{ integrating_sphere = { light_fraction = 1.0 } }]", "1.0", "lies inside (0, 1)"),
    ("scene = [{ cornell_box = { resolution = 0 } }]", "0", "a resolution lies in 1 to 4096 pixels"),
    ("scene = [{ cornell_box = { resolution = -1 } }]", "-1", "a resolution lies in 1 to 4096 pixels"),
    ("scene = [{ cornell_box = { resolution = 5000 } }]", "5000", "a resolution lies in 1 to 4096 pixels"),
    ("roulette = [{ constant = { q = 0 } }]", "0", "a finite number above 0"),
    ("roulette = [{ constant = { q = -1 } }]", "-1", "a finite number above 0"),
    ("roulette = [{ constant = { q = nan } }]", "nan", "a finite number above 0"),
    ("roulette = [{ constant = { q = [0.5, inf] } }]", "[0.5, inf]", "inf is out of range: q is"),
    ("roulette = [{ constant = { q = 0.5, from = -1 } }]", "-1", "0 to 1000"),
    ("roulette = [{ throughput = { floor = 0 } }]", "0", "it lies in (0, 1]"),
    ("roulette = [{ depth_clamp = { bounces = 2.5 } }]", "2.5", "a whole number from 0 to 1000"),
    ("roulette = [{ depth_clamp = { bounces = -1 } }]", "-1", "a whole number from 0 to 1000"),
    ("estimator = [{ recursive = { samples = 0, depth = 2 } }]", "0", "a whole number from 1 to 1000"),
    ("estimator = [{ recursive = { samples = 2, depth = nan } }]", "nan", "a whole number from 0 to 1000"),
    ("claim = [{ unbiased = { alpha = 0.0, margin = 0.1 } }]", "0.0", "it lies inside (0, 1)"),
    ("claim = [{ unbiased = { alpha = 0.1, margin = 1.0 } }]", "1.0", "it lies inside (0, 1)"),
    ("claim = [{ variance = { alpha = nan, margin = 0.1 } }]", "nan", "it lies inside (0, 1)"),
    ("claim = [{ tiles = { alpha = 0.1, margin = inf } }]", "inf", "it lies inside (0, 1)"),
    ("claim = [{ cost = { alpha = 1.5, margin = 0.1 } }]", "1.5", "it lies inside (0, 1)"),
    (
        "claim = [{ agree = { estimator = \"a\", roulette = \"b\", alpha = 0.1, margin = -1 } }]",
        "-1",
        "it lies inside (0, 1)",
    ),
];

const COMBINATIONS: [Case; 20] = [
    (
        "scene = [{ furnace = {}, furnace_box = {} }]",
        "{ furnace = {}, furnace_box = {} }",
        "`furnace_box` is another; give it a table of its own",
    ),
    (
        "claim = [{ cost = { alpha = 0.1, margin = 0.1, scene = \"kitchen\" } }]",
        "\"kitchen\"",
        "a claim names the scene `kitchen`; there are: furnace",
    ),
    (
        "claim = [{ agree = { estimator = \"implicit\", roulette = \"none\", alpha = 0.1, margin = 0.1 } }]",
        "\"none\"",
        "agree names `implicit` with `none`; there are: `implicit` with `albedo`",
    ),
    (
        "plot = [{ over = { parameter = \"q\", show = [\"bias\"] } }]",
        "\"q\"",
        "a plot goes over `q`, which is not swept",
    ),
    ("scene = []", "[]", "an empty list of scenes leaves nothing to run; give at least one"),
    ("estimator = []", "[]", "an empty list of estimators leaves nothing to run; give at least one"),
    ("roulette = []", "[]", "an empty list of termination rules leaves nothing to run; give at least one"),
    (
        "roulette = [{ constant = { q = [] } }]",
        "[]",
        "an empty list leaves nothing to run; give at least one number",
    ),
    ("scene = [{ furnace = { albedo = 1 } }]", "{ furnace = { albedo = 1 } }", "the albedo must be below 1"),
    ("scene = [{ furnace_box = { albedo = 1 } }]", "{ furnace_box = { albedo = 1 } }", "infinite radiance"),
    (
        "scene = [{ integrating_sphere = { light_albedo = 1, wall_albedo = 1, light_fraction = 0.5 } }]",
        "{ integrating_sphere = { light_albedo = 1, wall_albedo = 1, light_fraction = 0.5 } }",
        "infinite radiance",
    ),
    (
        "scene = [{ integrating_sphere = { light_fraction = 0.5, patches = [{ fraction = 0.5, albedo = 0.1 }] } }]",
        "{ integrating_sphere = { light_fraction = 0.5, patches = [{ fraction = 0.5, albedo = 0.1 }] } }",
        "cover 1 of the sphere; leave some for the wall",
    ),
    ("roulette = [\"none\"]", "\"none\"", "use depth_clamp = { bounces = 16 }"),
    (
        "roulette = [{ constant = { q = 1 } }]",
        "{ constant = { q = 1 } }",
        "cannot end; use q < 1 or add clamp",
    ),
    (
        "roulette = [{ constant = { q = 1.5 } }]",
        "{ constant = { q = 1.5 } }",
        "cannot end; use q < 1 or add clamp",
    ),
    ("roulette = [{ throughput = { floor = 1 } }]", "{ throughput = { floor = 1 } }", "use a constant q < 1"),
    ("seed = 2\nseed = 3", "seed", "duplicate key"),
    ("question = \"no end", "", "invalid basic string, expected `\"`"),
    ("estimator = [{ recursive = { samples = 2 } }]", "", "missing field `depth`"),
    ("claim = [{ unbiased = { alpha = 0.1 } }]", "", "missing field `margin`"),
];

/// All cases of a table, and what does not hold.
fn refused(cases: &[Case]) {
    let place = tempfile::tempdir().unwrap();
    let older = older_result(place.path());
    let wrong: Vec<String> = cases.iter().filter_map(|case| complaint(place.path(), case)).collect();
    assert!(wrong.is_empty(), "{} of {} cases:\n\n{}", wrong.len(), cases.len(), wrong.join("\n\n"));
    assert_eq!(contents(&place.path().join("reports")), older, "an older result was touched");
}

/// What a run of one case lacks, if anything.
fn complaint(place: &Path, &(line, at, why): &Case) -> Option<String> {
    let key = line.split_inclusive(" =").next().unwrap();
    // an unknown key takes the seed's line
    let replaced = GOOD.lines().position(|l| l.starts_with(key)).unwrap_or(1);
    let text: String = GOOD
        .lines()
        .enumerate()
        .map(|(i, good)| if i == replaced { format!("{line}\n") } else { format!("{good}\n") })
        .collect();
    fs::write(place.join("experiments/x.toml"), &text).unwrap();
    let output = Command::new(cargo_bin!("experiment")).arg("x").current_dir(place).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    // the last of several lines is the wrong one
    let (number, last) = (replaced + line.lines().count(), line.lines().last().unwrap());
    // where the place is a table that lacks something, any column of the line will do
    let column = if at.is_empty() { String::new() } else { (column(last, at) + 1).to_string() };
    let holds = output.status.code() == Some(2)
        && output.stdout.is_empty()
        && stderr.starts_with("error: ")
        && stderr.matches("error:").count() == 1
        && stderr.contains(why)
        && stderr.contains(&format!("--> experiments/x.toml:{number}:{column}"))
        && stderr.contains(&format!("{number} | {last}\n"))
        && stderr.trim_end().ends_with(&"^".repeat(at.chars().count().max(1)));
    (!holds).then(|| format!("{line}\nshould say `{why}` at `{at}` but {}:\n{stderr}", output.status))
}

/// Where `at` stands in a line: the last time, because keys come before values.
fn column(line: &str, at: &str) -> usize {
    line.rfind(at).unwrap()
}

/// The folders of an experiment `x` that has run before.
fn older_result(place: &Path) -> Vec<(String, Vec<u8>)> {
    fs::create_dir(place.join("experiments")).unwrap();
    fs::create_dir_all(place.join("reports/x")).unwrap();
    for file in ["cells.json", "results.csv"] {
        fs::write(place.join("reports/x").join(file), "older").unwrap();
    }
    contents(&place.join("reports"))
}

/// Every file below a folder, with its bytes.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(contents(&path));
        } else {
            all.push((path.display().to_string(), fs::read(&path).unwrap()));
        }
    }
    all.sort();
    all
}

#[test]
fn the_good_file_runs() {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), GOOD).unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(["plan", "x"]).current_dir(place.path()).assert().success().stderr("");
}

#[test]
fn mistakes_are_only_for_those_who_ask() {
    refused(&FAULTS);
}

#[test]
fn unknown_keys_and_wrong_types_are_refused() {
    refused(&KEYS_AND_TYPES);
}

#[test]
fn numbers_out_of_range_are_refused() {
    refused(&NUMBERS);
}

#[test]
fn what_cannot_end_or_leaves_nothing_to_run_is_refused() {
    refused(&COMBINATIONS);
}
