//! Which figures an experiment gets: quantities over a swept parameter with theory's curves, efficiency as bars, bias
//! against the margin.

use super::curves::{self, Curve};
use super::figure::{Axis, Colour, Figure, Marker, Panel, Point, Series, Style};
use super::lookup::Lookup;
use super::{axes, decline, forest, shares};
use crate::experiment::spec::{Plot, Quantity};
use crate::experiment::{Cell, CellPlan, Estimand};

/// A figure and the name of its files.
pub struct Named {
    /// File name without extension.
    pub name: String,
    /// The figure.
    pub figure: Figure,
}

/// Error bars are drawn for this probability, two-sided normal.
pub const Z_BAR: f64 = 3.290_526_731_491_9; // 99.9 %

/// All figures of a run.
pub fn figures(lookup: &Lookup<'_>, cells: &[Option<Cell>]) -> Vec<Named> {
    let mut figures = Vec::new();
    for plot in &lookup.plan.spec.plot {
        match plot {
            Plot::Over { parameter, show, series, log } => {
                for group in curves::groups(lookup, parameter, series) {
                    figures.push(over(lookup, &group, parameter, show, series, *log));
                }
            }
            Plot::Bars { scene } => figures.extend(bars(lookup, scene)),
            Plot::Shares { scene, of } => figures.extend(shares::figure(lookup, cells, scene, of)),
            Plot::Convergence { scene, show } => {
                figures.extend(decline::figure(lookup, cells, scene, show));
            }
            Plot::Bias {} => {
                let named = |figure| Named { name: "bias".to_owned(), figure };
                figures.extend(forest::figure(lookup).map(named));
            }
        }
    }
    number_namesakes(&mut figures);
    figures
}

/// Labels may differ only in what file names cannot hold.
fn number_namesakes(figures: &mut [Named]) {
    for i in 1..figures.len() {
        if figures[..i].iter().any(|other| other.name == figures[i].name) {
            figures[i].name = format!("{}_{i}", figures[i].name);
        }
    }
}

/// A name that every file system takes.
pub fn file_name(parts: &[&str]) -> String {
    let keep = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = parts.join("_").chars().map(keep).collect();
    let mut name = name.split('_').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("_");
    name.truncate(180);
    name
}

fn over(
    lookup: &Lookup<'_>,
    cells: &[usize],
    parameter: &str,
    show: &[Quantity],
    series: &str,
    log: bool,
) -> Named {
    let curves = curves::of(lookup, cells, parameter, series);
    let first = &lookup.plan.cells[cells[0]];
    let subject = subject(lookup, first, parameter, series);
    let mut panels = Vec::new();
    for &quantity in show {
        let x = axes::of_parameter(first, parameter, log);
        let (title, y) = (axes::title(quantity).to_owned(), axes::of_quantity(quantity));
        let mut panel = Panel { title, x, y, ..Panel::default() };
        for (i, curve) in curves.iter().enumerate() {
            draw(lookup, &mut panel, curve, i, quantity, parameter);
        }
        panels.push(panel);
    }
    let columns = panels.len().min(3);
    let shown = show.iter().map(|&q| axes::title(q).to_lowercase()).collect::<Vec<_>>().join(", ");
    Named {
        name: file_name(&[&subject, &shown, "over", parameter, "by", series]),
        figure: Figure {
            title: format!("{subject}: {shown} over {parameter}"),
            alt: format!("Measured {shown} with 99.9 % intervals over {parameter}; dashed: closed form."),
            panels,
            columns,
        },
    }
}

/// What all cells of a figure share: scene, estimator, rule and the swept parameters that the figure does not show.
fn subject(lookup: &Lookup<'_>, cell: &CellPlan, parameter: &str, series: &str) -> String {
    let estimator = if series == "estimator" { "" } else { cell.estimator_label.as_str() };
    let mut parts = vec![cell.scene_label.clone(), estimator.to_owned(), cell.roulette_label.clone()];
    for (name, value) in &cell.params {
        if lookup.plan.swept.contains(name) && name != parameter && name != series {
            parts.push(format!("{name} = {value}"));
        }
    }
    parts.retain(|part| !part.is_empty());
    parts.join(", ")
}

/// Adds one curve's measured points, theory and marks to a panel.
fn draw(
    lookup: &Lookup<'_>,
    panel: &mut Panel,
    curve: &Curve,
    i: usize,
    quantity: Quantity,
    parameter: &str,
) {
    let label = curve.label.clone();
    let theory = curves::theory(lookup, curve, quantity, parameter);
    if !theory.is_empty() {
        let style = [Style::Dashed, Style::Dotted, Style::DashDotted][i % 3];
        panel.series.push(Series { label: label.clone(), colour: curve.colour, style, points: theory });
    }
    let points = curves::measured(lookup, curve, quantity, parameter);
    if quantity == Quantity::Mse {
        panel.marks.extend(curves::least(&points, curve, parameter));
    }
    let style = Style::Markers(Marker::nth(i));
    panel.series.push(Series { label, colour: curve.colour, style, points });
    if parameter == "q" && quantity != Quantity::Cost {
        panel.regions.extend(curves::infinite_region(lookup, curve));
    }
    if parameter == "q" && quantity == Quantity::Efficiency {
        panel.marks.extend(curves::optimum(lookup, curve));
    }
}

/// Efficiency of every unbiased cell of a scene, by rule.
fn bars(lookup: &Lookup<'_>, scene: &str) -> Vec<Named> {
    let cells = lookup.of_scene(scene);
    let Some(&first) = cells.first() else { return Vec::new() };
    let kinds: &[(Estimand, &str, Colour)] = if lookup.is_image(first) {
        &[
            (Estimand::MedianPixelVariance, "median pixel", Colour::Blue),
            (Estimand::PixelVariance, "mean pixel (99.9 % bars)", Colour::Orange),
        ]
    } else {
        &[(Estimand::Mean, "all channels (99.9 % bars)", Colour::Blue)]
    };
    let shown: Vec<usize> = cells
        .into_iter()
        .filter(|&c| lookup.finds_all(c) && lookup.efficiency(c, kinds[0].0).is_some())
        .collect();
    if shown.is_empty() {
        return Vec::new();
    }
    let (shared, names) = forest::names(lookup, &shown);
    let series = kinds.iter().map(|&(estimand, label, colour)| {
        let bar = |(x, &cell): (usize, &usize)| {
            let (value, error) = lookup.efficiency(cell, estimand)?;
            let reach = Z_BAR * error.unwrap_or(0.0);
            Some(Point::between(x as f64, value, value - reach, value + reach))
        };
        let points = shown.iter().enumerate().filter_map(bar).collect();
        Series { label: label.to_owned(), colour, style: Style::Bars, points }
    });
    let panel = Panel {
        x: Axis::categories("", names),
        y: Axis::log("1 / (variance × rays), channels added  [(W m⁻² sr⁻¹)⁻²]"),
        series: series.collect(),
        lying: true,
        ..Panel::default()
    };
    let figure = Figure {
        title: format!("{}: efficiency", [vec![scene.to_owned()], shared].concat().join(", ")),
        alt: format!("Efficiency of each estimator and rule that finds all light in {scene}."),
        panels: vec![panel],
        columns: 1,
    };
    vec![Named { name: file_name(&[scene, "efficiency"]), figure }]
}
