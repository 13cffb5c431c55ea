//! What is of one run alone: when, where and how fast. Results do not depend on it; `run.json` and one line of the page
//! hold it.

use crate::experiment::{Error, file};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Run {
    /// Name of the experiment.
    pub experiment: String,
    /// Text of its file, with the changes of `--set`.
    pub spec: String,
    /// The seed.
    pub seed: u64,
    /// Version of this program.
    pub version: String,
    /// The commit of the folder it ran in, where that is known; "-dirty" behind it where files were changed.
    pub commit: Option<String>,
    /// Seconds since 1970-01-01 UTC at which it began.
    pub started: u64,
    /// Threads.
    pub threads: usize,
    /// Where it ran.
    pub machine: Machine,
    /// Wall-clock seconds of each cell, in the plan's order.
    pub seconds: Vec<f64>,
}

/// A computer.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Machine {
    /// Its kind of processor, such as x86_64.
    pub architecture: String,
    /// Its system, such as linux.
    pub system: String,
    /// Its processor's name, where the system tells.
    pub processor: Option<String>,
    /// Threads that it can run at once.
    pub cores: usize,
}

/// Name of the file.
pub const FILE: &str = "run.json";

impl Run {
    /// Reads the run that a folder holds.
    ///
    /// # Errors
    ///
    /// When there is none, or it is damaged.
    pub fn read(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(FILE);
        let text = file::bytes(&path, file::STORED).map_err(|e| Error::io("cannot read", &path, e))?;
        Self::parse(&path, &text)
    }

    /// Reads the bytes of `file`.
    ///
    /// # Errors
    ///
    /// When it is damaged.
    pub fn parse(file: &Path, text: &[u8]) -> Result<Self, Error> {
        let damaged = |e: serde_json::Error| Error::Refused(format!("{} is damaged: {e}", file.display()));
        serde_json::from_slice(text).map_err(damaged)
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).expect("a run has a JSON form") + "\n"
    }
}
