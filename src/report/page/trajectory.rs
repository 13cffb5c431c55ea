//! What bets on the mean have won as samples came in: a small figure for each cell.

use crate::experiment::row::CHANNELS;
use crate::experiment::{Cell, Estimand};
use crate::report::budget;
use crate::report::figure::Colour;
use crate::report::lookup::Lookup;
use crate::report::number;
use maud::{Markup, html};
use std::f64::consts::LN_10;

/// Size of the figure and of its margins: left, right, top, bottom.
const SIZE: (f64, f64) = (420.0, 170.0);
const MARGIN: (f64, f64, f64, f64) = (46.0, 12.0, 10.0, 28.0);

/// A line shows no more points than this.
const MOST: usize = 36;

/// Colours of the channels, and the dashes of the two sides.
const COLOURS: [Colour; 3] = [Colour::Vermilion, Colour::Green, Colour::Blue];

/// Evidence of one side in one channel: decimal logarithms of samples and of e.
struct Side {
    channel: usize,
    is_above: bool,
    points: Vec<(f64, f64)>,
}

/// The figure, if the cell's mean was bet on.
pub fn figure(lookup: &Lookup<'_>, index: usize, cell: &Cell) -> Markup {
    let sides = sides(lookup, index, cell);
    let Some(needed) = needed(lookup, index, &sides).filter(|_| sides.iter().any(|s| s.points.len() > 1))
    else {
        return html! {};
    };
    let two = if sides.iter().any(|side| !side.is_above) { " / 2" } else { "" };
    html! {
        figure.bets {
            (draw(&sides, needed))
            figcaption {
                "What bets against the right mean have won: log₁₀ e over samples; solid against \"at most\", dashed against "
                "\"at least\"; "
                @for (channel, colour) in CHANNELS.iter().zip(COLOURS) {
                    b style={ "color:" (hex(colour)) } { (channel) } " "
                }
                "· above the line the mean is refuted: e = 1 / (level of one question" (two) ") = "
                (format!("{:.1e}", libm::pow(10.0, needed))) "."
            }
        }
    }
}

/// The streams of the whole, which stand before those of single bounces.
fn sides(lookup: &Lookup<'_>, index: usize, cell: &Cell) -> Vec<Side> {
    let streams = lookup.plan.cells[index].streams.iter().take(3).enumerate();
    let mut sides = Vec::new();
    for (k, stream) in streams.filter(|(_, stream)| stream.bin.is_none()) {
        let taken = || cell.history.iter().filter_map(move |s| Some((s.total[0].n as f64, s.log_e.get(k)?)));
        let point = |n: f64, log_e: f64| (libm::log10(n), log_e / LN_10);
        let above = taken().map(|(n, e)| point(n, e.0)).collect();
        let below: Vec<(f64, f64)> = taken().filter_map(|(n, e)| Some(point(n, e.1?))).collect();
        sides.push(Side { channel: stream.channel, is_above: true, points: above });
        if !below.is_empty() {
            sides.push(Side { channel: stream.channel, is_above: false, points: below });
        }
    }
    sides
}

/// Decimal logarithm of the e-value that refutes the mean, under the claim that asks for it.
fn needed(lookup: &Lookup<'_>, index: usize, sides: &[Side]) -> Option<f64> {
    let claim = (0..3).find_map(|c| lookup.row(index, Estimand::Mean, Some(c))?.claim)?;
    let level = budget::shares(lookup).get(claim)?.level();
    // two sides share the level
    let shared = if sides.iter().any(|side| !side.is_above) { 2.0 } else { 1.0 };
    Some(libm::log10(shared / level))
}

/// Where a value lies.
struct Place {
    x: (f64, f64),
    y: (f64, f64),
}

