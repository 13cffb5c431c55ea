//! Promise: what is wrong in a `[[null]]` table is refused before anything is sampled, where it stands and with what
//! would be right.

use furnace::experiment::spec::{self, Spec};
use furnace::experiment::{Error, error::Place};
use furnace::stats::nulls::{Instrument, NullRow};
use std::path::Path;
use std::sync::atomic::AtomicBool;

const GOOD: &str = r#"question = "How often are the instruments wrong?"
samples = 64
[grid]
scene = ["furnace"]
estimator = ["implicit"]
roulette = ["albedo"]
[[null]]
law = { walk = { albedo = 0.5, q = 0.2 } }
samples = 2048
runs = 20000
level = [0.05, 1e-3]
bias = 0.1
"#;

/// A line that takes the place of the null's with the same key, the text that is pointed at, and words of the message.
type Case = (&'static str, &'static str, &'static str);

const CASES: [Case; 36] = [
    ("law = { rare = { p = 0 } }", "0", "0 is out of range: the probability of a rare event lies in (0, 1]"),
    ("law = { rare = { p = -0.5 } }", "-0.5", "lies in (0, 1]"),
    ("law = { rare = { p = 1.5 } }", "1.5", "lies in (0, 1]"),
    ("law = { rare = { p = nan } }", "nan", "lies in (0, 1]"),
    ("law = { rare = { q = 0.5 } }", "q", "unexpected keys in table: q, available keys: p"),
    ("law = { rare = {} }", "{}", "missing field `p`"),
    ("law = { lognormal = { sigma = 0 } }", "0", "sigma lies in (0, 3]"),
    ("law = { lognormal = { sigma = 3.5 } }", "3.5", "sigma lies in (0, 3]"),
    ("law = { lognormal = { sigma = inf } }", "inf", "sigma lies in (0, 3]"),
    ("law = { lognormal = { sigma = nan } }", "nan", "sigma lies in (0, 3]"),
    ("law = { walk = { albedo = 1, q = 0.5 } }", "1", "lies in [0, 1); at 1 its mean is infinite"),
    ("law = { walk = { albedo = -0.1, q = 0.5 } }", "-0.1", "the albedo of a walk lies in [0, 1)"),
    ("law = { walk = { albedo = nan, q = 0.5 } }", "nan", "the albedo of a walk lies in [0, 1)"),
    ("law = { walk = { albedo = 0.5, q = 0 } }", "0", "with a probability q inside (0, 1)"),
    ("law = { walk = { albedo = 0.5, q = 1.0 } }", "1.0", "with a probability q inside (0, 1)"),
    ("law = { walk = { albedo = 0.5, q = nan } }", "nan", "with a probability q inside (0, 1)"),
    ("law = { walk = { albedo = 0.5 } }", "{ albedo = 0.5 }", "missing field `q`"),
    ("law = { wlak = { albedo = 0.5, q = 0.5 } }", "wlak", "did you mean `walk`?"),
    (
        "law = { walk = { albdo = 0.5, q = 0.5 } }",
        "albdo",
        "unexpected keys in table: albdo, available keys: albedo, q",
    ),
    ("law = \"cauchy\"", "\"cauchy\"", "expected one of `rare`, `lognormal`, `walk`"),
    ("samples = 0", "0", "a run takes 1 to 10^7 samples"),
    ("samples = -3", "-3", "a run takes 1 to 10^7 samples"),
    ("samples = 10000001", "10000001", "a run takes 1 to 10^7 samples"),
    ("samples = 2.5", "2.5", "invalid type: floating point `2.5`"),
    ("runs = 1", "1", "a rate needs at least 2 runs"),
    ("runs = -1", "-1", "a rate needs at least 2 runs"),
    ("runs = 10000001", "10000001", "at most 10^7"),
    ("level = 0", "0", "0 is out of range: an error probability lies inside (0, 1)"),
    ("level = 1.0", "1.0", "lies inside (0, 1)"),
    ("level = [0.05, nan]", "[0.05, nan]", "NaN is out of range: an error probability"),
    ("level = []", "[]", "an empty list leaves nothing to run"),
    ("level = [0.05, 0.05]", "[0.05, 0.05]", "0.05 is listed twice"),
    ("bias = -1", "-1", "a bias lies above -1 and is 10 at most"),
    ("bias = [0, 11]", "[0, 11]", "a bias lies above -1 and is 10 at most"),
    ("bias = inf", "inf", "a bias lies above -1 and is 10 at most"),
    (
        "seeds = 3",
        "seeds",
        "unknown field `seeds`, expected one of `law`, `samples`, `runs`, `level`, `bias`",
    ),
];

fn read(text: &str) -> Result<Spec, Error> {
    spec::parse(Path::new("x.toml"), text)
}

/// The place at which a file is refused.
fn refused(text: &str) -> Option<Place> {
    match read(text) {
        Err(Error::Input(place)) => Some(place),
        _ => None,
    }
}

#[test]
fn the_good_file_is_read() {
    let null = read(GOOD).unwrap().null.remove(0);
    assert_eq!(
        (null.law.to_string().as_str(), null.samples, null.runs),
        ("walk albedo=0.5 q=0.2", 2048, 20_000)
    );
    assert_eq!((null.level, null.bias), (vec![0.05, 1e-3], vec![0.1]));
    let without = GOOD.replace("bias = 0.1\n", "");
    assert_eq!(read(&without).unwrap().null[0].bias, [0.0]);
    assert!(read(GOOD.split("[[null]]").next().unwrap()).unwrap().null.is_empty());
}

#[test]
fn a_null_becomes_the_lines_of_a_table() {
    let mut null = read(GOOD).unwrap().null.remove(0);
    (null.runs, null.bias) = (10, vec![0.0, 0.5]);
    let rows = null.rows(1, &AtomicBool::new(false)).unwrap();
    assert_eq!(rows.len(), 2 * 2 * Instrument::ALL.len());
    let at = |row: &NullRow| (row.bias, row.level, row.instrument.clone());
    assert_eq!(at(&rows[0]), (0.0, 0.05, "bets, above".to_owned()));
    assert_eq!(at(rows.last().unwrap()), (0.5, 1e-3, "red guard".to_owned()));
    for row in &rows {
        assert!(row.rejected <= row.runs && row.runs <= 10 && row.low <= row.high && row.samples == 2048);
        // where nothing was looked at, the note says why
        assert!(row.runs > 0 || !row.note.is_empty(), "{row:?}");
    }
    assert_eq!(null.rows(1, &AtomicBool::new(false)).unwrap(), rows);
    assert_eq!(null.rows(1, &AtomicBool::new(true)), None);
}

#[test]
fn what_is_wrong_is_refused_where_it_stands() {
    let start = GOOD.lines().position(|line| line == "[[null]]").unwrap();
    let mut wrong = Vec::new();
    for (line, at, why) in CASES {
        let key = line.split_inclusive(" =").next().unwrap();
        // an unknown key takes the bias's line
        let replaced = GOOD.lines().skip(start).position(|l| l.starts_with(key)).map_or(11, |i| i + start);
        let lines: Vec<&str> =
            GOOD.lines().enumerate().map(|(i, good)| if i == replaced { line } else { good }).collect();
        let holds = refused(&lines.join("\n")).is_some_and(|place| {
            let column = line.rfind(at).unwrap();
            let here = (place.line, place.column) == (replaced + 1, column + 1) && place.length == at.len();
            here && place.message.contains(why)
        });
        if !holds {
            wrong
                .push(format!("{line}\nshould say `{why}` at `{at}`, but: {:?}", refused(&lines.join("\n"))));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn what_is_missing_is_named() {
    for key in ["law", "samples", "runs", "level"] {
        let (before, null) = GOOD.split_once("[[null]]\n").unwrap();
        let null: Vec<&str> = null.lines().filter(|line| !line.starts_with(key)).collect();
        let place = refused(&format!("{before}[[null]]\n{}\n", null.join("\n"))).unwrap();
        assert!(place.message.contains(&format!("missing field `{key}`")), "{place}");
    }
}
