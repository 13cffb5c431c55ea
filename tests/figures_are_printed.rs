//! Promise: `experiment figure` draws what is stored as SVG and PDF of exactly the width that is asked for, with text of the
//! size that is asked for and selectable; writes its numbers as CSV and the verdicts as a LaTeX table, in which names stay
//! text; samples nothing, and gives the same bytes each time.

use assert_cmd::{Command, cargo::cargo_bin};
use flate2::read::ZlibDecoder;
use furnace::report::figure::{
    self, Axis, Colour, Column, Figure, Mark, Marker, Panel, Point, Region, Series, Style,
};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

const FILE: &str = r#"question = 'Does 50% & #1_$ of \input{x} stay ~text^?'
samples = 4096
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
plot = [{ bias = {} }, { over = { parameter = "q", show = ["variance", "cost", "efficiency"], series = "channel" } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.3], emission = 1.0 } }]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.7, 0.8, 0.9] } }, { depth_clamp = { bounces = 1 } }]
[[grid]]
estimator = ["explicit"]
roulette = ["albedo"]
[[grid.scene]]
primitives.name = '50% & #1_$ \input{x} ^~ --'
primitives.primitives = [{ shape = { sphere = { center = [0, 0, 0], radius = 1, inward = true } }, albedo = 0.5, emission = 1 }]
primitives.sensor = { probe = { origin = [0, 0, 0], direction = [0, 0, 1] } }
"#;

fn place() -> TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::create_dir(place.path().join("experiments")).unwrap();
    fs::write(place.path().join("experiments/x.toml"), FILE).unwrap();
    place
}

fn run(place: &TempDir, args: &[&str]) -> Output {
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(args).current_dir(place.path()).output().unwrap()
}

