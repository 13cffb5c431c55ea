//! What can be shown to be wrong but never to be right: that paths have the length that roulette promises, and that
//! realizations have nothing to do with each other.

use super::ledger::LENGTHS;
use super::row::{Estimand, Row};
use super::spec::Claim;
use super::subject::Subject;
use super::verdict::Sheet;
use crate::stats::law::log_e_value;
use crate::stats::multiplicity::holm;
use crate::stats::replicates::chance_of_repeats;
use crate::stats::{Engine, Verdict};

/// Something that speaks against a row, under a claim; both by their index.
pub(super) struct Suspicion {
    pub claim: usize,
    pub row: usize,
    /// Probability of as much evidence or more, were all well.
    pub p: f64,
    pub engine: Engine,
}

impl Subject<'_> {
    /// Lengths of paths and independence of blocks, where a claim asks for them.
    pub fn process(&self, sheet: &mut Sheet<'_>) {
        if let Some(claim) = sheet.chance(|c| matches!(c, Claim::Length(_))) {
            self.lengths(claim, sheet);
        }
        if let Some(claim) = sheet.chance(|c| matches!(c, Claim::Independent(_))) {
            self.repeats(claim, sheet);
            (0..3).for_each(|channel| self.serial(claim, channel, sheet));
        }
    }

    fn lengths(&self, claim: usize, sheet: &mut Sheet<'_>) {
        let law = self.truth.theory().and_then(|theory| theory.lengths(LENGTHS - 2));
        let Some(law) = law.filter(|_| self.plan.pixels == 1) else { return };
        let mut row = self.row(Estimand::Length, None, self.cell.cost.mean);
        let log_e = log_e_value(&self.cell.lengths, &law);
        row.e_value = Some(libm::exp(log_e));
        let p = libm::exp(-log_e).min(1.0);
        sheet.suspect(row, claim, p, Engine::Exact);
    }

    fn repeats(&self, claim: usize, sheet: &mut Sheet<'_>) {
        let cell = self.cell;
        let row = self.row(Estimand::Repeats, None, cell.repeats as f64);
        let chance = chance_of_repeats(&cell.lengths, self.plan.block, cell.blocks[0].n);
        sheet.suspect(row, claim, if cell.repeats > 0 { chance } else { 1.0 }, Engine::Exact);
    }

    fn serial(&self, claim: usize, channel: usize, sheet: &mut Sheet<'_>) {
        let Some((r, p)) = self.cell.serial[channel] else { return };
        let row = self.row(Estimand::Serial, Some(channel), r);
        sheet.suspect(row, claim, p, Engine::Asymptotic);
    }
}

/// FAIL where the suspicion is strong enough for the claim's family; no verdict elsewhere, as absence of evidence is none.
pub(super) fn answer(claims: &[Claim], rows: &mut [Row], suspicions: &[Suspicion]) {
    for (index, claim) in claims.iter().enumerate() {
        let family: Vec<&Suspicion> = suspicions.iter().filter(|s| s.claim == index).collect();
        let p: Vec<f64> = family.iter().map(|s| s.p).collect();
        for (suspicion, refuted) in family.iter().zip(holm(&p, claim.alpha())) {
            let row = &mut rows[suspicion.row];
            row.claim = Some(index);
            row.p_value = Some(suspicion.p);
            row.engine = Some(suspicion.engine);
            let (p, what) = (suspicion.p, row.estimand.promise());
            row.note = if refuted {
                format!("refuted, p = {p:.1e}: {what}")
            } else {
                format!("not refuted: {what}")
            };
            row.verdict = refuted.then_some(Verdict::Fail);
        }
    }
}
