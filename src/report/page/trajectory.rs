//! What bets on the mean have won as samples came in: a figure for each cell.

use crate::experiment::row::CHANNELS;
use crate::experiment::{Cell, Estimand};
use crate::report::budget;
use crate::report::curves::CHANNEL_COLOURS;
use crate::report::figure::{Axis, Colour, Figure, Mark, Panel, Point, Series, Style};
use crate::report::lookup::Lookup;
use crate::report::number;
use std::f64::consts::LN_10;

/// The figure, if the cell's mean was bet on: logarithm of e over samples, and the line above which the mean is refuted.
pub fn figure(lookup: &Lookup<'_>, index: usize, cell: &Cell) -> Option<Figure> {
    let series = series(lookup, index, cell);
    let needed = needed(lookup, index).filter(|_| series.iter().any(|side| side.points.len() > 1))?;
    let label = format!("refuted above 1/α = {:.1e}", libm::pow(10.0, needed));
    let (low, high) = reach(&series);
    // what has won far more than it had to leaves the figure at its top
    let y =
        Axis::linear("log₁₀ e").within(low.max(-needed) - 0.5, (1.1 * high.max(needed)).min(3.0 * needed));
    Some(Figure {
        title: "What bets against the right mean have won".to_owned(),
        alt: words(&series, needed),
        columns: 1,
        panels: vec![Panel {
            x: Axis::log("samples"),
            y,
            marks: vec![Mark::Horizontal { at: needed, label, colour: Colour::Black }],
            series,
            ..Panel::default()
        }],
    })
}

/// Both sides in each channel; the streams of the whole stand before those of single bounces.
fn series(lookup: &Lookup<'_>, index: usize, cell: &Cell) -> Vec<Series> {
    let streams = lookup.plan.cells[index].streams.iter().take(3).enumerate();
    let mut sides = Vec::new();
    for (k, stream) in streams.filter(|(_, stream)| stream.bin.is_none()) {
        let taken = || cell.history.iter().filter_map(move |s| Some((s.total[0].n as f64, s.log_e.get(k)?)));
        let point = |n: f64, log_e: f64| Point::new(n, log_e / LN_10);
        let above: Vec<Point> = taken().map(|(n, e)| point(n, e.0)).collect();
        let below: Vec<Point> = taken().filter_map(|(n, e)| Some(point(n, e.1?))).collect();
        let mut side = |what: &str, style, points: Vec<Point>| {
            if !points.is_empty() {
                let label = format!("{}, against \"at {what}\"", CHANNELS[stream.channel]);
                sides.push(Series { label, colour: CHANNEL_COLOURS[stream.channel], style, points });
            }
        };
        side("most", Style::Line, above);
        side("least", Style::Dashed, below);
    }
    sides
}

/// Decimal logarithm of the e-value that refutes the mean under the claim that asks for it.
fn needed(lookup: &Lookup<'_>, index: usize) -> Option<f64> {
    let rows = || (0..3).filter_map(|c| lookup.row(index, Estimand::Mean, Some(c)));
    let level = budget::shares(lookup).get(rows().find_map(|row| row.claim)?)?.level();
    // a side without evidence takes no share, and leaves its end of the interval open
    let sides = if rows().any(|row| row.ci.is_some()) { 2.0 } else { 1.0 };
    Some(libm::log10(sides / level))
}

/// The lowest and the highest value.
fn reach(series: &[Series]) -> (f64, f64) {
    let values = series.iter().flat_map(|side| &side.points).map(|point| point.y).filter(|y| !y.is_nan());
    values.fold((0.0, 0.0), |(low, high), y| (f64::min(low, y), f64::max(high, y)))
}

/// What the figure shows, for those who cannot see it.
fn words(series: &[Series], needed: f64) -> String {
    let one = |side: &Series| {
        let values = side.points.iter().map(|point| point.y).filter(|e| !e.is_nan());
        let most = values.fold(f64::NEG_INFINITY, f64::max);
        let crossed = side.points.iter().find(|point| point.y >= needed);
        let crossed =
            crossed.map_or_else(String::new, |at| format!(", beyond the line from {:.0} samples on", at.x));
        format!("{}: at most {}{crossed}", side.label, number::short(most))
    };
    let sides: Vec<String> = series.iter().map(one).collect();
    format!("Logarithm of evidence that the mean is wrong; the line is at {needed:.1}. {}", sides.join("; "))
}
