//! What can be wrong with a user's input or with the machine's answer to it: one sentence each, exit status 2.

use std::borrow::Cow;
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
    #[error("{}", shortened(.0))]
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
        let (text, column) = window(&self.text, self.column);
        let indent: String = text.chars().take(column - 1).map(|c| if c == '\t' { c } else { ' ' }).collect();
        let length = self.length.clamp(1, SHOWN);
        writeln!(f, "{}", shortened(&self.message))?;
        writeln!(f, "{gutter}--> {}:{}:{}", self.file.display(), self.line, self.column)?;
        writeln!(f, "{gutter} |")?;
        writeln!(f, "{} | {text}", self.line)?;
        write!(f, "{gutter} | {indent}{}", "^".repeat(length))
    }
}

impl Error {
    /// An error at the bytes `span` of `source`, the text of `file`.
    pub fn at(file: &Path, source: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let boundary = |at: usize| (0..=at.min(source.len())).rev().find(|&at| source.is_char_boundary(at));
        let start = boundary(span.start).unwrap_or(0);
        let line_start = source[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = source[start..].find('\n').map_or(source.len(), |i| start + i);
        let text = source[line_start..line_end].trim_end();
        let end = boundary(span.end).unwrap_or(0).min(line_start + text.len()).max(start);
        Error::Input(Place {
            file: file.to_owned(),
            line: source[..start].matches('\n').count() + 1,
            column: source[line_start..start].chars().count() + 1,
            text: text.to_owned(),
            length: source[start..end].chars().count(),
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

/// Characters of a line that are shown at most.
const SHOWN: usize = 160;

/// Characters of a message: what it quotes may be of any length.
const MESSAGE: usize = 4000;

/// A message without its end, if it is too long to be read.
fn shortened(message: &str) -> Cow<'_, str> {
    match message.char_indices().nth(MESSAGE) {
        Some((end, _)) => format!("{} ... (and more)", &message[..end]).into(),
        None => message.into(),
    }
}

/// The part of a long line that surrounds the column, and the column within it.
fn window(text: &str, column: usize) -> (Cow<'_, str>, usize) {
    if text.chars().nth(SHOWN).is_none() {
        return (text.into(), column);
    }
    let before = (column - 1).min(SHOWN / 4);
    let from = column - 1 - before;
    (text.chars().skip(from).take(SHOWN).collect(), before + 1)
}

/// The known name that is most like this one, if any is. Nobody has typed a long name by mistake, and time and memory
/// that it takes to compare two grow with both.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    const LONG: usize = 100;
    if name.len() > LONG {
        return None;
    }
    let known = known.filter(|name| name.len() <= LONG);
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
