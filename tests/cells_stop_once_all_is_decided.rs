//! Promise: a cell ends at the first look at which all that is claimed of it is decided, tells after how many samples each
//! question was, and goes on to the end where something is open or where other cells are compared with it. What was
//! decided at a look stays decided.

use furnace::experiment::{Cell, Estimand, Overrides, Plan, Row, run_cell, verdict};
use furnace::stats::{Engine, Verdict};
use std::path::Path;
use std::sync::atomic::AtomicBool;

const FILE: &str = r#"question = "Enough?"
samples = 1_048_576
[[claim]]
unbiased = { alpha = 1e-3, margin = 0.02 }
[grid]
scene = [{ furnace = { albedo = 0.5 } }]
estimator = ["implicit"]
roulette = [{ constant = { q = 0.6 } }]
"#;

fn run(file: &str) -> (Plan, Cell, Vec<Row>) {
    let plan = Plan::new("x", Path::new("x.toml"), file, &Overrides::default()).unwrap();
    let is_decided = |cell: &mut Cell| verdict::is_decided(&plan, 0, cell);
    let cell = run_cell(&plan.cells[0], &AtomicBool::new(false), &|_| (), &is_decided).unwrap();
    let rows = verdict::rows(&plan, &[Some(cell.clone())]);
    (plan, cell, rows)
}

fn mean(rows: &[Row]) -> &Row {
    rows.iter().find(|row| row.estimand == Estimand::Mean && row.channel == Some(0)).unwrap()
}

#[test]
fn at_the_first_look_that_suffices() {
    let (plan, cell, rows) = run(FILE);
    assert!(plan.cells[0].may_stop);
    assert_eq!(cell.cost.n, 1_048_576 / 8, "an eighth is enough");
    let row = mean(&rows);
    assert_eq!((row.verdict, row.engine), (Some(Verdict::Pass), Some(Engine::Exact)), "{}", row.note);
    assert_eq!((row.samples, row.needed), (1_048_576 / 8, Some(1_048_576 / 8)));
    assert!(row.e_value.unwrap() < 1e3);
}

#[test]
fn not_while_something_is_open() {
    let (_, cell, rows) = run(&FILE.replace("margin = 0.02", "margin = 1e-6"));
    assert_eq!(cell.cost.n, 1_048_576);
    let row = mean(&rows);
    assert_eq!((row.verdict, row.needed), (Some(Verdict::Inconclusive), None));
    assert!(row.note.contains("times the samples would be needed"), "{}", row.note);
}

#[test]
fn not_where_others_are_compared_with_it() {
    let agree = "[[claim]]\nagree = { estimator = \"implicit\", roulette = \"constant(q=0.6)\", alpha = 0.01, margin = 0.1 }\n[grid]";
    let (plan, cell, _) = run(&FILE.replace("[grid]", agree));
    assert!(!plan.cells[0].may_stop);
    assert_eq!(cell.cost.n, 1_048_576);
}

/// A wrong value is found as early as a right one is shown; what comes later cannot take it back.
#[test]
fn what_is_decided_stays_decided() {
    let (plan, mut cell, _) = run(&FILE.replace("margin = 0.02", "margin = 1e-6"));
    let decided = furnace::experiment::cell::Decided {
        estimand: Estimand::Mean,
        channel: Some(0),
        verdict: Verdict::Fail,
        samples: 8192,
    };
    cell.decided.push(decided);
    let rows = verdict::rows(&plan, &[Some(cell)]);
    let row = mean(&rows);
    assert_eq!((row.verdict, row.needed), (Some(Verdict::Fail), Some(8192)));
}
