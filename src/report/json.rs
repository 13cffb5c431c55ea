//! What `--format json` prints: an object for each experiment, on one line. The schema is made from the types, so that it
//! says what is printed.

mod planned;
mod run;
mod study;

pub use planned::{Listed, Planned, margin};
pub use run::Run;
pub use study::Study;

use crate::experiment::{CellPlan, Plan};
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The version of what is printed: a higher one means that something was renamed, removed or has another meaning. Keys may
/// be added without one.
const VERSION: u32 = 2;

/// An object of `--format json`.
#[derive(Serialize, JsonSchema)]
pub struct Object {
    /// Version of this form.
    #[schemars(extend("const" = VERSION))]
    schema: u32,
    /// Name of the experiment.
    experiment: String,
    /// What it asks.
    question: String,
    #[serde(flatten)]
    content: Content,
}

/// What an object is about, as its `kind` says.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Content {
    /// What a run has shown, or `report` from a stored one.
    Run(Run),
    /// What a study has shown: every cell with many seeds.
    Study(Study),
    /// What `plan` prints: all that would be run.
    Plan(Planned),
    /// What `list` prints.
    Listed(Listed),
}

impl Object {
    /// An object about this experiment.
    pub fn new(plan: &Plan, content: Content) -> Self {
        let (experiment, question) = (plan.name.clone(), plan.spec.question.clone());
        Object { schema: VERSION, experiment, question, content }
    }

    /// It, on one line.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("numbers and names have a JSON form")
    }
}

/// The JSON schema of all that `--format json` prints.
pub fn schema() -> String {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    let mut schema = settings.into_generator().into_root_schema_for::<Object>();
    schema.insert("title".to_owned(), "A line of --format json".into());
    serde_json::to_string_pretty(&schema).expect("a schema is JSON") + "\n"
}

/// A point of the grid.
#[derive(Serialize, JsonSchema)]
pub struct Subject {
    /// Its label, which `--only` takes.
    cell: String,
    /// The scene.
    scene: String,
    /// The estimator.
    estimator: String,
    /// The termination rule, without swept parameters.
    roulette: String,
    /// What follows its paths: `textbook` or `fast`.
    core: String,
    /// Numeric parameters by name, swept or not.
    params: BTreeMap<String, f64>,
    /// The mistake that is made in place of the estimator, if any: it is to be caught.
    fault: Option<String>,
}

impl Subject {
    fn new(plan: &Plan, cell: &CellPlan) -> Self {
        Subject {
            cell: plan.label(cell),
            scene: cell.scene_label.clone(),
            estimator: cell.estimator_label.clone(),
            roulette: cell.roulette_label.clone(),
            core: cell.core.to_string(),
            params: cell.params.clone(),
            fault: cell.fault.map(|fault| fault.name.to_owned()),
        }
    }
}

/// A cell that was asked for and cannot be run.
#[derive(Serialize, JsonSchema)]
pub struct LeftOut {
    /// What it would be called.
    cell: String,
    /// Why it is left out.
    why: String,
}

fn left_out(plan: &Plan) -> Vec<LeftOut> {
    plan.left_out.iter().map(|out| LeftOut { cell: plan.label(&out.cell), why: out.why.clone() }).collect()
}

/// Where the results are, if they were written.
#[derive(Serialize, JsonSchema)]
pub struct Files {
    /// The page; null with --claims, which writes nothing.
    page: Option<String>,
    /// The table of all rows; null with --claims.
    results: Option<String>,
}

impl Files {
    fn of(folder: Option<&Path>) -> Self {
        let file = |name: &str| folder.map(|folder| folder.join(name).display().to_string());
        Files { page: file("index.html"), results: file("results.csv") }
    }
}

/// JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}
