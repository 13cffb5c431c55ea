//! From values to pixels.

use super::Colour;
use super::canvas::{Canvas, Ink, Xy};

/// The range of an axis: `low` < `high`, both finite, and above 0 when `log`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub low: f64,
    pub high: f64,
    pub log: bool,
}

/// The farthest share of an axis that is told apart.
const FAR: f64 = 1e6;

/// Where a value lies with respect to an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Place {
    /// On the axis, at this share of its length.
    Inside(f64),
    /// Below the lower end, or without a logarithm.
    Below,
    /// Above the upper end.
    Above,
    /// Not a number.
    Nowhere,
}

impl Place {
    /// The share of the axis nearest to the value.
    pub fn nearest(self) -> f64 {
        match self {
            Self::Inside(share) => share,
            Self::Above => 1.0,
            Self::Below | Self::Nowhere => 0.0,
        }
    }

    pub fn is_inside(self) -> bool {
        matches!(self, Self::Inside(_))
    }
}

impl Extent {
    /// Share of the axis at which a value lies, outside 0..=1 beyond the ends. `None`: the value
    /// is not finite or has no logarithm.
    pub fn share(self, value: f64) -> Option<f64> {
        if !value.is_finite() || (self.log && value <= 0.0) {
            return None;
        }
        let share = if self.log {
            (value.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        };
        // far outside it does not matter how far, but the arithmetic of clipping must stay finite
        Some(share.clamp(-FAR, FAR))
    }

    pub fn place(self, value: f64) -> Place {
        // rounding must not push the ends themselves outside
        const SLACK: f64 = 1e-9;
        match self.share(value) {
            _ if value.is_nan() => Place::Nowhere,
            Some(share) if share < -SLACK => Place::Below,
            Some(share) if share > 1.0 + SLACK => Place::Above,
            Some(share) => Place::Inside(share.clamp(0.0, 1.0)),
            None if value > 0.0 => Place::Above,
            None => Place::Below,
        }
    }
}

/// The rectangle of a plot and its axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: Extent,
    pub y: Extent,
    /// x runs downwards and y to the right.
    pub sideways: bool,
}

impl Frame {
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The pixel at these shares of the axes.
    pub fn at(&self, x: f64, y: f64) -> Xy {
        if self.sideways {
            (self.left + y * self.width, self.top + x * self.height)
        } else {
            (self.left + x * self.width, self.bottom() - y * self.height)
        }
    }

    /// One pixel towards larger x.
    pub fn along_x(&self) -> Xy {
        if self.sideways { (0.0, 1.0) } else { (1.0, 0.0) }
    }

    /// One pixel towards larger y.
    pub fn along_y(&self) -> Xy {
        if self.sideways { (1.0, 0.0) } else { (0.0, -1.0) }
    }

    /// Flags a value that cannot be drawn: a triangle at the edge of the plot beyond which it lies,
    /// a cross where it is not a number. `hollow`: only the outline, for curves. Draws nothing for a
    /// value inside.
    pub fn flag(&self, canvas: &mut Canvas, x: Place, y: Place, colour: Colour, hollow: bool) {
        let missing = x == Place::Nowhere || y == Place::Nowhere;
        let forward = match (x, y) {
            (_, Place::Above) => self.along_y(),
            (_, Place::Below | Place::Nowhere) => opposite(self.along_y()),
            (Place::Above, _) => self.along_x(),
            (Place::Below | Place::Nowhere, _) => opposite(self.along_x()),
            _ => return,
        };
        let at = free_place(canvas, self.at(x.nearest(), y.nearest()), forward);
        canvas.flags.push(at);
        if missing {
            canvas.missing = true;
            small_cross(canvas, at, Ink::of(colour));
            return;
        }
        canvas.beyond = true;
        small_triangle(canvas, at, forward, Ink::of(colour));
        if hollow {
            let tip = (at.0 - 2.8 * forward.0, at.1 - 2.8 * forward.1);
            canvas.polygon(triangle(tip, forward, 4.9, 2.6), Ink::WHITE);
        }
    }
}

/// Steps back from the edge until no other flag is covered.
fn free_place(canvas: &Canvas, edge: Xy, forward: Xy) -> Xy {
    let mut at = edge;
    for _ in 0..8 {
        let taken = |flag: &Xy| (flag.0 - at.0).hypot(flag.1 - at.1) < 9.0;
        if !canvas.flags.iter().any(taken) {
            break;
        }
        at = (at.0 - 10.0 * forward.0, at.1 - 10.0 * forward.1);
    }
    at
}

fn opposite((x, y): Xy) -> Xy {
    (-x, -y)
}

/// A triangle with a white rim whose tip is at `tip` and points `forward`.
pub(super) fn small_triangle(canvas: &mut Canvas, tip: Xy, forward: Xy, ink: Ink) {
    let ahead = (tip.0 + 1.5 * forward.0, tip.1 + 1.5 * forward.1);
    canvas.polygon(triangle(ahead, forward, 11.5, 6.2), Ink::WHITE);
    canvas.polygon(triangle(tip, forward, 9.0, 4.8), ink);
}

/// The corners of a triangle of this length and half base.
fn triangle(tip: Xy, forward: Xy, length: f64, half: f64) -> Vec<Xy> {
    let base = (tip.0 - length * forward.0, tip.1 - length * forward.1);
    let side = (-half * forward.1, half * forward.0);
    vec![tip, (base.0 + side.0, base.1 + side.1), (base.0 - side.0, base.1 - side.1)]
}

/// A small cross with a white rim.
pub(super) fn small_cross(canvas: &mut Canvas, (x, y): Xy, ink: Ink) {
    for (arm, width, ink) in [(4.2, 3.6, Ink::WHITE), (3.5, 1.6, ink)] {
        canvas.line((x - arm, y - arm), (x + arm, y + arm), width, ink);
        canvas.line((x - arm, y + arm), (x + arm, y - arm), width, ink);
    }
}
