//! Reports of studies: how often each instrument finds each mistake, how often it cries wolf.

mod csv;
pub mod nulls;
mod page;

pub use csv::csv;
pub use page::page;

use crate::experiment::Plan;
use crate::experiment::study::{Detection, Instrument};
use crate::faults::Effect;
use crate::stats::binomial::clopper_pearson;
use crate::stats::nulls::NullRow;

/// A cell with what its runs have shown.
pub struct Studied<'a> {
    plan: &'a Plan,
    cells: Vec<(usize, &'a Detection)>,
    nulls: &'a [NullRow],
}

/// A mistake counts as found where its share of detections is at least this.
pub const FOUND: f64 = 0.99;

impl<'a> Studied<'a> {
    /// The finished cells of a study, and what synthetic laws have shown.
    pub fn new(plan: &'a Plan, detections: &'a [Option<Detection>], nulls: &'a [NullRow]) -> Self {
        let cells = detections.iter().enumerate().filter_map(|(i, d)| Some((i, d.as_ref()?))).collect();
        Studied { plan, cells, nulls }
    }

    /// What was planned.
    pub fn plan(&self) -> &'a Plan {
        self.plan
    }

    /// The finished cells, by their indices.
    pub fn cells(&self) -> &[(usize, &'a Detection)] {
        &self.cells
    }

    /// What synthetic laws have shown.
    pub fn nulls(&self) -> &'a [NullRow] {
        self.nulls
    }

    fn effect(&self, cell: usize) -> Option<Effect> {
        self.plan.cells[cell].fault.map(|fault| fault.effect)
    }

    /// The largest share with which an instrument finds a fault in any scene.
    fn best(&self, fault: &str, instrument: Instrument) -> Option<f64> {
        let is = |cell: usize| self.plan.cells[cell].fault.is_some_and(|f| f.name == fault);
        let shares = self.cells.iter().filter(|(c, _)| is(*c)).filter_map(|(_, d)| d.share(instrument));
        shares.map(|(share, ..)| share).reduce(f64::max)
    }

    /// Names of the faults that have an effect, in their order.
    fn faults(&self) -> Vec<&'static str> {
        let mut names = Vec::new();
        for (cell, _) in &self.cells {
            if let Some(fault) = self.plan.cells[*cell].fault.filter(|f| f.effect != Effect::Equivalent)
                && !names.contains(&fault.name)
            {
                names.push(fault.name);
            }
        }
        names
    }

    /// Faults that an instrument does not find in any scene.
    fn missed(&self, instrument: Instrument) -> Vec<&'static str> {
        let misses = |name: &&str| self.best(name, instrument).is_some_and(|share| share < FOUND);
        self.faults().into_iter().filter(misses).collect()
    }

    /// Whether each mistake is found in some scene, and sound cells and mistakes without effect raise no more alarms than
    /// their level allows.
    pub fn holds(&self) -> bool {
        nulls::hold(self.nulls)
            && self.missed(Instrument::Verdict).is_empty()
            && Instrument::ALL
                .iter()
                .filter(|i| !i.is_rival() && **i != Instrument::Student)
                .all(|i| self.false_alarms(*i).is_none_or(|a| a.is_kept()))
    }

    /// Alarms of an instrument where there is nothing to find.
    fn false_alarms(&self, instrument: Instrument) -> Option<Alarms> {
        let at = Instrument::ALL.iter().position(|i| *i == instrument)?;
        let sound = |cell: usize| self.effect(cell).is_none_or(|effect| effect == Effect::Equivalent);
        let cells = self.cells.iter().filter(|(cell, _)| sound(*cell));
        let counts: Vec<(u64, u64)> = cells.filter_map(|(_, d)| Some((d.found[at]?, d.seeds))).collect();
        let (found, runs) = counts.iter().fold((0, 0), |(f, r), (found, seeds)| (f + found, r + seeds));
        let level = self.plan.spec.claim.iter().map(|claim| claim.alpha()).fold(0.0, f64::max);
        let claims = self.plan.spec.claim.len() as f64;
        let level = if instrument == Instrument::Verdict { level * claims } else { level };
        (runs > 0).then_some(Alarms { found, runs, level })
    }
}

/// Alarms without a cause.
struct Alarms {
    found: u64,
    runs: u64,
    /// What was promised.
    level: f64,
}

impl Alarms {
    /// Limits of the true rate, at 99.9 %.
    fn limits(&self) -> (f64, f64) {
        clopper_pearson(self.found, self.runs, 0.998)
    }

    /// Whether the promise is not refuted.
    fn is_kept(&self) -> bool {
        self.limits().0 <= self.level
    }
}

/// The answer in words.
pub fn sentences(studied: &Studied<'_>) -> Vec<String> {
    let mut sentences = Vec::new();
    let faults = studied.faults();
    let seeds = u64::from(studied.plan.spec.seeds.unwrap_or(1));
    if !faults.is_empty() {
        let missed = studied.missed(Instrument::Verdict);
        let rest =
            if missed.is_empty() { String::new() } else { format!("; not found: {}", missed.join(", ")) };
        sentences.push(format!(
            "Of {} mistakes that have an effect, the bench finds {} in at least {:.0} % of runs in the scene that shows \
             them best{rest}. All of {seeds} runs exclude, with 99 % confidence, a true rate below {:.0} %.",
            faults.len(),
            faults.len() - missed.len(),
            100.0 * FOUND,
            100.0 * clopper_pearson(seeds, seeds, 0.99).0
        ));
        for instrument in Instrument::ALL.into_iter().filter(|i| i.is_rival() || *i == Instrument::Student) {
            let missed = studied.missed(instrument);
            let name = instrument.name();
            let who = if instrument.is_rival() {
                format!("The rule of {name}")
            } else {
                "A t test of the mean".to_owned()
            };
            sentences.push(format!("{who} misses {} of them: {}.", missed.len(), missed.join(", ")));
        }
    }
    for instrument in Instrument::ALL {
        if let Some(alarms) = studied.false_alarms(instrument) {
            let (low, high) = alarms.limits();
            let promise = if instrument.is_rival() || instrument == Instrument::Student {
                String::new()
            } else {
                format!("; promised are at most {:.2e}", alarms.level)
            };
            sentences.push(format!(
                "False alarms of {}: {} in {} runs, a rate between {low:.1e} and {high:.1e} (99.9 % each){promise}.",
                instrument.name(),
                alarms.found,
                alarms.runs
            ));
        }
    }
    sentences.extend(nulls::sentences(studied.nulls));
    sentences
}
