//! What can be typed.

mod complete;
mod examples;
mod options;
mod single;
mod slurm;
mod write;

pub use options::{Format, Options};
pub use single::{Export, Reference, Render};
pub use slurm::Slurm;
pub use write::{Kind, New};

use crate::figure::{self, Figure};
use clap::{Args, CommandFactory, Parser, Subcommand};
use clap_complete::ArgValueCompleter;
use single::relative_error;
use std::path::PathBuf;

/// Runs experiments on Monte Carlo light-transport estimators: is each one right, what does it cost, where is it wrong.
///
/// Exit status: 0 all claims held, 1 a claim failed or stayed inconclusive, 2 usage or input, 130 or 143 stopped by Ctrl-C
/// or a polite kill, with all that is finished kept: the same command goes on from there.
#[derive(Parser)]
#[command(
    name = "experiment",
    version,
    args_conflicts_with_subcommands = true,
    arg_required_else_help = true,
    after_help = examples::RUN
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Experiments to run: names in experiments/, or paths to .toml files
    #[arg(add = ArgValueCompleter::new(complete::experiments))]
    pub names: Vec<String>,
    #[command(flatten)]
    pub options: Options,
}

#[derive(Subcommand)]
pub enum Command {
    /// Every experiment: its question, cells, predicted rays and time
    #[command(after_help = examples::LIST)]
    List,
    /// The resolved grid, its predicted cost, and how many samples a margin takes; samples nothing
    #[command(after_help = examples::PLAN)]
    Plan {
        /// Experiments to plan
        #[arg(required = true, add = ArgValueCompleter::new(complete::experiments))]
        names: Vec<String>,
        /// The relative margin to plan for, instead of that of the claims
        #[arg(long, value_name = "M", value_parser = relative_error)]
        margin: Option<f64>,
    },
    /// Rebuilds CSV, plots and page from the stored cells; samples nothing
    #[command(after_help = examples::REPORT)]
    Report {
        /// Experiments to report
        #[arg(required = true, add = ArgValueCompleter::new(complete::experiments))]
        names: Vec<String>,
    },
    /// Puts the parts of a run together that were sampled with --shard, and reports it as if it had been run at once
    ///
    /// Exit status: as that of a run; 75 if blocks are missing, which are named.
    #[command(after_help = examples::MERGE)]
    Merge(Merge),
    /// How far a run or its parts have come, from their journals
    #[command(after_help = examples::STATUS)]
    Status {
        /// Folders with journals
        #[arg(required = true)]
        folders: Vec<PathBuf>,
    },
    /// Figures for a paper, at the width of a column, as SVG, PDF and CSV, and the verdicts as a LaTeX table; samples nothing
    #[command(after_help = figure::EXAMPLES)]
    Figure(Figure),
    /// Writes a new experiment file that runs as it is, with comments on what can be changed
    #[command(after_help = examples::NEW)]
    New(New),
    /// Renders one image
    #[command(after_help = examples::RENDER)]
    Render(Render),
    /// Makes a stored image that estimators of other kinds can be compared with, or adds samples to it
    ///
    /// Name it in an experiment file: [[reference]] scene = "...", file = "...". Stopping and going on leads to the same
    /// file as not stopping. Exit status: 0 the error is reached, 1 --max-samples came first, 130 interrupted (what is
    /// finished is kept).
    #[command(after_help = examples::REFERENCE)]
    Reference(Reference),
    /// Writes a scene for another renderer
    #[command(after_help = examples::EXPORT)]
    Export(Export),
    /// Writes a job array for a Slurm cluster, and the job that joins its parts into the report; samples nothing here
    #[command(after_help = examples::SLURM)]
    Slurm(Slurm),
    /// Prints the JSON schema of experiment files, by which editors complete and check them, or of --format json
    #[command(after_help = examples::SCHEMA)]
    Schema {
        /// Of what
        #[arg(default_value = "experiment")]
        of: Kind,
    },
    /// Prints the script by which a shell completes this command, names of experiments and scenes included
    #[command(after_help = examples::COMPLETIONS)]
    Completions {
        /// The shell
        #[arg(value_parser = complete::shells())]
        shell: String,
    },
}

#[derive(Args)]
pub struct Merge {
    /// Folders with journals, all of one run
    #[arg(required = true)]
    pub folders: Vec<PathBuf>,
}

/// Whether an experiment of this name could not be called: the name is a command.
pub fn is_command(name: &str) -> bool {
    let mut cli = Cli::command();
    cli.build(); // which adds `help`
    cli.find_subcommand(name).is_some()
}