impl Place {
    fn of(sides: &[Side], needed: f64) -> Self {
        let points = || sides.iter().flat_map(|side| &side.points);
        let (mut x, mut y) = ((f64::INFINITY, 0.0_f64), (0.0_f64, needed));
        for point in points().filter(|point| !point.1.is_nan()) {
            x = (x.0.min(point.0), x.1.max(point.0));
            y = (y.0.min(point.1), y.1.max(point.1));
        }
        // what has won far more than it had to leaves the figure at its top
        Place { x: (x.0, x.1.max(x.0 + 0.1)), y: (y.0.max(-needed) - 0.5, (1.1 * y.1).min(3.0 * needed)) }
    }

    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (left, right, top, bottom) = MARGIN;
        let along = (x - self.x.0) / (self.x.1 - self.x.0);
        let up = (y.clamp(self.y.0, self.y.1) - self.y.0) / (self.y.1 - self.y.0);
        (left + along * (SIZE.0 - left - right), SIZE.1 - bottom - up * (SIZE.1 - top - bottom))
    }
}

fn draw(sides: &[Side], needed: f64) -> Markup {
    let place = Place::of(sides, needed);
    let (x0, x1) = place.x;
    let line = |y: f64| (place.at((x0, y)), place.at((x1, y)));
    let (zero, limit) = (line(0.0), line(needed));
    let decades =
        (x0.ceil() as i32..=x1.floor() as i32).map(|decade| (decade, place.at((f64::from(decade), 0.0)).0));
    html! {
        svg viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } width=(SIZE.0) role="img" aria-label=(words(sides, needed)) {
            g fill="none" stroke="currentColor" stroke-width=".6" {
                path d={ "M" (at(zero.0)) "L" (at(zero.1)) } {}
                path d={ "M" (at(limit.0)) "L" (at(limit.1)) } stroke-width="1.6" {}
            }
            g fill="currentColor" font-size="11" {
                text x="40" y=(format!("{:.0}", zero.0.1 + 4.0)) text-anchor="end" { "0" }
                text x="40" y=(format!("{:.0}", limit.0.1 + 4.0)) text-anchor="end" { (format!("{needed:.1}")) }
                @for (decade, x) in decades {
                    text x=(format!("{x:.0}")) y=(SIZE.1 - 10.0) text-anchor="middle" { "10" tspan dy="-4" font-size="8" { (decade) } }
                }
            }
            @for side in sides { (polyline(&place, side)) }
        }
    }
}

fn polyline(place: &Place, side: &Side) -> Markup {
    let step = side.points.len().div_ceil(MOST).max(1);
    let last = side.points.len().saturating_sub(1);
    let kept = side
        .points
        .iter()
        .enumerate()
        .filter(|(i, point)| (last - i).is_multiple_of(step) && !point.1.is_nan());
    let path: Vec<String> = kept.map(|(_, point)| at(place.at(*point))).collect();
    html! {
        polyline points=(path.join(" ")) fill="none" stroke=(hex(COLOURS[side.channel])) stroke-width="1.5"
            stroke-dasharray=[(!side.is_above).then_some("5 3")] {}
    }
}

fn at((x, y): (f64, f64)) -> String {
    format!("{x:.0},{y:.0}")
}

fn hex(colour: Colour) -> String {
    let (r, g, b) = colour.rgb();
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// What the figure shows, for those who cannot see it.
fn words(sides: &[Side], needed: f64) -> String {
    let one = |side: &Side| {
        let most =
            side.points.iter().map(|point| point.1).filter(|e| !e.is_nan()).fold(f64::NEG_INFINITY, f64::max);
        let crossed = side.points.iter().find(|point| point.1 >= needed);
        let crossed =
            crossed.map_or_else(String::new, |(n, _)| format!(", beyond the line from 10^{n:.1} samples on"));
        let what = if side.is_above { "above" } else { "below" };
        format!("{} {what}: at most {}{crossed}", CHANNELS[side.channel], number::short(most))
    };
    let sides: Vec<String> = sides.iter().map(one).collect();
    format!("Logarithm of evidence that the mean is wrong; the line is at {needed:.1}. {}", sides.join("; "))
}
