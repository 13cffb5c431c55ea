//! Figures for a paper: as wide as its column, with text of a stated size.

use super::look::{Look, PRINT_EM};
use super::{Figure, FigureError, WOFF2, describe, font, paint, pdf, sheet};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// What a figure is made for. Lengths in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Width of the figure.
    pub width: f64,
    /// Size of all text.
    pub font: f64,
}

/// A figure as a paper includes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Printed {
    /// An SVG that carries its font.
    pub svg: String,
    /// A PDF of one page that carries its font.
    pub pdf: Vec<u8>,
    /// Height of both in millimetres.
    pub height: f64,
}

/// Millimetres in an inch.
const INCH: f64 = 25.4;
/// Points of PDF in an inch.
const POINTS: f64 = 72.0;

/// Lays a figure out for a column. Its title is left out, which in a paper is said by the caption; so many panels stand
/// beside one another as there is room for. The same figure gives the same bytes.
///
/// # Errors
///
/// When drawing fails.
pub fn print(figure: &Figure, column: Column) -> Result<Printed, FigureError> {
    font::register()?;
    // whole tenths of a pixel, in which the SVG is drawn
    let pixels = (10.0 * column.width * PRINT_EM / column.font).round() / 10.0;
    let unit = column.width / pixels;
    let canvas = sheet::draw(figure, Look::print(pixels));
    let height = canvas.height * unit;
    let size = (format!("{}mm", column.width), format!("{height}mm"));
    let svg = paint::svg(&canvas, &describe(figure), size)?;
    let font = format!(
        "<style>@font-face{{font-family:'Furnace Sans';src:url(data:font/woff2;base64,{}) format('woff2')}}</style>",
        STANDARD.encode(WOFF2)
    );
    let svg = svg.replacen(">\n", &format!(">\n{font}\n"), 1);
    let pdf = pdf::pdf(&canvas, &figure.title, unit * POINTS / INCH)?;
    Ok(Printed { svg, pdf, height })
}
