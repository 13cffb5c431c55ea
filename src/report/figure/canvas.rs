//! A list of shapes to paint, in pixels from the upper left corner, the later above the earlier.

use super::look::Look;
use super::{Colour, Marker, Style};

/// A position in pixels, x to the right and y downwards.
pub(super) type Xy = (f64, f64);

/// A colour with opacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ink {
    pub rgb: (u8, u8, u8),
    pub alpha: f64,
}

impl Ink {
    pub const WHITE: Self = Self::grey(0xFF);
    pub const TEXT: Self = Self::grey(0x26);
    pub const AXIS: Self = Self::grey(0x50);
    pub const GRID: Self = Self::grey(0xDA);
    pub const FAINT_GRID: Self = Self::grey(0xEE);

    const fn grey(level: u8) -> Self {
        Self { rgb: (level, level, level), alpha: 1.0 }
    }

    pub fn of(colour: Colour) -> Self {
        Self { rgb: colour.rgb(), alpha: 1.0 }
    }

    pub fn faded(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }
}

/// Which part of a line of text stands at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Rect {
        from: Xy,
        to: Xy,
        ink: Ink,
    },
    Path {
        points: Vec<Xy>,
        width: f64,
        ink: Ink,
    },
    Polygon {
        points: Vec<Xy>,
        ink: Ink,
    },
    Disc {
        centre: Xy,
        radius: f64,
        ink: Ink,
    },
    /// Text on a baseline through `at`; `upward`: read from bottom to top.
    Text {
        text: String,
        at: Xy,
        em: f64,
        anchor: Anchor,
        upward: bool,
        ink: Ink,
    },
}

/// The shapes of a figure and its size in pixels.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Canvas {
    pub width: f64,
    pub height: f64,
    pub look: Look,
    pub shapes: Vec<Shape>,
    /// Some value lies beyond its axis.
    pub beyond: bool,
    /// Some value is not a number.
    pub missing: bool,
    /// Where such values have been flagged.
    pub flags: Vec<Xy>,
}

/// Radius of a marker in pixels.
const RADIUS: f64 = 4.0;

impl Canvas {
    pub fn line(&mut self, from: Xy, to: Xy, width: f64, ink: Ink) {
        self.path(vec![from, to], width, ink);
    }

    pub fn path(&mut self, points: Vec<Xy>, width: f64, ink: Ink) {
        let width = width * self.look.weight;
        self.shapes.push(Shape::Path { points, width, ink });
    }

    pub fn rect(&mut self, from: Xy, to: Xy, ink: Ink) {
        let low = (from.0.min(to.0), from.1.min(to.1));
        let high = (from.0.max(to.0), from.1.max(to.1));
        let (from, to) = (low, high);
        self.shapes.push(Shape::Rect { from, to, ink });
    }

    pub fn disc(&mut self, centre: Xy, radius: f64, ink: Ink) {
        self.shapes.push(Shape::Disc { centre, radius, ink });
    }

    pub fn polygon(&mut self, points: Vec<Xy>, ink: Ink) {
        self.shapes.push(Shape::Polygon { points, ink });
    }

    pub fn text(&mut self, text: &str, at: Xy, em: f64, anchor: Anchor) {
        self.write(text, at, em, anchor, false);
    }

    /// Text read from bottom to top, with its middle at `at`.
    pub fn upward_text(&mut self, text: &str, at: Xy, em: f64) {
        self.write(text, at, em, Anchor::Middle, true);
    }

    fn write(&mut self, text: &str, at: Xy, em: f64, anchor: Anchor, upward: bool) {
        // control characters are not allowed in XML
        let text = text.replace(|letter: char| letter.is_control(), " ");
        self.shapes.push(Shape::Text { text, at, em, anchor, upward, ink: Ink::TEXT });
    }

