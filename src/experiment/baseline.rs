//! What is kept of a run to compare later ones with, and the comparison: mean, variance, efficiency and rays of each cell,
//! with intervals that hold together.

mod measured;

pub use measured::{Measured, Value};

use super::cell::Cell;
use super::error::Error;
use super::plan::Plan;
use super::row::Row;
use crate::stats::change::{Change, difference, ratio};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Probability that anything is called changed, improved or regressed although nothing is: of all questions of a
/// comparison together.
pub const LEVEL: f64 = 0.01;

/// Variances, efficiencies and rays that change by less than this share are of no interest, as in Criterion.
pub const NOISE: f64 = 0.01;

/// The layout of the file.
const SCHEMA: u32 = 1;

/// What is kept of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// The layout of the file.
    schema: u32,
    /// The experiment.
    pub experiment: String,
    /// Version of the program.
    pub version: String,
    /// Commit of the working folder, if it was known.
    pub commit: Option<String>,
    /// The seed.
    pub seed: u64,
    /// The finished cells.
    pub cells: Vec<Measured>,
}

impl Baseline {
    /// What is kept of the finished cells, whose rows are given.
    pub fn of(plan: &Plan, cells: &[Option<Cell>], rows: &[Row], commit: Option<String>) -> Self {
        let measured = |(index, cell): (usize, &Option<Cell>)| {
            let of_cell: Vec<&Row> = rows.iter().filter(|row| row.cell == index).collect();
            Some(Measured::of(plan, index, cell.as_ref()?, &of_cell))
        };
        Baseline {
            schema: SCHEMA,
            experiment: plan.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit,
            seed: plan.spec.seed,
            cells: cells.iter().enumerate().filter_map(measured).collect(),
        }
    }

    /// Reads the text of `file`.
    pub fn read(file: &Path, text: &str) -> Result<Self, Error> {
        let baseline: Self = serde_json::from_str(text)
            .map_err(|e| Error::Refused(format!("{} is damaged: {e}; save it again", file.display())))?;
        if baseline.schema != SCHEMA {
            let why = format!("has the layout {}, not {SCHEMA}; save it again", baseline.schema);
            return Err(Error::Refused(format!("{} {why}", file.display())));
        }
        Ok(baseline)
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers have a JSON form") + "\n"
    }
}

/// What is concluded of a change; the more there is to say, the later.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Finding {
    /// Nothing can be said, because a standard error is unknown.
    Unknown,
    /// The same bits.
    Identical,
    /// The interval holds no change.
    None,
    /// There is a change, but it may be smaller than [`NOISE`].
    Noise,
    /// For the better, by more than [`NOISE`].
    Improved,
    /// A mean is another one.
    Changed,
    /// For the worse, by more than [`NOISE`].
    Regressed,
}

/// The answer to one question.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Of a mean the difference in percent of the earlier one, else the ratio to the earlier value.
    pub change: Option<Change>,
    /// What is concluded.
    pub finding: Finding,
    /// Why nothing is known, or nothing.
    pub why: String,
}

/// A cell that both runs have.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Its label.
    pub label: String,
    /// Realizations, before and now.
    pub samples: (u64, u64),
    /// Mean of each channel.
    pub mean: [Answer; 3],
    /// Variance of each channel: of a pixel where there is an image.
    pub variance: [Answer; 3],
    /// 1 / (variance x rays) of each channel.
    pub efficiency: [Answer; 3],
    /// Rays a sample.
    pub rays: Answer,
}

/// Two runs of an experiment, cell by cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What the baseline is called.
    pub name: String,
    /// The earlier run, without its cells.
    pub before: Baseline,
    /// Seed of the present run.
    pub seed: u64,
    /// Cells that both have, in the present order.
    pub cells: Vec<Compared>,
    /// Labels of cells that only the baseline has.
    pub only_before: Vec<String>,
    /// Labels of cells that only the present run has.
    pub only_now: Vec<String>,
    /// How many questions share [`LEVEL`].
    pub questions: usize,
}

