//! Pages to open: those of runs that the tests make.

use assert_cmd::{Command, cargo::cargo_bin};
use std::fs;
use std::path::{Path, PathBuf};

/// A run of an experiment.
pub struct Report {
    /// `index.html`; the other files lie beside it.
    pub page: PathBuf,
    /// What the run said with `--format json`.
    pub said: serde_json::Value,
}

impl Report {
    /// Runs an experiment, given as the text of its file, in a folder of that name for what tests leave behind.
    pub fn of(name: &str, file: &str) -> Self {
        let place = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&place);
        fs::create_dir_all(place.join("experiments")).unwrap();
        fs::write(place.join("experiments/x.toml"), file).unwrap();
        let mut command = Command::new(cargo_bin!("experiment"));
        let arguments = ["x", "--quiet", "--format", "json"];
        let output = command.args(arguments).current_dir(&place).output().unwrap();
        assert!(output.status.code() < Some(2), "{}", String::from_utf8_lossy(&output.stderr));
        let said = serde_json::from_slice(&output.stdout).unwrap();
        Report { page: place.join("reports/x/index.html"), said }
    }

    /// The folder of the page.
    pub fn folder(&self) -> &Path {
        self.page.parent().unwrap()
    }

    /// Rows of `results.csv` of one estimand in one channel, by the columns' names.
    pub fn rows(&self, estimand: &str, channel: &str) -> Vec<Row> {
        let mut reader = csv::Reader::from_path(self.folder().join("results.csv")).unwrap();
        let rows = reader.deserialize().map(|row| Row(row.unwrap()));
        rows.filter(|row| row.text("estimand") == estimand && row.text("channel") == channel).collect()
    }
}

/// A row of `results.csv`.
pub struct Row(std::collections::HashMap<String, String>);

impl Row {
    /// What a column holds.
    pub fn text(&self, column: &str) -> &str {
        &self.0[column]
    }

    /// The number in a column.
    pub fn number(&self, column: &str) -> f64 {
        let text = self.text(column);
        text.parse().unwrap_or_else(|_| panic!("{column}: {text:?} is no number"))
    }
}
