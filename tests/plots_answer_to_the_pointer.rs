//! Promise: the page's plots tell the values of results.csv under the pointer and to the keyboard, hide what is not wanted,
//! change their axes, and are saved as valid files.

mod browser;

use browser::{Page, Report};
use std::io::Cursor;
use std::sync::LazyLock;

/// Variance over q, and the bias.
const FILE: &str = r#"question = "What does the variance do?"
samples = 2_000
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
plot = [{ bias = {} }, { over = { parameter = "q", show = ["variance"] } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2], emission = 1.0 } }]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.7, 0.8, 0.9] } }]
"#;

static REPORT: LazyLock<Report> = LazyLock::new(|| Report::of("plots_answer_to_the_pointer", FILE));

/// The figure of the variance.
const PLOT: &str = "figure[data-name*='_over_q_']";

fn page() -> Option<Page> {
    browser::shared().map(|browser| browser.open(&REPORT.page))
}

fn readout(page: &Page) -> String {
    page.text(&format!("document.querySelector(\"{PLOT} .readout\").textContent"))
}

/// The middles of what matches in the figure, as far as it is seen, which is scrolled into sight.
fn middles(page: &Page, of: &str) -> Vec<(f64, f64)> {
    let found = page.js(&format!(
        "(() => {{
           const plot = document.querySelector(\"{PLOT}\");
           plot.scrollIntoView({{ block: 'center', behavior: 'instant' }});
           return [...plot.querySelectorAll(\"{of}\")].map((one) => one.getBoundingClientRect())
             .filter((box) => box.width).map((box) => [box.left + box.width / 2, box.top + box.height / 2]);
         }})()"
    ));
    let at = |place: &serde_json::Value| (place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    found.as_array().unwrap().iter().map(at).collect()
}

/// "…q 0.5: 2.07 (…)": where and what.
fn told(readout: &str) -> (String, f64) {
    let (place, value) = readout.rsplit_once(": ").unwrap_or_else(|| panic!("{readout:?}"));
    let value = value.split(" (").next().unwrap().replace('−', "-");
    let digit = |c: char| {
        "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|raised| raised == c).map_or('-', |i| char::from(b'0' + i as u8))
    };
    let number = match value.split_once("·10") {
        Some((factor, power)) => format!("{factor}e{}", power.chars().map(digit).collect::<String>()),
        None => value,
    };
    (place.rsplit(' ').next().unwrap().to_owned(), number.parse().unwrap_or_else(|_| panic!("{readout:?}")))
}

#[test]
fn the_pointer_finds_the_measured_values() {
    let Some(page) = page() else { return };
    let points = middles(&page, "svg g path[transform]");
    assert!(points.len() >= 3, "{points:?}");
    let mut found = 0;
    for (x, y) in points {
        page.hover(x, y);
        let words = readout(&page);
        let (q, value) = told(&words);
        let rows = REPORT.rows("mean", &words[..1]);
        let row = rows.iter().find(|row| row.text("q") == q).unwrap_or_else(|| panic!("{words}"));
        let right = row.number("variance");
        assert!((value / right - 1.0).abs() < 5e-4, "{words}, not {right}");
        found += 1;
    }
    assert!(found >= 3);
    // far from all of them nothing is told
    let (x, y) = middles(&page, "svg.chart")[0];
    let half = page.js(&format!("document.querySelector(\"{PLOT} svg.chart\").clientWidth / 2 - 4"));
    page.hover(x - half.as_f64().unwrap(), y);
    assert_eq!(readout(&page).trim(), "");
}

#[test]
fn arrow_keys_step_through_the_points() {
    let Some(page) = page() else { return };
    page.js(&format!("document.querySelector(\"{PLOT} svg.chart\").focus()"));
    let step = |key: &str| {
        page.press(key);
        readout(&page)
    };
    let [first, second, back, last] = ["ArrowRight", "ArrowRight", "ArrowLeft", "ArrowLeft"].map(step);
    assert_eq!(first, back);
    assert!(first != second && last != first && last != second, "{first}, {second}, {last}");
    assert!([first, second, last].iter().all(|words| told(words).1 > 0.0));
}

#[test]
fn the_legend_hides_and_the_axes_change() {
    let Some(page) = page() else { return };
    let count = |page: &Page| middles(page, "svg g[data-series] path").len();
    let all = count(&page);
    page.click(&format!("{PLOT} .legend button"));
    assert_eq!(page.text(&format!("document.querySelector(\"{PLOT} .legend button\").ariaPressed")), "false");
    let fewer = count(&page);
    assert!(fewer < all, "{fewer} of {all} are left");
    let before = middles(&page, "svg g[data-series] path[transform]");
    page.click(&format!("{PLOT} .axes input"));
    let after = middles(&page, "svg g[data-series] path[transform]");
    assert_ne!(before, after, "the choice of the axis changes nothing");
    assert_eq!(count(&page), fewer, "it shows what is hidden");
    page.click(&format!("{PLOT} .legend button"));
    assert!(count(&page) > fewer);
    // what has values without a logarithm is not offered one
    assert_eq!(page.js("document.querySelectorAll(\"figure[data-name='bias'] .axes input\").length"), 0);
}

#[test]
fn figures_are_saved_and_have_their_files() {
    let Some(page) = page() else { return };
    let name = page.text(&format!("document.querySelector(\"{PLOT}\").dataset.name"));
    let press = |words: &str| {
        page.js(&format!(
            "[...document.querySelectorAll(\"{PLOT} .tools button\")].find((b) => b.textContent === '{words}').click()"
        ));
    };
    press("Save SVG");
    let svg = String::from_utf8(page.saved(&format!("{name}.svg"))).unwrap();
    let text = serde_json::json!(svg);
    let parsed = format!("new DOMParser().parseFromString({text}, 'image/svg+xml')");
    assert_eq!(page.text(&format!("{parsed}.documentElement.tagName")), "svg");
    assert_eq!(page.js(&format!("{parsed}.querySelectorAll('svg g path').length > 3")), true);
    press("Save PNG");
    let png = page.saved(&format!("{name}.png"));
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let (white, inked) =
        pixels.chunks(4).fold((0, 0), |(w, i), p| if p[..3] == [255; 3] { (w + 1, i) } else { (w, i + 1) });
    assert!(white > inked && inked > 1000, "{white} white and {inked} other pixels");
    press("Data");
    let rows =
        page.js(&format!("document.querySelectorAll(\"{PLOT} .wide tbody tr\").length")).as_u64().unwrap();
    let csv = std::fs::read_to_string(REPORT.folder().join(format!("{name}.csv"))).unwrap();
    assert!(rows >= 3 && rows as usize <= csv.lines().count(), "{rows} rows");
    let links =
        page.js("[...document.querySelectorAll('figure .files a')].map((a) => a.getAttribute('href'))");
    let links = links.as_array().unwrap();
    assert_eq!(links.len(), 6);
    for link in links {
        assert!(REPORT.folder().join(link.as_str().unwrap()).is_file(), "{link} is not there");
    }
    assert_eq!(page.complaints(), [""; 0]);
}
