//! The resolved experiment: every cell with its samples and what it will cost.

use super::about;
use super::bounds;
use super::cell::Keep;
use super::core::Core;
use super::error::Error;
use super::grid;
use super::ledger::Stream;
use super::references::{self, NamedReference};
use super::spec::{self, Spec};
use super::stakes;
use super::unit;
use crate::estimator::{Estimate, Estimator, Property};
use crate::faults::{Fault, Faulty};
use crate::sampling::Address;
use crate::scene::library::SceneKind;
use crate::truth::Truth;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// One point of the grid.
#[derive(Clone, Debug)]
pub struct CellPlan {
    /// The scene and its parameters.
    pub scene: SceneKind,
    /// What the scene is called.
    pub scene_label: String,
    /// The estimator with its termination rule.
    pub estimator: Estimator,
    /// The mistake that is made in place of the estimator, if any.
    pub fault: Option<&'static Fault>,
    /// What the estimator is called.
    pub estimator_label: String,
    /// What the termination rule is called.
    pub roulette_label: String,
    /// Numeric parameters by name, swept or not.
    pub params: BTreeMap<String, f64>,
    /// What follows its paths.
    pub core: Core,
    /// Realizations.
    pub samples: u64,
    /// Realizations a block.
    pub block: u64,
    /// Whether each block is a run whose mean is kept as it grows.
    pub traced: bool,
    /// How many times it is run, with a seed each.
    pub runs: u64,
    /// Pixels of one realization.
    pub pixels: u64,
    /// Expected rays a realization: by theory, or an upper bound.
    pub rays: f64,
    /// Whether no light is out of its reach.
    pub finds_all: bool,
    /// Where its random streams live.
    pub address: Address,
    /// Whether it shares its random numbers with other cells of its scene.
    pub paired: bool,
    /// What is bet on.
    pub streams: Vec<Stream>,
    /// Whether it may end before all samples are taken: nothing but claims about this cell alone wants them.
    pub may_stop: bool,
    /// Whether it is a run of a study.
    pub studied: bool,
    /// A walk that takes longer does not end, and makes the cell invalid.
    pub patience: Duration,
}

impl CellPlan {
    /// Whether its mean is meant to be the right value.
    pub fn is_unbiased(&self) -> bool {
        self.estimator.property() == Property::Unbiased && self.finds_all
    }

    /// The estimator with its mistake, if it makes one.
    pub fn faulty(&self) -> Option<Faulty> {
        self.fault.map(|fault| Faulty { fault, estimator: self.estimator })
    }

    /// Its blocks.
    pub fn blocks(&self) -> u64 {
        self.samples / self.block
    }

    /// What is kept of each block.
    pub fn keep(&self) -> Keep {
        Keep { traces: self.traced, parts: self.studied }
    }

    /// Blocks that are kept as one.
    pub fn unit(&self) -> u64 {
        unit::blocks(self)
    }

    /// Expected rays of the whole cell.
    pub fn total_rays(&self) -> f64 {
        self.rays * self.samples as f64 * self.runs as f64
    }
}

/// The resolved experiment.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The experiment's name.
    pub name: String,
    /// What the file says, with the command line's changes.
    pub spec: Spec,
    /// All cells.
    pub cells: Vec<CellPlan>,
    /// Cells that were asked for and are not run.
    pub left_out: Vec<LeftOut>,
    /// Names of the swept parameters.
    pub swept: Vec<String>,
    /// Stored images that the file names.
    pub references: Vec<NamedReference>,
    /// How many questions each claim asks at most: in the whole experiment, also if only one of its cells is run.
    pub(super) questions: Vec<usize>,
}

/// A cell that cannot be run.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// What it would be.
    pub cell: CellPlan,
    /// Why not.
    pub why: String,
}

/// What the command line changes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Overrides {
    /// Another seed.
    pub seed: Option<u64>,
    /// Other realizations for every cell.
    pub samples: Option<u64>,
    /// Only cells whose label contains this text.
    pub filter: Option<String>,
    /// Only the cell with this label, as if the others were run beside it: the same samples, bit for bit.
    pub only: Option<String>,
    /// Another core than the file's.
    pub core: Option<Core>,
    /// A hundredth of the samples.
    pub quick: bool,
    /// Run cells that are out of proportion.
    pub force: bool,
    /// Seconds after which a walk is taken not to end, instead of [`PATIENCE`].
    pub walk_seconds: Option<f64>,
    /// Read what the file names outside of the folder of its project, too.
    pub allow_outside: bool,
}

/// A walk that takes longer than this does not end.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Rays a second and core that predicted times assume.
pub const RAYS_PER_SECOND: f64 = 1e7;

/// The cells of an experiment file, whose text is `source`, without their samples: all that can be said of it before
/// its references are made.
pub fn cells(file: &Path, source: &str) -> Result<Vec<CellPlan>, Error> {
    Ok(grid::resolve(&spec::parse(file, source)?, file, source)?.cells)
}

