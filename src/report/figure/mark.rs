//! Drawing regions and marks.

use super::canvas::{Canvas, Ink, Xy};
use super::frame::{Frame, Place};
use super::{Colour, Mark, Region};

/// Shades a region over the full height of the plot.
pub(super) fn region(canvas: &mut Canvas, frame: &Frame, region: &Region) {
    let (from, to) = (frame.x.place(region.from), frame.x.place(region.to));
    if from == Place::Nowhere || to == Place::Nowhere {
        frame.flag(canvas, Place::Nowhere, Place::Inside(0.0), region.colour, false);
        return;
    }
    if from.nearest() == to.nearest() {
        // a region that is wholly beyond the axis
        frame.flag(canvas, from, Place::Inside(0.5), region.colour, false);
        return;
    }
    let corner = frame.at(from.nearest(), 0.0);
    shade(canvas, region.colour, corner, frame.at(to.nearest(), 1.0));
}

/// A pale hatched rectangle.
pub(super) fn shade(canvas: &mut Canvas, colour: Colour, from: Xy, to: Xy) {
    let ink = Ink::of(colour);
    canvas.rect(from, to, ink.faded(0.13));
    canvas.hatch(colour, from, to, 9.0, 0.7, ink.faded(0.32));
}

/// Draws a mark, or flags it when it lies beyond the axes.
pub(super) fn mark(canvas: &mut Canvas, frame: &Frame, mark: &Mark) {
    match *mark {
        Mark::Vertical { at, colour, .. } => match frame.x.place(at) {
            Place::Inside(x) => reference(canvas, colour, frame.at(x, 0.0), frame.at(x, 1.0)),
            beyond => frame.flag(canvas, beyond, Place::Inside(0.5), colour, false),
        },
        Mark::Horizontal { at, colour, .. } => match frame.y.place(at) {
            Place::Inside(y) => reference(canvas, colour, frame.at(0.0, y), frame.at(1.0, y)),
            beyond => frame.flag(canvas, Place::Inside(0.5), beyond, colour, false),
        },
        Mark::Point { x, y, colour, .. } => match (frame.x.place(x), frame.y.place(y)) {
            (Place::Inside(x), Place::Inside(y)) => ring(canvas, colour, frame.at(x, y)),
            (x, y) => frame.flag(canvas, x, y, colour, false),
        },
    }
}

/// A thin line with a long dash, unlike the patterns of curves.
pub(super) fn reference(canvas: &mut Canvas, colour: Colour, from: Xy, to: Xy) {
    canvas.dashes(&[from, to], &[14.0, 3.0], 1.2, Ink::of(colour));
}

/// A ring around a dot.
pub(super) fn ring(canvas: &mut Canvas, colour: Colour, at: Xy) {
    let ink = Ink::of(colour);
    for (radius, ink) in [(7.5, Ink::WHITE), (6.5, ink), (4.9, Ink::WHITE), (2.2, ink)] {
        canvas.disc(at, radius * canvas.look.weight, ink);
    }
}
