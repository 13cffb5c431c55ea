//! Where an axis is ticked and what is written there.

use super::Axis;
use super::font;
use super::frame::Extent;

/// The ticks of an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Ticks {
    /// Positions with a label.
    pub labelled: Vec<(f64, String)>,
    /// Positions between them, with a faint line only.
    pub minor: Vec<f64>,
}

/// The direction in which an axis runs on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Across,
    Upright,
}

/// The finest ticks whose labels, of size `em`, do not crowd an axis of `length` pixels.
pub(super) fn ticks(axis: &Axis, extent: Extent, length: f64, direction: Direction, em: f64) -> Ticks {
    if !axis.categories.is_empty() {
        return categories(axis, extent);
    }
    let candidates = if extent.log { log_candidates(extent) } else { linear_candidates(extent) };
    let fits = |ticks: &Ticks| fits(ticks, extent, length, direction, em);
    let chosen = candidates.iter().position(fits);
    let mut candidates = candidates;
    match chosen {
        Some(index) => candidates.swap_remove(index),
        None => candidates.pop().unwrap_or_default(),
    }
}

fn categories(axis: &Axis, extent: Extent) -> Ticks {
    let named = axis.categories.iter().enumerate();
    let labelled = named
        .map(|(index, name)| (index as f64, name.clone()))
        .filter(|(at, _)| extent.place(*at).is_inside())
        .collect();
    let minor = Vec::new();
    Ticks { labelled, minor }
}

/// Whether the labels keep a distance from one another.
fn fits(ticks: &Ticks, extent: Extent, length: f64, direction: Direction, em: f64) -> bool {
    let spans: Vec<(f64, f64)> = ticks
        .labelled
        .iter()
        .filter_map(|(at, label)| {
            let middle = extent.share(*at)? * length;
            let half = match direction {
                Direction::Across => font::width(label, em) / 2.0 + 7.0,
                Direction::Upright => 1.25 * em,
            };
            Some((middle - half, middle + half))
        })
        .collect();
    spans.windows(2).all(|pair| pair[0].1 <= pair[1].0)
}

/// Ticks at multiples of 1, 2, 5 times a power of ten, finest first, the last with few ticks.
fn linear_candidates(extent: Extent) -> Vec<Ticks> {
    let span = extent.high - extent.low;
    let coarsest = span.log10().floor() as i32;
    let mut candidates = Vec::new();
    for power in [coarsest - 1, coarsest] {
        for digit in [1.0, 2.0, 5.0] {
            let step = Step { digit, power };
            let count = span / step.times(1.0);
            if (1.5..=11.0).contains(&count) {
                candidates.push(linear_ticks(extent, step));
            }
        }
    }
    candidates
}

/// A distance between ticks: `digit` times ten to the `power`.
#[derive(Clone, Copy)]
struct Step {
    digit: f64,
    power: i32,
}

impl Step {
    /// `count` steps, correctly rounded: no 0.30000000000000004.
    fn times(self, count: f64) -> f64 {
        let digits = count * self.digit;
        if self.power < 0 { digits / 10f64.powi(-self.power) } else { digits * 10f64.powi(self.power) }
    }
}

fn linear_ticks(extent: Extent, step: Step) -> Ticks {
    let unit = step.times(1.0);
    let first = (extent.low / unit - 1e-9).ceil();
    let last = (extent.high / unit + 1e-9).floor();
    let largest = extent.low.abs().max(extent.high.abs());
    let count = (last - first) as usize;
    let labelled = (0..=count)
        .map(|index| {
            let value = step.times(first + index as f64);
            (value, linear_label(value, step.power, largest))
        })
        .collect();
    let minor = Vec::new();
    Ticks { labelled, minor }
}

/// A tick label with as many decimals as the step has, in powers of ten when the axis reaches very
/// large or only very small values.
fn linear_label(value: f64, power: i32, largest: f64) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    let text = if (1e-3..1e5).contains(&largest) {
        let decimals = usize::try_from(-power).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        let exponent = largest.log10().floor() as i32;
        let decimals = usize::try_from(exponent - power).unwrap_or(0);
        let mantissa = value / 10f64.powi(exponent);
        format!("{mantissa:.decimals$}×{}", power_of_ten(exponent))
    };
    text.replace('-', "−")
}

/// Ticks at powers of ten or finer, finest first.
fn log_candidates(extent: Extent) -> Vec<Ticks> {
    let first = extent.low.log10().floor() as i32;
    let last = extent.high.log10().ceil() as i32;
    if extent.high / extent.low < 4.0 {
        return linear_candidates(extent);
    }
    let mut candidates = Vec::new();
    if last - first <= 3 {
        for digits in [&[1, 2, 3, 4, 5, 6, 7, 8, 9][..], &[1, 2, 5]] {
            candidates.push(log_ticks(extent, digits, 1));
        }
        // over two decades and more, powers of ten alone are clearer
        candidates.retain(|ticks| ticks.labelled.len() <= 7);
    }
    for stride in [1, 2, 3, 5, 10, 20, 50, 100, 200] {
        candidates.push(log_ticks(extent, &[1], stride));
    }
    candidates.retain(|ticks| ticks.labelled.len() >= 2);
    if candidates.is_empty() {
        candidates = linear_candidates(extent);
    }
    candidates
}

/// Labelled ticks at `digits` times every `stride`-th power of ten, faint ones between them.
fn log_ticks(extent: Extent, digits: &[i32], stride: i32) -> Ticks {
    let first = extent.low.log10().floor() as i32;
    let last = extent.high.log10().ceil() as i32;
    let mut ticks = Ticks::default();
    for power in first..=last {
        for digit in 1..=9 {
            let (value, label) = log_tick(digit, power, digits == [1]);
            if !extent.place(value).is_inside() {
                continue;
            }
            if power % stride == 0 && digits.contains(&digit) {
                ticks.labelled.push((value, label));
            } else if stride == 1 && last - first <= 6 || digit == 1 && last - first <= 60 {
                ticks.minor.push(value);
            }
        }
    }
    ticks
}

/// The value `digit` times ten to the `power` and its label; `powers`: always as a power.
fn log_tick(digit: i32, power: i32, powers: bool) -> (f64, String) {
    let digits = f64::from(digit);
    let value = if power < 0 { digits / 10f64.powi(-power) } else { digits * 10f64.powi(power) };
    let label = if powers {
        power_of_ten(power)
    } else if (-3..=3).contains(&power) {
        let decimals = usize::try_from(-power).unwrap_or(0);
        format!("{value:.decimals$}")
    } else if digit == 1 {
        power_of_ten(power)
    } else {
        format!("{digit}×{}", power_of_ten(power))
    };
    (value, label)
}

/// Ten to a whole power, with superscript digits.
fn power_of_ten(power: i32) -> String {
    let superscript = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        other => char::from_u32(other as u32 - '4' as u32 + '⁴' as u32).unwrap_or(other),
    };
    let digits = power.to_string();
    let raised: String = digits.chars().map(superscript).collect();
    format!("10{raised}")
}
