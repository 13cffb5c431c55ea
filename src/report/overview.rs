//! `reports/index.html`: all experiments of a folder, with their questions and answers.

use super::page;
use crate::experiment::{Error, file};
use crate::stats::Verdict;
use maud::{Markup, html};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// What the overview says of an experiment; `summary.json` in its folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Its name.
    pub experiment: String,
    /// What it asks.
    pub question: String,
    /// The answer in words.
    pub answer: Vec<String>,
    /// How many cells it has.
    pub cells: usize,
    /// How many cells without a known mistake have each verdict, the worst first.
    pub verdicts: Vec<(Verdict, usize)>,
    /// File of a figure to show.
    pub figure: Option<String>,
}

/// Name of the file.
pub const FILE: &str = "summary.json";

impl Summary {
    /// Reads the bytes of `file`.
    ///
    /// # Errors
    ///
    /// When it is damaged, or its figure is not in its folder.
    pub fn parse(file: &Path, text: &[u8]) -> Result<Self, Error> {
        let damaged = |e: serde_json::Error| Error::Refused(format!("{} is damaged: {e}", file.display()));
        let summary: Self = serde_json::from_slice(text).map_err(damaged)?;
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
        match summary.figure.as_ref().filter(|figure| !figure.chars().all(is_plain)) {
            Some(figure) => Err(Error::Refused(format!(
                "{} is damaged: `{figure}` is no name of a figure in its folder",
                file.display()
            ))),
            None => Ok(summary),
        }
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).expect("a summary has a JSON form") + "\n"
    }
}

/// Writes `index.html` over all experiments that have a summary in a folder of their name below `folder`.
///
/// # Errors
///
/// When the folder cannot be read or written, or a summary is damaged.
pub fn write(folder: &Path) -> Result<(), Error> {
    let mut summaries = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| Error::io("cannot read", folder, e))?.flatten() {
        let path = entry.path().join(FILE);
        if !path.exists() {
            continue;
        }
        let text = file::bytes(&path, file::STORED).map_err(|e| Error::io("cannot read", &path, e))?;
        let summary = Summary::parse(&path, &text)?;
        // what an interrupted run has left is not the experiment
        if entry.file_name() == *summary.experiment {
            summaries.push(summary);
        }
    }
    summaries.sort_by(|a, b| a.experiment.cmp(&b.experiment));
    let path = folder.join("index.html");
    fs::write(&path, overview(&summaries)).map_err(|e| Error::io("cannot write", &path, e))
}

/// The page over these experiments.
pub fn overview(summaries: &[Summary]) -> String {
    let header = html! {
        h1 { "furnace" }
        p.question { "What a test bench for Monte Carlo light-transport estimators has found." }
    };
    let main = html! { div.cards { @for summary in summaries { (card(summary)) } } };
    page::bare("reports", &header, &main)
}

fn card(summary: &Summary) -> Markup {
    let page = format!("{}/index.html", summary.experiment);
    html! {
        article.card {
            h2 { a href=(page) { (summary.experiment) } }
            p.question { (summary.question) }
            p {
                (summary.cells) " cells "
                @for (verdict, count) in &summary.verdicts { (page::badge(Some(*verdict))) @if *count > 1 { " " (count) } " " }
            }
            @if let Some(figure) = &summary.figure {
                a href=(page) { img src={ (summary.experiment) "/" (figure) } alt={ "a figure of " (summary.experiment) } loading="lazy"; }
            }
            details { summary { "Answer" } ul { @for sentence in &summary.answer { li { (sentence) } } } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(name: &str) -> Summary {
        Summary {
            experiment: name.to_owned(),
            question: "Is <b> text?".to_owned(),
            answer: vec!["Yes & no".to_owned()],
            cells: 3,
            verdicts: vec![(Verdict::Pass, 3)],
            figure: None,
        }
    }

    #[test]
    fn experiments_stand_in_order_and_leftovers_do_not_count() {
        let folder = tempfile::tempdir().unwrap();
        for (dir, name) in [("b", "b"), ("a", "a"), ("c-interrupted", "c")] {
            fs::create_dir(folder.path().join(dir)).unwrap();
            fs::write(folder.path().join(dir).join(FILE), summary(name).text()).unwrap();
        }
        fs::create_dir(folder.path().join("other")).unwrap();
        write(folder.path()).unwrap();
        let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
        let at = |text: &str| page.find(text);
        assert!(at("a/index.html") < at("b/index.html") && at("a/index.html").is_some());
        assert!(at("c/index.html").is_none());
        assert!(page.contains("Is &lt;b&gt; text?") && !page.contains("Is <b>"));
    }

    #[test]
    fn a_damaged_summary_is_named() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("a")).unwrap();
        fs::write(folder.path().join("a").join(FILE), "{").unwrap();
        let error = write(folder.path()).unwrap_err().to_string();
        assert!(error.contains("summary.json is damaged"), "{error}");
    }
}
