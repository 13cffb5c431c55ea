//! Drawing the data of a panel.

use super::canvas::{Canvas, Ink, Xy};
use super::frame::{Frame, Place};
use super::{Colour, Panel, Point, Series, Style};

/// Share of the space between categories that bars and markers use.
const USED: f64 = 0.76;

/// Distance in pixels below which the flags of a curve are not repeated.
const FLAG_DISTANCE: f64 = 28.0;

/// A series with its place beside the others on a category axis.
struct Drawn<'a> {
    series: &'a Series,
    /// Shift in x.
    shift: f64,
    /// Width of a bar in x.
    width: f64,
}

/// Draws the bars, which lie below the marks.
pub(super) fn draw_bars(canvas: &mut Canvas, frame: &Frame, panel: &Panel) {
    for drawn in side_by_side(panel) {
        if drawn.series.style == Style::Bars {
            bars(canvas, frame, &drawn);
        }
    }
}

/// Draws the curves, above them error bars and markers, and the flags of all series on top.
pub(super) fn draw(canvas: &mut Canvas, frame: &Frame, panel: &Panel) {
    let all = side_by_side(panel);
    for drawn in &all {
        if is_curve(drawn.series.style) {
            curve(canvas, frame, drawn.series);
        }
    }
    for drawn in &all {
        let points = &drawn.series.points;
        for point in points.iter().filter(|point| has_bar(point)) {
            error_bar(canvas, frame, drawn, point);
        }
    }
    for drawn in &all {
        if let Style::Markers(marker) | Style::LineMarkers(marker) = drawn.series.style {
            for point in &drawn.series.points {
                let (x, y) = place(frame, drawn, point);
                if let (Place::Inside(x), Place::Inside(y)) = (x, y) {
                    let ink = Ink::of(drawn.series.colour);
                    canvas.marker(marker, frame.at(x, y), ink);
                }
            }
        }
    }
    for drawn in &all {
        flags(canvas, frame, drawn);
    }
}

fn is_curve(style: Style) -> bool {
    !matches!(style, Style::Markers(_) | Style::Bars)
}

fn has_bar(point: &Point) -> bool {
    point.low < point.y || point.high > point.y
}

/// Gives each series of bars or markers its own place within a category.
fn side_by_side(panel: &Panel) -> Vec<Drawn<'_>> {
    let beside = |series: &Series| match series.style {
        Style::Bars | Style::Markers(_) => !panel.x.categories.is_empty(),
        _ => false,
    };
    let count = panel.series.iter().filter(|series| beside(series)).count();
    let slot = USED / count.max(1) as f64;
    let mut index = 0;
    let mut place = |series| {
        if !beside(series) {
            return 0.0;
        }
        index += 1;
        (index as f64 - 0.5 - count as f64 / 2.0) * slot
    };
    let all = panel.series.iter().map(|series| Drawn {
        series,
        shift: place(series),
        width: if beside(series) { 0.92 * slot } else { USED },
    });
    all.collect()
}

fn place(frame: &Frame, drawn: &Drawn, point: &Point) -> (Place, Place) {
    (frame.x.place(point.x + drawn.shift), frame.y.place(point.y))
}

fn bars(canvas: &mut Canvas, frame: &Frame, drawn: &Drawn) {
    let colour = drawn.series.colour;
    let zero = if frame.y.log { f64::MIN_POSITIVE } else { 0.0 };
    let base = frame.y.place(zero).nearest();
    for point in &drawn.series.points {
        let middle = point.x + drawn.shift;
        let from = frame.x.place(middle - drawn.width / 2.0);
        let to = frame.x.place(middle + drawn.width / 2.0);
        let y = frame.y.place(point.y);
        let seen = from.is_inside() || to.is_inside();
        if !seen || y == Place::Nowhere || y.nearest() == base {
            continue;
        }
        let corner = frame.at(from.nearest(), base);
        let opposite = frame.at(to.nearest(), y.nearest());
        canvas.rect(corner, opposite, Ink::of(colour));
        let white = Ink::WHITE.faded(0.75);
        canvas.hatch(colour, corner, opposite, 6.0, 1.0, white);
    }
}

