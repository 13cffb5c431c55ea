//! Bounce by bounce: how far a cell is from what theory expects of it, against the margin.

use crate::estimator::BINS;
use crate::experiment::row::CHANNELS;
use crate::experiment::spec::Claim;
use crate::experiment::{Estimand, Row};
use crate::report::curves::CHANNEL_COLOURS;
use crate::report::figure::{Axis, Colour, Figure, Mark, Marker, Panel, Point, Series, Style};
use crate::report::lookup::Lookup;
use crate::report::table;

/// The figure, if anything is known to compare with; deviations in percent of the whole, as margins are.
pub fn figure(lookup: &Lookup<'_>, cell: usize) -> Option<Figure> {
    let against_truth = series(lookup, cell, Estimand::Mean, Estimand::Bounce);
    let is_judged = against_truth.iter().any(|s| !s.points.is_empty());
    let (series, margin, what) = if is_judged {
        let scene = &lookup.plan.cells[cell].scene_label;
        let limits = lookup.plan.spec.claim.iter().filter_map(Claim::unbiased).find(|l| l.covers(scene));
        (against_truth, limits.map(|limits| limits.margin), "truth")
    } else {
        let claims = lookup.plan.spec.claim.iter();
        let margin = |claim: &Claim| match claim {
            Claim::Agree { margin, .. } => Some(*margin),
            _ => None,
        };
        let series = series(lookup, cell, Estimand::Agree, Estimand::AgreeBounce);
        (series, claims.filter_map(margin).next(), "the other cell's mean")
    };
    let last = series.iter().flat_map(|s| &s.points).map(|point| point.x as usize).max()?;
    let bin = |bin: usize| format!("bounce {}", table::index(Estimand::Bounce(bin), bin));
    let names: Vec<String> = std::iter::once("all".to_owned()).chain((0..last).map(bin)).collect();
    let line = |at: f64, label: String| Mark::Horizontal { at, label, colour: Colour::Black };
    let marks =
        margin.map(|m| 100.0 * m).map(|m| [line(m, format!("margin ±{m} %")), line(-m, String::new())]);
    Some(Figure {
        title: "Bounce by bounce, with simultaneous intervals".to_owned(),
        alt: "Deviation of the mean and of each bounce from what theory expects, in percent of the whole."
            .to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::categories("", names),
            y: Axis::linear(&format!("(measured − expected) / {what}  [%]")),
            marks: marks.into_iter().flatten().collect(),
            series,
            lying: true,
            ..Panel::default()
        }],
    })
}

/// A series a channel: the whole at 0, bounce k at k + 1.
fn series(lookup: &Lookup<'_>, cell: usize, whole: Estimand, part: fn(usize) -> Estimand) -> Vec<Series> {
    let of_channel = |channel: usize| {
        let row = |estimand| lookup.row(cell, estimand, Some(channel));
        let scale = row(whole).and_then(|row| row.truth).filter(|&truth| truth != 0.0);
        let bins = (0..BINS).map(|bin| (bin + 1, row(part(bin))));
        let rows = std::iter::once((0, row(whole))).chain(bins);
        let point = |(x, row): (usize, Option<&Row>)| {
            let (row, scale) = (row?, 100.0 / scale?);
            let expected = row.expected_bias.unwrap_or(0.0);
            let (low, high) = row.ci?;
            let at = |bias: f64| (bias - expected) * scale;
            Some(Point::between(x as f64, at(row.bias?), at(low), at(high)))
        };
        Series {
            label: CHANNELS[channel].to_owned(),
            colour: CHANNEL_COLOURS[channel],
            style: Style::Markers(Marker::nth(channel)),
            points: rows.filter_map(point).collect(),
        }
    };
    (0..3).map(of_channel).collect()
}
