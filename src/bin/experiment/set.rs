//! Changes of a file's values: `--set path.to.key=value`.

use furnace::experiment::Error;
use std::ops::Range;
use std::path::Path;

/// No key of an experiment file lies deeper.
const DEEPEST: usize = 32;

/// Applies changes to the text of a file, one after the other.
pub fn all(file: &Path, text: String, changes: &[String]) -> Result<String, Error> {
    changes.iter().try_fold(text, |text, change| one(file, &text, change))
}

/// What is wrong in a change, where it is wrong.
fn at(change: &str, span: Range<usize>, why: impl Into<String>) -> Error {
    Error::at(Path::new("--set"), change, span, why)
}

/// Applies one change; the value is TOML, or else a string.
fn one(file: &Path, text: &str, change: &str) -> Result<String, Error> {
    let whole = 0..change.len();
    let (path, written) = change.split_once('=').ok_or_else(|| {
        at(change, whole.clone(), "expected path=value, such as seed=7 or grid.0.samples=100")
    })?;
    if path.split('.').nth(DEEPEST).is_some() {
        return Err(at(change, whole, format!("the path is deeper than {DEEPEST}, and no file is")));
    }
    let mut table: toml::Value = toml::from_str(text).map_err(|e| Error::toml(file, text, &e))?;
    let parsed = toml::from_str::<toml::Table>(&format!("value = {written}"));
    let value = parsed.ok().and_then(|mut t| t.remove("value"));
    let value = value.unwrap_or_else(|| toml::Value::String(written.to_owned()));
    let mut place = &mut table;
    let mut start = 0;
    for key in path.split('.') {
        let span = start..start + key.len();
        start = span.end + 1;
        place = match (place, key.parse::<usize>()) {
            (toml::Value::Array(items), Ok(i)) => {
                let count = items.len();
                let why =
                    || at(change, span, format!("there is no element {key}; the list has {count}, from 0"));
                items.get_mut(i).ok_or_else(why)?
            }
            (toml::Value::Table(t), _) => {
                t.entry(key).or_insert_with(|| toml::Value::Table(toml::Table::new()))
            }
            _ => return Err(at(change, span, format!("`{key}` is not inside a table or list"))),
        };
    }
    *place = value;
    toml::to_string(&table).map_err(|e| at(change, whole, e.to_string()))
}

/// An error of the changed file, told by the change that holds what is wrong: by the last one in which it is written.
pub fn blame(error: Error, changes: &[String]) -> Error {
    let Error::Input(place) = &error else { return error };
    let wrong: String = place.text.chars().skip(place.column - 1).take(place.length).collect();
    // names may be written without their quotes
    let wrong = wrong.trim_matches('"');
    let found = changes.iter().rev().find_map(|change| Some((change, change.rfind(wrong)?)));
    match found {
        Some((change, start)) => at(change, start..start + wrong.len(), place.message.clone()),
        // what is wrong now follows from the changes, but is written in none of them
        None => match changes.last() {
            Some(change) => at(change, 0..change.len(), place.message.clone()),
            None => error,
        },
    }
}
