//! What runs have stored.

use super::{says_where, small};
use furnace::experiment::baseline::{Baseline, Comparison};
use furnace::experiment::outcome::Outcome;
use furnace::experiment::{Plan, store, verdict};
use furnace::report::overview::{self, Summary};
use furnace::report::run::Run;
use furnace::report::study::{self, Studied};
use std::path::Path;
use std::sync::LazyLock;

static PLAN: LazyLock<Plan> = LazyLock::new(small);

/// `cells.json`: what is taken can be judged, and stored and read again to the same judgement.
pub fn cells(bytes: &[u8]) {
    let file = Path::new("reports/small/cells.json");
    let mut plan = PLAN.clone();
    let stored = match store::read(file, bytes, &mut plan) {
        Ok(stored) => stored,
        Err(error) => return says_where(&error, file),
    };
    let rows = verdict::rows(&plan, &stored.cells);
    let text = serde_json::to_vec(&stored).expect("cells have a JSON form");
    let again = store::read(file, &text, &mut PLAN.clone()).expect("what is stored can be read");
    assert_eq!(format!("{rows:?}"), format!("{:?}", verdict::rows(&plan, &again.cells)));
}

/// `run.json`.
pub fn run(bytes: &[u8]) {
    let file = Path::new("reports/small/run.json");
    match Run::parse(file, bytes) {
        Ok(run) => {
            let again = Run::parse(file, run.text().as_bytes()).expect("what is stored can be read");
            assert_eq!(run.text(), again.text());
        }
        Err(error) => says_where(&error, file),
    }
}

/// `study.json`: what is taken can be reported.
pub fn study(bytes: &[u8]) {
    let file = Path::new("reports/small/study.json");
    let outcome = match Outcome::parse(file, bytes, &PLAN) {
        Ok(outcome) => outcome,
        Err(error) => return says_where(&error, file),
    };
    let studied = Studied::new(&PLAN, &outcome.detections, &outcome.nulls);
    let (held, table) = (studied.holds(), study::csv(&studied));
    let text = serde_json::to_vec(&outcome).expect("counts have a JSON form");
    let again = Outcome::parse(file, &text, &PLAN).expect("what is stored can be read");
    let again = Studied::new(&PLAN, &again.detections, &again.nulls);
    assert_eq!((held, table), (again.holds(), study::csv(&again)));
}

/// `summary.json`: nothing that it says becomes markup, or a link to elsewhere.
pub fn summary(bytes: &[u8]) {
    let file = Path::new("reports/small/summary.json");
    let summary = match Summary::parse(file, bytes) {
        Ok(summary) => summary,
        Err(error) => return says_where(&error, file),
    };
    assert_eq!(Summary::parse(file, summary.text().as_bytes()).ok().as_ref(), Some(&summary));
    let empty = Summary { experiment: "small".to_owned(), ..summary };
    let page = overview::overview(&[empty]);
    let card = page.split("<article").nth(1).expect("a card").split("</article").next().unwrap_or_default();
    assert!(!card.contains("<script"), "{card}");
    let figures = card.split("src=\"small/").skip(1).filter_map(|rest| rest.split('"').next());
    figures.for_each(|figure| assert!(!figure.contains('/'), "a figure in another folder: {figure}"));
}

/// A stored baseline: what is taken can be compared with, and is unchanged beside itself.
pub fn baseline(bytes: &[u8]) {
    let file = Path::new("reports/.baselines/before/small.json");
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let baseline = match Baseline::read(file, text) {
        Ok(baseline) => baseline,
        Err(error) => return says_where(&error, file),
    };
    let again = Baseline::read(file, &baseline.text()).expect("what is stored can be read");
    assert!(again == baseline, "a baseline that is stored is another one");
    assert_eq!(Comparison::new("before", baseline.clone(), &again).questions, 0);
    // each value beside another one
    let mut moved = again.clone();
    for cell in &mut moved.cells {
        cell.mean.rotate_left(1);
        cell.variance.rotate_left(1);
        cell.samples = cell.samples.wrapping_add(1);
    }
    let _ = Comparison::new("before", baseline, &moved);
}
