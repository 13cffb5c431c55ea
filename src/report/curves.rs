//! Curves over a swept parameter: which cells belong together, what was measured, what theory says.

use super::family::scene_at;
use super::figure::{Colour, Mark, Point, Region};
use super::lookup::Lookup;
use super::plots::Z_BAR;
use crate::estimator::{BINS, Estimator, Roulette, Rule};
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Quantity;
use crate::experiment::{CellPlan, Estimand};
use crate::truth::{ClosedForm, Counted, Known, Optimum, best_constant_q};

/// Colours of red, green and blue that colour-blind readers tell apart.
pub const CHANNEL_COLOURS: [Colour; 3] = [Colour::Vermilion, Colour::Green, Colour::Blue];

/// Steps of theory's curve over a parameter of the scene.
const BETWEEN: u32 = 48;

/// One curve of a panel.
pub struct Curve {
    /// What the legend calls it.
    pub label: String,
    /// Its colour.
    pub colour: Colour,
    /// Its cells, in the order of the parameter.
    pub cells: Vec<usize>,
    /// The channel that it shows.
    pub channel: usize,
}

/// Cells that go into one figure: the same in everything but the parameter and what tells curves apart.
pub fn groups(lookup: &Lookup<'_>, parameter: &str, series: &str) -> Vec<Vec<usize>> {
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, cell) in lookup.plan.cells.iter().enumerate() {
        if !cell.params.contains_key(parameter) || lookup.cell(i).is_empty() {
            continue;
        }
        let key = key(cell, &[parameter, series]);
        match groups.iter_mut().find(|(k, _)| *k == key) {
            Some((_, cells)) => cells.push(i),
            None => groups.push((key, vec![i])),
        }
    }
    groups.into_iter().map(|(_, cells)| cells).filter(|cells| cells.len() > 1).collect()
}

/// What identifies a cell, but for the properties left out.
fn key(cell: &CellPlan, without: &[&str]) -> String {
    let estimator = if without.contains(&"estimator") { "" } else { &cell.estimator_label };
    let params = cell.params.iter().filter(|(name, _)| !without.contains(&name.as_str()));
    format!(
        "{}|{estimator}|{}|{params:?}",
        cell.scene_label,
        cell.roulette_label,
        params = params.collect::<Vec<_>>()
    )
}

/// The curves of one figure.
pub fn of(lookup: &Lookup<'_>, cells: &[usize], parameter: &str, series: &str) -> Vec<Curve> {
    if series == "channel" {
        return channels(lookup, cells).map(|c| channel_curve(lookup, cells, c)).collect();
    }
    let name = |i: usize| {
        let cell = &lookup.plan.cells[i];
        match cell.params.get(series) {
            Some(value) => format!("{series} = {value}"),
            None => cell.estimator_label.clone(),
        }
    };
    let mut curves: Vec<Curve> = Vec::new();
    for &i in cells {
        let label = name(i);
        match curves.iter_mut().find(|curve| curve.label == label) {
            Some(curve) => curve.cells.push(i),
            None => {
                let colour = Colour::nth(curves.len());
                curves.push(Curve { label, colour, cells: vec![i], channel: 0 });
            }
        }
    }
    for curve in &mut curves {
        curve.cells.sort_by(|&a, &b| value(lookup, a, parameter).total_cmp(&value(lookup, b, parameter)));
    }
    curves
}

fn value(lookup: &Lookup<'_>, cell: usize, parameter: &str) -> f64 {
    lookup.plan.cells[cell].params[parameter]
}

/// The channels worth showing: one of them if all are the same.
fn channels(lookup: &Lookup<'_>, cells: &[usize]) -> std::ops::Range<usize> {
    let mean = |cell, channel| lookup.row(cell, Estimand::Mean, Some(channel)).map(|row| row.mean);
    let grey = |&cell: &usize| mean(cell, 0) == mean(cell, 1) && mean(cell, 1) == mean(cell, 2);
    if cells.iter().all(grey) { 0..1 } else { 0..3 }
}

fn channel_curve(lookup: &Lookup<'_>, cells: &[usize], channel: usize) -> Curve {
    use crate::scene::library::SceneKind::{Furnace, FurnaceBox, IntegratingSphere};
    let letter = CHANNELS[channel];
    let label = match &lookup.plan.cells[cells[0]].scene {
        Furnace { albedo, .. } | FurnaceBox { albedo, .. } => format!("{letter}: albedo {}", albedo[channel]),
        IntegratingSphere { patches, looks_at, .. } => {
            format!("{letter}: wall albedo {}", patches[*looks_at].albedo[channel])
        }
        _ => letter.to_owned(),
    };
    Curve { label, colour: CHANNEL_COLOURS[channel], cells: cells.to_vec(), channel }
}

