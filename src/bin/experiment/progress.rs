//! How far a run has come: a bar on a terminal, a line a cell elsewhere. All of it on standard error.

use anstream::eprintln;
use furnace::experiment::Plan;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, stderr};

/// Progress in rays, which are what time is spent on.
pub struct Progress {
    bar: ProgressBar,
    lines: bool,
}

impl Progress {
    /// Starts at zero of the plan's predicted rays.
    pub fn new(plan: &Plan, quiet: bool) -> Self {
        let terminal = stderr().is_terminal();
        let rays: f64 = plan.cells.iter().map(|cell| cell.total_rays()).sum();
        let bar = if quiet || !terminal { ProgressBar::hidden() } else { ProgressBar::new(rays as u64) };
        let style = "{wide_bar} {percent:>3} %  {per_sec} rays  {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        Progress { bar, lines: !quiet && !terminal }
    }

    /// A cell begins.
    pub fn cell(&self, label: &str) {
        self.bar.set_message(label.to_owned());
    }

    /// So many rays were traced.
    pub fn rays(&self, rays: f64) {
        self.bar.inc(rays as u64);
    }

    /// A cell is done; the bar moves to where the plan had put its end.
    pub fn done(&self, label: &str, number: usize, plan: &Plan, seconds: f64) {
        let planned: f64 = plan.cells[..number].iter().map(|cell| cell.total_rays()).sum();
        self.bar.set_position(planned as u64);
        if self.lines {
            eprintln!("[{number}/{}] {label}: {seconds:.2} s", plan.cells.len());
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
