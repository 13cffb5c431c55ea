//! A study as an object.

use super::{Files, Subject, finite};
use crate::experiment::study::{Detection, Instrument};
use crate::report::study::{self, Studied};
use crate::stats::nulls::NullRow;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// What a study has shown.
#[derive(Serialize, JsonSchema)]
pub struct Study {
    /// The answer in words.
    answer: Vec<String>,
    /// Whether each mistake was found in some scene, without more false alarms than are allowed; the exit status is 0 then.
    held: bool,
    /// Whether Ctrl-C came first; only finished cells are there then.
    interrupted: bool,
    /// All chance follows from it.
    seed: u64,
    /// The finished cells.
    cells: Vec<Detected>,
    /// What the instruments say of samples of known laws.
    nulls: Vec<NullRow>,
    #[serde(flatten)]
    files: Files,
}

/// What the runs of one cell have shown.
#[derive(Serialize, JsonSchema)]
pub struct Detected {
    #[serde(flatten)]
    subject: Subject,
    /// Realizations of a run.
    samples: u64,
    /// Runs, with a seed each.
    seeds: u64,
    /// In how many runs each instrument found something; those are left out that have nothing to look at.
    found: BTreeMap<&'static str, u64>,
    /// Realizations after which half of those runs that were caught were caught.
    needed: Option<u64>,
    /// Mean over all runs, red, green and blue.
    mean: [Option<f64>; 3],
}

impl Study {
    /// What a study says; `folder` holds the results, if they were written.
    pub fn new(studied: &Studied<'_>, interrupted: bool, folder: Option<&Path>) -> Self {
        let plan = studied.plan();
        let cell = |&(index, detection): &(usize, &Detection)| {
            let found = Instrument::ALL.iter().zip(&detection.found);
            Detected {
                subject: Subject::new(plan, &plan.cells[index]),
                samples: plan.cells[index].samples,
                seeds: detection.seeds,
                found: found.filter_map(|(instrument, found)| Some((instrument.name(), (*found)?))).collect(),
                needed: detection.needed,
                mean: detection.mean.map(finite),
            }
        };
        Study {
            answer: study::sentences(studied),
            held: studied.holds(),
            interrupted,
            seed: plan.spec.seed,
            cells: studied.cells().iter().map(cell).collect(),
            nulls: studied.nulls().to_vec(),
            files: Files::of(folder),
        }
    }
}
