//! The data of a panel.

use super::Colour;

/// A set of points drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; series with the same label and colour share one entry. Empty: not listed.
    pub label: String,
    /// Colour of lines, markers and bars; also settles the hatching of bars.
    pub colour: Colour,
    /// Shape of what is drawn.
    pub style: Style,
    /// The points, in the order in which a line joins them.
    pub points: Vec<Point>,
}

/// How a series is drawn. Give series of one panel different styles as well as different colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// A solid line, broken where a point has no place.
    Line,
    /// A dashed line.
    Dashed,
    /// A dotted line.
    Dotted,
    /// A line of dashes and dots.
    DashDotted,
    /// Markers only.
    Markers(Marker),
    /// A thin solid line with markers.
    LineMarkers(Marker),
    /// Bars from 0, or from the lower edge on a logarithmic axis.
    Bars,
}

/// The shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// A disc.
    Circle,
    /// A square.
    Square,
    /// A triangle on its base.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// A diagonal cross.
    Cross,
}

impl Marker {
    /// The marker for the series with this index; starts again after five.
    pub fn nth(index: usize) -> Self {
        const ALL: [Marker; 5] =
            [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross];
        ALL[index % ALL.len()]
    }
}

/// A point with an error bar from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Horizontal position; the index of the category on a category axis.
    pub x: f64,
    /// Value.
    pub y: f64,
    /// Lower end of the error bar. `y` or NaN: none.
    pub low: f64,
    /// Upper end of the error bar. `y` or NaN: none.
    pub high: f64,
}

impl Point {
    /// A point without error bar.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, low: y, high: y }
    }

    /// A point with an error bar from `low` to `high`.
    pub fn between(x: f64, y: f64, low: f64, high: f64) -> Self {
        Self { x, y, low, high }
    }
}
