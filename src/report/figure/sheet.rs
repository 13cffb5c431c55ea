//! The layout of a figure: title, legend, rows of panels, footnote.

use super::Figure;
use super::canvas::{Anchor, Canvas, Ink};
use super::frame::{small_cross, small_triangle};
use super::panel::Plan;
use super::{font, legend};

/// Space around the figure in pixels.
const MARGIN: f64 = 14.0;
/// Space between panels.
const BETWEEN: f64 = 14.0;
const TITLE_EM: f64 = 17.0;
const NOTE_EM: f64 = 11.5;

/// Lays out and draws a figure.
pub(super) fn draw(figure: &Figure) -> Canvas {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let (width, height) = match columns {
        1 => (780.0, 360.0),
        2 => (1060.0, 320.0),
        more => (60.0 + 390.0 * more as f64, 290.0),
    };
    let gaps = BETWEEN * (columns - 1) as f64;
    let cell = (width - 2.0 * MARGIN - gaps) / columns as f64;
    let plans = figure.panels.iter();
    let mut plans: Vec<Plan> = plans.map(|p| Plan::new(p, cell, height)).collect();
    align(&mut plans, columns);

    let mut canvas = Canvas { width, ..Canvas::default() };
    let mut y = draw_title(&mut canvas, &figure.title, MARGIN);
    let sideways: Vec<bool> = plans.iter().map(|plan| plan.sideways).collect();
    let inner = width - 2.0 * MARGIN;
    y = legend::draw(&mut canvas, figure, &sideways, MARGIN, y, inner) + 12.0;
    for row in plans.chunks(columns) {
        y = draw_row(&mut canvas, row, cell, y);
    }
    y = draw_note(&mut canvas, y);
    canvas.height = (y + MARGIN).ceil();
    canvas
}

/// Lines up the plots of each column at the left.
fn align(plans: &mut [Plan], columns: usize) {
    for column in 0..columns {
        let lefts = plans.iter().skip(column).step_by(columns);
        let left = lefts.map(|plan| plan.left).fold(0.0, f64::max);
        for plan in plans.iter_mut().skip(column).step_by(columns) {
            plan.left = left;
        }
    }
}

fn draw_title(canvas: &mut Canvas, title: &str, top: f64) -> f64 {
    let mut y = top;
    for line in font::wrap(title, TITLE_EM, canvas.width - 2.0 * MARGIN) {
        let at = (MARGIN, y + TITLE_EM);
        canvas.text(&line, at, TITLE_EM, Anchor::Start);
        y += font::line_height(TITLE_EM);
    }
    if y > top { y + 6.0 } else { y }
}

/// Draws a row of panels from `top` and returns where it ends.
fn draw_row(canvas: &mut Canvas, row: &[Plan], cell: f64, top: f64) -> f64 {
    let above = row.iter().map(Plan::above).fold(0.0, f64::max);
    let mut bottom = top;
    for (index, plan) in row.iter().enumerate() {
        let start = MARGIN + index as f64 * (cell + BETWEEN);
        plan.draw(canvas, start + plan.left, top + above, start + cell);
        bottom = bottom.max(top + above + plan.height + plan.below(cell));
    }
    bottom + 10.0
}

/// Explains the triangles and crosses at the edges of plots, if there are any.
fn draw_note(canvas: &mut Canvas, top: f64) -> f64 {
    let baseline = top + NOTE_EM;
    let middle = baseline - 0.36 * NOTE_EM;
    let mut x = MARGIN;
    if canvas.beyond {
        small_triangle(canvas, (x + 9.0, middle), (1.0, 0.0), Ink::AXIS);
        let text = "beyond the axis: infinite, ≤ 0 on a logarithmic axis, or out of range \
                    (hollow: a curve)";
        canvas.text(text, (x + 16.0, baseline), NOTE_EM, Anchor::Start);
        x += 16.0 + font::width(text, NOTE_EM) + 22.0;
    }
    if canvas.missing {
        small_cross(canvas, (x + 5.0, middle), Ink::AXIS);
        canvas.text("not a number", (x + 16.0, baseline), NOTE_EM, Anchor::Start);
    }
    if canvas.beyond || canvas.missing { baseline + 4.0 } else { top - 8.0 }
}
