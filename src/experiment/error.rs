//! What can be wrong with a user's input or with the machine's answer to it: one sentence each, exit status 2.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// An error that a user can do something about.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Something is wrong at a place in a file.
    #[error("{0}")]
    Input(Place),
    /// A file or folder could not be read or written.
    #[error("{what} {}: {source}", path.display())]
    Io {
        /// What was attempted.
        what: &'static str,
        /// Where.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// A name that nothing has.
    #[error("there is no experiment called `{name}`{}", suggestion(name, known))]
    UnknownExperiment {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// Anything else that the user asked for and cannot have.
    #[error("{0}")]
    Refused(String),
}

/// A place in a file and what is wrong there.
#[derive(Debug)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// The offending line.
    pub text: String,
    /// How many characters of it are meant.
    pub length: usize,
    /// What is wrong and what would be right.
    pub message: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let gutter = " ".repeat(self.line.to_string().len());
        let indent: String =
            self.text.chars().take(self.column - 1).map(|c| if c == '\t' { c } else { ' ' }).collect();
        writeln!(f, "{}", self.message)?;
        writeln!(f, "{gutter}--> {}:{}:{}", self.file.display(), self.line, self.column)?;
        writeln!(f, "{gutter} |")?;
        writeln!(f, "{} | {}", self.line, self.text)?;
        write!(f, "{gutter} | {indent}{}", "^".repeat(self.length.max(1)))
    }
}

impl Error {
    /// An error at the bytes `span` of `source`, the text of `file`.
    pub fn at(file: &Path, source: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let start = span.start.min(source.len());
        let line_start = source[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = source[start..].find('\n').map_or(source.len(), |i| start + i);
        Error::Input(Place {
            file: file.to_owned(),
            line: source[..start].matches('\n').count() + 1,
            column: source[line_start..start].chars().count() + 1,
            text: source[line_start..line_end].trim_end().to_owned(),
            length: source[start..span.end.clamp(start, line_end)].chars().count(),
            message: message.into(),
        })
    }

    /// What the TOML reader found wrong with `source`, the text of `file`.
    pub fn toml(file: &Path, source: &str, error: &toml::de::Error) -> Self {
        let message = error.message();
        let message = format!("{message}{}", nearest_expected(message));
        Error::at(file, source, error.span().unwrap_or(0..0), message)
    }

    /// A name that none of the `known` things of this kind has.
    pub fn unknown(kind: &str, name: &str, known: &[&str]) -> Self {
        let suggestion = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`? There are"),
            None => "there are".to_owned(),
        };
        Error::Refused(format!("no {kind} `{name}`; {suggestion} {}", known.join(", ")))
    }

    /// A failed attempt to read or write.
    pub fn io(what: &'static str, path: &Path, source: std::io::Error) -> Self {
        Error::Io { what, path: path.to_owned(), source }
    }
}

/// "; did you mean `x`?" if one of the known names is close to what was written, else the list of them.
fn suggestion(name: &str, known: &[String]) -> String {
    match nearest(name, known.iter().map(String::as_str)) {
        Some(near) => format!("; did you mean `{near}`?"),
        None if known.is_empty() => "; there are none in the folder experiments/".to_owned(),
        None => format!("; there are: {}", known.join(", ")),
    }
}

fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |k: &&str| strsim::damerau_levenshtein(name, k);
    known.min_by_key(distance).filter(|k| distance(k) <= 1 + name.len() / 4)
}

/// serde's "unknown field `x`, expected one of `a`, `b`": the nearest of those names.
fn nearest_expected(message: &str) -> String {
    if !message.starts_with("unknown ") {
        return String::new();
    }
    let mut quoted = message.split('`').skip(1).step_by(2);
    let written = quoted.next().unwrap_or_default();
    nearest(written, quoted).map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}
