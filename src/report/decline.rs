//! How errors fall as samples grow: `convergence.csv` and its figures.

use super::figure::{Axis, Colour, Figure, Marker, Panel, Point, Series, Style};
use super::forest;
use super::lookup::Lookup;
use super::plots::{Named, Z_BAR, file_name};
use super::table::number;
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::ErrorKind;
use crate::experiment::{Cell, Decline, Fall, Plan};
use crate::stats::decay::{Error, Estimate};
use crate::truth::After;

/// The text of `convergence.csv`: the error of each cell's runs in each channel, each time that they were looked at.
pub fn csv(plan: &Plan, cells: &[Option<Cell>]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let fixed = ["experiment", "scene", "estimator", "roulette"];
    let measured = [
        "channel",
        "runs",
        "n",
        "rays",
        "bias",
        "bias_error",
        "variance",
        "variance_error",
        "mse",
        "mse_error",
        "theory_bias",
        "theory_variance",
        "theory_mse",
        "truth",
        "truth_error",
        "truth_bound",
    ];
    let swept = plan.swept.iter().map(String::as_str);
    csv.write_record(fixed.into_iter().chain(swept).chain(measured)).expect("a Vec takes all");
    for (cell_plan, cell) in plan.cells.iter().zip(cells) {
        let Some(cell) = cell else { continue };
        let truth = plan.truth(cell_plan);
        for (channel, letter) in CHANNELS.iter().enumerate() {
            let Some(decline) = Decline::of(cell_plan, cell, &truth, channel) else { continue };
            for (error, theory) in decline.errors().iter().zip(&decline.theory) {
                let labels = [&plan.name, &cell_plan.scene_label];
                let mut record: Vec<String> = labels.into_iter().cloned().collect();
                record.extend([cell_plan.estimator_label.clone(), cell_plan.roulette_label.clone()]);
                record.extend(plan.swept.iter().map(|name| number(cell_plan.params.get(name).copied())));
                record.extend([(*letter).to_owned(), decline.count().to_string()]);
                record.extend(numbers(error, theory, cell.cost.mean, &decline));
                csv.write_record(record).expect("a Vec takes all");
            }
        }
    }
    csv.into_inner().expect("a Vec takes all")
}

/// The columns from `n` on.
fn numbers(error: &Error, theory: &After, rays: f64, decline: &Decline) -> Vec<String> {
    let both = |estimate: Option<Estimate>| {
        [number(estimate.map(|e| e.value)), number(estimate.map(|e| e.std_error))]
    };
    let right = decline.right();
    let mut numbers = vec![error.n.to_string(), number(Some(rays * error.n as f64))];
    numbers.extend([both(error.bias), both(Some(error.variance)), both(error.mse)].concat());
    numbers.extend([number(theory.bias), number(theory.variance.value()), number(theory.mse())]);
    numbers.extend([right.map(|r| r.value), right.map(|r| r.std_error), right.map(|r| r.bound)].map(number));
    numbers
}

/// The channel that is shown.
const SHOWN: usize = 0;

/// The errors of a scene's cells over the number of samples, in the red channel; none if no cell there is cut into runs.
pub fn figure(lookup: &Lookup<'_>, cells: &[Option<Cell>], scene: &str, show: &[ErrorKind]) -> Option<Named> {
    let mut shown = Vec::new();
    let mut declines = Vec::new();
    for index in lookup.of_scene(scene) {
        let plan = &lookup.plan.cells[index];
        let cell = cells[index].as_ref()?;
        if let Some(decline) = Decline::of(plan, cell, &lookup.plan.truth(plan), SHOWN) {
            shown.push(index);
            declines.push(decline);
        }
    }
    if shown.is_empty() {
        return None;
    }
    let (shared, names) = forest::names(lookup, &shown);
    let label = |(name, decline): (&String, &Decline)| {
        let slopes: Vec<String> = show.iter().map(|&kind| slope(&decline.fall(kind))).collect();
        let infinite = if decline.is_infinite() { " (infinite variance)" } else { "" };
        format!("{name}: {}{infinite}", slopes.join(" / "))
    };
    let labels: Vec<String> = names.iter().zip(&declines).map(label).collect();
    let panels = show.iter().map(|&kind| panel(&declines, &labels, kind)).collect();
    let words = show.iter().map(|&kind| title(kind).to_lowercase()).collect::<Vec<_>>();
    let subject = [vec![scene.to_owned()], shared].concat().join(", ");
    let name = file_name(&[&subject, "convergence"]);
    let figure = Figure {
        title: format!("{subject}, red: fitted exponents of {}", words.join(" / ")),
        alt: format!("{} over the number of samples of a run; dashed: theory.", words.join(", ")),
        panels,
        columns: show.len().min(3),
    };
    Some(Named { name, figure })
}

