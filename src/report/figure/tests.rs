use super::*;
use crate::report::figure::canvas::{Canvas, Shape};
use crate::report::figure::look::Look;

fn series(style: Style, points: Vec<Point>) -> Series {
    Series { label: "data".to_string(), colour: Colour::Blue, style, points }
}

fn figure(y: Axis, series: Vec<Series>) -> Figure {
    Figure {
        title: "title".to_string(),
        alt: "what is seen".to_string(),
        panels: vec![Panel { y, series, ..Panel::default() }],
        columns: 1,
    }
}

fn drawn(figure: &Figure) -> Canvas {
    font::register().expect("the font is readable");
    sheet::draw(figure, Look::SCREEN)
}

fn texts(canvas: &Canvas) -> Vec<&str> {
    let texts = canvas.shapes.iter().filter_map(|shape| match shape {
        Shape::Text { text, .. } => Some(text.as_str()),
        _ => None,
    });
    texts.collect()
}

/// Opening and closing tags, for a document without comments.
fn is_balanced(svg: &str) -> bool {
    let opened = svg.matches('<').count() - svg.matches("</").count();
    let closed = svg.matches("/>").count() + svg.matches("</").count();
    opened == closed && svg.matches('<').count() == svg.matches('>').count()
}

#[test]
fn the_font_is_registered_and_has_the_expected_em() {
    font::register().expect("the font is readable");
    font::register().expect("a second time too");
    // DejaVu Sans: a digit is 1303 of 2048 units wide; the line height of 1.24 em must cancel
    assert!((font::width("0000", 100.0) - 4.0 * 63.6).abs() < 0.5);
    assert!(font::width("ϱ̄ ≤ 10⁻³ → ∞", 12.0) > 50.0);
    assert!(WOFF2.starts_with(b"wOF2"));
}

#[test]
fn text_is_wrapped_at_spaces_and_within_long_words() {
    font::register().expect("the font is readable");
    let lines = font::wrap("one two  three", 10.0, 45.0);
    assert_eq!(lines, ["one two", "three"]);
    let lines = font::wrap("incomprehensibilities", 10.0, 45.0);
    assert!(lines.len() > 1 && lines.concat() == "incomprehensibilities");
    assert!(font::wrap(" \n", 10.0, 45.0).is_empty());
    assert_eq!(font::wrap("ab", 10.0, 0.0), ["a", "b"]);
}

#[test]
fn values_without_a_place_are_flagged_not_drawn() {
    for style in [Style::Line, Style::Dashed, Style::Markers(Marker::Circle), Style::Bars] {
        for value in [0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let points = vec![Point::new(1.0, 1.0), Point::new(2.0, value)];
            let canvas = drawn(&figure(Axis::log("y"), vec![series(style, points)]));
            assert_eq!(canvas.flags.len(), 1, "{style:?} {value}");
            assert_eq!(canvas.missing, value.is_nan());
            assert_eq!(canvas.beyond, !value.is_nan());
        }
    }
}

#[test]
fn values_out_of_a_given_range_are_flagged() {
    let points = vec![Point::new(0.0, 0.5), Point::new(1.0, 7.0)];
    let data = vec![series(Style::Markers(Marker::Square), points)];
    let canvas = drawn(&figure(Axis::linear("y").within(0.0, 1.0), data));
    assert_eq!(canvas.flags.len(), 1);
    assert!(texts(&canvas).iter().any(|text| text.contains("beyond")));
}

#[test]
fn an_ordinary_figure_has_no_flags() {
    let points = vec![Point::between(1.0, 1.0, 0.5, 2.0), Point::between(9.0, 100.0, 90.0, 120.0)];
    for axis in [Axis::log("y"), Axis::linear("y")] {
        for style in [Style::LineMarkers(Marker::Cross), Style::Bars] {
            let canvas = drawn(&figure(axis.clone(), vec![series(style, points.clone())]));
            assert!(canvas.flags.is_empty() && !canvas.beyond && !canvas.missing);
        }
    }
}

#[test]
fn flags_of_several_series_do_not_cover_one_another() {
    let curve = |style| series(style, vec![Point::new(1.0, f64::INFINITY)]);
    let data = vec![curve(Style::Line), curve(Style::Dashed)];
    let canvas = drawn(&figure(Axis::linear("y"), data));
    assert_eq!(canvas.flags.len(), 2);
    assert!((canvas.flags[0].1 - canvas.flags[1].1).abs() > 9.0);
}

