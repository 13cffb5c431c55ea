//! Runs that are kept under a name, for later ones to be compared with.

use crate::args::Options;
use crate::files::{self, Source};
use clap::Args;
use furnace::experiment::baseline::{Baseline, Comparison};
use furnace::experiment::file::{STORED, text};
use furnace::experiment::{Cell, Error, Plan, Row};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Args, Clone, Default)]
pub struct Names {
    /// Keep this run under NAME, beside the reports, for later ones to be compared with; replaces an older one of that name
    #[arg(long, value_name = "NAME", global = true)]
    pub save_baseline: Option<String>,
    /// Say how mean, variance and efficiency have changed since the run kept as NAME; the exit status does not depend on it
    #[arg(long, value_name = "NAME", global = true)]
    pub baseline: Option<String>,
}

/// Where baselines are kept, beside the reports: running again does not touch them.
const FOLDER: &str = ".baselines";

/// What is asked for, found before anything is sampled.
pub struct Wanted {
    /// The run to be compared with, and its name.
    earlier: Option<(String, Baseline)>,
    /// Where to keep the run.
    save: Option<PathBuf>,
}

/// Reads the baseline that the options name, and holds that another can be written.
pub fn wanted(source: &Source, plan: &Plan, options: &Options) -> Result<Wanted, Error> {
    let Names { save_baseline, baseline } = &options.baselines;
    let is_study = plan.spec.seeds.is_some();
    if is_study && (save_baseline.is_some() || baseline.is_some()) {
        let why = "is a study: its rates are not compared with those of a baseline";
        return Err(Error::Refused(format!("{} {why}", source.name)));
    }
    let folder = options.out.clone().unwrap_or_else(|| files::root().join("reports")).join(FOLDER);
    let file =
        |name: &String| valid(name).map(|name| folder.join(name).join(format!("{}.json", source.name)));
    let save = save_baseline.as_ref().map(file).transpose()?;
    let read = |name: &String| {
        let file = file(name)?;
        if !file.exists() {
            return Err(missing(&folder, name, &source.name));
        }
        let text = text(&file, STORED).map_err(|e| Error::io("cannot read", &file, e))?;
        Ok((name.clone(), Baseline::read(&file, &text)?))
    };
    Ok(Wanted { earlier: baseline.as_ref().map(read).transpose()?, save })
}

/// A name that is one folder on every system: the path of another place is none.
fn valid(name: &str) -> Result<&str, Error> {
    let letter = |c: char| c.is_ascii_alphanumeric() || "._-+".contains(c);
    let is_name = name.chars().all(letter) && name.starts_with(|c: char| c.is_ascii_alphanumeric());
    if is_name && name.len() <= 100 {
        return Ok(name);
    }
    Err(Error::Refused(format!(
        "`{name}` cannot be the name of a baseline: it begins with a letter or a digit, and holds letters, digits, and . _ - + \
         only"
    )))
}

fn missing(folder: &Path, name: &str, experiment: &str) -> Error {
    let file = format!("{experiment}.json");
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let mut known: Vec<String> = entries
        .filter(|entry| entry.path().join(&file).exists())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    known.sort();
    let there = match known.is_empty() {
        true => format!("there are none; `experiment {experiment} --save-baseline {name}` makes it"),
        false => format!("there are: {}", known.join(", ")),
    };
    Error::Refused(format!("{experiment} has no baseline called `{name}`; {there}"))
}

impl Wanted {
    /// Compares a run with the baseline that was asked for.
    pub fn compare(&self, plan: &Plan, cells: &[Option<Cell>], rows: &[Row]) -> Option<Comparison> {
        let (name, earlier) = self.earlier.as_ref()?;
        let now = Baseline::of(plan, cells, rows, None);
        Some(Comparison::new(name, earlier.clone(), &now))
    }

    /// Keeps a run of this commit, if that was asked for and all of it is there.
    pub fn save(
        &self,
        plan: &Plan,
        cells: &[Option<Cell>],
        rows: &[Row],
        commit: Option<String>,
    ) -> Result<(), Error> {
        let Some(file) = &self.save else { return Ok(()) };
        if cells.iter().any(Option::is_none) {
            eprintln!("not kept as a baseline: cells are missing");
            return Ok(());
        }
        let folder = file.parent().expect("a baseline has a folder");
        fs::create_dir_all(folder).map_err(|e| Error::io("cannot create", folder, e))?;
        let write = || -> std::io::Result<()> {
            // an interrupted write must not leave half a baseline
            let mut staged = tempfile::NamedTempFile::new_in(folder)?;
            std::io::Write::write_all(
                &mut staged,
                Baseline::of(plan, cells, rows, commit).text().as_bytes(),
            )?;
            staged.persist(file).map_err(|e| e.error)?;
            Ok(())
        };
        write().map_err(|e| Error::io("cannot write", file, e))
    }
}
