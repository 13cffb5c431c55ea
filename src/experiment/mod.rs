//! From an experiment file to verdicts: spec, plan, blocks, cells, rows.

mod agree;
pub mod allot;
pub mod cell;
pub mod choices;
pub mod error;
mod grid;
mod image;
pub mod input;
pub mod ledger;
pub mod making;
pub mod mistake;
pub mod pixels;
pub mod plan;
pub mod reach;
mod references;
mod refute;
pub mod row;
pub mod run;
pub mod spec;
mod stakes;
pub mod store;
pub mod study;
mod subject;
pub mod verdict;

pub use cell::Cell;
pub use error::Error;
pub use plan::{CellPlan, Overrides, Plan};
pub use row::{Estimand, Row};
pub use run::{run_cell, sample};
pub use spec::Spec;