#[test]
fn strange_figures_do_not_panic() {
    assert!(svg(&Figure::default()).is_ok());
    let extremes = [0.0, 1.0, -1.0, 1e-320, 1e308, -1e308, f64::MAX, f64::NAN];
    let ranges = extremes.iter().flat_map(|&low| extremes.map(|high| Some((low, high)))).chain([None]);
    for range in ranges {
        for scale in [Scale::Linear, Scale::Log] {
            let axis = Axis { range, scale, ..Axis::default() };
            let points = extremes.map(|v| Point::between(v, v, -v, f64::INFINITY));
            let mut figure = figure(axis.clone(), vec![series(Style::Dashed, vec![])]);
            figure.columns = 0;
            figure.panels[0].x = axis;
            drawn(&figure);
            figure.panels[0].series =
                vec![series(Style::Dotted, points.to_vec()), series(Style::Bars, points.to_vec())];
            drawn(&figure);
        }
    }
}

#[test]
fn linear_ticks_are_short_decimals() {
    let points = vec![Point::new(0.0, 0.0), Point::new(1.0, 0.7)];
    let canvas = drawn(&figure(Axis::linear("y"), vec![series(Style::Line, points)]));
    assert!(texts(&canvas).contains(&"0.3"));
    assert!(texts(&canvas).iter().all(|text| text.len() < 9));
}

#[test]
fn log_ticks_are_powers_of_ten() {
    let points = vec![Point::new(0.0, 1e-4), Point::new(1.0, 10.0)];
    let canvas = drawn(&figure(Axis::log("y"), vec![series(Style::Line, points)]));
    for tick in ["10⁻⁴", "10⁻¹", "10⁰", "10¹"] {
        assert!(texts(&canvas).contains(&tick), "{tick}");
    }
}

#[test]
fn many_categories_lie_on_their_side() {
    let names: Vec<String> = (0..16).map(|n| format!("throughput from {n}")).collect();
    let points = (0..16).map(|n| Point::new(f64::from(n), 1.0)).collect();
    let mut figure = figure(Axis::linear("y"), vec![series(Style::Bars, points)]);
    figure.panels[0].x = Axis::categories("rule", names.clone());
    let canvas = drawn(&figure);
    for name in &names {
        assert!(texts(&canvas).contains(&name.as_str()));
    }
    let ends: Vec<_> = canvas
        .shapes
        .iter()
        .filter_map(|shape| match shape {
            Shape::Text { at, text, .. } if names.contains(text) => Some(*at),
            _ => None,
        })
        .collect();
    assert!(ends.windows(2).all(|pair| pair[0].0 == pair[1].0));
    assert!(ends.windows(2).all(|pair| pair[1].1 - pair[0].1 > 15.0));
}

#[test]
fn a_label_is_listed_once_for_curve_and_markers() {
    let points = vec![Point::new(0.0, 1.0), Point::new(1.0, 2.0)];
    let data = vec![series(Style::Dashed, points.clone()), series(Style::Markers(Marker::Circle), points)];
    let canvas = drawn(&figure(Axis::linear("y"), data));
    let listed = texts(&canvas).iter().filter(|text| **text == "data").count();
    assert_eq!(listed, 1);
}

#[test]
fn labels_are_escaped_and_the_same_figure_gives_the_same_bytes() {
    let hostile = "\"<script>alert('x')</script>\u{1}&";
    let points = vec![Point::between(1.0, 1.0, 0.5, 2.0), Point::new(2.0, 0.0)];
    let mut figure = figure(Axis::log(hostile), vec![series(Style::Line, points)]);
    figure.title = hostile.to_string();
    figure.alt = hostile.to_string();
    figure.panels[0].title = hostile.to_string();
    figure.panels[0].series[0].label = hostile.to_string();
    let text = svg(&figure).expect("the figure is drawn");
    assert!(!text.contains("<script") && text.contains("&lt;script&gt;"));
    assert!(text.contains("font-family=\"Furnace Sans, "));
    assert!(!text.contains('\u{1}') && is_balanced(&text));
    assert_eq!(text, svg(&figure).expect("the figure is drawn again"));
    let png = || paint::png(&drawn(&figure)).expect("the figure is drawn");
    assert_eq!(png(), png());
}

#[test]
fn the_files_carry_the_stem_with_its_points() {
    let directory = std::env::temp_dir().join(format!("figure-{}", std::process::id()));
    fs::create_dir_all(&directory).expect("a directory can be made");
    let stem = directory.join("q=0.5");
    write(&Figure::default(), &stem).expect("the figure is written");
    let saved = fs::read_to_string(directory.join("q=0.5.svg")).expect("the SVG is there");
    assert_eq!(saved, svg(&Figure::default()).expect("the figure is drawn"));
    let png = fs::read(directory.join("q=0.5.png")).expect("the PNG is there");
    assert!(png.starts_with(b"\x89PNG"));
    fs::remove_dir_all(&directory).expect("the directory can be removed");
    let error = write(&Figure::default(), &stem).expect_err("there is no directory");
    assert!(error.to_string().contains("q=0.5.svg"));
}