impl Comparison {
    /// Compares the present run with an earlier one, called `name`.
    pub fn new(name: &str, mut before: Baseline, now: &Baseline) -> Self {
        let earlier = std::mem::take(&mut before.cells);
        let find = |label: &str| earlier.iter().find(|cell| cell.label == label);
        let pairs: Vec<(&Measured, &Measured)> =
            now.cells.iter().filter_map(|cell| Some((find(&cell.label)?, cell))).collect();
        // what is the same takes no chance
        let questions = 10 * pairs.iter().filter(|(before, now)| before != now).count();
        let level = LEVEL / questions.max(1) as f64;
        let has = |cells: &[Measured], label: &str| cells.iter().any(|cell| cell.label == label);
        let missing = |cells: &[Measured], from: &[Measured]| {
            let missing = cells.iter().filter(|cell| !has(from, &cell.label));
            missing.map(|cell| cell.label.clone()).collect()
        };
        Comparison {
            name: name.to_owned(),
            seed: now.seed,
            cells: pairs.iter().map(|(before, now)| compare(before, now, level)).collect(),
            only_before: missing(&earlier, &now.cells),
            only_now: missing(&now.cells, &earlier),
            before,
            questions,
        }
    }

    /// Whether the runs drew from the same random numbers, without being the same.
    pub fn shares_numbers(&self) -> bool {
        self.before.seed == self.seed && self.questions > 0
    }
}

/// The ten answers about a cell.
fn compare(before: &Measured, now: &Measured, level: f64) -> Compared {
    // a run that may end early is looked at several times, and each pair of looks is a question of its own
    let level = level / f64::from(before.looks * now.looks);
    let slack = before.rounding.max(now.rounding);
    let same = before == now;
    let each = |ask: &dyn Fn(usize) -> Answer| {
        [0, 1, 2].map(|channel| if same { identical() } else { ask(channel) })
    };
    let about = |values: [&Value; 2], ask: &dyn Fn([&Value; 2]) -> Answer| {
        let unknown = values.iter().find_map(|value| value.unknown.clone());
        unknown.map_or_else(|| ask(values), |why| Answer { change: None, finding: Finding::Unknown, why })
    };
    let growth = |values: [&Value; 2], more_is_better: bool| {
        about(values, &|[before, now]| of_ratio(before, now, more_is_better, level, slack))
    };
    Compared {
        label: now.label.clone(),
        samples: (before.samples, now.samples),
        mean: each(&|c| about([&before.mean[c], &now.mean[c]], &|[b, n]| of_mean(b, n, level, slack))),
        variance: each(&|c| growth([&before.variance[c], &now.variance[c]], false)),
        efficiency: each(&|c| growth([&before.efficiency(c), &now.efficiency(c)], true)),
        rays: if same { identical() } else { growth([&before.rays, &now.rays], false) },
    }
}

fn identical() -> Answer {
    Answer { change: None, finding: Finding::Identical, why: String::new() }
}

fn of_mean(before: &Value, now: &Value, level: f64, slack: f64) -> Answer {
    let scale = before.value.abs();
    let change = difference(before.measure(), now.measure(), level, slack * scale);
    let finding = if change.is_beyond(0.0, 0.0) { Finding::Changed } else { Finding::None };
    // a change from nothing has no percentage
    let change = (scale > 0.0).then(|| change.scaled(100.0 / scale));
    Answer { change, finding, why: String::new() }
}

fn of_ratio(before: &Value, now: &Value, more_is_better: bool, level: f64, slack: f64) -> Answer {
    let Some(change) = ratio(before.measure(), now.measure(), level, slack) else {
        let finding = if before.value == now.value { Finding::None } else { Finding::Unknown };
        return Answer { change: None, finding, why: "zero, or without noise".to_owned() };
    };
    let finding = match (change.is_beyond(1.0, 1.0), change.is_beyond(1.0 - NOISE, 1.0 + NOISE)) {
        (false, _) => Finding::None,
        (true, false) => Finding::Noise,
        (true, true) if (change.estimate > 1.0) == more_is_better => Finding::Improved,
        (true, true) => Finding::Regressed,
    };
    Answer { change: Some(change), finding, why: String::new() }
}
