//! Promise: the verdict table sorts, filters and opens by mouse and by keyboard; what a row opens to is what the run has
//! said; costs compare with any baseline, by the numbers of results.csv.

mod browser;

use browser::{Page, Report};
use std::sync::LazyLock;

/// Eight cells in one scene, some of which pass while others stay open.
const FILE: &str = r#"question = "Which is cheapest?"
samples = 2_000
claim = [{ unbiased = { alpha = 1e-3, margin = 0.05 } }]
[[grid]]
scene = ["furnace"]
estimator = ["implicit", "explicit"]
roulette = [{ constant = { q = [0.5, 0.7, 0.9] } }, { depth_clamp = { bounces = 1 } }]
"#;

static REPORT: LazyLock<Report> = LazyLock::new(|| Report::of("tables_sort_and_filter", FILE));

fn page() -> Option<Page> {
    browser::shared().map(|browser| browser.open(&REPORT.page))
}

/// The button of a column's heading.
fn heading(page: &Page, name: &str) -> String {
    let at = page.js(&format!(
        "[...document.querySelector('#cells thead tr').cells].findIndex((cell) => cell.textContent === '{name}') + 1"
    ));
    format!("#cells th:nth-child({at}) button")
}

/// Cells in the order of their rows, of those that are shown.
fn shown(page: &Page) -> Vec<u64> {
    let rows = page.js(
        "[...document.querySelectorAll('#cells tr[data-cell]')].filter((row) => row.getClientRects().length)
        .map((row) => Number(row.dataset.cell))",
    );
    rows.as_array().unwrap().iter().map(|cell| cell.as_u64().unwrap()).collect()
}

fn sorted(page: &Page) -> String {
    page.text("[...document.querySelectorAll('#cells th')].map((th) => th.getAttribute('aria-sort') ?? '').join('')")
}

#[test]
fn columns_sort_by_their_numbers() {
    let Some(page) = page() else { return };
    let button = heading(&page, "efficiency");
    // those without noise have none, and come last whichever the direction
    let rows = REPORT.rows("mean", "R");
    let found: Vec<f64> = rows.iter().map(|row| row.text("efficiency").parse().unwrap_or(f64::NAN)).collect();
    let order = |sign: f64| {
        let mut cells: Vec<u64> = (0..8).collect();
        let key = |cell: u64| Some(sign * found[cell as usize]).filter(|e| e.is_finite());
        cells.sort_by(|&a, &b| key(a).unwrap_or(f64::INFINITY).total_cmp(&key(b).unwrap_or(f64::INFINITY)));
        cells
    };
    assert_ne!(order(1.0), order(-1.0));
    page.click(&button);
    assert_eq!((shown(&page), sorted(&page)), (order(1.0), "ascending".to_owned()));
    page.click(&button);
    assert_eq!((shown(&page), sorted(&page)), (order(-1.0), "descending".to_owned()));
    // the heading still has the focus
    page.press("Enter");
    assert_eq!((shown(&page), sorted(&page)), ((0..8).collect(), String::new()));
    page.press("Enter");
    page.click(&heading(&page, "rule"));
    assert_eq!(sorted(&page), "ascending", "two columns say that they are sorted");
}

#[test]
fn an_opened_row_stays_with_its_own() {
    let Some(page) = page() else { return };
    page.click("tr[data-cell='2'] button.open");
    page.click("tr[data-cell='5'] button.open");
    page.click(&heading(&page, "efficiency"));
    for cell in [2, 5] {
        let below = format!("document.querySelector('tr[data-cell=\"{cell}\"]').nextElementSibling");
        let label = REPORT.said["cells"][cell]["cell"].as_str().unwrap();
        assert_eq!(page.text(&format!("{below}.querySelector('h3').textContent")), label);
    }
    // filtered with it as well
    page.click("input[type='search']");
    page.write("implicit");
    assert_eq!(
        page.js(
            "[...document.querySelectorAll('tr.opened')].filter((row) => row.getClientRects().length).length"
        ),
        1
    );
}

#[test]
fn words_and_verdicts_filter() {
    let Some(page) = page() else { return };
    let count = || page.text("document.querySelector('.filter .count').textContent");
    assert_eq!(count(), "8 of 8 cells");
    page.click("input[type='search']");
    page.write("CLAMP ex");
    assert_eq!((shown(&page), count()), (vec![7], "1 of 8 cells".to_owned()));
    "CLAMP ex".chars().for_each(|_| page.press("Backspace"));
    assert_eq!(shown(&page).len(), 8);
    let passed: Vec<u64> =
        (0..8).filter(|&i| REPORT.said["cells"][i as usize]["verdict"] == "PASS").collect();
    assert!(!passed.is_empty() && passed.len() < 8);
    for (kind, left) in [("PASS", (0..8).filter(|i| !passed.contains(i)).collect()), ("INCONCLUSIVE", vec![])]
    {
        let label = "[...document.querySelectorAll('.filter label')]";
        page.js(&format!(
            "{label}.find((l) => l.textContent.trim() === '{kind}').querySelector('input').id = '{kind}'"
        ));
        page.click(&format!("#{kind}"));
        assert_eq!((shown(&page), count()), (left.clone(), format!("{} of 8 cells", left.len())), "{kind}");
    }
}

