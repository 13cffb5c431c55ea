//! What the terminal shows: a line a cell, where it is wrong, and what the error probability is spent on.

use super::lookup::Lookup;
use super::summary::{self, Line};
use super::{budget, wrong};
use std::fmt::Write;

/// All of it as text; columns aligned.
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
        let verdict = line.verdict.map_or_else(|| "-".to_owned(), |v| v.to_string());
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
    let width = |column: usize| grid.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..grid[0].len()).map(width).collect();
    let mut text = String::new();
    for row in &grid {
        let mut out = String::new();
        for (i, cell) in row.iter().enumerate() {
            let pad = " ".repeat(widths[i] - cell.chars().count());
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