/// Measured points with 99.9 % intervals; what theory calls infinite has none.
pub fn measured(lookup: &Lookup<'_>, curve: &Curve, quantity: Quantity, parameter: &str) -> Vec<Point> {
    let point = |&cell: &usize| {
        let x = value(lookup, cell, parameter);
        let row = |estimand, channel| lookup.row(cell, estimand, channel);
        let mean = row(Estimand::Mean, Some(curve.channel))?;
        let image = lookup.is_image(cell);
        // an image is rated by its pixels
        let rated = if image { row(Estimand::PixelVariance, Some(curve.channel))? } else { mean };
        let paths = lookup.plan.cells[cell].pixels as f64;
        let (y, error) = match quantity {
            Quantity::Bias => {
                let scale = 100.0 / mean.truth?;
                (mean.bias? * scale, mean.std_error? * scale)
            }
            Quantity::Variance => {
                let error = row(Estimand::Variance, Some(curve.channel)).and_then(|r| r.std_error);
                let error = if image { rated.std_error } else { error };
                (rated.variance?, error.unwrap_or(0.0))
            }
            Quantity::Cost => {
                let cost = row(Estimand::Cost, None)?;
                (cost.mean / paths, cost.std_error? / paths)
            }
            Quantity::Efficiency => (rated.efficiency?, rated.efficiency_error.unwrap_or(0.0)),
            Quantity::Added => {
                let bin = last_bounce(&lookup.plan.cells[cell])?;
                let last = row(Estimand::Bounce(bin), Some(curve.channel))?;
                let scale = 100.0 / mean.truth?;
                (last.mean * scale, last.std_error? * scale)
            }
            Quantity::Zeros => {
                let zeros = row(Estimand::Zeros, None)?;
                let error = (zeros.mean * (1.0 - zeros.mean) / zeros.samples as f64).sqrt();
                (100.0 * zeros.mean, 100.0 * error)
            }
            Quantity::Mse => {
                let (bias, error, scale) = (mean.bias?, mean.std_error?, mean.truth?.powi(-2));
                let of_variance = row(Estimand::Variance, Some(curve.channel)).and_then(|r| r.std_error);
                // the mean's own noise is in its square too
                let square = bias * bias - error * error + mean.variance?;
                (square * scale, of_variance.unwrap_or(0.0).hypot(2.0 * bias * error) * scale)
            }
        };
        let noise_free = quantity == Quantity::Variance && lookup.is_noise_free(cell);
        (!noise_free).then(|| Point::between(x, y, y - Z_BAR * error, y + Z_BAR * error))
    };
    curve.cells.iter().filter_map(point).collect()
}

/// Theory's curve: dense where the parameter can have any value, else at the measured points.
pub fn theory(lookup: &Lookup<'_>, curve: &Curve, quantity: Quantity, parameter: &str) -> Vec<Point> {
    let plan = |cell: usize| &lookup.plan.cells[cell];
    let at = |x: f64, cell: &CellPlan, estimator: &Estimator| {
        let closed = ClosedForm::of(&cell.scene, estimator)?;
        let last = last_bounce(cell).map(|bin| bin as u32);
        Some(Point::new(x, predicted(&closed, quantity, curve.channel, last)?))
    };
    let first = plan(curve.cells[0]);
    let values = || curve.cells.iter().map(|&c| value(lookup, c, parameter));
    let (lowest, highest) =
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    if parameter != "q" {
        let measured = |&cell: &usize| at(value(lookup, cell, parameter), plan(cell), &plan(cell).estimator);
        let mut points: Vec<Point> = curve.cells.iter().filter_map(measured).collect();
        let between = |x: f64| {
            at(
                x,
                &CellPlan { scene: scene_at(&first.scene, parameter, x)?, ..first.clone() },
                &first.estimator,
            )
        };
        points.extend(spread(lowest, highest).filter_map(between));
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        return points;
    }
    let steps = 240;
    let q = |i: u32| lowest + (highest - lowest) * f64::from(i) / f64::from(steps);
    // a curve that runs to infinity would leave no room for the rest
    let infinite = optimum_of(lookup, curve).map_or(0.0, |(_, optimum)| optimum.infinite_up_to);
    let finite = |&i: &u32| quantity == Quantity::Cost || q(i) > infinite + 0.004 || infinite == 0.0;
    (0..=steps).filter(finite).filter_map(|i| at(q(i), first, &with_q(&first.estimator, q(i)))).collect()
}

