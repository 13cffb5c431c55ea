//! Promise: a cell in which a block cannot be made is INVALID, with the block and what happened; all others are what they
//! are without it, and everything is reported.

use furnace::experiment::guard::{Failure, guarded};
use furnace::experiment::run::{Next, merged};
use furnace::experiment::store::Store;
use furnace::experiment::unit::Unit;
use furnace::experiment::{Cell, Overrides, Plan, Row, one_block, run_cell, verdict};
use furnace::report::{self, run::Run};
use furnace::stats::Verdict;
use std::fs;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const FILE: &str = r#"question = "What if one fails?"
samples = 6400
claim = [
  { unbiased = { alpha = 1e-3, margin = 0.2, scene = "furnace" } },
  { agree = { estimator = "explicit", roulette = "throughput", alpha = 1e-3, margin = 0.5, scene = "integrating_sphere" } },
]
plot = [{ bias = {} }, { bars = { scene = "furnace" } }, { bars = { scene = "cornell_box" } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }, "integrating_sphere"]
estimator = ["implicit", "explicit"]
roulette = ["throughput"]
[[grid]]
scene = [{ cornell_box = { resolution = 8 } }]
estimator = ["explicit", "implicit"]
roulette = ["throughput"]
samples = 700
"#;

/// Cells of which those in `failing` panic at a block.
fn cells(plan: &Plan, failing: &[(usize, u64)]) -> Vec<Option<Cell>> {
    let stop = AtomicBool::new(false);
    let one = |(i, cell)| {
        let Some((_, at)) = failing.iter().find(|(c, _)| *c == i) else {
            return run_cell(cell, &stop, &|_| (), &|_| false);
        };
        let mut source = |blocks: Range<u64>, _| {
            let mut unit = Unit::default();
            for number in blocks {
                let made = guarded(number, |number| {
                    assert!(number != *at, "the <b>light</b> went out");
                    one_block(cell, number)
                });
                match made {
                    Ok(block) => unit.push(block),
                    Err(failure) => return Ok(Next::Failed(failure)),
                }
            }
            Ok(Next::Unit(unit))
        };
        merged(cell, &mut source, &|_| (), &|_| false).unwrap()
    };
    plan.cells.iter().enumerate().map(one).collect()
}

/// The files of a report.
fn report(plan: &Plan, cells: &[Option<Cell>], rows: &[Row]) -> (String, String) {
    let place = tempfile::tempdir().unwrap();
    let store = Store::open(&place.path().join("x")).unwrap();
    let run = Run { seconds: vec![0.1; cells.len()], ..Run::default() };
    report::write(plan, cells, rows, &run, &store, None, None).unwrap();
    let read = |file: &str| fs::read_to_string(store.path().join(file)).unwrap();
    (read("results.csv"), read("index.html"))
}

#[test]
fn a_failed_cell_is_invalid_and_the_others_are_not() {
    let plan = Plan::new("x", Path::new("x.toml"), FILE, &Overrides::default()).unwrap();
    let sound = cells(&plan, &[]);
    let right = verdict::rows(&plan, &sound);
    let name = |row: &Row| (row.cell, row.estimand, row.channel);
    // a first block, one in the middle, an image's first and a later one, and all
    for failing in [
        vec![(0, 0)],
        vec![(1, 7)],
        vec![(2, 0), (4, 0)],
        vec![(3, 1), (5, 40)],
        (0..6).map(|cell| (cell, 0)).collect(),
    ] {
        let cells = cells(&plan, &failing);
        let rows = verdict::rows(&plan, &cells);
        for &(cell, block) in &failing {
            let Failure { block: told, why } = cells[cell].as_ref().unwrap().failure.clone().unwrap();
            assert_eq!(told, block);
            assert!(
                why.starts_with("it panicked: the <b>light</b> went out, at tests/failed_cells"),
                "{why}"
            );
            let of_cell: Vec<&Row> = rows.iter().filter(|row| row.cell == cell).collect();
            assert!(!of_cell.is_empty() && of_cell.iter().all(|r| r.verdict == Some(Verdict::Invalid)));
            assert!(
                of_cell.iter().any(|row| row.note.contains(&format!("block {block} failed: it panicked")))
            );
        }
        // what is compared with a cell that failed cannot be judged
        let apart = |row: &&Row| !row.estimand.is_agreement() && failing.iter().all(|(c, _)| *c != row.cell);
        for row in rows.iter().filter(apart) {
            let other = right.iter().find(|other| name(other) == name(row)).unwrap();
            assert_eq!((row.mean, row.samples), (other.mean, other.samples));
            assert_ne!(row.verdict, Some(Verdict::Invalid));
        }
        let (csv, page) = report(&plan, &cells, &rows);
        // more, where others are compared with one that failed
        assert!(csv.matches("went out").count() >= 3 * failing.len(), "{failing:?}");
        assert!(page.contains("INVALID") && !page.contains("<b>light"), "{failing:?}");
    }
}
