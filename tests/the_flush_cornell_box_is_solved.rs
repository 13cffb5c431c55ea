//! Promise: the deterministic solution of the flush Cornell box that comes with the program is what the solver gives, to
//! the bit, and is as exact as promised.
//!
//! `FURNACE_SOLVE=1 cargo test --test the_flush_cornell_box_is_solved` writes it anew, after a change of the method.

use furnace::scene::library::SceneKind;
use furnace::truth::deterministic::{Deterministic, Solved};
use furnace::truth::{Counted, Source};
use std::path::Path;

#[test]
fn the_stored_solution_is_the_solvers() {
    let solved = Solved::new();
    if std::env::var_os("FURNACE_SOLVE").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("references/cornell_flush.json");
        std::fs::write(path, serde_json::to_string(&solved).unwrap() + "\n").unwrap();
        return;
    }
    assert_eq!(Some(solved), Solved::embedded());
}

#[test]
fn errors_are_small_and_bounces_add_up() {
    for (tile, blocks) in (0..6).flat_map(|tile| [(tile, false), (tile, true)]) {
        let solution = Deterministic::of(&SceneKind::CornellFlush { tile, blocks }).unwrap();
        for channel in 0..3 {
            let mean = |counted| solution.mean(channel, counted);
            let direct = mean(Counted::Only(1)).unwrap();
            let open = Deterministic::of(&SceneKind::CornellFlush { tile, blocks: false }).unwrap();
            let unhidden = open.mean(channel, Counted::Only(1)).unwrap().value;
            assert!(direct.bound <= 2.5e-6 * unhidden && direct.source == Source::Deterministic);
            if blocks {
                assert!(mean(Counted::All).is_none() && mean(Counted::Only(2)).is_none());
                continue;
            }
            let total = mean(Counted::All).unwrap();
            assert!(total.bound <= 1e-5 * total.value, "{tile}: {total:?}");
            let bounces: f64 = (0..8).map(|k| mean(Counted::Only(k)).unwrap().value).sum();
            let rest = mean(Counted::From(8)).unwrap();
            assert!((bounces + rest.value - total.value).abs() <= total.bound + rest.bound);
            let clamped = solution.clamped(channel, Counted::All, 7).unwrap();
            assert!((clamped.value - bounces).abs() <= 1e-15);
            assert_eq!(solution.clamped(channel, Counted::From(8), 7).unwrap().value, 0.0);
        }
    }
}
