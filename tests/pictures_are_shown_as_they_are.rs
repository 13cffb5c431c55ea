//! Promise: the image viewer holds the numbers of the EXR files, and shows them flipped, brighter, larger and in false
//! colour as keys and pointer ask.

mod browser;

use browser::{Page, Report};
use exr::prelude::read_first_flat_layer_from_file;
use std::sync::LazyLock;

/// Small pictures.
const FILE: &str = r#"question = "What does it look like?"
samples = 130
[[grid]]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["explicit", "implicit"]
roulette = ["throughput"]
"#;
const SIZE: usize = 16;

/// Milliseconds within which another picture is there; far above what it takes, as machines do other things as well.
const FLIP: f64 = 250.0;

static REPORT: LazyLock<Report> = LazyLock::new(|| Report::of("pictures_are_shown_as_they_are", FILE));

fn page() -> Option<Page> {
    browser::shared().map(|browser| browser.open(&REPORT.page))
}

/// A channel of an EXR file.
fn channel(name: &str, channel: &str) -> Vec<f32> {
    let image = read_first_flat_layer_from_file(REPORT.folder().join(format!("{name}.exr"))).unwrap();
    let found = image.layer_data.channel_data.list.into_iter().find(|one| one.name.to_string() == channel);
    found.unwrap_or_else(|| panic!("{name} has no {channel}")).sample_data.values_as_f32().collect()
}

fn state(page: &Page, name: &str) -> String {
    page.text(&format!("document.getElementById('viewer').dataset.{name}"))
}

fn focus(page: &Page) {
    page.js("document.querySelector('#viewer canvas').focus()");
}

/// What is in the middle of the canvas, where no label is.
fn seen(page: &Page) -> String {
    page.text(
        "((canvas) => canvas.getContext('2d').getImageData(canvas.width / 2 - 50, canvas.height / 2 - 50, 100, 100).data.join())
        (document.querySelector('#viewer canvas'))",
    )
}

#[test]
fn pixels_are_those_of_the_files() {
    let Some(page) = page() else { return };
    let names = page.js("[...document.querySelectorAll('#viewer .list button')].map((b) => (b.click(), document.getElementById('viewer').dataset.shown))");
    let names: Vec<&str> = names.as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert_eq!(names.iter().filter(|name| !name.starts_with("reference")).count(), 2, "{names:?}");
    for (index, name) in names.iter().filter(|name| !name.starts_with("reference")).enumerate() {
        let all = |which: &str| {
            page.js(&format!(
                "Array.from({{ length: {SIZE} * {SIZE} }}, (_, i) => document.getElementById('viewer').pixel({which}, i % {SIZE}, Math.floor(i / {SIZE})))"
            ))
        };
        let pixels = all(&format!("'{name}'"));
        assert_eq!(pixels, all(&index.to_string()));
        let samples = channel(name, "samples");
        for (c, letter) in ["R", "G", "B"].into_iter().enumerate() {
            let spread = channel(name, &format!("variance.{letter}"));
            for (i, value) in channel(name, letter).into_iter().enumerate() {
                let found = pixels[i]["mean"][c].as_f64().unwrap();
                assert_eq!(
                    (found as f32).to_bits(),
                    value.to_bits(),
                    "{name} {letter} {i}: {found}, not {value}"
                );
                assert_eq!(f64::from(found as f32), found);
                let right = f64::from(spread[i] / samples[i]).sqrt();
                let error = pixels[i]["std_error"][c].as_f64().unwrap();
                assert!((error - right).abs() <= 0.03 * right, "{name} {letter} {i}: ± {error}, not {right}");
            }
        }
    }
}

#[test]
fn keys_flip_brighten_and_recolour() {
    let Some(page) = page() else { return };
    focus(&page);
    let first = seen(&page);
    page.press("2");
    assert_eq!(state(&page, "index"), "1");
    let second = seen(&page);
    assert_ne!(first, second, "flipping shows the same");
    page.press("[");
    assert_eq!((state(&page, "index"), seen(&page) == first), ("0".to_owned(), true));
    page.press("e");
    assert_eq!(state(&page, "exposure"), "0.5");
    assert_ne!(seen(&page), first, "half a stop changes nothing");
    page.press("Shift+e");
    assert_eq!((state(&page, "exposure"), seen(&page) == first), ("0".to_owned(), true));
    page.press("v");
    assert_eq!(state(&page, "view"), "false-colour");
    assert_ne!(seen(&page), first, "the view changes nothing");
    page.click("#viewer input[type='number']");
    page.press("Backspace");
    page.write("2");
    page.press("Enter");
    assert_eq!(state(&page, "exposure"), "2");
}

#[test]
fn the_pointer_reads_values_and_zooms_about_itself() {
    let Some(page) = page() else { return };
    let (x, y) = page.middle("#viewer canvas");
    let (x, y) = (x + 200.0, y + 150.0);
    page.hover(x, y);
    let read = |of: &str| page.text(&format!("document.querySelector('#viewer .readout {of}').textContent"));
    let at = read("caption b");
    let (column, row) = at.strip_prefix("x ").and_then(|at| at.split_once(", y ")).unwrap();
    let i = row.parse::<usize>().unwrap() * SIZE + column.parse::<usize>().unwrap();
    let name = state(&page, "shown");
    let (value, error) =
        read("tbody td").split_once(" ± ").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let number = |text: &str| text.replace('−', "-").parse::<f64>().unwrap();
    let right = f64::from(channel(&name, "R")[i]);
    assert!((number(&value) - right).abs() <= 1e-5 * right, "{value}, not {right}");
    let right = f64::from(channel(&name, "variance.R")[i] / channel(&name, "samples")[i]).sqrt();
    assert!((number(&error) - right).abs() <= 0.08 * right, "± {error}, not {right}");
    let turn = |by: f64| {
        let before = state(&page, "zoom");
        page.wheel(x, y, by);
        page.wait_for(&format!("document.getElementById('viewer').dataset.zoom !== '{before}'"));
        read("caption b")
    };
    // until it is larger than its pane, a picture stays in the middle of it
    let at = turn(-600.0);
    for by in [-300.0, -300.0, 300.0] {
        assert_eq!(turn(by), at, "the pixel under the pointer has changed");
    }
    assert!(state(&page, "zoom").parse::<f64>().unwrap() > 4.0);
}

#[test]
fn flipping_is_quick() {
    let Some(page) = page() else { return };
    focus(&page);
    let times = page.js("Array.from({ length: 20 }, () => {
           const canvas = document.querySelector('#viewer canvas');
           const start = performance.now();
           canvas.dispatchEvent(new KeyboardEvent('keydown', { key: ']', bubbles: true }));
           canvas.getContext('2d').getImageData(0, 0, 1, 1); // until it is drawn
           return performance.now() - start;
         })");
    let mut times: Vec<f64> = times.as_array().unwrap().iter().map(|time| time.as_f64().unwrap()).collect();
    times.sort_by(f64::total_cmp);
    println!("a flip takes {:.1} ms, at most {:.1} ms", times[10], times[19]);
    assert!(times[19] < FLIP, "{times:?} ms");
}
