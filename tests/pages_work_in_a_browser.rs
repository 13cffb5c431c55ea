//! Promise: a report's page opens from disk without complaint and asks nobody for anything; names stay text; it fits narrow
//! and wide screens, light and dark, paper, and readers without a mouse, without good eyes or without scripts.

mod browser;

use browser::{Page, Report};
use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;
use std::time::Instant;

/// A probe, images, and a scene whose name wants to be more than text.
const FILE: &str = r#"question = "Is <b>this</b> text?"
samples = 2_000
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
plot = [{ bias = {} }, { over = { parameter = "q", show = ["variance"] } }]
[[grid]]
scene = ["furnace"]
estimator = ["implicit"]
roulette = [{ constant = { q = [0.5, 0.7] } }, { depth_clamp = { bounces = 1 } }]
[[grid]]
scene = [{ cornell_box = { resolution = 16 } }]
estimator = ["explicit", "implicit"]
roulette = ["throughput"]
samples = 130
[[grid]]
estimator = ["implicit", "explicit"]
roulette = ["albedo"]
samples = 20
[[grid.scene]]
[grid.scene.primitives]
name = 'NAME'
primitives = [{ shape = { sphere = { center = [0, 0, 0], radius = 1, inward = true } }, albedo = 0.5, emission = 1 }]
sensor = { camera = { origin = [0, 0, 0], direction = [0, 0, 1], up = [0, 1, 0], fov = 40, resolution = 4 } }
"#;

const HOSTILE: &str = "\"><script>window.hit = 1</script><img src=x onerror=hit=1>";

/// Opens every row of the verdict table.
const OPEN_ALL: &str = "document.querySelectorAll('button.open').forEach((button) => button.click())";

/// Seconds within which the page is awake, on a machine that does other things as well.
const AWAKE: f64 = 5.0;

/// The page of one run, shared by all tests.
static PAGE: LazyLock<PathBuf> =
    LazyLock::new(|| Report::of("pages_work_in_a_browser", &FILE.replace("NAME", HOSTILE)).page);

/// That over all experiments of the folder.
fn overview() -> PathBuf {
    PAGE.ancestors().nth(2).unwrap().join("index.html")
}

/// The page, opened and awake; `None` where there is no browser.
fn page() -> Option<Page> {
    browser::shared().map(|browser| browser.open(&PAGE))
}

#[track_caller]
fn fits(page: &Page, what: &str) {
    let [wide, seen] =
        ["document.documentElement.scrollWidth", "innerWidth"].map(|of| page.js(of).as_f64().unwrap());
    let widest =
        "[...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > innerWidth)
        .map((e) => e.outerHTML.slice(0, 80)).slice(0, 5)";
    assert!(wide <= seen, "{what}: {wide} pixels in {seen}: {}", page.js(widest));
}

#[test]
fn the_driver_hears_of_what_goes_wrong() {
    let Some(browser) = browser::shared() else { return };
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("a page.html");
    let scripts = "console.error('told'); console.assert(false, 'held'); setTimeout(() => { throw new Error('thrown') })";
    let body = "<p style='width: 2000px' id=p>&nbsp;<img src='https://furnace.invalid/x.png'><input>";
    fs::write(&file, format!("<!DOCTYPE html><body data-ready=1>{body}<script>{scripts}</script>")).unwrap();
    let page = browser.open(&file);
    page.wait_for("document.images[0].complete");
    let complaints = page.complaints().join("\n");
    for heard in ["told", "held", "Error: thrown", "ERR_NAME_NOT_RESOLVED"] {
        assert!(complaints.contains(heard), "{heard} is not in {complaints}");
    }
    assert_eq!(page.requests(), ["https://furnace.invalid/x.png"]);
    let broken: Vec<String> = page.axe().into_iter().map(|finding| finding.rule).collect();
    for rule in ["html-has-lang", "image-alt", "label"] {
        assert!(broken.iter().any(|broken| broken == rule), "axe does not find {rule} in {broken:?}");
    }
    assert!(page.js("document.documentElement.scrollWidth > innerWidth") == true);
}