#[track_caller]
fn experiment(place: &TempDir, args: &[&str]) -> String {
    let output = run(place, args);
    assert!(output.status.code() < Some(2), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A place with a finished run.
fn finished() -> TempDir {
    let place = place();
    experiment(&place, &["x", "--quiet"]);
    place
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    entries.map(|path| (name(&path), fs::read(&path).unwrap())).collect()
}

/// The number that follows `before` in `text`.
#[track_caller]
fn number_after(text: &str, before: &str) -> f64 {
    let start = text.find(before).unwrap_or_else(|| panic!("no {before}")) + before.len();
    let rest = &text[start..];
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap();
    rest[..end].parse().unwrap()
}

/// Width and height of a PDF's page in points.
fn media_box(pdf: &[u8]) -> (f64, f64) {
    let text = String::from_utf8_lossy(pdf);
    let numbers = text.split("/MediaBox").nth(1).unwrap().split(['[', ']']).nth(1).unwrap();
    let numbers: Vec<f64> = numbers.split_whitespace().map(|n| n.parse().unwrap()).collect();
    assert_eq!(numbers[..2], [0.0, 0.0]);
    (numbers[2], numbers[3])
}

/// The streams of a PDF, unpacked.
fn streams(pdf: &[u8]) -> Vec<String> {
    let starts = pdf.windows(7).enumerate().filter(|(_, w)| *w == b"stream\n").map(|(i, _)| i + 7);
    let unpack = |start: usize| {
        let mut text = Vec::new();
        ZlibDecoder::new(&pdf[start..]).read_to_end(&mut text).ok()?;
        Some(String::from_utf8_lossy(&text).into_owned())
    };
    starts.filter_map(unpack).collect()
}

#[test]
fn figures_are_as_wide_as_the_column() {
    let place = finished();
    let cases = [("84mm", 84.0), ("241pt", 241.0 / 72.27 * 25.4), ("3.33in", 3.33 * 25.4), ("177mm", 177.0)];
    let mut heights = Vec::new();
    for (width, millimetres) in cases {
        experiment(&place, &["figure", "x", "--width", width, "-o", "out"]);
        let files = files(&place.path().join("out"));
        let names = ["bias", "furnace_implicit_constant_variance_cost_efficiency_over_q_by_channel"];
        for name in names {
            let svg = String::from_utf8(files[&format!("{name}.svg")].clone()).unwrap();
            assert!((number_after(&svg, "width=\"") - millimetres).abs() < 1e-9, "{width}");
            assert!(svg.contains("mm\" height=\"") && svg.contains("font/woff2;base64,"));
            let across = number_after(&svg, "viewBox=\"0 0 ");
            let down = number_after(&svg, &format!("viewBox=\"0 0 {across} "));
            let height = number_after(&svg, "mm\" height=\"");
            assert!((height / millimetres - down / across).abs() < 1e-9);
            let pdf = media_box(&files[&format!("{name}.pdf")]);
            assert!((pdf.0 - millimetres * 72.0 / 25.4).abs() < 1e-3, "{width}: {pdf:?}");
            assert!((pdf.1 - height * 72.0 / 25.4).abs() < 1e-3, "{width}: {pdf:?}");
            heights.push(height);
        }
    }
    // three panels below one another in a narrow column, beside one another on a page
    assert!(heights[1] > 2.0 * heights[7], "{heights:?}");
}

#[test]
fn text_has_the_size_that_is_asked_for_and_stays_text() {
    let place = finished();
    for (size, points) in [("8pt", 8.0 * 72.0 / 72.27), ("10bp", 10.0)] {
        experiment(&place, &["figure", "x", "--figure", "variance", "--font-size", size, "-o", size]);
        let folder = place.path().join(size);
        let written = files(&folder);
        let name = "furnace_implicit_constant_variance_cost_efficiency_over_q_by_channel";
        let svg = String::from_utf8(written[&format!("{name}.svg")].clone()).unwrap();
        let unit = 84.0 / 25.4 * 72.0 / number_after(&svg, "viewBox=\"0 0 ");
        let texts = svg.split("<text ").skip(1);
        // plotters sets its text of size n with n / 1.24 to the em
        let sizes: Vec<f64> = texts.map(|text| number_after(text, "font-size=\"") * unit).collect();
        assert!(
            sizes.len() > 20 && sizes.iter().all(|s| (s / points - 1.0).abs() < 0.01),
            "{size}: {sizes:?}"
        );
        let pdf = &written[&format!("{name}.pdf")];
        let streams = streams(pdf);
        let text: Vec<&String> = streams.iter().filter(|stream| stream.contains("BT\n")).collect();
        assert_eq!(text.len(), 1, "one page");
        let raw = String::from_utf8_lossy(pdf);
        assert!(raw.contains("/ToUnicode") && raw.contains("/FontFile") && raw.contains("FurnaceSans"));
        // the table that makes letters of glyphs knows those of the labels
        let letters = raw.split("beginbfchar").nth(1).unwrap().split("endbfchar").next().unwrap();
        for letter in "Varince q".chars().filter(|letter| *letter != ' ') {
            assert!(letters.contains(&format!("<{:04X}>", letter as u32)), "no {letter}");
        }
        assert!(!raw.contains("/CreationDate") && !raw.contains("/Subtype /Image"));
        assert!(!written.contains_key("bias.pdf"), "only what was asked for");
    }
}

#[test]
fn the_same_bytes_each_time_and_nothing_is_sampled() {
    let place = finished();
    let reports = files(&place.path().join("reports/x"));
    let said = experiment(&place, &["figure", "x"]);
    assert!(said.contains("bias: 84.0 × ") && said.contains("x.tex: the verdicts"), "{said}");
    let first = files(&place.path().join("figures/x"));
    // a day's work, were it sampled
    let longer = FILE.replace("samples = 4096", "samples = 4_000_000_000");
    fs::write(place.path().join("experiments/x.toml"), longer).unwrap();
    experiment(&place, &["figure", "x", "-o", "again"]);
    assert!(files(&place.path().join("again")) == first);
    assert!(files(&place.path().join("reports/x")) == reports);
    let said = experiment(&place, &["figure", "x", "-o", "again", "--format", "json"]);
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(said["figures"].as_array().unwrap().len(), 2);
    assert_eq!(said["figures"][0]["width_mm"], 84.0);
}

#[test]
fn the_numbers_of_a_figure_are_those_of_the_results() {
    let place = finished();
    experiment(&place, &["figure", "x"]);
    let name = "furnace_implicit_constant_variance_cost_efficiency_over_q_by_channel.csv";
    let here = fs::read(place.path().join("figures/x").join(name)).unwrap();
    assert!(here == fs::read(place.path().join("reports/x").join(name)).unwrap());
    let mut reader = csv::Reader::from_reader(&here[..]);
    assert_eq!(reader.headers().unwrap(), vec!["panel", "kind", "series", "x", "y", "low", "high"]);
    let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let point = |panel: &str, series: &str, x: &str| {
        let is = |r: &&csv::StringRecord| {
            r[0] == *panel && r[1] == *"points" && r[2].starts_with(series) && r[3] == *x
        };
        records.iter().find(is).unwrap_or_else(|| panic!("no {panel} {series} at {x}"))
    };
    let mut results = csv::Reader::from_path(place.path().join("reports/x/results.csv")).unwrap();
    let header = results.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let (mut seen, mut with_bars) = (0, 0);
    for row in results.records().map(Result::unwrap) {
        let of = |name: &str| row[column(name)].to_owned();
        if of("scene") != "furnace"
            || of("estimand") != "mean"
            || of("q").is_empty()
            || of("variance").is_empty()
        {
            continue;
        }
        let shown = point("Variance", &of("channel"), &of("q"));
        let [y, right]: [f64; 2] = [&shown[4], &of("variance")].map(|n| n.parse().unwrap());
        assert!((y / right - 1.0).abs() < 1e-8);
        // no error of the variance is known where theory has an infinite fourth moment
        if !shown[5].is_empty() {
            let [low, high]: [f64; 2] = [&shown[5], &shown[6]].map(|n| n.parse().unwrap());
            assert!(low < y && y < high);
            with_bars += 1;
        }
        seen += 1;
    }
    assert_eq!(seen, 9);
    assert!(with_bars >= 6, "{with_bars}");
    assert!(records.iter().any(|r| r[1] == *"curve"), "no theory");
}

#[test]
fn names_stay_text_in_latex() {
    let place = finished();
    experiment(&place, &["figure", "x"]);
    let tex = fs::read_to_string(place.path().join("figures/x/x.tex")).unwrap();
    let scene = r"\emph{50\% \& \#1\_\$ \textbackslash{}input\{x\} \textasciicircum{}\textasciitilde{} -{}-}";
    assert!(tex.contains(scene), "{tex}");
    assert!(tex.contains(r"\caption{Does 50\% \& \#1\_\$ of \textbackslash{}input\{x\} stay \textasciitilde{}text\textasciicircum{}?"));
    assert!(tex.contains(r"at most $0.001$."), "{tex}");
    assert!(tex.contains(r"\label{tab:x}") && !tex.contains(r"\input"));
    for (begin, end) in [("\\begin{table*}", "\\end{table*}"), ("\\begin{tabular}", "\\end{tabular}")] {
        assert_eq!((tex.matches(begin).count(), tex.matches(end).count()), (1, 1));
    }
    for rule in ["\\toprule", "\\bottomrule"] {
        assert_eq!(tex.matches(rule).count(), 1);
    }
    // eight columns in each row, one row a cell
    let unescaped =
        |line: &str, c: char| line.match_indices(c).filter(|(i, _)| !line[..*i].ends_with('\\')).count();
    let rows: Vec<&str> = tex.lines().filter(|line| line.ends_with("\\\\") && line.contains(" & ")).collect();
    assert_eq!(rows.len(), 1 + 5);
    for row in &rows {
        assert_eq!(unescaped(row, '&'), 7, "{row}");
        assert!(unescaped(row, '$').is_multiple_of(2), "{row}");
    }
    let clamped = rows.iter().find(|row| row.contains("depth") || row.contains("clamp")).unwrap();
    assert!(clamped.contains("$^\\ast$") && clamped.contains("$-"), "{clamped}");
    assert!(tex.contains("judged against the bias that theory predicts"));
    let depth = tex.chars().fold((0_i32, ' '), |(depth, before), c| match c {
        '{' if before != '\\' => (depth + 1, c),
        '}' if before != '\\' => (depth - 1, c),
        _ => (depth, c),
    });
    assert_eq!(depth.0, 0, "braces");
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let place = place();
    let refuses = |args: &[&str], words: &[&str]| {
        let output = run(&place, args);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
        assert_eq!(stderr.matches("error:").count(), 1, "{args:?}: {stderr}");
        words
            .iter()
            .for_each(|word| assert!(stderr.contains(word), "{args:?} should say `{word}`: {stderr}"));
        assert!(!place.path().join("figures").exists(), "{args:?} wrote something");
    };
    refuses(&["figure", "x"], &["cannot read reports/x/cells.json"]);
    experiment(&place, &["x", "--quiet", "--samples", "64"]);
    for width in ["84", "wide", "84px", "mm"] {
        refuses(&["figure", "x", "--width", width], &["a length is a number with its unit, such as 84mm"]);
    }
    for width in ["0mm", "-3mm", "infmm", "nanmm"] {
        refuses(&["figure", "x", &format!("--width={width}")], &["it must be positive"]);
    }
    refuses(
        &["figure", "x", "--width", "10mm"],
        &["--width is 10.00 mm; with text of 2.81 mm it lies between 42.2 and"],
    );
    refuses(
        &["figure", "x", "--font-size", "2cm", "--width", "90cm", "--figure", "nothing"],
        &["no figure of x has `nothing`", "\n  bias"],
    );
    refuses(
        &["figure", "x", "--font-size", "0.5mm"],
        &["--font-size is 0.50 mm; it lies between 1 and 20 mm"],
    );
    refuses(&["figure", "y"], &["no experiment called `y`"]);
}

/// Another digest is another file for everyone who keeps them under version control: a change of this must be meant.
#[test]
fn the_bytes_are_pinned() {
    let points = vec![Point::between(0.0, 0.5, 0.25, 1.0), Point::new(0.5, 0.75), Point::new(1.0, f64::NAN)];
    let series =
        |style, colour| Series { label: "⟨data⟩".to_owned(), colour, style, points: points.clone() };
    let panel = Panel {
        title: "title".to_owned(),
        x: Axis::linear("x  [m]"),
        y: Axis::linear("y  [(W m⁻² sr⁻¹)²]"),
        regions: vec![Region { from: 0.25, to: 0.5, label: "region".to_owned(), colour: Colour::Green }],
        marks: vec![Mark::Horizontal { at: 0.5, label: "mark".to_owned(), colour: Colour::Black }],
        series: vec![
            series(Style::Dashed, Colour::Blue),
            series(Style::Markers(Marker::Circle), Colour::Orange),
        ],
        lying: false,
    };
    let figure = Figure { title: "A figure".to_owned(), alt: String::new(), panels: vec![panel], columns: 1 };
    let printed = figure::print(&figure, Column { width: 84.0, font: 3.0 }).unwrap();
    let digest =
        |bytes: &[u8]| Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let digests = [digest(printed.svg.as_bytes()), digest(&printed.pdf), digest(&figure::csv(&figure))];
    assert_eq!(
        digests.each_ref().map(|d| &d[..16]),
        ["bd15886d75fe071d", "77a0b25095acdc30", "ea7758f20dc54c12"]
    );
}
