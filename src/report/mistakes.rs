//! Cells with a known mistake: whether it was caught, by what first, and whether it is as large as theory says.

use super::lookup::Lookup;
use super::{number, table};
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Row};
use crate::faults::{Effect, Fault};
use crate::stats::Verdict;

/// A mistake that was tried in one cell.
pub struct Tried<'a> {
    /// The cell.
    pub cell: usize,
    /// The mistake.
    pub fault: &'static Fault,
    /// What told it first.
    pub caught: Option<&'a Row>,
    /// Whether theory says that it changes nothing here.
    pub is_harmless: bool,
    /// Measured means beside theory's wrong values, where it knows them.
    pub values: Vec<&'a Row>,
}

/// All mistakes, by cell.
pub fn tried<'a>(lookup: &Lookup<'a>) -> Vec<Tried<'a>> {
    let finished = (0..lookup.plan.cells.len()).filter(|&c| !lookup.cell(c).is_empty());
    finished.filter_map(|c| one(lookup, c)).collect()
}

fn one<'a>(lookup: &Lookup<'a>, cell: usize) -> Option<Tried<'a>> {
    let fault = lookup.plan.cells[cell].fault?;
    let values: Vec<&Row> = (0..3).filter_map(|c| lookup.row(cell, Estimand::Wrong, Some(c))).collect();
    let same = |wrong: &&Row| {
        let right = lookup.row(cell, Estimand::Mean, wrong.channel);
        let right = right.and_then(|row| Some(row.truth? + row.expected_bias?));
        right.zip(wrong.truth).is_some_and(|(right, wrong)| (wrong - right).abs() <= 1e-9 * right.abs())
    };
    let no_change = fault.effect == Effect::Mean && values.len() == 3 && values.iter().all(same);
    let rows = lookup.cell(cell).iter().copied().filter(|row| row.estimand != Estimand::Wrong);
    let alarms = rows.filter(|row| matches!(row.verdict, Some(Verdict::Fail | Verdict::Invalid)));
    Some(Tried {
        cell,
        fault,
        // of those that are equally early the first: the mean stands before its bounces
        caught: alarms.min_by_key(|row| row.needed.unwrap_or(row.samples)),
        is_harmless: fault.effect == Effect::Equivalent || no_change,
        values,
    })
}

impl Tried<'_> {
    /// "caught: bounce 1 G, after 65536 samples".
    pub fn outcome(&self) -> String {
        match self.caught {
            Some(row) => {
                let index = row
                    .estimand
                    .index()
                    .map_or_else(String::new, |i| format!(" {}", table::index(row.estimand, i)));
                let channel = row.channel.map_or_else(String::new, |c| format!(" {}", CHANNELS[c]));
                let n = row.needed.unwrap_or(row.samples);
                let unexpected = if self.is_harmless { ", although nothing should change" } else { "" };
                format!("caught: {}{index}{channel}, after {n} samples{unexpected}", row.estimand)
            }
            None if self.is_harmless => "not caught: theory says that it changes nothing here".to_owned(),
            None => "not caught".to_owned(),
        }
    }
}

/// What the table says of a cell with a mistake.
pub fn note(lookup: &Lookup<'_>, cell: usize) -> Option<String> {
    one(lookup, cell).map(|tried| tried.outcome())
}

/// How many of the mistakes were caught; nothing where none was tried.
pub fn sentences(lookup: &Lookup<'_>) -> Vec<String> {
    let all = tried(lookup);
    let (harmless, harmful): (Vec<&Tried<'_>>, Vec<&Tried<'_>>) = all.iter().partition(|t| t.is_harmless);
    let names = |of: &dyn Fn(&Tried<'_>) -> bool| {
        let mut names: Vec<String> = Vec::new();
        for tried in harmful.iter().filter(|tried| of(tried)) {
            if !names.iter().any(|name| name == tried.fault.name) {
                names.push(tried.fault.name.to_owned());
            }
        }
        names
    };
    let (known, caught) = (names(&|_| true), names(&|tried| tried.caught.is_some()));
    let mut told = Vec::new();
    if !known.is_empty() {
        let cells = harmful.iter().filter(|tried| tried.caught.is_some()).count();
        let cells = if harmful.len() == known.len() {
            String::new()
        } else {
            format!(", in {cells} of {} cells", harmful.len())
        };
        let missed: Vec<String> = known.iter().filter(|name| !caught.contains(name)).cloned().collect();
        let missed = if missed.is_empty() {
            String::new()
        } else {
            format!("; not caught: {}", number::list(&missed, "and"))
        };
        told.push(format!("{} of {} mistakes were caught{cells}{missed}.", caught.len(), known.len()));
    }
    let judged = || all.iter().flat_map(|tried| &tried.values).filter_map(|row| row.verdict);
    let count = judged().filter(|&verdict| verdict == Verdict::Pass).count();
    if judged().count() > 0 {
        let judged = judged().count();
        told.push(format!(
            "The wrong values that theory gives for mistakes were shown in {count} of {judged} channels."
        ));
    }
    if !harmless.is_empty() {
        let quiet = harmless.iter().filter(|tried| tried.caught.is_none()).count();
        told.push(format!(
            "{quiet} of {} cells whose mistake changes nothing raised no alarm.",
            harmless.len()
        ));
    }
    told
}
