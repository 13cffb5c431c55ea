//! The font of the figures, and the width of text in it.

use super::FigureError;
use plotters::prelude::{BLACK, BitMapBackend, IntoDrawingArea};
use plotters::style::{FontStyle, IntoFont, register_font};
use std::sync::OnceLock;

/// The font as WOFF2, for the `@font-face` of a page that shows the SVG; its family is
/// "Furnace Sans".
pub const WOFF2: &[u8] =
    include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/fonts/FurnaceSans.woff2"));

pub(super) const TTF: &[u8] =
    include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/fonts/FurnaceSans.ttf"));

/// What text in the SVG asks for: our font, else its parent, which is as wide, else any.
/// plotters takes the whole list as one name.
pub const FAMILY: &str = "Furnace Sans, DejaVu Sans, Verdana, sans-serif";

/// plotters sets text of size n with n / 1.24 pixels to the em. The line height in our font file is
/// 1.24 em, so that this holds for bitmaps too.
pub(super) const SIZE_OF_EM: f64 = 1.24;

/// Makes the font known to plotters; later calls do nothing.
pub fn register() -> Result<(), FigureError> {
    static DONE: OnceLock<bool> = OnceLock::new();
    let known = DONE.get_or_init(|| register_font(FAMILY, FontStyle::Normal, TTF).is_ok());
    if *known { Ok(()) } else { Err(FigureError::Font) }
}

/// Width of a line of text in pixels when the em is `em` pixels.
pub fn width(text: &str, em: f64) -> f64 {
    // plotters returns whole pixels: measure at 1000 pixels to the em
    let font = (FAMILY, 1000.0 * SIZE_OF_EM).into_font();
    let right = font.layout_box(text).map_or(0, |(_, (right, _))| right);
    f64::from(right) * em / 1000.0
}

/// Writes a line of black text, 12 pixels to the em, into a bitmap of this size; its top left corner is at `at`.
pub fn write(bitmap: &mut [u8], size: (usize, usize), at: (f64, f64), text: &str) {
    let area = BitMapBackend::with_buffer(bitmap, (size.0 as u32, size.1 as u32)).into_drawing_area();
    let font = (FAMILY, 12.0 * SIZE_OF_EM).into_font();
    // a label that cannot be drawn is no reason to lose the results
    let _ = area.draw_text(text, &font.color(&BLACK), (at.0 as i32, at.1 as i32));
}

/// Height from one line of text to the next.
pub(super) fn line_height(em: f64) -> f64 {
    1.35 * em
}

/// Breaks text at spaces, and within words that are too long, into lines of at most `limit` pixels.
/// Text of spaces only has no lines.
pub(super) fn wrap(text: &str, em: f64, limit: f64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in words(text, em, limit) {
        let longer = if line.is_empty() { word.clone() } else { format!("{line} {word}") };
        if width(&longer, em) <= limit {
            line = longer;
            continue;
        }
        if !line.is_empty() {
            lines.push(line);
        }
        line = break_word(&word, em, limit, &mut lines);
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// What spaces separate; a unit in brackets stays together if it fits on a line.
fn words(text: &str, em: f64, limit: f64) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match words.last_mut().filter(|unit| unit.starts_with('[') && !unit.ends_with(']')) {
            Some(unit) if width(&format!("{unit} {word}"), em) <= limit => *unit = format!("{unit} {word}"),
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Moves full lines of an overlong word to `lines` and returns what is left.
fn break_word(word: &str, em: f64, limit: f64, lines: &mut Vec<String>) -> String {
    let mut rest = String::new();
    for letter in word.chars() {
        rest.push(letter);
        if width(&rest, em) > limit && rest.chars().count() > 1 {
            rest.pop();
            lines.push(std::mem::replace(&mut rest, letter.to_string()));
        }
    }
    rest
}
