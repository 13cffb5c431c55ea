//! From an experiment file to verdicts: spec, plan, blocks, cells, rows.

mod about;
mod agree;
pub mod allot;
pub mod baseline;
mod block;
pub mod bounds;
pub mod cell;
pub mod choices;
pub mod core;
pub mod error;
pub mod file;
mod grid;
pub mod input;
mod inside;
pub mod ledger;
pub mod making;
pub mod mistake;
pub mod outcome;
pub mod pixels;
pub mod plan;
mod rates;
pub mod reach;
mod references;
mod refute;
pub mod row;
pub mod run;
mod runs;
pub mod spec;
mod stakes;
pub mod store;
pub mod study;
mod subject;
mod tiles;
pub mod verdict;

pub use cell::Cell;
pub use core::Core;
pub use error::Error;

pub use plan::{CellPlan, Overrides, Plan};
pub use rates::{Decline, Fall};
pub use row::{Estimand, Row};
pub use run::{run_cell, sample};
pub use spec::Spec;
