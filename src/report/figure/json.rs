//! A figure as data, for the page's script, which draws it anew.

use super::{Axis, Colour, Figure, Mark, Marker, Panel, Point, Region, Scale, Series, Style};
use serde_json::{Value, json};

/// The figure; numbers have seven digits, those that are not finite are texts ("inf", "-inf", "NaN").
pub fn json(figure: &Figure) -> Value {
    json!({
        "title": figure.title,
        "alt": figure.alt,
        "columns": figure.columns.max(1),
        "panels": figure.panels.iter().map(panel).collect::<Vec<_>>(),
    })
}

fn panel(panel: &Panel) -> Value {
    json!({
        "title": panel.title,
        "x": axis(&panel.x),
        "y": axis(&panel.y),
        "lying": panel.lying,
        "regions": panel.regions.iter().map(region).collect::<Vec<_>>(),
        "marks": panel.marks.iter().map(mark).collect::<Vec<_>>(),
        "series": panel.series.iter().map(series).collect::<Vec<_>>(),
    })
}

fn axis(axis: &Axis) -> Value {
    json!({
        "label": axis.label,
        "log": axis.scale == Scale::Log,
        "range": axis.range.map(|(low, high)| [number(low), number(high)]),
        "categories": axis.categories,
    })
}

fn region(region: &Region) -> Value {
    let Region { from, to, label, colour } = region;
    json!({ "from": number(*from), "to": number(*to), "label": label, "colour": hex(*colour) })
}

fn mark(mark: &Mark) -> Value {
    match mark {
        Mark::Vertical { at, label, colour } => {
            json!({ "kind": "vertical", "x": number(*at), "label": label, "colour": hex(*colour) })
        }
        Mark::Horizontal { at, label, colour } => {
            json!({ "kind": "horizontal", "y": number(*at), "label": label, "colour": hex(*colour) })
        }
        Mark::Point { x, y, label, colour } => {
            json!({ "kind": "point", "x": number(*x), "y": number(*y), "label": label, "colour": hex(*colour) })
        }
    }
}

fn series(series: &Series) -> Value {
    let (style, marker) = match series.style {
        Style::Line => ("line", None),
        Style::Dashed => ("dashed", None),
        Style::Dotted => ("dotted", None),
        Style::DashDotted => ("dash_dotted", None),
        Style::Markers(marker) => ("markers", Some(marker)),
        Style::LineMarkers(marker) => ("line", Some(marker)),
        Style::Bars => ("bars", None),
    };
    let marker = marker.map(|marker| match marker {
        Marker::Circle => "circle",
        Marker::Square => "square",
        Marker::Triangle => "triangle",
        Marker::Diamond => "diamond",
        Marker::Cross => "cross",
    });
    json!({
        "label": series.label,
        "colour": hex(series.colour),
        "style": style,
        "marker": marker,
        "points": series.points.iter().map(point).collect::<Vec<_>>(),
    })
}

/// `[x, y]`, or `[x, y, low, high]` with an error bar.
fn point(point: &Point) -> Value {
    let Point { x, y, low, high } = *point;
    let has_bar = |end: f64| end != y && !end.is_nan();
    if has_bar(low) || has_bar(high) {
        Value::Array([x, y, low, high].map(number).to_vec())
    } else {
        Value::Array([x, y].map(number).to_vec())
    }
}

fn number(value: f64) -> Value {
    let short: f64 = format!("{value:.6e}").parse().expect("what was written as a number reads as one");
    if short.is_finite() { json!(short) } else { json!(short.to_string()) }
}

/// "#0072b2".
fn hex(colour: Colour) -> String {
    let (r, g, b) = colour.rgb();
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_nothing_becomes_null() {
        let told = |v: f64| number(v).to_string();
        assert_eq!(told(1.0 / 3.0), "0.3333333");
        assert_eq!(told(1234567.89), "1234568.0");
        assert_eq!(
            [f64::INFINITY, f64::NEG_INFINITY, f64::NAN].map(told),
            ["\"inf\"", "\"-inf\"", "\"NaN\""]
        );
    }

    #[test]
    fn error_bars_are_told_where_there_are_any() {
        assert_eq!(point(&Point::new(1.0, 2.0)).to_string(), "[1.0,2.0]");
        assert_eq!(point(&Point::between(1.0, 2.0, 1.5, 2.5)).to_string(), "[1.0,2.0,1.5,2.5]");
        assert_eq!(point(&Point::between(1.0, 2.0, f64::NAN, 2.5)).to_string(), "[1.0,2.0,\"NaN\",2.5]");
    }
}