#[test]
fn keys_and_mouse_reach_the_page() {
    let Some(browser) = browser::shared() else { return };
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("index.html");
    let body = "<button onclick='clicks++'>b</button><input><a download='x.csv' href='data:text/csv,1'>a</a><div style='height: 3000px'></div>
        <script>let clicks = 0, keys = [], moves = 0;
        addEventListener('keydown', (e) => keys.push(e.shiftKey + e.key));
        addEventListener('mousemove', (e) => moves += e.buttons);</script>";
    fs::write(&file, format!("<!DOCTYPE html><body data-ready=1>{body}")).unwrap();
    let page = browser.open(&file);
    page.click("button");
    page.press("Enter");
    page.press(" ");
    assert_eq!(page.js("clicks"), 3);
    page.press("Tab");
    page.write("a 1");
    page.press("Shift+Tab");
    assert_eq!(page.text("document.querySelector('input').value"), "a 1");
    assert_eq!(page.text("keys.join()"), "falseEnter,false ,falseTab,falsea,false ,false1,trueTab");
    page.drag((10.0, 100.0), (50.0, 120.0));
    assert_eq!(page.js("moves"), 2);
    page.click("a");
    assert_eq!(page.saved("x.csv"), b"1");
    page.wheel(100.0, 100.0, 500.0);
    page.wait_for("scrollY === 500");
}

#[test]
fn the_page_opens_from_disk_and_asks_nobody() {
    let Some(browser) = browser::shared() else { return };
    let (page, file) = (browser.page(), &*PAGE);
    let start = Instant::now();
    page.load(file);
    page.ready();
    let seconds = start.elapsed().as_secs_f64();
    println!("awake after {seconds:.3} s");
    assert!(seconds < AWAKE, "awake after {seconds} s");
    assert_eq!(page.complaints(), [""; 0]);
    assert_eq!(page.requests(), [""; 0]);
}

#[test]
fn names_stay_text() {
    let Some(page) = page() else { return };
    page.js(OPEN_ALL);
    // in the table, above what rows open to, in their commands, over costs and in the viewer
    let shown = "['#cells', 'tr.opened h3', 'tr.opened pre', '#costs', '#viewer'].filter((place) =>
        [...document.querySelectorAll(place)].some((e) => e.textContent.includes(name))).join()";
    let shown = page.text(&format!("const name = {}; {shown}", serde_json::json!(HOSTILE)));
    assert_eq!(shown, "#cells,tr.opened h3,tr.opened pre,#costs,#viewer");
    page.js("document.querySelectorAll('.plot .tools button').forEach((b) => b.textContent === 'Data' && b.click())");
    assert!(page.text("document.querySelector('.question').textContent").contains("<b>this</b>"));
    assert_eq!(page.text("typeof window.hit"), "undefined");
    assert_eq!(page.js("document.querySelectorAll('[onerror], [src=x], .question b').length"), 0);
    // one that wakes the page, and blocks of data, which do not run
    let running = "[...document.scripts].filter((s) => !s.type || /javascript|module/.test(s.type)).length";
    assert_eq!(page.js(running), 1);
}

#[test]
fn the_page_fits_narrow_and_wide_screens() {
    let Some(page) = page() else { return };
    page.js("document.querySelector('button.open').click()");
    for width in [1600, 360] {
        page.resize(width, 800, 1.0);
        page.screenshot(&format!("page_{width}"));
        fits(&page, &format!("{width} pixels"));
        // what a row opens to is no wider than what is seen of its table
        let right = "document.querySelector('.details').getBoundingClientRect().right <= innerWidth";
        assert!(page.js(right) == true, "an opened row is cut off at {width} pixels");
    }
}

