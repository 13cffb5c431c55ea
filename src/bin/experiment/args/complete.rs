//! What a shell offers while one types.

use crate::{files, subject};
use clap::builder::PossibleValuesParser;
use clap_complete::engine::{CompletionCandidate, PathCompleter, ValueCompleter};
use clap_complete::env::Shells;
use std::ffi::OsStr;
use std::path::Path;

/// Names of shells.
pub fn shells() -> PossibleValuesParser {
    PossibleValuesParser::new(Shells::builtins().names())
}

/// Names of experiments with what they ask, and paths to experiment files.
pub fn experiments(begun: &OsStr) -> Vec<CompletionCandidate> {
    let begun_text = begun.to_string_lossy();
    let names = files::names().unwrap_or_default().into_iter().filter(|name| name.starts_with(&*begun_text));
    let named = names.map(|name| {
        let question = files::question(&name).map(Into::into);
        CompletionCandidate::new(name).help(question)
    });
    let is_experiment = |path: &Path| path.extension().is_some_and(|extension| extension == "toml");
    let mut all: Vec<_> = named.collect();
    // files clutter the list, unless somebody has begun to name one
    if begun_text.contains(['/', '.']) {
        all.extend(PathCompleter::file().filter(is_experiment).complete(begun));
    }
    all
}

/// Names of scenes.
pub fn scenes() -> Vec<CompletionCandidate> {
    subject::names().map(CompletionCandidate::new).collect()
}

/// Names of estimators.
pub fn estimators() -> Vec<CompletionCandidate> {
    subject::ESTIMATORS.into_iter().map(CompletionCandidate::new).collect()
}
