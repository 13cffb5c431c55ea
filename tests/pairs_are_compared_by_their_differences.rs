//! Promise: cells that share their random numbers are compared block by block, so that what both have in common cancels:
//! a smaller difference is found with the same samples, and the same one is measured.

use furnace::experiment::{Cell, Estimand, Overrides, Plan, Row, run_cell, verdict};
use std::path::Path;
use std::sync::atomic::AtomicBool;

const FILE: &str = r#"question = "Do both heuristics have the same mean?"
samples = 65_536
streams = "STREAMS"
claim = [{ agree = { estimator = "explicit(both, balance)", roulette = "constant(q=0.5)", alpha = 1e-3, margin = 0.05 } }]
[grid]
scene = [{ exhibit = { name = "disk_light" } }]
estimator = [{ explicit = { technique = "both" } }, { explicit = { technique = "both", heuristic = "power" } }]
roulette = [{ constant = { q = 0.5 } }]
"#;

/// The comparison of the red channel.
fn compared(streams: &str) -> Row {
    let plan = Plan::new("x", Path::new("x.toml"), &FILE.replace("STREAMS", streams), &Overrides::default())
        .unwrap();
    let run = |i: usize| run_cell(&plan.cells[i], &AtomicBool::new(false), &|_| (), &|_| false);
    let cells: Vec<Option<Cell>> = (0..plan.cells.len()).map(run).collect();
    assert_eq!(cells[0].as_ref().unwrap().block_means.is_empty(), streams == "independent");
    let rows = verdict::rows(&plan, &cells);
    rows.into_iter().find(|row| row.estimand == Estimand::Agree && row.channel == Some(0)).unwrap()
}

#[test]
fn and_what_they_share_cancels() {
    let (paired, independent) = (compared("paired"), compared("independent"));
    let (mde, apart) = (paired.mde.unwrap(), independent.mde.unwrap());
    assert!(mde < 0.8 * apart, "{mde} {apart}");
    let (low, high) = paired.ci.unwrap();
    let bias = paired.bias.unwrap();
    assert!(low < bias && bias < high && (0.5 * (low + high) - bias).abs() < 1e-9, "{low} {bias} {high}");
    assert_eq!(paired.verdict, independent.verdict);
}
