//! The bias of all that should be right against the margin, one panel a scene.

use super::curves::CHANNEL_COLOURS;
use super::figure::{Axis, Colour, Figure, Mark, Marker, Panel, Point, Series, Style};
use super::lookup::Lookup;
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Claim;
use crate::experiment::{CellPlan, Estimand};

/// A panel with more rows than this is divided.
const MOST_ROWS: usize = 12;

/// Relative bias of every judged cell that finds all light, with its simultaneous interval.
pub fn figure(lookup: &Lookup<'_>) -> Option<Figure> {
    let judged = |&c: &usize| {
        let has_interval =
            |channel| lookup.row(c, Estimand::Mean, Some(channel)).is_some_and(|r| r.ci.is_some());
        lookup.finds_all(c) && (0..3).any(has_interval)
    };
    let mut panels = Vec::new();
    for scene in lookup.scenes() {
        let cells: Vec<usize> = lookup.of_scene(scene).into_iter().filter(judged).collect();
        let parts = parts(lookup, cells);
        panels.extend(parts.iter().filter_map(|cells| panel(lookup, scene, cells)));
    }
    // neighbours of like height leave the least empty space
    panels.sort_by_key(|panel| std::cmp::Reverse(panel.x.categories.len()));
    (!panels.is_empty()).then(|| Figure {
        title: "Bias of what should be right, against the margin".to_owned(),
        alt: "Relative bias with simultaneous intervals, scene by scene, against the margin.".to_owned(),
        columns: panels.len().min(2),
        panels,
    })
}

/// A scene's cells in panels of bearable length: divided by their rule, and if that does not do, by their estimator.
fn parts(lookup: &Lookup<'_>, cells: Vec<usize>) -> Vec<Vec<usize>> {
    let mut parts = vec![cells];
    let labels: [fn(&CellPlan) -> &str; 2] = [|cell| &cell.roulette_label, |cell| &cell.estimator_label];
    for label in labels {
        let divide = |part: Vec<usize>| {
            let mut divided: Vec<Vec<usize>> = Vec::new();
            let of = |cell: usize| label(&lookup.plan.cells[cell]);
            let is_long = part.len() > MOST_ROWS;
            for cell in part {
                match divided.iter_mut().find(|other| !is_long || of(other[0]) == of(cell)) {
                    Some(other) => other.push(cell),
                    None => divided.push(vec![cell]),
                }
            }
            divided
        };
        parts = parts.into_iter().flat_map(divide).collect();
    }
    parts
}

fn panel(lookup: &Lookup<'_>, scene: &str, cells: &[usize]) -> Option<Panel> {
    let limits = lookup.plan.spec.claim.iter().filter_map(Claim::unbiased).find(|l| l.covers(scene))?;
    let (shared, names) = names(lookup, cells);
    let margin = 100.0 * limits.margin;
    let line = |at: f64, label: &str| Mark::Horizontal { at, label: label.to_owned(), colour: Colour::Black };
    Some(Panel {
        title: [vec![scene.to_owned()], shared].concat().join(", "),
        x: Axis::categories("", names),
        y: Axis::linear("bias / truth  [%]"),
        marks: vec![line(margin, &format!("margin ±{margin} %")), line(-margin, "")],
        series: series(lookup, cells),
        lying: true,
        ..Panel::default()
    })
}

/// One series a channel, or a single one where the channels' relative biases are the same.
fn series(lookup: &Lookup<'_>, cells: &[usize]) -> Vec<Series> {
    let points = |channel: usize| {
        let point = |(x, &cell): (usize, &usize)| {
            let row = lookup.row(cell, Estimand::Mean, Some(channel))?;
            let scale = 100.0 / row.truth?;
            let (low, high) = row.ci?;
            Some(Point::between(x as f64, row.bias? * scale, low * scale, high * scale))
        };
        cells.iter().enumerate().filter_map(point).collect::<Vec<Point>>()
    };
    let channels = [0, 1, 2].map(points);
    let alike = |a: &Point, b: &Point| {
        let tolerance = 1e-6 * (1e-6 + a.high - a.low);
        a.x == b.x && (a.y - b.y).abs() < tolerance && (a.high - b.high).abs() < tolerance
    };
    let same = |other: &Vec<Point>| {
        other.len() == channels[0].len() && other.iter().zip(&channels[0]).all(|(a, b)| alike(a, b))
    };
    if channels[1..].iter().all(same) {
        let [points, ..] = channels;
        let style = Style::Markers(Marker::Diamond);
        return vec![Series { label: "R, G, B alike".to_owned(), colour: Colour::Grey, style, points }];
    }
    let one = |(channel, points): (usize, Vec<Point>)| Series {
        label: CHANNELS[channel].to_owned(),
        colour: CHANNEL_COLOURS[channel],
        style: Style::Markers(Marker::nth(channel)),
        points,
    };
    channels.into_iter().enumerate().map(one).collect()
}

/// What all cells share, and what each is called beside that: estimator, rule, swept parameters.
pub fn names(lookup: &Lookup<'_>, cells: &[usize]) -> (Vec<String>, Vec<String>) {
    let parts = |&cell: &usize| {
        let CellPlan { estimator_label, roulette_label, params, .. } = &lookup.plan.cells[cell];
        let mut parts = vec![estimator_label.clone(), roulette_label.clone()];
        let swept = lookup.plan.swept.iter().filter_map(|name| Some(format!("{name}={}", params.get(name)?)));
        parts.extend(swept);
        parts
    };
    let all: Vec<Vec<String>> = cells.iter().map(parts).collect();
    let everywhere = |part: &String| all.iter().all(|parts| parts.contains(part));
    let shared: Vec<String> = all[0].iter().filter(|part| everywhere(part)).cloned().collect();
    let name = |parts: &Vec<String>| {
        let own: Vec<String> = parts.iter().filter(|part| !shared.contains(part)).cloned().collect();
        if own.is_empty() { parts[0].clone() } else { own.join(", ") }
    };
    let names = all.iter().map(name).collect();
    (shared, names)
}