fn title(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::Mse => "Squared error",
        ErrorKind::Variance => "Variance",
        ErrorKind::Bias => "Bias",
    }
}

/// "-1.00", or a dash where nothing was fitted.
fn slope(fall: &Fall) -> String {
    let two = |value: f64| format!("{value:.2}").replace("-0.00", "0.00").replace('-', "−");
    fall.measured.map_or_else(|| "–".to_owned(), |measured| two(measured.value))
}

fn panel(declines: &[Decline], labels: &[String], kind: ErrorKind) -> Panel {
    let of_error = |error: &Error| match kind {
        ErrorKind::Mse => error.mse,
        ErrorKind::Variance => Some(error.variance),
        ErrorKind::Bias => error.bias.map(|bias| Estimate { value: bias.value.abs(), ..bias }),
    };
    let of_theory = |after: &After| match kind {
        ErrorKind::Mse => after.mse(),
        ErrorKind::Variance => after.variance.value(),
        ErrorKind::Bias => after.bias.map(f64::abs),
    };
    let mut series = Vec::new();
    for (i, (decline, label)) in declines.iter().zip(labels).enumerate() {
        let (colour, label) = (Colour::nth(i), label.clone());
        let theory = decline.marks.iter().zip(&decline.theory);
        let known = theory.filter_map(|(&n, after)| Some((n, of_theory(after)?)));
        let known = known.filter(|point| point.1 > decline.rounding(kind));
        let points: Vec<Point> = known.map(|(n, y)| Point::new(n as f64, y)).collect();
        if !points.is_empty() {
            series.push(Series { label: label.clone(), colour, style: Style::Dashed, points });
        }
        let point = |error: &Error| {
            let Estimate { value, std_error } = of_error(error)?;
            let resolved = kind != ErrorKind::Bias || (value > Z_BAR * std_error && !decline.is_infinite());
            // on a logarithmic axis, intervals of the logarithm
            let times = if decline.is_infinite() { 1.0 } else { libm::exp(Z_BAR * std_error / value) };
            let bar = Point::between(error.n as f64, value, value / times, value * times);
            (resolved && value > decline.rounding(kind)).then_some(bar)
        };
        let points = decline.errors().iter().filter_map(point).collect();
        series.push(Series { label, colour, style: Style::Markers(Marker::nth(i + i / 5)), points });
    }
    if kind != ErrorKind::Bias {
        series.extend(guide(declines, &series));
    }
    let (title, unit) = match kind {
        ErrorKind::Mse => ("Mean squared error", "mean squared error  [(W m⁻² sr⁻¹)²]"),
        ErrorKind::Variance => ("Variance of a run's mean", "variance  [(W m⁻² sr⁻¹)²]"),
        ErrorKind::Bias => ("Bias, where beyond its 99.9 % interval", "|bias|  [W m⁻² sr⁻¹]"),
    };
    let most = declines.iter().flat_map(|d| d.marks.last()).max().map_or(2.0, |&n| n as f64);
    Panel {
        title: title.to_owned(),
        x: Axis::log("samples of a run").within(0.8, 1.25 * most),
        y: Axis::log(unit),
        series,
        ..Panel::default()
    }
}

/// A thin line of slope -1 above the first of the points.
fn guide(declines: &[Decline], series: &[Series]) -> Option<Series> {
    let most = declines.iter().flat_map(|d| d.marks.last()).max().map(|&n| n as f64)?;
    let start = series.iter().flat_map(|s| s.points.first()).map(|p| 2.0 * p.x * p.y).reduce(f64::max)?;
    let points = vec![Point::new(1.0, start), Point::new(most, start / most)];
    Some(Series { label: "slope −1".to_owned(), colour: Colour::Grey, style: Style::Dotted, points })
}
