//! Cells that run an estimator with a known mistake: the mistake is to be found, and to be as large as theory says.

use super::plan::{CellPlan, Plan};
use super::row::{Estimand, Row};
use super::spec::Claim;
use super::subject::Subject;
use super::verdict::Sheet;
use crate::faults::Effect;
use crate::stats::tails::Light;
use crate::stats::{Question, Verdict};
use crate::truth::{Counted, Source, Value};

impl Subject<'_> {
    /// A mistake whose wrong value theory knows is to have just that.
    pub fn wrong(&self, channel: usize, sheet: &mut Sheet<'_>) {
        let wrong = self.plan.faulty().and_then(|faulty| faulty.wrong(&self.plan.scene, channel));
        let Some(wrong) = wrong.filter(|wrong| wrong.is_finite()) else { return };
        let total = &self.cell.total[channel];
        let mut row = self.row(Estimand::Wrong, Some(channel), total.mean);
        row.std_error = total.std_error();
        row.against(&Value::exact(wrong, Source::ClosedForm), Some(wrong));
        sheet.state(row);
        if let Some((claim, margin)) = sheet.claim(Claim::unbiased) {
            let right = self.truth.mean(channel, Counted::All).map_or(0.0, |right| right.value);
            let scale = wrong.abs().max(right);
            let question = Question::about(total, self.cell.invalid(), wrong, margin * scale);
            let noise_free = total.m2 == 0.0;
            let skewness = total.skewness().unwrap_or(0.0) / (total.n as f64).sqrt();
            let unfit = self.cell.tails[channel].guard();
            let unfit = (unfit.0 == Light::Red).then_some(unfit.1);
            let foreseen = unfit.clone();
            sheet.ask_in_vain(
                claim,
                Question { noise_free, skewness, unfit, looks: self.looks(), ..question },
                foreseen,
            );
        }
    }
}

/// Whether the rows of a cell say that something is wrong with it.
pub fn is_caught(rows: &[&Row]) -> bool {
    let against_truth = rows.iter().filter(|row| row.estimand != Estimand::Wrong);
    against_truth.filter_map(|row| row.verdict).any(|v| matches!(v, Verdict::Fail | Verdict::Invalid))
}

/// Whether a cell's mistake shows in its scene: not where theory says that it computes the right value all the same.
fn shows(plan: &Plan, cell: &CellPlan) -> bool {
    let Some(faulty) = cell.faulty().filter(|f| f.fault.effect != Effect::Equivalent) else { return false };
    let truth = plan.truth(cell);
    let differs = |channel: usize| {
        let right = truth.mean(channel, Counted::All).map(|right| right.value);
        let wrong = faulty.wrong(&cell.scene, channel);
        // what is not known may well be wrong
        right.zip(wrong).is_none_or(|(right, wrong)| (wrong - right).abs() > 1e-12 * right.abs())
    };
    (0..3).any(differs)
}

/// Whether all that is claimed was shown: sound cells are right, those with a mistake are caught, or found to be right
/// where their mistake has no effect.
pub fn all_held(plan: &Plan, rows: &[Row]) -> bool {
    let passed = |row: &&Row| row.verdict.is_none_or(|v| v == Verdict::Pass);
    plan.cells.iter().enumerate().all(|(index, cell)| {
        let own: Vec<&Row> = rows.iter().filter(|row| row.cell == index).collect();
        if own.is_empty() {
            return true; // interrupted before it
        }
        let as_theory_says = own.iter().filter(|row| row.estimand == Estimand::Wrong).all(passed);
        if shows(plan, cell) { is_caught(&own) && as_theory_says } else { own.iter().all(passed) }
    })
}