impl Plan {
    /// Resolves the experiment `name` from the text of its file.
    pub fn new(name: &str, file: &Path, source: &str, overrides: &Overrides) -> Result<Self, Error> {
        let mut spec = spec::parse(file, source)?;
        spec.seed = overrides.seed.unwrap_or(spec.seed);
        spec.core = overrides.core.unwrap_or(spec.core);
        let grid::Resolved { cells, left_out, swept, .. } = grid::resolve(&spec, file, source)?;
        let references = references::load(&spec, &cells, file, source, overrides.allow_outside)?;
        let mut plan =
            Plan { name: name.to_owned(), spec, cells, left_out, swept, references, questions: Vec::new() };
        plan.distinct()?;
        about::something(&plan, file, source)?;
        if let Some(text) = &overrides.filter {
            let labels = plan.labels();
            if !labels.iter().any(|label| label.contains(text.as_str())) {
                let why = format!("no cell of {name} has `{text}` in its label");
                return Err(Error::Refused(format!("{why}; there are:{}", listed(&labels, text))));
            }
            let swept = &plan.swept;
            plan.cells.retain(|cell| label(cell, swept).contains(text.as_str()));
        }
        plan.count_questions();
        stakes::lay(&mut plan);
        plan.allot(overrides);
        if let Some(seconds) = overrides.walk_seconds {
            let patience = Duration::from_secs_f64(seconds);
            plan.cells.iter_mut().for_each(|cell| cell.patience = patience);
        }
        if let Some(wanted) = &overrides.only {
            plan.keep_only(wanted)?;
        }
        bounds::proportionate(&plan, overrides.force).map_err(Error::Refused)?;
        Ok(plan)
    }

    /// What the terminal and the page call a cell.
    pub fn label(&self, cell: &CellPlan) -> String {
        label(cell, &self.swept)
    }

    fn labels(&self) -> Vec<String> {
        self.cells.iter().map(|cell| self.label(cell)).collect()
    }

    /// A cell's termination rule and swept parameters.
    pub fn rule_label(&self, cell: &CellPlan) -> String {
        rule_label(cell, &self.swept)
    }

    /// What is right for a cell.
    pub fn truth(&self, cell: &CellPlan) -> Truth {
        let here = self.references.iter().filter(|r| r.scene == cell.scene_label);
        let stored: Vec<_> = here.map(|r| Arc::clone(&r.reference)).collect();
        Truth::of(&cell.scene, &cell.estimator, &stored)
    }

    /// How many questions a claim, by its index, asks at most.
    pub(super) fn questions(&self, claim: usize) -> usize {
        self.questions[claim]
    }

    pub(super) fn count_questions(&mut self) {
        self.questions = self.spec.claim.iter().map(|claim| stakes::questions(self, claim)).collect();
    }

    /// Forgets all cells but one, but not how many questions were to share the error probabilities: when a cell may end
    /// depends on that.
    fn keep_only(&mut self, wanted: &str) -> Result<(), Error> {
        let labels = self.labels();
        if !labels.iter().any(|label| label == wanted) {
            let why = format!("no cell of {} is called `{wanted}`", self.name);
            return Err(Error::Refused(format!("{why}; there are:{}", listed(&labels, wanted))));
        }
        let swept = &self.swept;
        self.cells.retain(|cell| label(cell, swept) == wanted);
        // studies judge each cell as if it were the whole experiment
        if self.spec.seeds.is_some() {
            self.count_questions();
        }
        Ok(())
    }

    /// Two cells of one name would be one row twice.
    fn distinct(&self) -> Result<(), Error> {
        let mut seen = std::collections::BTreeSet::new();
        for cell in &self.cells {
            let label = self.label(cell);
            if !seen.insert(label.clone()) {
                return Err(Error::Refused(format!(
                    "{}: two cells are both called `{label}`; give one of the scenes another `name`",
                    self.name
                )));
            }
        }
        Ok(())
    }
}

/// A line for each label, those first that are most like what was written; of many the rest is only counted.
fn listed(labels: &[String], written: &str) -> String {
    const SHOWN: usize = 12;
    let mut labels: Vec<&String> = labels.iter().collect();
    if labels.len() > SHOWN {
        labels.sort_by_key(|label| strsim::damerau_levenshtein(label, written));
    }
    let shown = labels.iter().take(SHOWN).map(|label| format!("\n  {label}"));
    let more = labels.len().saturating_sub(SHOWN);
    let more = (more > 0).then(|| format!("\n  and {more} more, which `plan` lists"));
    shown.chain(more).collect()
}

fn label(cell: &CellPlan, swept: &[String]) -> String {
    format!("{} {} {}", cell.scene_label, cell.estimator_label, rule_label(cell, swept))
}

fn rule_label(cell: &CellPlan, swept: &[String]) -> String {
    let swept = cell.params.iter().filter(|(name, _)| swept.contains(name));
    let params: String = swept.map(|(name, value)| format!(" {name}={value}")).collect();
    format!("{}{params}", cell.roulette_label)
}
