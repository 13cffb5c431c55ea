//! Promise: of a cell that fails, the report names the first wrong bounce, the channels, the tiles with their sign, the
//! technique and the instruments, and the command with which it is shown again bit for bit; of cells that do not fail it
//! names nothing. Mistakes that were tried are told from those that were made unknowingly.

use assert_cmd::{Command, cargo::cargo_bin};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The sphere of one wall: bounce k adds rho^k, so a limit of eight bounces is wrong from the ninth on.
const FURNACE: &str = r#"question = "Is each mistake found, and where?"
faults = true
samples = 32_768
max_samples = 1_048_576
claim = [
  { unbiased = { alpha = 1e-3, margin = 0.02 } },
  { length = { alpha = 1e-3 } },
  { independent = { alpha = 1e-3 } },
]
[grid]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }]
estimator = [
  "implicit",
  { fault = { name = "emission_counted_twice", of = "implicit" } },
  { fault = { name = ["emission_counted_twice", "survivors_not_weighted", "hidden_depth_limit", "blocks_share_a_seed"], of = "explicit" } },
]
roulette = [{ constant = { q = 0.8 } }]
"#;

const BOX: &str = r#"question = "Which tiles are wrong?"
faults = true
samples = 200
claim = [
  { unbiased = { alpha = 1e-3, margin = 0.1 } },
  { tiles = { alpha = 1e-3, margin = 0.2 } },
]
[grid]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["explicit", { fault = { name = ["light_without_cosine", "emission_never_added"], of = "explicit" } }]
roulette = ["throughput"]
"#;

fn place(text: &str) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), text).unwrap();
    place
}

