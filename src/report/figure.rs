//! Scientific figures: panels of points, curves and bars on linear, logarithmic and category axes,
//! written as SVG and PNG, or as SVG and PDF for a paper.
//!
//! Nothing that cannot be drawn is left out in silence: a value that lies beyond its axis, is
//! infinite, or is not positive on a logarithmic axis becomes a small triangle at the edge of the
//! plot, and a value that is not a number becomes a small cross there. A footnote explains both.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

mod canvas;
mod colour;
mod data;
pub(super) mod font;
mod frame;
mod json;
mod legend;
mod look;
mod mark;
mod paint;
mod panel;
mod pdf;
mod print;
mod range;
mod series;
mod sheet;
mod table;
#[cfg(test)]
mod tests;
mod ticks;

pub use colour::Colour;
pub use data::{Marker, Point, Series, Style};
pub use font::{FAMILY, WOFF2};
pub use json::json;
pub use print::{Column, Printed, print};
pub use table::csv;

use look::Look;

/// A figure: a title, one legend for all panels, and the panels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// Title above the legend. Empty: none.
    pub title: String,
    /// What the figure shows, in words, for those who cannot see it.
    pub alt: String,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row. 0 counts as 1.
    pub columns: usize,
}

/// One plot with its two axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Title above the plot. Empty: none.
    pub title: String,
    /// The horizontal axis. When it has categories whose labels do not fit beside one another,
    /// the whole panel is laid on its side: categories run downwards, values to the right.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Shaded intervals of x.
    pub regions: Vec<Region>,
    /// Reference lines and single points.
    pub marks: Vec<Mark>,
    /// The data, later series above earlier ones.
    pub series: Vec<Series>,
    /// Lay the panel on its side even if the labels of its categories would fit beside one another.
    pub lying: bool,
}

/// An axis of a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// What the axis shows, with the unit.
    pub label: String,
    /// How values are spaced.
    pub scale: Scale,
    /// Lowest and highest value. `None`: taken from the data with some space around it. An end that
    /// is not finite, or not positive on a logarithmic axis, is taken from the data too.
    pub range: Option<(f64, f64)>,
    /// When not empty, the positions 0, 1, 2, … carry these names and the scale is linear.
    pub categories: Vec<String>,
}

impl Axis {
    /// A linear axis whose range is taken from the data.
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_string(), ..Self::default() }
    }

    /// A logarithmic axis whose range is taken from the data.
    pub fn log(label: &str) -> Self {
        Self { label: label.to_string(), scale: Scale::Log, ..Self::default() }
    }

    /// An axis of named positions 0, 1, 2, …
    pub fn categories(label: &str, names: Vec<String>) -> Self {
        Self { label: label.to_string(), categories: names, ..Self::default() }
    }

    /// The same axis from `low` to `high`.
    #[must_use]
    pub fn within(self, low: f64, high: f64) -> Self {
        Self { range: Some((low, high)), ..self }
    }
}

/// How values are spaced along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Equal steps for equal ratios; only values above 0 have a place.
    Log,
}

/// A shaded interval of x over the full height of the plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Lower end. Minus infinity: the edge of the plot.
    pub from: f64,
    /// Upper end. Plus infinity: the edge of the plot.
    pub to: f64,
    /// Name in the legend. Empty: not listed.
    pub label: String,
    /// Colour of the shading, which also settles its hatching.
    pub colour: Colour,
}

/// A reference line or point. An empty label is not listed in the legend.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A line at one x.
    Vertical {
        /// The x of the line.
        at: f64,
        /// Name in the legend.
        label: String,
        /// Colour of the line.
        colour: Colour,
    },
    /// A line at one y.
    Horizontal {
        /// The y of the line.
        at: f64,
        /// Name in the legend.
        label: String,
        /// Colour of the line.
        colour: Colour,
    },
    /// A ringed point, for instance an optimum.
    Point {
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Name in the legend.
        label: String,
        /// Colour of the ring.
        colour: Colour,
    },
}

/// Why a figure was not written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The embedded font cannot be read.
    #[error("the font built into the program cannot be read")]
    Font,
    /// Drawing failed.
    #[error("drawing the figure failed: {0}")]
    Draw(String),
    /// A file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        source: io::Error,
    },
}

/// Writes `stem`.svg, `stem`.png (two pixels to the unit of the SVG) and `stem`.csv with the numbers. The directory must
/// exist.
///
/// # Errors
///
/// When drawing fails or a file cannot be written.
pub fn write(figure: &Figure, stem: &Path) -> Result<(), FigureError> {
    save(with_ending(stem, ".svg"), svg(figure)?.as_bytes())?;
    save(with_ending(stem, ".png"), &paint::png(&sheet::draw(figure, Look::SCREEN))?)?;
    save(with_ending(stem, ".csv"), &csv(figure))
}

fn save(path: PathBuf, bytes: &[u8]) -> Result<(), FigureError> {
    fs::write(&path, bytes).map_err(|source| FigureError::Write { path, source })
}

/// Draws the figure as SVG, without writing a file. The text is the same for the same figure.
///
/// # Errors
///
/// When drawing fails.
pub fn svg(figure: &Figure) -> Result<String, FigureError> {
    font::register()?;
    let canvas = sheet::draw(figure, Look::SCREEN);
    let size = (canvas.width.to_string(), canvas.height.to_string());
    paint::svg(&canvas, &describe(figure), size)
}

/// The text alternative of a figure.
fn describe(figure: &Figure) -> String {
    let words = [figure.title.trim(), figure.alt.trim()];
    let description = words.map(|text| text.trim_end_matches('.')).join(". ");
    description.trim_matches(['.', ' ']).to_owned()
}

/// Appends an ending; `Path::with_extension` would cut "q=0.5" at the point.
fn with_ending(stem: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(stem);
    name.push(ending);
    PathBuf::from(name)
}
