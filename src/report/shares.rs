//! How much light each estimator found of what another one finds, and how heavy the tails of what it returns look.

use super::figure::{Axis, Colour, Figure, Mark, Marker, Panel, Point, Series, Style};
use super::forest;
use super::lookup::Lookup;
use super::plots::{Named, Z_BAR, file_name};
use crate::experiment::{Cell, Estimand};

/// Tail indices above this are drawn there: so light a tail can hardly be told from none.
const LIGHT: f64 = 10.0;

/// The cells of a scene, each beside the first one of the estimator `of`; nothing where that was not run.
pub fn figure(lookup: &Lookup<'_>, cells: &[Option<Cell>], scene: &str, of: &str) -> Option<Named> {
    let here = lookup.of_scene(scene);
    let anchor = here.iter().copied().find(|&c| lookup.plan.cells[c].estimator_label == of)?;
    let (shared, names) = forest::names(lookup, &here);
    let whole = light(lookup, anchor)?;
    let share = |(x, &cell): (usize, &usize)| {
        let (mean, error) = light(lookup, cell)?;
        let both = if cell == anchor { error } else { error.hypot(whole.1 * mean / whole.0) };
        let (y, reach) = (100.0 * mean / whole.0, 100.0 * Z_BAR * both / whole.0);
        Some(Point::between(x as f64, y, y - reach, y + reach))
    };
    let tail = |(x, &cell): (usize, &usize)| {
        let tails = &cells[cell].as_ref()?.tails;
        let index = tails.iter().filter_map(|tail| tail.apparent_index()).reduce(f64::min)?;
        Some(Point::new(x as f64, index.min(LIGHT)))
    };
    let panel = |title: &str, y: Axis, marks, points, colour| Panel {
        title: title.to_owned(),
        x: Axis::categories("", names.clone()),
        y,
        marks,
        series: vec![Series { label: String::new(), colour, style: Style::Markers(Marker::Diamond), points }],
        lying: true,
        ..Panel::default()
    };
    let line = |at: f64, label: &str| Mark::Horizontal { at, label: label.to_owned(), colour: Colour::Black };
    let shares: Vec<Point> = here.iter().enumerate().filter_map(share).collect();
    let tails: Vec<Point> = here.iter().enumerate().filter_map(tail).collect();
    let panels = vec![
        panel(
            "Light found",
            Axis::linear(&format!("mean / mean of {of}  [%]")),
            vec![line(100.0, "all")],
            shares,
            Colour::Blue,
        ),
        panel(
            "Tail of the image's mean",
            Axis::linear("apparent tail index of a pass, worst channel (10: no tail)"),
            vec![line(2.0, "infinite variance below")],
            tails,
            Colour::Vermilion,
        ),
    ];
    let title = [vec![scene.to_owned()], shared].concat().join(", ");
    let figure = Figure {
        title: format!("{title}: light found and its tails"),
        alt: format!("Light that each estimator found in {scene}, relative to {of}, with 99.9 % intervals."),
        panels,
        columns: 2,
    };
    Some(Named { name: file_name(&[scene, "light found"]), figure })
}

/// Mean of a realization, channels added, with its standard error at worst.
fn light(lookup: &Lookup<'_>, cell: usize) -> Option<(f64, f64)> {
    let rows = (0..3).map(|c| lookup.row(cell, Estimand::Mean, Some(c)));
    rows.map(|row| Some((row?.mean, row?.std_error?)))
        .collect::<Option<Vec<_>>>()
        .map(|values| values.iter().fold((0.0, 0.0), |sum, value| (sum.0 + value.0, sum.1 + value.1)))
        .filter(|sum| sum.0 > 0.0)
}
