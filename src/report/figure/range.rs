//! The range an axis covers.

use super::frame::Extent;
use super::{Axis, Mark, Panel, Point, Scale, Style};

/// Limits that keep differences and ratios of range ends finite.
const LARGEST: f64 = 1e300;
const SMALLEST: f64 = 1e-300;

/// On a logarithmic axis, error bars and bars reach at most this many times below the lowest value.
const REACH: f64 = 10.0;

/// The range of the horizontal axis of a panel.
pub(super) fn of_x(panel: &Panel) -> Extent {
    let axis = &panel.x;
    let points = panel.series.iter().flat_map(|series| &series.points);
    let mut values: Vec<f64> = points.map(|point| point.x).collect();
    for region in &panel.regions {
        values.extend([region.from, region.to]);
    }
    for mark in &panel.marks {
        match mark {
            Mark::Vertical { at: x, .. } | Mark::Point { x, .. } => values.push(*x),
            Mark::Horizontal { .. } => {}
        }
    }
    extent(axis, &values, &[], false)
}

/// The range of the vertical axis of a panel.
pub(super) fn of_y(panel: &Panel) -> Extent {
    let axis = &panel.y;
    let points: Vec<&Point> = panel.series.iter().flat_map(|s| &s.points).collect();
    let mut values: Vec<f64> = points.iter().map(|point| point.y).collect();
    let ends: Vec<f64> = points.iter().flat_map(|p| [p.low, p.high]).collect();
    for mark in &panel.marks {
        match mark {
            Mark::Horizontal { at: y, .. } | Mark::Point { y, .. } => values.push(*y),
            Mark::Vertical { .. } => {}
        }
    }
    let bars = panel.series.iter().any(|s| s.style == Style::Bars);
    extent(axis, &values, &ends, bars)
}

/// The range of an axis that shows `values` and, where possible, the `ends` of error bars.
fn extent(axis: &Axis, values: &[f64], ends: &[f64], bars: bool) -> Extent {
    let log = axis.scale == Scale::Log && axis.categories.is_empty();
    let (mut low, mut high) = if !axis.categories.is_empty() {
        (-0.5, axis.categories.len() as f64 - 0.5)
    } else if log {
        log_range(values, ends, bars)
    } else {
        linear_range(values, ends, bars)
    };
    if let Some((from, to)) = axis.range {
        let usable = |end: f64| end.is_finite() && (!log || end > 0.0);
        let (from, to) = if from > to { (to, from) } else { (from, to) };
        low = if usable(from) { from } else { low };
        high = if usable(to) { to } else { high };
    }
    apart(low, high, log)
}

/// Moves ends apart that are too close, or in the wrong order, to be an axis.
fn apart(low: f64, high: f64, log: bool) -> Extent {
    let (low, high) = if log {
        let low = low.clamp(SMALLEST, LARGEST / 10.0);
        let high = high.clamp(SMALLEST, LARGEST);
        let close = high / low < 1.0 + 1e-9;
        if close { (low / 2.0, low * 2.0) } else { (low, high) }
    } else {
        let low = low.clamp(-LARGEST, LARGEST);
        let high = high.clamp(-LARGEST, LARGEST);
        let size = low.abs().max(high.abs());
        let close = high - low <= 1e-9 * size;
        let step = if size > 0.0 { 0.5 * size } else { 1.0 };
        if close { (low - step, low + step) } else { (low, high) }
    };
    Extent { low, high, log }
}

/// Lowest and highest of the values for which `usable` holds.
fn bounds(values: &[f64], usable: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
    let usable = values.iter().copied().filter(|&value| usable(value));
    usable.fold(None, |bounds, value| match bounds {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

fn linear_range(values: &[f64], ends: &[f64], bars: bool) -> (f64, f64) {
    let mut all = values.to_vec();
    all.extend(ends);
    if bars {
        all.push(0.0);
    }
    let usable = |value: f64| value.abs() <= LARGEST;
    let Some((low, high)) = bounds(&all, usable) else {
        return (0.0, 1.0);
    };
    let space = 0.04 * (high - low);
    let (mut from, mut to) = (low - space, high + space);
    // what is never negative should not get a negative axis
    if low >= 0.0 {
        from = from.max(0.0);
    }
    if high <= 0.0 {
        to = to.min(0.0);
    }
    (from, to)
}

fn log_range(values: &[f64], ends: &[f64], bars: bool) -> (f64, f64) {
    let usable = |value: f64| (SMALLEST..=LARGEST).contains(&value);
    let Some((mut low, mut high)) = bounds(values, usable) else {
        return (0.1, 10.0);
    };
    // an error bar that nearly reaches 0 would stretch the axis over decades without data
    let reach = (low / REACH, high * REACH);
    if let Some((low_end, high_end)) = bounds(ends, usable) {
        low = low.min(low_end.max(reach.0));
        high = high.max(high_end.min(reach.1));
    }
    // the lowest bar should not vanish
    let space = (high / low).powf(0.03).max(1.05);
    let below = if bars { 2.0 } else { space };
    (round_down(low / below), round_up(high * space))
}

/// The largest of 1, 2, 5 times a power of ten that is at most `value`.
fn round_down(value: f64) -> f64 {
    let power = 10f64.powi(value.log10().floor() as i32);
    let steps = [5.0, 2.0, 1.0];
    let fitting = steps.iter().find(|&&step| step * power <= value);
    fitting.map_or(power, |step| step * power)
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `value`.
fn round_up(value: f64) -> f64 {
    let power = 10f64.powi(value.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0];
    let fitting = steps.iter().find(|&&step| step * power >= value);
    fitting.map_or(10.0 * power, |step| step * power)
}