#[test]
fn a_row_opens_to_what_the_run_has_said() {
    let Some(page) = page() else { return };
    // one that stayed open after several rounds, so that bets have a history
    let said = &REPORT.said["cells"][0];
    page.click("tr[data-cell='0'] button.open");
    let text = |of: &str| page.text(&format!("document.querySelector('tr.opened {of}').textContent"));
    assert_eq!(text("h3"), said["cell"].as_str().unwrap());
    assert_eq!(text(".command pre"), said["replay"].as_str().unwrap());
    let titles =
        "[...document.querySelectorAll('tr.opened figcaption')].map((title) => title.textContent).join('; ')";
    let titles = page.text(titles);
    assert!(titles.contains("Bounce by bounce") && titles.contains("bets"), "{titles}");
    assert_eq!(page.js("document.querySelectorAll('tr.opened .guard .lamp').length"), 3);
    assert_eq!(page.js("document.querySelectorAll('tr.opened .checks li').length"), 10);
    // the bets' line, and the level that they must reach
    assert_eq!(page.js("document.querySelectorAll('tr.opened [data-series^=\"refuted above\"]').length"), 1);
    page.click("tr.opened details:last-of-type summary");
    let numbers = "[...document.querySelectorAll('tr.opened tbody tr')].find((row) => row.textContent.startsWith('meanR')).cells[2]";
    let mean: f64 = page.text(&format!("{numbers}.textContent")).parse().unwrap();
    assert!((mean - REPORT.rows("mean", "R")[0].number("mean")).abs() < 1e-6, "{mean}");
    // once more closes it; the keyboard does both as well
    let state = || {
        let open = page.js("document.querySelector('tr.opened').getClientRects().length > 0");
        (open, page.text("document.querySelector('tr[data-cell=\"0\"] button.open').ariaExpanded"))
    };
    page.js("document.querySelector('tr[data-cell=\"0\"] button.open').focus()");
    page.press("Enter");
    assert_eq!(state(), (false.into(), "false".to_owned()));
    page.press(" ");
    assert_eq!(state(), (true.into(), "true".to_owned()));
}

#[test]
fn costs_compare_with_any_baseline() {
    let Some(page) = page() else { return };
    let rows = REPORT.rows("mean", "R");
    // relative variance of a sample, per ray
    let price = |i: usize| {
        rows[i].number("variance") * rows[i].number("rays_per_sample") / rows[i].number("truth").powi(2)
    };
    let choose = |label: &str, value: &str| {
        page.js(&format!(
            "(() => {{
               const select = [...document.querySelectorAll('#costs label')].find((l) => l.textContent.startsWith('{label}')).firstElementChild;
               select.value = [...select.options].find((o) => o.textContent === '{value}').value;
               select.dispatchEvent(new Event('change'));
             }})()"
        ));
    };
    choose("channels", "R");
    let heads =
        page.text("[...document.querySelectorAll('#costs th')].map((th) => th.textContent).join('|')");
    let at = heads.split('|').position(|head| head.starts_with("relMSE, equal rays")).unwrap();
    // a cell's error, the speed-up and what is written there
    let row = |i: usize| {
        let cell =
            |column: usize| format!("document.querySelectorAll('#costs tbody tr')[{i}].cells[{column}]");
        let number = |column| page.js(&format!("Number({}.dataset.sort)", cell(column))).as_f64().unwrap();
        (number(at), number(at + 1), page.text(&format!("{}.textContent", cell(at + 1))))
    };
    for (base, other) in [(0, 4), (4, 0), (1, 6)] {
        let rule = |i: usize| format!("{}, constant q={}", rows[i].text("estimator"), rows[i].text("q"));
        choose("baseline", &rule(base));
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a}, not {b}");
        let (error, speed_up, words) = row(other);
        near(error, price(other) / (rows[base].number("samples") * rows[base].number("rays_per_sample")));
        near(speed_up, price(base) / price(other));
        assert_eq!(row(base).2, "baseline");
        let shown: Vec<f64> = words.split(['(', ')', ' ']).filter_map(|word| word.parse().ok()).collect();
        let [ratio, low, high] = shown[..] else { panic!("{words}") };
        assert!((ratio / speed_up - 1.0).abs() < 5e-3 && low < ratio && ratio < high, "{words}");
    }
}
