//! `results.csv` of a study.

use super::Studied;
use crate::experiment::Plan;
use crate::experiment::study::{Detection, Instrument};
use crate::report::table;
use crate::truth::Counted;

/// The text: a row for each cell and instrument.
pub fn csv(studied: &Studied<'_>) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<&str> = vec!["experiment", "scene", "estimator", "roulette"];
    header.extend(studied.plan.swept.iter().map(String::as_str));
    header.extend([
        "fault",
        "number",
        "effect",
        "samples",
        "instrument",
        "seeds",
        "found",
        "share",
        "low",
        "high",
    ]);
    header.extend(["needed", "channel_G_mean", "truth", "wrong_mean", "rate", "rate_low", "rate_high"]);
    csv.write_record(&header).expect("a Vec takes all");
    for &(index, detection) in &studied.cells {
        for instrument in Instrument::ALL {
            if let Some(share) = detection.share(instrument) {
                csv.write_record(record(studied.plan, index, detection, instrument, share))
                    .expect("a Vec takes all");
            }
        }
    }
    csv.into_inner().expect("a Vec takes all")
}

fn record(
    plan: &Plan,
    index: usize,
    detection: &Detection,
    instrument: Instrument,
    (share, low, high): (f64, f64, f64),
) -> Vec<String> {
    let cell = &plan.cells[index];
    let fault = cell.fault;
    let right = plan.truth(cell).mean(1, Counted::All).map(|value| value.value);
    let wrong = cell.faulty().and_then(|faulty| faulty.wrong(&cell.scene, 1));
    let mut record = vec![
        plan.name.clone(),
        cell.scene_label.clone(),
        cell.estimator_label.clone(),
        cell.roulette_label.clone(),
    ];
    record.extend(plan.swept.iter().map(|name| table::number(cell.params.get(name).copied())));
    record.extend([
        fault.map_or_else(String::new, |f| f.name.to_owned()),
        fault.map_or_else(String::new, |f| f.number.to_owned()),
        fault.map_or_else(String::new, |f| format!("{:?}", f.effect).to_lowercase()),
        cell.samples.to_string(),
        instrument.name().to_owned(),
        detection.seeds.to_string(),
        (share * detection.seeds as f64).round().to_string(),
        table::number(Some(share)),
        table::derived(Some(low)),
        table::derived(Some(high)),
        detection.needed.map_or_else(String::new, |n| n.to_string()),
        table::number(Some(detection.mean[1])),
        table::number(right),
        table::number(wrong),
        table::derived(detection.rate.map(|r| r.0)),
        table::derived(detection.rate.map(|r| r.1)),
        table::derived(detection.rate.map(|r| r.2)),
    ]);
    record
}