#[test]
fn readers_of_all_kinds_can_use_the_page() {
    let Some(browser) = browser::shared() else { return };
    for (name, file) in [("page", PAGE.clone()), ("overview", overview())] {
        let page = browser.open(&file);
        page.js("document.querySelector('button.open')?.click()");
        for (width, scheme) in [(1280, "light"), (1280, "dark"), (360, "light"), (360, "dark")] {
            page.resize(width, 800, 1.0);
            page.show_as("screen", scheme);
            page.screenshot(&format!("{name}_{scheme}_{width}"));
            assert_eq!(page.axe(), [], "{name}, {scheme}, {width} pixels");
        }
    }
}

#[test]
fn the_style_is_what_the_reader_prefers_or_chooses() {
    let Some(page) = page() else { return };
    let dark = "(([r, g, b]) => r + g + b < 200)(getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g).map(Number))";
    for (scheme, is_dark) in [("dark", true), ("light", false)] {
        page.show_as("screen", scheme);
        assert!(page.js(dark) == is_dark, "{scheme}");
        let offered = if is_dark { "Light style" } else { "Dark style" };
        assert_eq!(page.text("document.querySelector('button.theme').textContent"), offered);
        page.click("button.theme");
        assert!(page.js(dark) != is_dark, "{scheme}: the button changes nothing");
        page.show_as("print", scheme);
        assert!(page.js(dark) == false, "{scheme}: paper is white");
        page.js("delete document.documentElement.dataset.theme");
    }
}

#[test]
fn the_page_can_be_read_without_scripts() {
    let Some(browser) = browser::shared() else { return };
    let page = browser.page();
    page.run_scripts(false);
    page.load(&PAGE);
    assert!(page.js("document.body.dataset.ready").is_null(), "scripts have run");
    let text = page.text("document.body.innerText");
    for words in ["Is <b>this</b> text?", "Of 87 questions", "PASS", "INCONCLUSIVE", HOSTILE] {
        assert!(text.contains(words), "{words} cannot be read");
    }
    let links = page.js("[...document.querySelectorAll('a[href]')].map((a) => a.getAttribute('href')).filter((href) => !href.startsWith('#'))");
    let links: Vec<&str> = links.as_array().unwrap().iter().map(|link| link.as_str().unwrap()).collect();
    for kind in ["results.csv", ".exr", ".png"] {
        assert!(links.iter().any(|link| link.ends_with(kind)), "no link to {kind} in {links:?}");
    }
    for link in links.iter().filter(|link| !link.contains("://")) {
        assert!(PAGE.with_file_name(link).is_file(), "{link} is not there");
    }
    assert_eq!(page.complaints(), [""; 0]);
}

#[test]
fn paper_keeps_the_verdicts() {
    let Some(page) = page() else { return };
    page.js("document.querySelector('button.open').click()");
    page.show_as("print", "dark");
    // a column of an A4 page
    page.resize(720, 1000, 1.0);
    page.screenshot("page_print");
    let text = page.text("document.body.innerText");
    for words in ["Is <b>this</b> text?", "PASS", "INCONCLUSIVE", HOSTILE] {
        assert!(text.contains(words), "{words} is not printed");
    }
    // a reader cannot scroll paper sideways
    let seen = "(e) => e.getClientRects().length && e.getBoundingClientRect().right <= innerWidth";
    let verdicts = format!("[...document.querySelectorAll('tr[data-cell] .badge')].filter({seen}).length");
    assert_eq!(
        page.js(&verdicts),
        page.js("document.querySelectorAll('#cells tr[data-cell]').length"),
        "verdicts are cut off"
    );
    fits(&page, "paper");
    let controls = "[...document.querySelectorAll('button, input, select')].filter((e) => e.getClientRects().length && !e.closest('.legend, th'))
        .map((e) => e.outerHTML.slice(0, 80))";
    assert_eq!(page.js(controls), serde_json::json!([]), "controls are printed");
    let opened = "[...document.querySelectorAll('tr.opened svg.chart, tr.opened pre')].filter((e) => e.getClientRects().length).length";
    assert!(page.js(opened).as_u64() >= Some(2), "what a row opens to is not printed");
}
