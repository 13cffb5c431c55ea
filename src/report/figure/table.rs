//! The numbers of a figure.

use super::{Axis, Figure, Mark, Panel, Point, Region, Style};
use crate::report::table::{derived, number};

/// What a figure shows, a row a point: panel, kind (points, curve, bars, mark, region), series, x (of categories: the name),
/// y, and the ends of its error bar. Of a region, x is one of its ends. y and error bars have nine digits, as some of them
/// pass through the platform's logarithm.
pub fn csv(figure: &Figure) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(["panel", "kind", "series", "x", "y", "low", "high"]).expect("a Vec takes all");
    for panel in &figure.panels {
        for record in records(panel) {
            csv.write_record(record).expect("a Vec takes all");
        }
    }
    csv.into_inner().expect("a Vec takes all")
}

fn records(panel: &Panel) -> impl Iterator<Item = [String; 7]> {
    let name = if panel.title.is_empty() { &panel.y.label } else { &panel.title };
    let data = panel.series.iter().flat_map(move |series| {
        let row = |point| record(name, kind(series.style), &series.label, &panel.x, point);
        series.points.iter().map(row)
    });
    let marks = panel.marks.iter().map(move |mark| {
        let (label, x, y) = match mark {
            Mark::Vertical { at, label, .. } => (label, Some(*at), None),
            Mark::Horizontal { at, label, .. } => (label, None, Some(*at)),
            Mark::Point { x, y, label, .. } => (label, Some(*x), Some(*y)),
        };
        [name.clone(), "mark".to_owned(), label.clone(), number(x), derived(y), String::new(), String::new()]
    });
    let regions = panel.regions.iter().flat_map(move |Region { from, to, label, .. }| {
        let end = |x: f64| {
            let empty = String::new;
            [name.clone(), "region".to_owned(), label.clone(), number(Some(x)), empty(), empty(), empty()]
        };
        [end(*from), end(*to)]
    });
    data.chain(marks).chain(regions)
}

fn kind(style: Style) -> &'static str {
    match style {
        Style::Markers(_) | Style::LineMarkers(_) => "points",
        Style::Bars => "bars",
        Style::Line | Style::Dashed | Style::Dotted | Style::DashDotted => "curve",
    }
}

fn record(panel: &str, kind: &str, series: &str, axis: &Axis, point: &Point) -> [String; 7] {
    let category = axis.categories.get(point.x as usize).filter(|_| point.x >= 0.0);
    let x = category.cloned().unwrap_or_else(|| number(Some(point.x)));
    let has_bar = point.low < point.y || point.high > point.y;
    let end = |value: f64| derived(Some(value).filter(|_| has_bar));
    let [panel, kind, series] = [panel, kind, series].map(str::to_owned);
    [panel, kind, series, x, derived(Some(point.y)), end(point.low), end(point.high)]
}
