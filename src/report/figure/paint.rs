//! Painting a list of shapes with plotters.
//!
//! plotters places everything on whole pixels, so both forms are drawn larger: the SVG in tenths of
//! a pixel, the PNG at four times its nominal size and then halved, which also smooths the edges
//! that plotters leaves rough.

use super::FigureError;
use super::canvas::{Anchor, Canvas, Ink, Shape, Xy};
use super::font::{FAMILY, SIZE_OF_EM};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Display;

/// How a form is drawn.
#[derive(Clone, Copy)]
struct Form {
    /// Pixels of the backend to a pixel of the figure.
    unit: f64,
    /// How far the backend puts the baseline below the position of text anchored at the top, in em.
    drop: f64,
    /// Whether thick lines must be put together from pieces: where a line bends sharply, the
    /// outline that plotters makes for bitmaps has spikes and holes.
    pieces: bool,
}

const SVG: Form = Form { unit: 10.0, drop: 0.76, pieces: false };
const PNG: Form = Form { unit: 4.0, drop: SIZE_OF_EM / 2.0, pieces: true };

/// The canvas as SVG text of this width and height. `description`: the text alternative.
pub(super) fn svg(canvas: &Canvas, description: &str, size: (String, String)) -> Result<String, FigureError> {
    let mut text = String::new();
    let (width, height) = pixels(canvas, SVG.unit);
    {
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        paint(&area, canvas, SVG)?;
        area.present().map_err(draw_error)?;
    }
    // the opening tag of plotters knows neither the nominal size nor the description
    let inside = text.split_once(">\n").map_or("", |(_, inside)| inside);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\" \
         stroke-linejoin=\"round\">\n{inside}",
        size.0,
        size.1,
        escape(description),
    ))
}

/// The canvas as a PNG file, two pixels to a pixel of the figure.
pub(super) fn png(canvas: &Canvas) -> Result<Vec<u8>, FigureError> {
    let (width, height) = pixels(canvas, PNG.unit);
    let mut large = vec![0xFF; 3 * width as usize * height as usize];
    {
        let area = BitMapBackend::with_buffer(&mut large, (width, height)).into_drawing_area();
        paint(&area, canvas, PNG)?;
        area.present().map_err(draw_error)?;
    }
    let small = halve(&large, width as usize);
    encode(&small, width / 2, height / 2).map_err(draw_error)
}

/// The file of an RGB image. plotters would write it too, but four times as large.
fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}

/// The image at half its width and height, each pixel the mean of four.
fn halve(large: &[u8], width: usize) -> Vec<u8> {
    let row = 3 * width;
    let mut small = Vec::with_capacity(large.len() / 4);
    for two_rows in large.chunks_exact(2 * row) {
        for x in 0..width / 2 {
            for channel in 0..3 {
                let first = 6 * x + channel;
                let four = [first, first + 3, first + row, first + row + 3];
                let sum: u32 = four.iter().map(|&at| u32::from(two_rows[at])).sum();
                small.push(((sum + 2) / 4) as u8);
            }
        }
    }
    small
}

fn pixels(canvas: &Canvas, unit: f64) -> (u32, u32) {
    ((canvas.width * unit).round() as u32, (canvas.height * unit).round() as u32)
}

fn draw_error(error: impl Display) -> FigureError {
    FigureError::Draw(error.to_string())
}

fn escape(text: &str) -> String {
    text.replace(|letter: char| letter.is_control(), " ")
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn paint<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    canvas: &Canvas,
    form: Form,
) -> Result<(), FigureError> {
    area.fill(&WHITE).map_err(draw_error)?;
    for shape in &canvas.shapes {
        paint_shape(area, shape, form).map_err(draw_error)?;
    }
    Ok(())
}

fn paint_shape<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    shape: &Shape,
    form: Form,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let at = |point: &Xy| pixel(*point, form.unit);
    match shape {
        Shape::Rect { from, to, ink } => {
            let corners = [at(from), at(to)];
            area.draw(&Rectangle::new(corners, colour(*ink).filled()))
        }
        Shape::Polygon { points, ink } => {
            let corners: Vec<_> = points.iter().map(at).collect();
            area.draw(&Polygon::new(corners, colour(*ink)))
        }
        Shape::Disc { centre, radius, ink } => {
            let radius = (radius * form.unit).round() as i32;
            area.draw(&Circle::new(at(centre), radius, colour(*ink).filled()))
        }
        Shape::Path { points, width, ink } => {
            let mut corners: Vec<_> = points.iter().map(at).collect();
            corners.dedup();
            let width = (width * form.unit).round().max(1.0) as u32;
            stroke(area, corners, width, colour(*ink), form.pieces)
        }
        Shape::Text { .. } => paint_text(area, shape, form),
    }
}

/// Draws a polyline; `pieces`: each part by itself, with a disc over each joint.
fn stroke<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    corners: Vec<(i32, i32)>,
    width: u32,
    colour: RGBAColor,
    pieces: bool,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let style = colour.stroke_width(width);
    if !pieces || corners.len() < 3 {
        return area.draw(&PathElement::new(corners, style));
    }
    for pair in corners.windows(2) {
        area.draw(&PathElement::new(pair.to_vec(), style))?;
    }
    let radius = (width / 2) as i32;
    for &joint in &corners[1..corners.len() - 1] {
        area.draw(&Circle::new(joint, radius, colour.filled()))?;
    }
    Ok(())
}

fn paint_text<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    shape: &Shape,
    form: Form,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let Shape::Text { text, at, em, anchor, upward, ink } = shape else {
        return Ok(());
    };
    let side = match anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    // plotters puts the position above the baseline; for upward text, above is to the left
    let drop = form.drop * em;
    let (turn, position) = if *upward {
        (FontTransform::Rotate270, (at.0 - drop, at.1))
    } else {
        (FontTransform::None, (at.0, at.1 - drop))
    };
    let font = (FAMILY, em * form.unit * SIZE_OF_EM).into_font();
    let colour = colour(*ink);
    let style = TextStyle::from(font.transform(turn)).color(&colour).pos(Pos::new(side, VPos::Top));
    area.draw(&Text::new(text.as_str(), pixel(position, form.unit), style))
}

fn pixel((x, y): Xy, unit: f64) -> (i32, i32) {
    ((x * unit).round() as i32, (y * unit).round() as i32)
}

fn colour(ink: Ink) -> RGBAColor {
    let (red, green, blue) = ink.rgb;
    RGBAColor(red, green, blue, ink.alpha)
}
