//! A panel: its measures, axes and grid.

use super::canvas::{Anchor, Canvas, Ink};
use super::frame::{Extent, Frame};
use super::look::Look;
use super::ticks::{Direction, Ticks, ticks};
use super::{Axis, Panel, font, mark, range, series};

/// Length of a tick in pixels.
const TICK: f64 = 4.0;
/// Space between a tick and its label.
const GAP: f64 = 4.0;
/// Space to the right of a plot, for half a tick label.
const RIGHT: f64 = 16.0;
/// Share of a panel's width that category labels at its left may take.
const NAMES: f64 = 0.42;

/// A panel with what must be known before it can be placed. Lengths in pixels.
pub(super) struct Plan<'a> {
    panel: &'a Panel,
    look: Look,
    x: Extent,
    y: Extent,
    /// See [`Frame::sideways`].
    pub sideways: bool,
    /// Height of the plot.
    pub height: f64,
    /// Space left of the plot, for tick labels and the axis label.
    pub left: f64,
    /// Lines of the title.
    title: Vec<String>,
    /// Ticks of the upright axis.
    upright: Ticks,
    /// Their labels, broken into lines.
    names: Vec<Vec<String>>,
}

impl<'a> Plan<'a> {
    /// Plans a panel in a cell of `width` pixels, with a plot of `height` pixels unless categories
    /// at its left need more or less.
    pub fn new(panel: &'a Panel, width: f64, height: f64, look: Look) -> Self {
        let lying = panel.lying && !panel.x.categories.is_empty();
        let sideways = lying || !names_fit(&panel.x, 0.85 * width, look.tick);
        let mut plan = Self {
            panel,
            look,
            x: range::of_x(panel),
            y: range::of_y(panel),
            sideways,
            height,
            left: 0.0,
            title: font::wrap(&panel.title, look.panel, 0.9 * width),
            upright: Ticks::default(),
            names: Vec::new(),
        };
        if sideways {
            let sets = panel.series.len().max(1) as f64;
            let row = (10.0 + 9.0 * sets).max(21.0);
            let rows = panel.x.categories.iter();
            let lines = rows.map(|name| font::wrap(name, look.tick, NAMES * width).len().max(1));
            let most = lines.max().unwrap_or(1) as f64;
            let row = row.max(most * font::line_height(look.tick) + 4.0);
            plan.height = row * panel.x.categories.len() as f64;
        }
        plan.measure_left(width);
        plan
    }

    fn measure_left(&mut self, width: f64) {
        let (axis, extent) = self.upright_axis();
        self.upright = ticks(axis, extent, self.height, Direction::Upright, self.look.tick);
        let labels = self.upright.labelled.iter();
        self.names = labels.map(|(_, label)| font::wrap(label, self.look.tick, NAMES * width)).collect();
        let widths = self.names.iter().flatten();
        let widest = widths.map(|line| font::width(line, self.look.tick)).fold(0.0, f64::max);
        let label = font::wrap(&axis.label, self.look.label, self.height).len() as f64;
        self.left = label * font::line_height(self.look.label) + 4.0 + widest + GAP + TICK;
    }

    fn upright_axis(&self) -> (&'a Axis, Extent) {
        if self.sideways { (&self.panel.x, self.x) } else { (&self.panel.y, self.y) }
    }

    fn level_axis(&self) -> (&'a Axis, Extent) {
        if self.sideways { (&self.panel.y, self.y) } else { (&self.panel.x, self.x) }
    }

    /// Height of the title.
    pub fn above(&self) -> f64 {
        if self.title.is_empty() {
            return 6.0;
        }
        self.title.len() as f64 * font::line_height(self.look.panel) + 6.0
    }

    /// Height of the tick labels and the axis label under a plot in a cell of `width` pixels.
    pub fn below(&self, width: f64) -> f64 {
        let (axis, _) = self.level_axis();
        let label = font::wrap(&axis.label, self.look.label, width - self.left).len() as f64;
        TICK + GAP + font::line_height(self.look.tick) + label * font::line_height(self.look.label) + 4.0
    }

    /// Draws the panel with the upper left corner of its plot at `left`, `top`, in a cell that ends
    /// at `end`.
    pub fn draw(&self, canvas: &mut Canvas, left: f64, top: f64, end: f64) {
        let frame = Frame {
            left,
            top,
            width: (end - RIGHT - left).max(20.0),
            height: self.height,
            x: self.x,
            y: self.y,
            sideways: self.sideways,
        };
        let (axis, extent) = self.level_axis();
        let level = ticks(axis, extent, frame.width, Direction::Across, self.look.tick);
        self.draw_grid(canvas, &frame, &level);
        for region in &self.panel.regions {
            mark::region(canvas, &frame, region);
        }
        self.draw_axes(canvas, &frame, &level);
        series::draw_bars(canvas, &frame, self.panel);
        for mark in &self.panel.marks {
            mark::mark(canvas, &frame, mark);
        }
        series::draw(canvas, &frame, self.panel);
        self.draw_titles(canvas, &frame);
    }

