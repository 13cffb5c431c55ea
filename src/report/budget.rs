//! The error budget of a run: how probable a false alarm may be, and how it is shared among the questions.

use super::lookup::Lookup;
use crate::experiment::Row;
use crate::experiment::spec::Claim;
use crate::stats::{Engine, Verdict};
use std::fmt::Write;

/// What a claim spends.
pub struct Share {
    /// What it is about.
    pub what: &'static str,
    /// The only scene, or the cell that others are compared with.
    pub scope: Option<String>,
    /// What counts as no difference, relative; `None` for what can be refuted and never shown.
    pub margin: Option<f64>,
    /// Probability of any false alarm among its questions.
    pub alpha: f64,
    /// Questions that could be asked.
    pub asked: usize,
    /// Of those how many were decided exactly, asymptotically, and by comparison of what has no noise.
    pub decided: [usize; 3],
    /// Questions about numbers that are none.
    pub invalid: usize,
}

/// What decides, in the order of [`Share::decided`].
pub const ENGINES: [Engine; 3] = [Engine::Exact, Engine::Asymptotic, Engine::Comparison];

impl Share {
    /// The level of one question, before others are decided (then Holm's method passes theirs on).
    pub fn level(&self) -> f64 {
        self.alpha / self.asked.max(1) as f64
    }

    /// Questions that stayed open.
    pub fn open(&self) -> usize {
        self.asked - self.decided.iter().sum::<usize>()
    }
}

/// What each claim spends, in the order of the claims.
pub fn shares(lookup: &Lookup<'_>) -> Vec<Share> {
    lookup.plan.spec.claim.iter().enumerate().map(|(index, claim)| share(lookup, index, claim)).collect()
}

fn share(lookup: &Lookup<'_>, index: usize, claim: &Claim) -> Share {
    let cells = 0..lookup.plan.cells.len();
    let rows = cells.flat_map(|c| lookup.cell(c).iter().copied()).filter(|row| row.claim == Some(index));
    let rows: Vec<&Row> = rows.collect();
    let is_decided = |row: &&&Row| matches!(row.verdict, Some(Verdict::Pass | Verdict::Fail));
    let decided =
        ENGINES.map(|engine| rows.iter().filter(is_decided).filter(|r| r.engine == Some(engine)).count());
    let (what, margin) = about(claim);
    let scope = match claim {
        Claim::Agree { estimator, roulette, .. } => Some(format!("{estimator}, {roulette}")),
        _ => claim.scene().cloned(),
    };
    Share {
        what,
        scope,
        margin,
        alpha: claim.alpha(),
        asked: rows.iter().filter(|row| row.engine.is_some()).count(),
        decided,
        invalid: rows.iter().filter(|row| row.verdict == Some(Verdict::Invalid)).count(),
    }
}

fn about(claim: &Claim) -> (&'static str, Option<f64>) {
    match claim {
        Claim::Unbiased(l) => ("mean and each bounce", Some(l.margin)),
        Claim::Tiles(l) => ("means of the image's 4 × 4 tiles", Some(l.margin)),
        Claim::Variance(l) => ("variance", Some(l.margin)),
        Claim::Cost(l) => ("rays a sample", Some(l.margin)),
        Claim::Rate(l) => ("exponents with which errors fall (margin absolute)", Some(l.get_ref().margin)),
        Claim::Length(_) => ("lengths of paths", None),
        Claim::Independent(_) => ("independence of realizations", None),
        Claim::Agree { margin, .. } => ("mean, against another cell", Some(*margin)),
    }
}

/// Probability of any false alarm in the whole run, at most.
pub fn total(lookup: &Lookup<'_>) -> f64 {
    lookup.plan.spec.claim.iter().map(Claim::alpha).sum()
}

/// A number without the digits that binary fractions add up to.
pub fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    if rounded != 0.0 && rounded.abs() < 1e-4 { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// The budget as text; nothing where nothing is claimed.
pub fn text(lookup: &Lookup<'_>) -> String {
    let mut text = String::new();
    let shares = shares(lookup);
    if shares.is_empty() {
        return text;
    }
    let total = plain(total(lookup));
    let _ = writeln!(text, "Error budget: any false alarm in this run has a probability of at most {total}.");
    for share in &shares {
        let Share { what, alpha, asked, decided: [exact, asymptotic, comparison], .. } = share;
        let scope = share.scope.as_ref().map_or_else(String::new, |scope| format!(" ({scope})"));
        let _ = write!(text, "  {what}{scope}: {}", plain(*alpha));
        let _ = match asked {
            0 => writeln!(text, ", nothing could be asked"),
            _ => writeln!(
                text,
                " for {asked} questions, {:.1e} each; decided {exact} exactly, {asymptotic} asymptotically, {comparison} \
                 by comparison, {} open",
                share.level(),
                share.open()
            ),
        };
    }
    text
}
