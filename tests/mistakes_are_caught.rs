//! Promise: every mistake of the catalogue that has an effect is caught at the number of samples that
//! `experiments/faults.toml` names, in the scene that shows it, and sound estimators beside it raise no more alarms than are promised.

use furnace::experiment::study::{Detection, Instrument, detect};
use furnace::experiment::{Overrides, Plan};
use furnace::faults::{self, Effect};
use furnace::stats::binomial::clopper_pearson;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The study with fewer seeds: few runs, all of which have to see what is there.
fn plan(seeds: u32) -> Plan {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/faults.toml");
    let text = std::fs::read_to_string(&file).unwrap().replace("seeds = 40", &format!("seeds = {seeds}"));
    let mut plan = Plan::new("faults", &file, &text, &Overrides::default()).unwrap();
    assert_eq!(plan.spec.seeds, Some(seeds));
    // the one that takes millions of samples has its time in the study itself
    plan.cells.retain(|cell| cell.samples <= 1 << 18);
    plan
}

fn share(detection: &Detection) -> f64 {
    detection.share(Instrument::Verdict).unwrap().0
}

#[test]
fn and_sound_estimators_are_not() {
    let plan = plan(2);
    let stop = AtomicBool::new(false);
    let mut best: BTreeMap<&str, f64> = BTreeMap::new();
    let (mut alarms, mut sound) = (0, 0);
    for (i, cell) in plan.cells.iter().enumerate() {
        let seen = share(&detect(&plan, i, &stop, &|_| ()).unwrap());
        match cell.fault.filter(|fault| fault.effect != Effect::Equivalent) {
            Some(fault) => {
                let best = best.entry(fault.name).or_default();
                *best = best.max(seen);
            }
            None => {
                alarms += (2.0 * seen) as u64;
                sound += 2;
            }
        }
    }
    // five claims of 1e-3 each; with probability 1e-3 the limit is wrong
    let (least, _) = clopper_pearson(alarms, sound, 0.998);
    assert!(sound >= 40 && least <= 5e-3, "{alarms} false alarms in {sound} runs");
    let missed: Vec<&str> = best.iter().filter(|(_, share)| **share < 1.0).map(|(name, _)| *name).collect();
    assert!(missed.is_empty(), "not caught: {missed:?}");
}

/// A mistake that no experiment looks for would be a promise that nobody keeps.
#[test]
fn all_of_the_catalogue_are_looked_for() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
    let text = ["faults.toml", "as_printed.toml"]
        .map(|name| std::fs::read_to_string(root.join(name)).unwrap())
        .concat();
    let forgotten: Vec<&str> =
        faults::all().map(|fault| fault.name).filter(|name| !text.contains(&format!("\"{name}\""))).collect();
    assert!(forgotten.is_empty(), "in no experiment: {forgotten:?}");
}

/// The same detections whatever runs beside them.
#[test]
fn studies_repeat_bit_for_bit() {
    let plan = plan(3);
    let stop = AtomicBool::new(false);
    let json = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let all = || {
            (0..3)
                .map(|i| serde_json::to_string(&detect(&plan, i, &stop, &|_| ())).unwrap())
                .collect::<Vec<_>>()
        };
        pool.install(all)
    };
    assert_eq!(json(1), json(3));
}
