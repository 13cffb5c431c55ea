//! What helps to write experiment files.

use super::complete;
use clap::{Args, ValueEnum};
use clap_complete::ArgValueCandidates;

#[derive(Args)]
pub struct New {
    /// Its name: experiments/NAME.toml is written, never over another file
    pub name: String,
    /// Scenes to run it in [default: furnace]
    #[arg(long = "scene", value_name = "SCENE", num_args = 1.., add = ArgValueCandidates::new(complete::scenes))]
    pub scenes: Vec<String>,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Kind {
    /// Experiment files
    Experiment,
    /// What --format json prints
    Result,
}