    /// A marker with a thin white rim, which keeps it apart from lines under it.
    pub fn marker(&mut self, marker: Marker, at: Xy, ink: Ink) {
        let radius = RADIUS * self.look.weight;
        self.bare_marker(marker, at, radius + 1.0, 3.4, Ink::WHITE);
        self.bare_marker(marker, at, radius, 2.0, ink);
    }

    fn bare_marker(&mut self, marker: Marker, (x, y): Xy, r: f64, stroke: f64, ink: Ink) {
        let s = 0.88 * r;
        match marker {
            Marker::Circle => self.disc((x, y), r, ink),
            Marker::Square => self.rect((x - s, y - s), (x + s, y + s), ink),
            Marker::Triangle => {
                let (half, up, down) = (1.13 * r, 1.2 * r, 0.78 * r);
                let corners = vec![(x, y - up), (x + half, y + down), (x - half, y + down)];
                self.polygon(corners, ink);
            }
            Marker::Diamond => {
                let d = 1.25 * r;
                let corners = vec![(x, y - d), (x + d, y), (x, y + d), (x - d, y)];
                self.polygon(corners, ink);
            }
            Marker::Cross => {
                self.line((x - s, y - s), (x + s, y + s), stroke, ink);
                self.line((x - s, y + s), (x + s, y - s), stroke, ink);
            }
        }
    }

    /// A polyline in the pattern of the style; styles without a line draw none.
    pub fn stroke(&mut self, style: Style, points: &[Xy], ink: Ink) {
        match style {
            Style::Line => self.path(points.to_vec(), 1.8, ink),
            Style::LineMarkers(_) => self.path(points.to_vec(), 1.3, ink),
            Style::Dashed => self.dashes(points, &[7.0, 4.0], 1.8, ink),
            Style::Dotted => self.dashes(points, &[1.8, 2.6], 1.8, ink),
            Style::DashDotted => self.dashes(points, &[9.0, 3.0, 1.8, 3.0], 1.8, ink),
            Style::Markers(_) | Style::Bars => {}
        }
    }

    /// A polyline cut into dashes: `pattern` holds lengths in pixels, drawn and left out in turn.
    pub fn dashes(&mut self, points: &[Xy], pattern: &[f64], width: f64, ink: Ink) {
        let Some(&first) = points.first() else { return };
        let (mut part, mut left) = (0, pattern[0]);
        let mut dash = vec![first];
        for pair in points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            let mut done = 0.0;
            while length - done > left {
                done += left;
                let share = done / length;
                let at = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
                dash.push(at);
                if part % 2 == 0 {
                    self.path(dash, width, ink);
                }
                dash = vec![at];
                part = (part + 1) % pattern.len();
                left = pattern[part];
            }
            left -= length - done;
            dash.push(to);
        }
        if part % 2 == 0 && dash.len() > 1 {
            self.path(dash, width, ink);
        }
    }

    /// Diagonal lines over a rectangle, `apart` pixels from one another along its sides.
    pub fn hatch(&mut self, colour: Colour, from: Xy, to: Xy, apart: f64, width: f64, ink: Ink) {
        let (left, right) = (from.0.min(to.0), from.0.max(to.0));
        let (top, bottom) = (from.1.min(to.1), from.1.max(to.1));
        let (upwards, downwards) = colour.hatch();
        let (w, h) = (right - left, bottom - top);
        let count = ((w + h) / apart).ceil() as usize;
        for index in 0..count {
            let t = (index as f64 + 0.5) * apart;
            // the line x + y = t within a box of w times h
            let (x0, x1) = ((t - h).max(0.0), t.min(w));
            if x1 <= x0 {
                continue;
            }
            if upwards {
                let start = (left + x0, top + t - x0);
                self.line(start, (left + x1, top + t - x1), width, ink);
            }
            if downwards {
                let start = (left + x0, bottom - t + x0);
                self.line(start, (left + x1, bottom - t + x1), width, ink);
            }
        }
    }
}
