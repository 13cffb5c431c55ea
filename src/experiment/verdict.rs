//! From cells to verdicts: states every estimand beside its truth, asks the legal questions of each claim as one
//! family, and lets `stats` answer. A pure function of plan and cells.

use super::agree;
use super::cell::Cell;
use super::plan::Plan;
use super::row::Row;
use super::spec::{Claim, Limits};
use super::subject::Subject;
use crate::stats::{Question, Verdict, judge, student};

/// Fewer contributing paths than this, and the normal approximation of a rare bounce's mean is not to be trusted: a
/// Bernoulli-like contribution has skewness² = 1/p, and Cochran's rule n > 25 skewness², made stricter for the small
/// error probabilities used here [Cochran 1977, sec. 2.15].
pub const MIN_EFFECTIVE: f64 = 400.0;

/// A question about a row, asked under a claim; both by their index.
pub(super) struct Asked {
    pub claim: usize,
    pub row: usize,
    pub question: Question,
}

/// All rows of the finished cells, judged.
pub fn rows(plan: &Plan, cells: &[Option<Cell>]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut asked = Vec::new();
    for (index, (cell_plan, cell)) in plan.cells.iter().zip(cells).enumerate() {
        let Some(cell) = cell else { continue };
        let truth = plan.truth(cell_plan);
        let subject = Subject { index, plan: cell_plan, cell, truth: &truth };
        let scene = &cell_plan.scene_label;
        let mut sheet = Sheet { scene, claims: &plan.spec.claim, rows: &mut rows, asked: &mut asked };
        subject.means(&mut sheet);
        subject.spread(&mut sheet);
        subject.image(&mut sheet);
    }
    agree::compare(plan, cells, &mut rows, &mut asked);
    answer(plan, &mut rows, asked);
    rows
}

/// Asks each claim's questions as one family.
fn answer(plan: &Plan, rows: &mut [Row], asked: Vec<Asked>) {
    for (index, claim) in plan.spec.claim.iter().enumerate() {
        let family: Vec<&Asked> = asked.iter().filter(|a| a.claim == index).collect();
        let questions: Vec<Question> = family.iter().map(|a| a.question.clone()).collect();
        let level = claim.alpha() / family.len() as f64;
        for (asked, answer) in family.iter().zip(judge(&questions, claim.alpha())) {
            let row = &mut rows[asked.row];
            let shift = row.expected_bias.unwrap_or(0.0);
            row.ci = Some((answer.ci.0 + shift, answer.ci.1 + shift)).filter(|ci| ci.0.is_finite());
            row.p_value = Some(answer.p_different).filter(|p| p.is_finite());
            row.mde = Some(answer.mde).filter(|mde| mde.is_finite());
            row.verdict = Some(answer.verdict);
            row.note = answer.reason;
            if row.truth.is_some_and(|truth| truth > 0.0 && row.expected_bias == Some(-truth)) {
                row.note = format!("this estimator cannot find the light {}", row.note).trim_end().to_owned();
            }
            let undecided = matches!(answer.verdict, Verdict::Pass | Verdict::Inconclusive);
            if let Some(why) =
                inexact(&asked.question, level).filter(|_| undecided && !row.estimand.is_agreement())
            {
                row.verdict = Some(Verdict::Inconclusive);
                row.note = why;
            }
        }
    }
}

/// Why a truth is too inexact to show that something is right: its own error, by its bound and at the question's
/// confidence, exceeds half of the margin. What differs by more than all errors together stays FAIL.
fn inexact(question: &Question, level: f64) -> Option<String> {
    let noise = match question.expected_std_error {
        0.0 => 0.0,
        error => student::upper_quantile(level / 2.0, question.expected_df) * error,
    };
    let error = question.systematic + noise;
    (error > 0.5 * question.margin).then(|| {
        let margin = question.margin;
        format!(
            "the truth is the reason: its own error of {error:.3e} exceeds half of the margin {margin:.3e}"
        )
    })
}

/// Where rows and questions are collected.
pub(super) struct Sheet<'a> {
    pub scene: &'a str,
    pub claims: &'a [Claim],
    pub rows: &'a mut Vec<Row>,
    pub asked: &'a mut Vec<Asked>,
}

impl Sheet<'_> {
    /// The first claim of a kind about this scene: its index and margin.
    pub fn claim(&self, kind: impl Fn(&Claim) -> Option<&Limits>) -> Option<(usize, f64)> {
        self.claims.iter().enumerate().find_map(|(i, claim)| {
            let limits = kind(claim)?;
            limits.covers(self.scene).then_some((i, limits.margin))
        })
    }

    pub fn state(&mut self, row: Row) {
        self.rows.push(row);
    }

    pub fn ask(&mut self, claim: usize, question: Question) {
        self.asked.push(Asked { claim, row: self.rows.len() - 1, question });
    }
}