    fn draw_grid(&self, canvas: &mut Canvas, frame: &Frame, level: &Ticks) {
        let (upright_axis, upright_extent) = self.upright_axis();
        let (level_axis, level_extent) = self.level_axis();
        let mut row = |at: f64, width: f64, ink: Ink| {
            let y = pixel_of(frame, upright_extent, at, self.sideways);
            canvas.line((frame.left, y), (frame.right(), y), width, ink);
        };
        for &at in &self.upright.minor {
            row(at, 0.6, Ink::FAINT_GRID);
        }
        if upright_axis.categories.is_empty() {
            for (at, _) in &self.upright.labelled {
                row(*at, 0.8, Ink::GRID);
            }
        }
        let mut column = |at: f64, width: f64, ink: Ink| {
            let x = frame.left + level_extent.place(at).nearest() * frame.width;
            canvas.line((x, frame.top), (x, frame.bottom()), width, ink);
        };
        for &at in &level.minor {
            column(at, 0.6, Ink::FAINT_GRID);
        }
        if level_axis.categories.is_empty() {
            for (at, _) in &level.labelled {
                column(*at, 0.8, Ink::GRID);
            }
        }
    }

    fn draw_axes(&self, canvas: &mut Canvas, frame: &Frame, level: &Ticks) {
        let (left, right) = (frame.left, frame.right());
        let (top, bottom) = (frame.top, frame.bottom());
        let ink = Ink::AXIS;
        canvas.line((left, top), (left, bottom), 1.0, ink);
        canvas.line((left, bottom), (right, bottom), 1.0, ink);
        let zero = frame.y.place(0.0);
        if !frame.y.log && zero.is_inside() {
            let share = zero.nearest();
            canvas.line(frame.at(0.0, share), frame.at(1.0, share), 1.0, ink);
        }
        let (_, extent) = self.level_axis();
        for (at, label) in &level.labelled {
            let x = left + extent.place(*at).nearest() * frame.width;
            canvas.line((x, bottom), (x, bottom + TICK), 1.0, ink);
            let baseline = bottom + TICK + GAP + 0.8 * self.look.tick;
            canvas.text(label, (x, baseline), self.look.tick, Anchor::Middle);
        }
        let (_, extent) = self.upright_axis();
        for ((at, _), lines) in self.upright.labelled.iter().zip(&self.names) {
            let y = pixel_of(frame, extent, *at, self.sideways);
            canvas.line((left - TICK, y), (left, y), 1.0, ink);
            let line = font::line_height(self.look.tick);
            let first = y - line * (lines.len() as f64 - 1.0) / 2.0 + 0.36 * self.look.tick;
            for (index, text) in lines.iter().enumerate() {
                let at = (left - TICK - GAP, first + line * index as f64);
                canvas.text(text, at, self.look.tick, Anchor::End);
            }
        }
    }

    fn draw_titles(&self, canvas: &mut Canvas, frame: &Frame) {
        let middle = frame.left + frame.width / 2.0;
        let line = font::line_height(self.look.panel);
        for (index, text) in self.title.iter().rev().enumerate() {
            let baseline = frame.top - 10.0 - line * index as f64;
            // a title wider than its plot may reach over what is left of it, but not out of the panel
            let end = frame.right() + RIGHT - font::width(text, self.look.panel) / 2.0;
            canvas.text(text, (middle.min(end), baseline), self.look.panel, Anchor::Middle);
        }
        let (axis, _) = self.level_axis();
        let line = font::line_height(self.look.label);
        let first = frame.bottom() + TICK + GAP + font::line_height(self.look.tick) + self.look.label;
        let lines = font::wrap(&axis.label, self.look.label, frame.width);
        for (index, text) in lines.iter().enumerate() {
            let at = (middle, first + line * index as f64);
            canvas.text(text, at, self.look.label, Anchor::Middle);
        }
        let (axis, _) = self.upright_axis();
        let lines = font::wrap(&axis.label, self.look.label, self.height);
        for (index, text) in lines.iter().enumerate() {
            let x = frame.left - self.left + self.look.label + line * index as f64;
            let at = (x, frame.top + frame.height / 2.0);
            canvas.upward_text(text, at, self.look.label);
        }
    }
}

/// Vertical pixel of a value on the upright axis; categories of a panel on its side run downwards.
fn pixel_of(frame: &Frame, extent: Extent, value: f64, downwards: bool) -> f64 {
    let share = extent.place(value).nearest();
    if downwards { frame.top + share * frame.height } else { frame.bottom() - share * frame.height }
}

/// Whether the category names of an axis fit beside one another on `width` pixels.
fn names_fit(axis: &Axis, width: f64, em: f64) -> bool {
    let names = axis.categories.iter();
    let widest = names.map(|name| font::width(name, em)).fold(0.0, f64::max);
    (widest + 10.0) * axis.categories.len() as f64 <= width
}
