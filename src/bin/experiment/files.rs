//! Finding and reading experiment files.

use crate::args::{Options, is_command};
use crate::set;
use furnace::experiment::journal::{Header, Shard};
use furnace::experiment::{Error, Plan, file};
use std::fs;
use std::path::{Path, PathBuf};

/// An experiment file with its text.
pub struct Source {
    pub name: String,
    pub file: PathBuf,
    pub text: String,
    /// The text before the changes of `--set`.
    unchanged: String,
    changes: Vec<String>,
    /// Where results go, unless the options say otherwise.
    reports: PathBuf,
}

impl Source {
    /// Finds an experiment by name, or by the path of its file, and reads it with the changes of `--set`.
    pub fn read(wanted: &str, options: &Options) -> Result<Self, Error> {
        let folder = folder();
        let file = match &folder {
            _ if wanted.ends_with(".toml") => PathBuf::from(wanted),
            Some(folder) => folder.join(format!("{wanted}.toml")),
            None => return Err(Error::UnknownExperiment { name: wanted.to_owned(), known: Vec::new() }),
        };
        if !wanted.ends_with(".toml") && !file.exists() {
            return Err(Error::UnknownExperiment { name: wanted.to_owned(), known: names()? });
        }
        let text = file::text(&file, file::WRITTEN).map_err(|e| Error::io("cannot read", &file, e))?;
        let name = file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        if is_command(&name) {
            return Err(Error::Refused(format!(
                "{}: `{name}` is a command; rename the file",
                file.display()
            )));
        }
        let unchanged = text.clone();
        let text = set::all(&file, text, &options.set)?;
        Ok(Source {
            name,
            file,
            text,
            unchanged,
            changes: options.set.clone(),
            reports: root().join("reports"),
        })
    }

    /// The experiment of a journal that lies in `folder`; its results go beside that, unless the options say otherwise.
    pub fn of_journal(header: &Header, folder: &Path) -> Self {
        let known = || self::folder().map(|f| f.join(format!("{}.toml", header.name))).filter(|f| f.exists());
        let file = Some(header.file.clone()).filter(|file| file.exists()).or_else(known);
        let text = header.spec.clone();
        Source {
            name: header.name.clone(),
            file: file.unwrap_or_else(|| header.file.clone()),
            unchanged: text.clone(),
            text,
            changes: Vec::new(),
            reports: folder.parent().unwrap_or(Path::new("")).to_owned(),
        }
    }

    /// The resolved experiment.
    pub fn plan(&self, options: &Options) -> Result<Plan, Error> {
        let overrides = &options.overrides();
        if self.text == self.unchanged {
            return Plan::new(&self.name, &self.file, &self.text, overrides);
        }
        Plan::new(&self.name, &self.file, &self.text, overrides).map_err(|error| {
            let of_file = Plan::new(&self.name, &self.file, &self.unchanged, overrides).err();
            // a mistake of the file is told by the file's own lines
            of_file.unwrap_or_else(|| set::blame(error, &self.changes))
        })
    }

    /// What journals of a part of its plan begin with.
    pub fn header(&self, plan: &Plan, options: &Options, shard: Shard) -> Header {
        Header::new(plan, self.file.clone(), &self.text, options.overrides(), shard)
    }

    /// Where its results go.
    pub fn report_folder(&self, options: &Options) -> PathBuf {
        self.reports(options).join(&self.name)
    }

    /// Where the results of all experiments go.
    pub fn reports(&self, options: &Options) -> PathBuf {
        options.out.clone().unwrap_or_else(|| self.reports.clone())
    }
}

/// The nearest folder `experiments/`, from here upwards.
pub fn folder() -> Option<PathBuf> {
    let here = std::env::current_dir().ok()?;
    let found = here.ancestors().map(|a| a.join("experiments")).find(|folder| folder.is_dir())?;
    // shorter messages, where the folder is right here
    Some(if found == here.join("experiments") { PathBuf::from("experiments") } else { found })
}

/// The folder that holds `experiments/`, or the present one.
pub fn root() -> PathBuf {
    folder().and_then(|f| f.parent().map(Path::to_owned)).unwrap_or_default()
}

/// Names of all experiments, sorted.
pub fn names() -> Result<Vec<String>, Error> {
    let Some(folder) = folder() else { return Ok(Vec::new()) };
    let entries = fs::read_dir(&folder).map_err(|e| Error::io("cannot read", &folder, e))?;
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".toml").map(str::to_owned))
        .collect();
    names.sort();
    Ok(names)
}

/// What an experiment asks, if its file can be read.
pub fn question(name: &str) -> Option<String> {
    let text = file::text(&folder()?.join(format!("{name}.toml")), file::WRITTEN).ok()?;
    let table: toml::Table = toml::from_str(&text).ok()?;
    table.get("question")?.as_str().map(str::to_owned)
}
