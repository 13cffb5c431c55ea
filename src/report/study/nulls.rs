//! Error rates on synthetic laws, as a table and in words.

use crate::stats::nulls::{Instrument, NullRow};
use maud::{Markup, html};

/// The instruments that decide in the bench, where theory is known.
const DECIDING: [Instrument; 5] = [
    Instrument::BetsAbove,
    Instrument::BetsBelow,
    Instrument::Interval,
    Instrument::KnownBelow,
    Instrument::KnownAbove,
];

fn deciding(row: &&NullRow) -> bool {
    row.bias == 0.0 && row.runs > 0 && DECIDING.iter().any(|i| i.name() == row.instrument)
}

/// Whether no deciding instrument is shown to err more often than it says.
pub fn hold(rows: &[NullRow]) -> bool {
    rows.iter().filter(deciding).all(|row| row.low <= row.level)
}

/// What the laws have shown, a sentence for each level.
pub fn sentences(rows: &[NullRow]) -> Vec<String> {
    let mut levels: Vec<f64> = rows.iter().map(|row| row.level).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let told = |level: f64| {
        let here: Vec<&NullRow> = rows.iter().filter(deciding).filter(|row| row.level == level).collect();
        let exact =
            |row: &&&NullRow| row.instrument.starts_with("bets") || row.instrument.starts_with("interval");
        let worst = |rows: Vec<&&NullRow>| {
            let rate = |row: &NullRow| row.rejected as f64 / row.runs as f64;
            let worst = rows.into_iter().max_by(|a, b| rate(a).total_cmp(&rate(b)))?;
            Some(format!("{:.3} % ({}, at most {:.3} %)", 100.0 * rate(worst), worst.law, 100.0 * worst.high))
        };
        let bets = worst(here.iter().filter(exact).collect())?;
        let t =
            worst(here.iter().filter(|row| !exact(row)).collect()).unwrap_or_else(|| "nothing".to_owned());
        Some(format!(
            "Synthetic samples without bias, at a level of {} %: bets and their limits err in {bets} of runs at worst, t tests \
             where theory lets them decide in {t}.",
            100.0 * level
        ))
    };
    levels.into_iter().filter_map(told).collect()
}

/// All lines.
pub fn table(rows: &[NullRow]) -> Markup {
    html! {
        p {
            "Samples from laws whose mean is known. bias: samples are multiplied by one more than this; without it each "
            "rejection is an error, with it it is a find. Intervals are of 99.9 % [Clopper & Pearson 1934]."
        }
        div.wide { table.matrix {
            thead { tr {
                th { "law" } th.n { "samples" } th.n { "bias" } th.n { "level [%]" } th { "instrument" }
                th.n { "rejected" } th.n { "of runs" } th.n { "rate [%]" } th.n { "between [%]" } th { "note" }
            } }
            tbody { @for row in rows.iter().filter(|row| row.runs > 0) { tr {
                td { (row.law) } td.n { (row.samples) } td.n { (format!("{:+}", row.bias)) } td.n { (100.0 * row.level) }
                td { (row.instrument) } td.n { (row.rejected) } td.n { (row.runs) }
                td.n { (format!("{:.3}", 100.0 * row.rejected as f64 / row.runs as f64)) }
                td.n { (format!("{:.3} … {:.3}", 100.0 * row.low, 100.0 * row.high)) } td { (row.note) }
            } } }
        } }
    }
}

/// `nulls.csv`.
pub fn csv(rows: &[NullRow]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.iter().for_each(|row| csv.serialize(row).expect("a Vec takes all"));
    csv.into_inner().expect("a Vec takes all")
}
