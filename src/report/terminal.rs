//! What the terminal shows: a line a cell, where it is wrong, and what the error probability is spent on.

use super::lookup::Lookup;
use super::summary::{self, Line};
use super::{budget, wrong};
use crate::stats::Verdict;
use anstream::adapter::strip_str;
use anstyle::AnsiColor;
use std::fmt::Write;

/// A verdict in its colour.
pub fn verdict(verdict: Verdict) -> String {
    let style = match verdict {
        Verdict::Pass => AnsiColor::Green.on_default(),
        Verdict::Inconclusive => AnsiColor::Yellow.on_default(),
        Verdict::Fail => AnsiColor::Red.on_default().bold(),
        Verdict::Invalid => AnsiColor::Magenta.on_default().bold(),
    };
    format!("{style}{verdict}{style:#}")
}

/// How wide a text is on a terminal, where colours take no room.
fn width(text: &str) -> usize {
    strip_str(text).to_string().chars().count()
}

/// All of it as text; columns aligned, verdicts in colours, which who prints it takes away where they are not wanted.
pub fn table(lookup: &Lookup<'_>) -> String {
    let finished = (0..lookup.plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty());
    let lines: Vec<Line> = finished.map(|c| summary::line(lookup, c)).collect();
    let names = [
        "scene",
        "estimator",
        "rule",
        "samples",
        "needed",
        "bias % (R G B)",
        "mde %",
        "rays",
        "verdict",
        "by",
        "",
    ];
    let header = names.map(str::to_owned);
    let mut grid = vec![header];
    for line in lines {
        let verdict = line.verdict.map_or_else(|| "-".to_owned(), verdict);
        let samples = line.samples.to_string();
        grid.push([
            line.scene,
            line.estimator,
            line.rule,
            samples,
            line.needed.map_or_else(String::new, |needed| needed.to_string()),
            line.bias,
            line.mde,
            line.rays,
            verdict,
            summary::by_text(&line.by),
            line.note,
        ]);
    }
    let widest = |column: usize| grid.iter().map(|row| width(&row[column])).max().unwrap_or(0);
    let widths: Vec<usize> = (0..grid[0].len()).map(widest).collect();
    let mut text = String::new();
    for row in &grid {
        let mut out = String::new();
        for (i, cell) in row.iter().enumerate() {
            let pad = " ".repeat(widths[i] - width(cell));
            let right = (3..=7).contains(&i);
            let _ = if right { write!(out, "{pad}{cell}  ") } else { write!(out, "{cell}{pad}  ") };
        }
        let _ = writeln!(text, "{}", out.trim_end());
    }
    for more in [wrong::text(lookup), budget::text(lookup)].iter().filter(|more| !more.is_empty()) {
        let _ = write!(text, "\n{more}");
    }
    text
}