/// Draws a line through the points, cut at the frame and broken where a point has no place.
fn curve(canvas: &mut Canvas, frame: &Frame, series: &Series) {
    let ink = Ink::of(series.colour);
    let shares = series.points.iter().map(|point| Some((frame.x.share(point.x)?, frame.y.share(point.y)?)));
    let shares: Vec<Option<Xy>> = shares.collect();
    for run in shares.split(Option::is_none) {
        let run: Vec<Xy> = run.iter().flatten().copied().collect();
        if let &[(x, y)] = &run[..]
            && inside(x)
            && inside(y)
        {
            // a point between gaps has no line of its own
            canvas.disc(frame.at(x, y), 1.5, ink);
        }
        for piece in visible_pieces(&run) {
            let points: Vec<Xy> = piece.iter().map(|&(x, y)| frame.at(x, y)).collect();
            canvas.stroke(series.style, &points, ink);
        }
    }
}

fn inside(share: f64) -> bool {
    (0.0..=1.0).contains(&share)
}

/// The parts of a polyline within the unit square.
fn visible_pieces(points: &[Xy]) -> Vec<Vec<Xy>> {
    let mut pieces: Vec<Vec<Xy>> = Vec::new();
    for pair in points.windows(2) {
        let Some((from, to)) = visible_part(pair[0], pair[1]) else {
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&from) => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
    }
    pieces
}

/// The part of a segment within the unit square.
fn visible_part(from: Xy, to: Xy) -> Option<(Xy, Xy)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for (start, change) in [(from.0, dx), (from.1, dy)] {
        if change == 0.0 {
            if !inside(start) {
                return None;
            }
            continue;
        }
        let (one, other) = (-start / change, (1.0 - start) / change);
        enter = enter.max(one.min(other));
        leave = leave.min(one.max(other));
    }
    if enter > leave {
        return None;
    }
    let at = |t: f64| (from.0 + t * dx, from.1 + t * dy);
    // the ends stay exact, so that pieces can be joined
    let start = if enter == 0.0 { from } else { at(enter) };
    let end = if leave == 1.0 { to } else { at(leave) };
    Some((start, end))
}

/// Draws an error bar with caps; an end beyond the axis is flagged instead of capped.
fn error_bar(canvas: &mut Canvas, frame: &Frame, drawn: &Drawn, point: &Point) {
    let Place::Inside(x) = frame.x.place(point.x + drawn.shift) else {
        return;
    };
    let or_value = |end: f64| if end.is_nan() { point.y } else { end };
    let low = frame.y.place(or_value(point.low));
    let high = frame.y.place(or_value(point.high));
    if low == high && !low.is_inside() {
        return;
    }
    let bars = drawn.series.style == Style::Bars;
    let ink = if bars { Ink::TEXT } else { Ink::of(drawn.series.colour) };
    let (from, to) = (frame.at(x, low.nearest()), frame.at(x, high.nearest()));
    canvas.line(from, to, 1.2, ink);
    for (end, at) in [(low, from), (high, to)] {
        if end.is_inside() {
            let (dx, dy) = frame.along_x();
            let cap = 3.0;
            let start = (at.0 - cap * dx, at.1 - cap * dy);
            canvas.line(start, (at.0 + cap * dx, at.1 + cap * dy), 1.2, ink);
        } else {
            frame.flag(canvas, Place::Inside(x), end, drawn.series.colour, false);
        }
    }
}

/// Flags the points that have no place in the frame.
fn flags(canvas: &mut Canvas, frame: &Frame, drawn: &Drawn) {
    let mut last: Option<Xy> = None;
    for point in &drawn.series.points {
        let (x, y) = place(frame, drawn, point);
        if x.is_inside() && y.is_inside() {
            continue;
        }
        let at = frame.at(x.nearest(), y.nearest());
        let near = last.is_some_and(|last| (at.0 - last.0).hypot(at.1 - last.1) < FLAG_DISTANCE);
        let curve = is_curve(drawn.series.style);
        if near && curve {
            continue;
        }
        // on its own bar a flag would not be seen
        let on_bar = drawn.series.style == Style::Bars && y == Place::Above;
        let colour = if on_bar { Colour::Black } else { drawn.series.colour };
        frame.flag(canvas, x, y, colour, curve);
        last = Some(at);
    }
}
