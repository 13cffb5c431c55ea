//! Painting a list of shapes as a PDF of one page, whose text stays text in the embedded font.

use super::FigureError;
use super::canvas::{Anchor, Canvas, Ink, Shape, Xy};
use super::font;
use krilla::Document;
use krilla::SerializeSettings;
use krilla::color::rgb;
use krilla::configure::{Configuration, PdfVersion};
use krilla::geom::{Path, PathBuilder, Point, Transform};
use krilla::metadata::Metadata;
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, LineJoin, Stroke};
use krilla::surface::Surface;
use krilla::text::{Font, TextDirection};

/// Control points of the cubic curve nearest to a quarter of a circle of radius 1.
const KAPPA: f64 = 0.552_284_75;

/// The canvas as a PDF, `unit` points (1/72 inch) to a pixel. The same canvas gives the same bytes: no date is written,
/// and the file's identifier is a digest of its content.
pub(super) fn pdf(canvas: &Canvas, title: &str, unit: f64) -> Result<Vec<u8>, FigureError> {
    let failed = |why: &str| FigureError::Draw(why.to_owned());
    // the newest that pdfTeX includes without a warning
    let configuration = Configuration::new_with_version(PdfVersion::Pdf15);
    let settings = SerializeSettings { configuration, xmp_metadata: false, ..SerializeSettings::default() };
    let mut document = Document::new_with(settings);
    document.set_metadata(Metadata::new().title(title.replace(char::is_control, " ")));
    let font = Font::new(font::TTF.to_vec().into(), 0).ok_or(FigureError::Font)?;
    let (width, height) = (canvas.width * unit, canvas.height * unit);
    let settings = PageSettings::from_wh(width as f32, height as f32);
    let mut page = document.start_page_with(settings.ok_or_else(|| failed("the page has no size"))?);
    let mut surface = page.surface();
    surface.push_transform(&Transform::from_scale(unit as f32, unit as f32));
    for shape in &canvas.shapes {
        paint(&mut surface, shape, &font);
    }
    surface.pop();
    surface.finish();
    page.finish();
    document.finish().map_err(|e| failed(&format!("{e:?}")))
}

fn paint(surface: &mut Surface<'_>, shape: &Shape, font: &Font) {
    match shape {
        Shape::Rect { from, to, ink } => {
            let corners = [*from, (to.0, from.1), *to, (from.0, to.1)];
            fill(surface, polyline(&corners, true), *ink);
        }
        Shape::Polygon { points, ink } => fill(surface, polyline(points, true), *ink),
        Shape::Disc { centre, radius, ink } => fill(surface, circle(*centre, *radius), *ink),
        Shape::Path { points, width, ink } => {
            surface.set_fill(None);
            surface.set_stroke(Some(Stroke {
                paint: colour(*ink).into(),
                width: *width as f32,
                opacity: opacity(*ink),
                line_join: LineJoin::Round,
                ..Stroke::default()
            }));
            if let Some(path) = polyline(points, false) {
                surface.draw_path(&path);
            }
        }
        Shape::Text { text, at, em, anchor, upward, ink } => {
            let width = font::width(text, *em);
            let start = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => -0.5 * width,
                Anchor::End => -width,
            };
            let turn = if *upward { -90.0 } else { 0.0 };
            pen(surface, *ink);
            surface.push_transform(&Transform::from_translate(at.0 as f32, at.1 as f32));
            surface.push_transform(&Transform::from_rotate(turn));
            let start = Point::from_xy(start as f32, 0.0);
            surface.draw_text(start, font.clone(), *em as f32, text, false, TextDirection::LeftToRight);
            surface.pop();
            surface.pop();
        }
    }
}

/// Fills with a colour, and draws no outline.
fn pen(surface: &mut Surface<'_>, ink: Ink) {
    surface.set_stroke(None);
    surface.set_fill(Some(Fill { paint: colour(ink).into(), opacity: opacity(ink), ..Fill::default() }));
}

fn fill(surface: &mut Surface<'_>, path: Option<Path>, ink: Ink) {
    pen(surface, ink);
    if let Some(path) = path {
        surface.draw_path(&path);
    }
}

fn polyline(points: &[Xy], closed: bool) -> Option<Path> {
    let (first, rest) = points.split_first()?;
    let mut path = PathBuilder::new();
    path.move_to(first.0 as f32, first.1 as f32);
    for (x, y) in rest {
        path.line_to(*x as f32, *y as f32);
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn circle((x, y): Xy, radius: f64) -> Option<Path> {
    let mut path = PathBuilder::new();
    let at = |(dx, dy): Xy| ((x + radius * dx) as f32, (y + radius * dy) as f32);
    let start = at((1.0, 0.0));
    path.move_to(start.0, start.1);
    let (mut from, mut to) = ((1.0, 0.0), (0.0, 1.0));
    for _ in 0..4 {
        let one = at((from.0 + KAPPA * to.0, from.1 + KAPPA * to.1));
        let two = at((to.0 + KAPPA * from.0, to.1 + KAPPA * from.1));
        let end = at(to);
        path.cubic_to(one.0, one.1, two.0, two.1, end.0, end.1);
        (from, to) = (to, (-from.0, -from.1));
    }
    path.close();
    path.finish()
}

fn colour(ink: Ink) -> rgb::Color {
    let (red, green, blue) = ink.rgb;
    rgb::Color::new(red, green, blue)
}

fn opacity(ink: Ink) -> NormalizedF32 {
    NormalizedF32::new(ink.alpha as f32).unwrap_or(NormalizedF32::ONE)
}
