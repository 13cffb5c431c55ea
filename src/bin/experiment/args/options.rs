//! What can be said of every command.

use crate::baseline::Names;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ColorChoice, ValueEnum};
use furnace::experiment::journal::{Shard, Start};
use furnace::experiment::{Core, Overrides};
use std::path::PathBuf;

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
    #[arg(long, value_parser = core(), global = true)]
    pub core: Option<Core>,
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
    /// Colours: of what goes to a terminal, unless NO_COLOR says otherwise; or in any case, or never
    #[arg(long, value_name = "WHEN", value_enum, default_value_t, global = true)]
    pub color: ColorChoice,
    /// No progress, only results
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Run cells that are out of proportion, or take more memory than there is
    #[arg(long, global = true)]
    pub force: bool,
    /// Seconds after which a walk is taken not to end, which makes its cell invalid; 60 unless said
    #[arg(long, value_name = "S", global = true, value_parser = seconds)]
    pub walk_seconds: Option<f64>,
    /// Go on from the journal of an earlier run; there must be one. Without this it is gone on from where it is of the same
    /// run
    #[arg(long, conflicts_with = "fresh")]
    pub resume: bool,
    /// Start over, whatever the journal of an earlier run holds
    #[arg(long)]
    pub fresh: bool,
    /// Only this part of the run, such as 3/16, and no report: `merge` makes it of all parts
    #[arg(long, value_name = "I/N", conflicts_with_all = ["claims", "baseline", "save_baseline"])]
    pub shard: Option<Shard>,
    /// Only this block of each cell, from 0, on one thread: shows what went wrong in it. Writes nothing
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "claims", "resume", "fresh"])]
    pub block: Option<u64>,
    /// Read references also from outside the folder of the experiment file's project
    #[arg(long, global = true)]
    pub allow_outside: bool,
}

impl Options {
    /// What they change of a plan.
    pub fn overrides(&self) -> Overrides {
        Overrides {
            seed: self.seed,
            samples: self.samples,
            filter: self.filter.clone(),
            only: self.only.clone(),
            core: self.core,
            quick: self.quick,
            force: self.force,
            walk_seconds: self.walk_seconds,
            allow_outside: self.allow_outside,
        }
    }

    /// The threads that there will be.
    pub fn threads(&self) -> usize {
        match self.jobs {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            jobs => jobs.into(),
        }
    }

    /// What becomes of a journal that is there.
    pub fn start(&self) -> Start {
        match (self.resume, self.fresh) {
            (true, _) => Start::Resume,
            (_, true) => Start::Fresh,
            _ => Start::Either,
        }
    }
}

/// A time that can be waited for.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|s: &f64| (0.001..=1e9).contains(s));
    seconds.ok_or_else(|| "a number of seconds from 0.001 to 1e9".to_owned())
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

/// The names of cores, and nothing else.
fn core() -> impl TypedValueParser<Value = Core> {
    PossibleValuesParser::new(Core::ALL.map(Core::name)).try_map(|name| name.parse())
}
