//! Finding and reading experiment files.

use crate::args::{Options, is_command};
use furnace::experiment::{Error, Overrides, Plan};
use std::fs;
use std::path::{Path, PathBuf};

/// An experiment file with its text.
pub struct Source {
    pub name: String,
    pub file: PathBuf,
    pub text: String,
    /// The text before the changes of `--set`.
    unchanged: String,
    /// The folder that holds `experiments/`, or the present one.
    root: PathBuf,
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
        let text = fs::read_to_string(&file).map_err(|e| Error::io("cannot read", &file, e))?;
        let name = file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        if is_command(&name) {
            return Err(Error::Refused(format!(
                "{}: `{name}` is a command; rename the file",
                file.display()
            )));
        }
        let unchanged = text.clone();
        let text = options.set.iter().try_fold(text, |text, change| set(&file, &text, change))?;
        Ok(Source { name, file, text, unchanged, root: root() })
    }

    /// The resolved experiment.
    pub fn plan(&self, options: &Options) -> Result<Plan, Error> {
        let overrides = Overrides {
            seed: options.seed,
            samples: options.samples,
            filter: options.filter.clone(),
            only: options.only.clone(),
            core: options.core,
            quick: options.quick,
            force: options.force,
        };
        if self.text == self.unchanged {
            return Plan::new(&self.name, &self.file, &self.text, &overrides);
        }
        // a mistake of the file is told by the file's own lines
        let changed = self.file.with_extension("toml with --set");
        Plan::new(&self.name, &changed, &self.text, &overrides).map_err(|error| {
            Plan::new(&self.name, &self.file, &self.unchanged, &overrides).err().unwrap_or(error)
        })
    }

    /// Where its results go.
    pub fn report_folder(&self, options: &Options) -> PathBuf {
        self.reports(options).join(&self.name)
    }

    /// Where the results of all experiments go.
    pub fn reports(&self, options: &Options) -> PathBuf {
        options.out.clone().unwrap_or_else(|| self.root.join("reports"))
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
    let text = fs::read_to_string(folder()?.join(format!("{name}.toml"))).ok()?;
    let table: toml::Table = toml::from_str(&text).ok()?;
    table.get("question")?.as_str().map(str::to_owned)
}

/// Applies `path.to.key=value` to the text of a file; the value is TOML, or else a string.
fn set(file: &Path, text: &str, change: &str) -> Result<String, Error> {
    let refuse = |why: &str| Error::Refused(format!("--set {change}: {why}"));
    let (path, value) = change.split_once('=').ok_or_else(|| refuse("expected path=value"))?;
    let mut table: toml::Value = toml::from_str(text).map_err(|e| Error::toml(file, text, &e))?;
    let parsed = toml::from_str::<toml::Table>(&format!("value = {value}"));
    let value = parsed.ok().and_then(|mut t| t.remove("value"));
    let value = value.unwrap_or_else(|| toml::Value::String(change[path.len() + 1..].to_owned()));
    let mut place = &mut table;
    for key in path.split('.') {
        place = match (place, key.parse::<usize>()) {
            (toml::Value::Array(items), Ok(i)) => {
                items.get_mut(i).ok_or_else(|| refuse(&format!("there is no element {key}")))?
            }
            (toml::Value::Table(t), _) => {
                t.entry(key).or_insert_with(|| toml::Value::Table(toml::Table::new()))
            }
            _ => return Err(refuse(&format!("`{key}` is not inside a table or list"))),
        };
    }
    *place = value;
    toml::to_string(&table).map_err(|e| refuse(&e.to_string()))
}