/// Values between two: in equal ratios where both are above 0, else in equal steps.
fn spread(lowest: f64, highest: f64) -> impl Iterator<Item = f64> {
    let ratio = highest / lowest;
    (1..BETWEEN).map(move |i| {
        let share = f64::from(i) / f64::from(BETWEEN);
        if lowest > 0.0 { lowest * libm::pow(ratio, share) } else { lowest + (highest - lowest) * share }
    })
}

/// The same estimator with another constant q.
fn with_q(estimator: &Estimator, q: f64) -> Estimator {
    estimator.with_roulette(Roulette { rule: Rule::Constant { q }, ..*estimator.roulette() })
}

fn predicted(closed: &ClosedForm, quantity: Quantity, channel: usize, last: Option<u32>) -> Option<f64> {
    let variance = || closed.central(channel, Counted::All, 2).value().filter(|&v| v > 0.0);
    match quantity {
        Quantity::Variance => variance(),
        Quantity::Cost => closed.rays(),
        Quantity::Efficiency => Some(1.0 / (variance()? * closed.rays()?)),
        Quantity::Bias => {
            let truth = closed.truth(channel, Counted::All);
            Some(100.0 * (closed.mean(channel, Counted::All)? - truth) / truth)
        }
        Quantity::Added => {
            let last = closed.expected(channel, Counted::Only(last?));
            Some(100.0 * last / closed.truth(channel, Counted::All))
        }
        Quantity::Zeros => None,
        Quantity::Mse => {
            let truth = closed.truth(channel, Counted::All);
            let bias = closed.mean(channel, Counted::All)? - truth;
            Some((bias * bias + variance()?) / (truth * truth))
        }
    }
}

/// The last bounce that a clamped cell counts, if it has a bin of its own.
fn last_bounce(cell: &CellPlan) -> Option<usize> {
    let clamp = cell.estimator.roulette().clamp?;
    Some(clamp as usize).filter(|&bin| bin + 1 < BINS)
}

/// What theory says of constant q here.
fn optimum_of(lookup: &Lookup<'_>, curve: &Curve) -> Option<(CellPlan, Optimum)> {
    let cell = lookup.plan.cells[curve.cells[0]].clone();
    let unclamped = cell.estimator.roulette().clamp.is_none() && cell.estimator.roulette().from == 0;
    let optimum = best_constant_q(&cell.scene, &cell.estimator, curve.channel).filter(|_| unclamped)?;
    Some((cell, optimum))
}

/// Where the variance is infinite.
pub fn infinite_region(lookup: &Lookup<'_>, curve: &Curve) -> Option<Region> {
    let (_, optimum) = optimum_of(lookup, curve)?;
    let lowest = curve.cells.iter().map(|&c| value(lookup, c, "q")).fold(1.0, f64::min);
    (optimum.infinite_up_to > lowest).then(|| Region {
        from: f64::NEG_INFINITY,
        to: optimum.infinite_up_to,
        label: format!("infinite variance ({})", CHANNELS[curve.channel]),
        colour: curve.colour,
    })
}

/// The measured point of least error.
pub fn least(points: &[Point], curve: &Curve, parameter: &str) -> Option<Mark> {
    let least = points.iter().min_by(|a, b| a.y.total_cmp(&b.y))?;
    let label = format!("best: {parameter} = {}", least.x);
    Some(Mark::Point { x: least.x, y: least.y, label, colour: curve.colour })
}

/// The most efficient q.
pub fn optimum(lookup: &Lookup<'_>, curve: &Curve) -> Option<Mark> {
    let (cell, optimum) = optimum_of(lookup, curve)?;
    let x = optimum.best?;
    let closed = ClosedForm::of(&cell.scene, &with_q(&cell.estimator, x))?;
    assert!(closed.central(curve.channel, Counted::All, 2) != Known::Infinite);
    let y = predicted(&closed, Quantity::Efficiency, curve.channel, None)?;
    Some(Mark::Point {
        x,
        y,
        label: format!("best q = {x:.3} ({})", CHANNELS[curve.channel]),
        colour: curve.colour,
    })
}
