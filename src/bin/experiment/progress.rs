//! How far a run has come, on standard error: on a terminal a bar, above which the finished cells stand with their
//! verdicts; a line a cell elsewhere.

use anstream::{AutoStream, ColorChoice, adapter::strip_str, eprintln};
use furnace::experiment::Plan;
use furnace::experiment::guard::Failure;
use furnace::report::replay;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt;
use std::io::{IsTerminal, stderr};

/// Progress in rays, which are what time is spent on.
pub struct Progress {
    bar: ProgressBar,
    lines: bool,
    /// Characters of the longest label.
    width: usize,
}

impl Progress {
    /// Starts at zero of the plan's predicted rays.
    pub fn new(plan: &Plan, quiet: bool) -> Self {
        let terminal = stderr().is_terminal();
        let rays: f64 = plan.cells.iter().map(|cell| cell.total_rays()).sum();
        let bar = if quiet || !terminal { ProgressBar::hidden() } else { ProgressBar::new(rays as u64) };
        let style = "{wide_bar} {percent:>3} %  {rate} million rays/s  {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(style) {
            let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
                let _ = write!(out, "{:.1}", state.per_sec() / 1e6);
            };
            bar.set_style(style.with_key("rate", rate));
        }
        let width = plan.cells.iter().map(|cell| plan.label(cell).chars().count()).max().unwrap_or(0);
        Progress { bar, lines: !quiet && !terminal, width }
    }

    /// Whether nobody looks.
    pub fn is_silent(&self) -> bool {
        self.bar.is_hidden() && !self.lines
    }

    /// A cell begins.
    pub fn cell(&self, label: &str) {
        self.bar.set_message(label.to_owned());
    }

    /// So many rays were traced.
    pub fn rays(&self, rays: f64) {
        self.bar.inc(rays as u64);
    }

    /// A cell is done, and this is what it has shown; the bar moves to where the plan had put its end.
    pub fn done(&self, label: &str, number: usize, plan: &Plan, seconds: f64, shown: &str) {
        let planned: f64 = plan.cells[..number].iter().map(|cell| cell.total_rays()).sum();
        self.bar.set_position(planned as u64);
        if self.lines {
            eprintln!("[{number}/{}] {label}: {seconds:.2} s, {shown}", plan.cells.len());
            return;
        }
        let line = format!("{label:<width$}  {seconds:>7.2} s  {shown}", width = self.width);
        let plain = AutoStream::choice(&stderr()) == ColorChoice::Never;
        self.bar.println(if plain { strip_str(&line).to_string() } else { line });
    }

    /// A cell failed; how to see it happen again is said besides.
    pub fn failed(&self, plan: &Plan, cell: usize, failure: &Failure) {
        let label = plan.label(&plan.cells[cell]);
        let again = replay::block(plan, cell, failure.block);
        self.bar.suspend(|| eprintln!("{label}: {failure}\n  to see it again: {again}"));
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
