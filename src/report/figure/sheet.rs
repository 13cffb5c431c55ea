//! The layout of a figure: title, legend, rows of panels, footnote.

use super::Figure;
use super::canvas::{Anchor, Canvas, Ink};
use super::frame::{small_cross, small_triangle};
use super::look::{Arrangement, BETWEEN, Look};
use super::panel::Plan;
use super::{font, legend};

const TITLE_EM: f64 = 17.0;

/// Lays out and draws a figure.
pub(super) fn draw(figure: &Figure, look: Look) -> Canvas {
    let Arrangement { columns, width, height } = look.arrange(figure);
    let gaps = BETWEEN * (columns - 1) as f64;
    let inner = width - 2.0 * look.margin;
    let cell = (inner - gaps) / columns as f64;
    let plans = figure.panels.iter();
    let mut plans: Vec<Plan> = plans.map(|p| Plan::new(p, cell, height, look)).collect();
    align(&mut plans, columns);

    let mut canvas = Canvas { width, look, ..Canvas::default() };
    let title = if look.titled { figure.title.as_str() } else { "" };
    let mut y = draw_title(&mut canvas, title, look.margin);
    let sideways: Vec<bool> = plans.iter().map(|plan| plan.sideways).collect();
    y = legend::draw(&mut canvas, figure, &sideways, look.margin, y, inner) + 12.0;
    for row in plans.chunks(columns) {
        y = draw_row(&mut canvas, row, cell, y);
    }
    y = draw_note(&mut canvas, y);
    canvas.height = (y + look.margin).ceil();
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
    for line in font::wrap(title, TITLE_EM, canvas.width - 2.0 * canvas.look.margin) {
        let at = (canvas.look.margin, y + TITLE_EM);
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
        let start = canvas.look.margin + index as f64 * (cell + BETWEEN);
        plan.draw(canvas, start + plan.left, top + above, start + cell);
        bottom = bottom.max(top + above + plan.height + plan.below(cell));
    }
    bottom + 10.0
}

/// Explains the triangles and crosses at the edges of plots, if there are any.
fn draw_note(canvas: &mut Canvas, top: f64) -> f64 {
    if !canvas.beyond && !canvas.missing {
        return top - 8.0;
    }
    let (em, left) = (canvas.look.note, canvas.look.margin);
    let limit = canvas.width - left - 16.0;
    let (mut x, mut baseline) = (left, top + em);
    if canvas.beyond {
        let middle = baseline - 0.36 * em;
        small_triangle(canvas, (x + 9.0, middle), (1.0, 0.0), Ink::AXIS);
        let text = "beyond the axis: infinite, ≤ 0 on a logarithmic axis, or out of range \
                    (hollow: a curve)";
        let lines = font::wrap(text, em, limit - left);
        for (index, line) in lines.iter().enumerate() {
            baseline += if index > 0 { font::line_height(em) } else { 0.0 };
            canvas.text(line, (left + 16.0, baseline), em, Anchor::Start);
        }
        x += 16.0 + font::width(lines.last().map_or("", String::as_str), em) + 22.0;
    }
    if canvas.missing {
        let text = "not a number";
        if x + font::width(text, em) > limit {
            (x, baseline) = (left, baseline + font::line_height(em));
        }
        small_cross(canvas, (x + 5.0, baseline - 0.36 * em), Ink::AXIS);
        canvas.text(text, (x + 16.0, baseline), em, Anchor::Start);
    }
    baseline + 4.0
}
