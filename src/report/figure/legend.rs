//! The legend between the title and the panels: each label once, with all its signs.

use super::canvas::{Anchor, Canvas, Ink, Xy};
use super::{Colour, Figure, Mark, Panel, Style, font, mark};

/// Width of the sign beside a label in pixels.
const SIGN: f64 = 28.0;
const AFTER_SIGN: f64 = 7.0;
const BETWEEN: f64 = 22.0;

/// A sign beside a label.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sign {
    Series(Style),
    Region,
    UprightLine,
    LevelLine,
    Ring,
}

/// A label with its colour and signs.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    label: String,
    colour: Colour,
    signs: Vec<Sign>,
}

/// Draws the legend from `top` downwards and returns where it ends.
pub(super) fn draw(
    canvas: &mut Canvas,
    figure: &Figure,
    sideways: &[bool],
    left: f64,
    top: f64,
    width: f64,
) -> f64 {
    let em = canvas.look.legend;
    let line = font::line_height(em);
    let (mut x, mut y, mut rows) = (left, top, 0);
    for entry in entries(figure, sideways) {
        let limit = width - SIGN - AFTER_SIGN;
        let lines = font::wrap(&entry.label, em, limit);
        let text = lines.iter().map(|line| font::width(line, em));
        let needed = SIGN + AFTER_SIGN + text.fold(0.0, f64::max);
        if x > left && x + needed > left + width {
            (x, y) = (left, y + line * f64::from(rows) + 2.0);
            rows = 0;
        }
        draw_signs(canvas, &entry, (x, y + 0.5 * line));
        for (index, text) in lines.iter().enumerate() {
            let baseline = y + line * (index as f64 + 0.5) + 0.36 * em;
            let start = (x + SIGN + AFTER_SIGN, baseline);
            canvas.text(text, start, em, Anchor::Start);
        }
        rows = rows.max(lines.len() as u32);
        x += needed + BETWEEN;
    }
    y + line * f64::from(rows)
}

/// All entries in the order of first use: data first, then regions and marks.
fn entries(figure: &Figure, sideways: &[bool]) -> Vec<Entry> {
    let mut entries = Vec::new();
    for panel in &figure.panels {
        for series in &panel.series {
            let sign = Sign::Series(series.style);
            add(&mut entries, &series.label, series.colour, sign);
        }
    }
    for (panel, &sideways) in figure.panels.iter().zip(sideways) {
        add_references(&mut entries, panel, sideways);
    }
    entries
}

fn add_references(entries: &mut Vec<Entry>, panel: &Panel, sideways: bool) {
    for region in &panel.regions {
        add(entries, &region.label, region.colour, Sign::Region);
    }
    let (at_x, at_y) =
        if sideways { (Sign::LevelLine, Sign::UprightLine) } else { (Sign::UprightLine, Sign::LevelLine) };
    for mark in &panel.marks {
        match mark {
            Mark::Vertical { label, colour, .. } => add(entries, label, *colour, at_x),
            Mark::Horizontal { label, colour, .. } => add(entries, label, *colour, at_y),
            Mark::Point { label, colour, .. } => add(entries, label, *colour, Sign::Ring),
        }
    }
}

fn add(entries: &mut Vec<Entry>, label: &str, colour: Colour, sign: Sign) {
    if label.trim().is_empty() {
        return;
    }
    let known = entries.iter_mut().find(|entry| entry.label == label && entry.colour == colour);
    match known {
        Some(entry) if entry.signs.contains(&sign) => {}
        Some(entry) => entry.signs.push(sign),
        None => entries.push(Entry { label: label.to_string(), colour, signs: vec![sign] }),
    }
}

/// Draws the signs of an entry over one another, to the right of `start`: areas, lines, markers.
fn draw_signs(canvas: &mut Canvas, entry: &Entry, start: Xy) {
    let mut signs = entry.signs.clone();
    signs.sort_by_key(|sign| match sign {
        Sign::Region | Sign::Series(Style::Bars) => 0,
        Sign::Series(Style::Markers(_)) | Sign::Ring => 2,
        _ => 1,
    });
    for sign in signs {
        draw_sign(canvas, sign, entry.colour, start);
    }
}

fn draw_sign(canvas: &mut Canvas, sign: Sign, colour: Colour, (x, y): Xy) {
    let ink = Ink::of(colour);
    let (middle, end) = (x + SIGN / 2.0, x + SIGN);
    match sign {
        Sign::Region => mark::shade(canvas, colour, (x + 2.0, y - 6.0), (end - 2.0, y + 6.0)),
        Sign::UprightLine => mark::reference(canvas, colour, (middle, y + 8.0), (middle, y - 8.0)),
        Sign::LevelLine => mark::reference(canvas, colour, (x, y), (end, y)),
        Sign::Ring => mark::ring(canvas, colour, (middle, y)),
        Sign::Series(Style::Bars) => {
            let (from, to) = ((x + 2.0, y - 5.5), (end - 2.0, y + 5.5));
            canvas.rect(from, to, ink);
            let white = Ink::WHITE.faded(0.75);
            canvas.hatch(colour, from, to, 6.0, 1.0, white);
        }
        Sign::Series(style) => {
            canvas.stroke(style, &[(x, y), (end, y)], ink);
            if let Style::Markers(marker) | Style::LineMarkers(marker) = style {
                canvas.marker(marker, (middle, y), ink);
            }
        }
    }
}