/// Runs `experiment ARGS` and gives its standard output.
#[track_caller]
fn experiment(place: &TempDir, args: &[&str]) -> String {
    let mut command = Command::new(cargo_bin!("experiment"));
    let output = command.args(args).args(["--quiet"]).current_dir(place.path()).output().unwrap();
    assert!(output.status.code() < Some(2), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// What the terminal says of a cell, line by line; nothing if it names no such cell.
fn of_cell(stdout: &str, label: &str) -> Vec<String> {
    let from = stdout.lines().skip_while(|line| *line != format!("  {label}"));
    from.skip(1).take_while(|line| line.starts_with("    ")).map(|line| line.trim().to_owned()).collect()
}

#[track_caller]
fn says(lines: &[String], words: &[&str]) {
    for word in words {
        assert!(lines.iter().any(|line| line.contains(word)), "no `{word}` in {lines:#?}");
    }
}

#[test]
fn the_first_wrong_bounce_and_what_else_fails_are_named() {
    let place = place(FURNACE);
    let stdout = experiment(&place, &["x"]);
    let told = |name: &str| of_cell(&stdout, &format!("furnace {name} (explicit) constant(q=0.8)"));
    // sampled light, and the same light hit: bounce 1 is twice 0.8
    let twice = told("emission_counted_twice");
    says(
        &twice,
        &[
            "First wrong bounce: 1, too bright in R, G and B",
            "Before it: 0 shown to be right within the margin.",
        ],
    );
    says(&twice, &["R by +0.", "where 0.800 is right", "Channels of the mean: R, G and B wrong"]);
    says(
        &told("survivors_not_weighted"),
        &["First wrong bounce: 2, too dark in R", "Before it: 0, 1 shown to be right within the margin."],
    );
    let hidden = told("hidden_depth_limit");
    says(
        &hidden,
        &["First wrong bounce: 8+, too dark in R", "Before it: 0 to 7 shown to be right within the margin."],
    );
    says(&hidden, &["Channels of the mean: R wrong", "paths do not end with the probabilities"]);
    says(&told("blocks_share_a_seed"), &["each block depends on the one before in R"]);
    // the mistake needs sampled lights: where none are sampled, all is well
    says(
        &twice,
        &[
            "(explicit) is wrong; emission_counted_twice (implicit) is right. The mistake is where lights are sampled.",
        ],
    );
}

#[test]
fn nothing_is_localised_where_nothing_fails() {
    let place = place(FURNACE);
    let stdout = experiment(&place, &["x"]);
    let page = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
    assert_eq!(page.matches("class=\"place\"").count(), 4);
    for estimator in ["implicit", "emission_counted_twice (implicit)"] {
        let label = format!("furnace {estimator} constant(q=0.8)");
        assert!(of_cell(&stdout, &label).is_empty());
        let is_listed = page.contains(&format!("<td>{estimator}</td>"));
        assert!(is_listed && !page.contains(&format!("<h3>{label}")), "{label}");
    }
    let sound = FURNACE.split("  { fault").next().unwrap().to_owned() + "]\nroulette = [\"albedo\"]\n";
    fs::write(place.path().join("experiments/x.toml"), sound).unwrap();
    let stdout = experiment(&place, &["x"]);
    let page = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
    for text in [&stdout, &page] {
        assert!(text.contains("PASS"), "{text}");
        assert!(!text.contains("Where is it wrong") && !text.contains("Where it is wrong"), "{text}");
        assert!(!text.contains("--only") && !text.contains("Mistakes"));
    }
}

/// The maps of a cell on the page: channel by channel, row by row, number and whether it is framed.
fn maps(page: &str, label: &str) -> Vec<(f64, bool)> {
    let section =
        page.split("class=\"place\"").find(|part| part.contains(&format!("<h3>{label}</h3>"))).unwrap();
    let map = section.split("class=\"tiles\"").nth(1).unwrap().split("<figcaption>").next().unwrap();
    let cells = map.split("<td").skip(1).map(|cell| {
        let text = cell.split('>').nth(1).unwrap().split('<').next().unwrap();
        (text.parse().unwrap(), cell.starts_with(" class=\"wrong\""))
    });
    cells.collect()
}

#[test]
fn tiles_have_the_sign_of_their_mistake() {
    let place = place(BOX);
    let stdout = experiment(&place, &["x"]);
    let page = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
    let bright = maps(&page, "cornell_box light_without_cosine (explicit) throughput");
    assert_eq!(bright.len(), 48);
    let framed: Vec<f64> = bright.iter().filter(|tile| tile.1).map(|tile| tile.0).collect();
    assert!(framed.len() > 30 && framed.iter().all(|z| *z > 0.0), "{bright:?}");
    // the lamp, which the camera sees in the upper middle, is missing, and nothing else
    let dark = maps(&page, "cornell_box emission_never_added (explicit) throughput");
    let framed: Vec<usize> = (0..48).filter(|&i| dark[i].1).collect();
    assert!(framed.iter().all(|&i| dark[i].0 < 0.0 && i % 16 < 8), "{dark:?}");
    assert!((3..=12).contains(&framed.len()), "{framed:?}");
    let told = of_cell(&stdout, "cornell_box emission_never_added (explicit) throughput");
    says(&told, &["Wrong tiles. R: ", "too dark of 16", "in row 1", "--only"]);
    assert!(!told.iter().any(|line| line.contains("too bright")), "{told:?}");
    assert!(of_cell(&stdout, "cornell_box explicit throughput").is_empty());
}

/// Rows of `results.csv` by label, without what follows from how many questions are asked.
fn numbers(folder: &Path) -> BTreeMap<String, Vec<String>> {
    let mut reader = csv::Reader::from_path(folder.join("results.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|h| h == name).unwrap();
    let mut cells: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for row in reader.records().map(Result::unwrap) {
        let measured = [
            "estimand",
            "bounce",
            "channel",
            "samples",
            "mean",
            "std_error",
            "variance",
            "guard",
            "efficiency",
        ];
        let text = measured.map(|name| row[at(name)].to_owned()).join(",");
        cells.entry(format!("{} {} {}", &row[1], &row[2], &row[3])).or_default().push(text);
    }
    cells
}

/// Each command of the page gives its cell the same numbers, whatever options the run had, and touches no other report.
#[test]
fn the_command_brings_back_the_same_bits() {
    for (text, options) in [(FURNACE, &["--seed", "7"][..]), (FURNACE, &["--samples", "19135"]), (BOX, &[])] {
        let place = place(text);
        let stdout = experiment(&place, &[&["x"], options].concat());
        let folder = place.path().join("reports/x");
        let (before, page) = (numbers(&folder), fs::read(folder.join("index.html")).unwrap());
        let commands: Vec<&str> =
            stdout.lines().filter_map(|line| line.trim().strip_prefix("Again: ")).collect();
        assert!(commands.len() > 1, "{stdout}");
        for command in commands {
            let rest = command.strip_prefix("cargo run --bin experiment -- ").unwrap();
            let line = format!("'{}' {rest} --quiet", cargo_bin!("experiment").display());
            let output = Command::new("bash").args(["-c", &line]).current_dir(place.path()).output().unwrap();
            // a mistake may be caught and yet not be shown to be as large as theory says
            assert!(output.status.code() < Some(2), "{line}: {}", String::from_utf8_lossy(&output.stderr));
            let after = numbers(&place.path().join("reports/replay/x"));
            assert_eq!(after.len(), 1, "{command}");
            for (cell, rows) in &after {
                assert_eq!(before.get(cell), Some(rows), "{command}");
            }
        }
        assert!(fs::read(folder.join("index.html")).unwrap() == page, "the report was overwritten");
    }
}

#[test]
fn one_cell_alone_is_chosen_by_its_whole_name() {
    let place = place(FURNACE);
    let label = "furnace emission_counted_twice (explicit) constant(q=0.8)";
    let stdout = experiment(&place, &["plan", "x", "--only", label]);
    assert!(stdout.contains(label) && stdout.contains("1 cells"), "{stdout}");
    let refuses = |args: &[&str], words: &[&str]| {
        let output =
            Command::new(cargo_bin!("experiment")).args(args).current_dir(place.path()).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        words.iter().for_each(|word| assert!(stderr.contains(word), "no `{word}`: {stderr}"));
    };
    // part of a name is none
    refuses(
        &["x", "--only", "furnace"],
        &["no cell of x is called `furnace`; there are:", "\n  furnace implicit constant(q=0.8)\n", label],
    );
    refuses(&["x", "--only", label, "--filter", "a"], &["--filter"]);
}

#[test]
fn mistakes_are_told_apart_from_sound_estimators() {
    let place = place(FURNACE);
    let stdout = experiment(&place, &["x"]);
    for sentence in
        ["4 of 4 mistakes were caught", "1 of 1 cells whose mistake changes nothing raised no alarm"]
    {
        assert!(stdout.contains(sentence), "no `{sentence}` in {stdout}");
    }
    // of two estimators of which one is wrong, none is the better one
    assert!(!stdout.contains("most efficient") && !stdout.contains("times as efficient"), "{stdout}");
    let folder = place.path().join("reports/x");
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    let mistakes = page.split("<h2>Mistakes</h2>").nth(1).unwrap().split("</section>").next().unwrap();
    // emission counted twice: 1 + 2 rho / (1 - rho) = 9
    for words in [
        "emission_counted_twice",
        "M5, A-4",
        "slide &quot;Split the Integral&quot;",
        "R 9.000000, measured ",
        "caught: mean R, after ",
    ] {
        assert!(mistakes.contains(words), "no `{words}` in {mistakes}");
    }
    assert!(
        stdout.contains("Error budget: any false alarm in this run has a probability of at most 0.003."),
        "{stdout}"
    );
    // a report is made of what is stored, all of this included
    experiment(&place, &["report", "x"]);
    assert!(fs::read_to_string(folder.join("index.html")).unwrap() == page);
}

#[test]
fn hostile_names_stay_text_and_can_be_typed_again() {
    for name in ["<script>alert(1)</script>", "it's $HOME `id` \"x\"", "two\nlines", "-x"] {
        let quoted = serde_json::to_string(name).unwrap();
        // a scene of one's own has no truth, but it has blocks that repeat
        let text = format!(
            "question = {quoted}\nfaults = true\nsamples = 8192\nclaim = [{{ independent = {{ alpha = 1e-3 }} }}]\n\
             [grid]\nestimator = [{{ fault = {{ name = \"blocks_share_a_seed\", of = \"explicit\" }} }}]\n\
             roulette = [\"albedo\"]\n[[grid.scene]]\nprimitives.name = {quoted}\n\
             primitives.primitives = [{{ shape = {{ sphere = {{ center = [0, 0, 0], radius = 1, inward = true }} }}, \
             albedo = 0.5, emission = 1 }}]\nprimitives.sensor = {{ camera = {{ origin = [0, 0, 0], \
             direction = [0, 0, 1], up = [0, 1, 0], fov = 40, resolution = 4 }} }}\n"
        );
        let place = place(&text);
        let stdout = experiment(&place, &["x"]);
        let page = fs::read_to_string(place.path().join("reports/x/index.html")).unwrap();
        assert!(stdout.contains("blocks repeat an earlier one, bit for bit"), "{stdout}");
        assert!(!page.contains("<script>alert") && page.contains("class=\"place\""), "{name}");
        let again =
            stdout.split("Again: cargo run --bin experiment -- ").nth(1).unwrap().lines().next().unwrap();
        let line = format!("'{}' {again} --quiet", cargo_bin!("experiment").display());
        let output = Command::new("bash").args(["-c", &line]).current_dir(place.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        let cell = |folder: &str| numbers(&place.path().join(folder));
        assert_eq!(cell("reports/x"), cell("reports/replay/x"), "{name}");
    }
}
