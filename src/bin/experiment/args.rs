//! What can be typed.

use crate::baseline::Names;
use crate::figure::{self, Figure};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

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
    /// Figures for a paper, at the width of a column, as SVG, PDF and CSV, and the verdicts as a LaTeX table; samples nothing
    #[command(after_help = figure::EXAMPLES)]
    Figure(Figure),
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

#[derive(Args)]
pub struct Render {
    /// A scene with a camera: its name, such as cornell_box or smallpt, or FILE.toml:NAME
    pub scene: String,
    /// explicit, implicit, light_tracing or photon_map
    #[arg(long, default_value = "explicit")]
    pub estimator: String,
    /// Samples a pixel
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u64).range(2..))]
    pub spp: u64,
    /// Pixels along each edge; of smallpt, whose image is 4 : 3, from top to bottom
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub resolution: u32,
    /// Where to write; a PNG preview goes beside it
    #[arg(short, long, default_value = "out.exr")]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct Reference {
    /// Name of a scene, such as cornell_box or furnace, or FILE.toml:NAME for a scene of an experiment file
    pub scene: String,
    /// Relative standard error of the image's mean, worst channel, at which it is good enough
    #[arg(long, value_name = "ERROR", default_value_t = 1e-3, value_parser = relative_error)]
    pub until_error: f64,
    /// Stop at so many samples (a pixel) in any case
    #[arg(long, value_name = "N", default_value_t = 1_000_000_000_000,
        value_parser = clap::value_parser!(u64).range(2..=1_000_000_000_000_000))]
    pub max_samples: u64,
    /// explicit, implicit or light_tracing; the reference will not judge estimators of the same kind
    #[arg(long, default_value = "explicit")]
    pub estimator: String,
    /// Pixels along each edge, if the scene has a camera
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub resolution: u32,
    /// Where it is, or will be; references/own/SCENE.exr if left out
    #[arg(short, long)]
    pub output: Option<PathBuf>,
}

fn relative_error(text: &str) -> Result<f64, String> {
    let error: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if error > 0.0 && error < 1.0 { Ok(error) } else { Err("it lies inside (0, 1)".to_owned()) }
}

#[derive(Args)]
pub struct Export {
    /// cornell_box, cornell_empty, cornell_flush, furnace, furnace_box, a scene of lectures such as veach_mis, or one of the
    /// gallery
    pub scene: String,
    /// Where to write, instead of standard output; triangles go into OBJ files beside it
    #[arg(short, long, value_name = "FILE.xml")]
    pub output: Option<PathBuf>,
    /// Pixels along each edge of the image [default: 32 of a Cornell box, 128 of scenes of lectures, 96 rows of smallpt]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub resolution: Option<u32>,
    /// Which tile of cornell_flush is measured, 1 to 6 [default: 1]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=6))]
    pub tile: Option<u8>,
    /// cornell_flush with its two blocks
    #[arg(long)]
    pub blocks: bool,
    /// Moves the scene's middle to the origin and multiplies lengths by S, which changes no radiance, but the rounding
    /// errors of renderers in single precision
    #[arg(long, value_name = "S", value_parser = positive)]
    pub scale: Option<f64>,
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("it must be finite and positive".to_owned())
    }
}

#[derive(Args, Clone, Default)]
pub struct Options {
    #[command(flatten)]
    pub baselines: Names,
    /// Write to DIR/NAME instead of reports/NAME
    #[arg(long, value_name = "DIR", global = true)]
    pub out: Option<PathBuf>,
    /// Another seed than the file's
    #[arg(long, value_name = "N", global = true)]
    pub seed: Option<u64>,
    /// Threads; 0 = one for each core. Results do not depend on it
    #[arg(short, long, value_name = "N", default_value_t = 0, global = true,
        value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub jobs: u16,
    /// What follows paths: the textbook, one path at a time in double precision, or, where it is offered, the fast path,
    /// sixteen at once in single precision; instead of what the file says
    #[arg(long, value_enum, global = true)]
    pub core: Option<CoreName>,
    /// A hundredth of the samples: shows that all works, decides little
    #[arg(long, global = true)]
    pub quick: bool,
    /// Realizations of every cell
    #[arg(long, value_name = "N", global = true, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000_000_000))]
    pub samples: Option<u64>,
    /// Every experiment there is
    #[arg(long)]
    pub all: bool,
    /// Judge the claims and write nothing: what a nightly run wants. Takes a fresh seed, and prints it, unless --seed is given
    #[arg(long, conflicts_with_all = ["baseline", "save_baseline"])]
    pub claims: bool,
    /// Only cells whose label contains TEXT
    #[arg(long, value_name = "TEXT", global = true)]
    pub filter: Option<String>,
    /// Only the cell with this label, with the samples that it has in the whole experiment; fewer questions then share the
    /// error probabilities, so that verdicts can be sharper
    #[arg(long, value_name = "LABEL", global = true, allow_hyphen_values = true, conflicts_with = "filter")]
    pub only: Option<String>,
    /// Change a value of the file: --set seed=7, --set grid.0.samples=100
    #[arg(long, value_name = "PATH=VALUE", global = true)]
    pub set: Vec<String>,
    /// What goes to standard output
    #[arg(long, value_enum, default_value_t = Format::Text, global = true)]
    pub format: Format,
    /// No progress, only results
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Run cells that are out of proportion
    #[arg(long, global = true)]
    pub force: bool,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table
    #[default]
    Text,
    /// A JSON object an experiment, on one line
    Json,
    /// A scene file for Mitsuba 3, which is what `export` writes
    Mitsuba,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CoreName {
    /// One path at a time in double precision
    Textbook,
    /// Sixteen paths at once in single precision
    Fast,
}

impl From<CoreName> for furnace::experiment::Core {
    fn from(name: CoreName) -> Self {
        match name {
            CoreName::Textbook => Self::Textbook,
            CoreName::Fast => Self::Fast,
        }
    }
}
