//! What can be typed.

mod options;
mod single;

pub use options::{Format, Options};
pub use single::{Export, Reference, Render};

use clap::{Parser, Subcommand};
use single::relative_error;

/// Runs experiments on Monte Carlo light-transport estimators: is each one right, what does it cost, where is it wrong.
///
/// Exit status: 0 all claims held, 1 a claim failed or stayed inconclusive, 2 usage or input, 130 interrupted.
#[derive(Parser)]
#[command(
    name = "experiment",
    version,
    args_conflicts_with_subcommands = true,
    arg_required_else_help = true
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Experiments to run: names in experiments/, or paths to .toml files
    pub names: Vec<String>,
    #[command(flatten)]
    pub options: Options,
}

#[derive(Subcommand)]
pub enum Command {
    /// Every experiment: its question, cells, predicted rays and time
    List,
    /// The resolved grid, its predicted cost, and how many samples a margin takes; samples nothing
    Plan {
        /// Experiments to plan
        #[arg(required = true)]
        names: Vec<String>,
        /// The relative margin to plan for, instead of that of the claims
        #[arg(long, value_name = "M", value_parser = relative_error)]
        margin: Option<f64>,
    },
    /// Rebuilds CSV, plots and page from the stored cells; samples nothing
    Report {
        /// Experiments to report
        #[arg(required = true)]
        names: Vec<String>,
    },
    /// Renders one image, e.g. `experiment render cornell_box --estimator explicit --spp 64 -o out.exr`
    Render(Render),
    /// Makes a stored image that estimators of other kinds can be compared with, or adds samples to it
    ///
    /// Name it in an experiment file: [[reference]] scene = "...", file = "...". Stopping and going on leads to the same
    /// file as not stopping. Exit status: 0 the error is reached, 1 --max-samples came first, 130 interrupted (what is
    /// finished is kept).
    Reference(Reference),
    /// Writes a scene for another renderer, e.g. `experiment export cornell_box --format mitsuba -o box.xml`
    Export(Export),
}
