//! From cells to verdicts: states every estimand beside its truth, asks the legal questions of each claim as one
//! family, and lets `stats` answer. A pure function of plan and cells.

use super::agree;
use super::cell::{Cell, Decided};
use super::plan::Plan;
use super::refute::{self, Suspicion};
use super::row::{Estimand, Row};
use super::spec::{Claim, Limits};
use super::subject::Subject;
use crate::stats::{Answer, Engine, Question, Verdict, decide, judge, student};

/// Fewer contributing paths than this, and the normal approximation of a rare bounce's mean is not to be trusted: a
/// Bernoulli-like contribution has skewness² = 1/p, and Cochran's rule n > 25 skewness², made stricter for the small
/// error probabilities used here [Cochran 1977, sec. 2.15].
pub const MIN_EFFECTIVE: f64 = 400.0;

/// A question about a row, asked under a claim; both by their index.
pub(super) struct Asked {
    pub claim: usize,
    pub row: usize,
    pub question: Question,
    /// Why theory says that these samples cannot show it to be right; it may still be shown to be wrong.
    pub foreseen: Option<String>,
}

/// All rows of the finished cells, judged.
pub fn rows(plan: &Plan, cells: &[Option<Cell>]) -> Vec<Row> {
    let mut found = Found::default();
    for (index, cell) in cells.iter().enumerate() {
        let Some(cell) = cell else { continue };
        of_cell(plan, index, cell, &mut found);
    }
    let Found { mut rows, mut asked, suspicions } = found;
    agree::compare(plan, cells, &mut rows, &mut asked);
    answer(plan, cells, &mut rows, asked);
    refute::answer(&plan.spec.claim, &mut rows, &suspicions);
    rows
}

/// Rows, and what is asked about them.
#[derive(Default)]
struct Found {
    rows: Vec<Row>,
    asked: Vec<Asked>,
    suspicions: Vec<Suspicion>,
}

/// Adds the rows of one cell, and what is asked about them. Of one that failed nothing can be asked.
fn of_cell(plan: &Plan, index: usize, cell: &Cell, found: &mut Found) {
    if let Some(failure) = &cell.failure {
        found.rows.extend((0..3).map(|channel| {
            let row = Row::new(index, Estimand::Mean, Some(channel), cell.cost.n, cell.total[channel].mean);
            Row { verdict: Some(Verdict::Invalid), note: failure.to_string(), ..row }
        }));
        return;
    }
    let cell_plan = &plan.cells[index];
    let truth = plan.truth(cell_plan);
    let subject = Subject { index, plan: cell_plan, cell, truth: &truth };
    let claims = &plan.spec.claim;
    let levels = (0..claims.len()).map(|claim| level(plan, claim)).collect();
    let Found { rows, asked, suspicions } = found;
    let mut sheet = Sheet { scene: &cell_plan.scene_label, claims, levels, rows, asked, suspicions };
    subject.means(&mut sheet);
    subject.spread(&mut sheet);
    subject.image(&mut sheet);
    subject.process(&mut sheet);
    subject.rates(&mut sheet);
}

/// Level that each question of a claim, by its index, has at least, before it is known how many will be asked.
pub fn level(plan: &Plan, claim: usize) -> f64 {
    plan.spec.claim[claim].alpha() / plan.questions(claim) as f64
}

/// Whether all that is asked about a cell is decided by the samples that it has so far. Writes into it what is.
///
/// Bounces that theory says will stay open do not keep it going; a whole that can only be shown to be wrong does.
pub fn is_decided(plan: &Plan, index: usize, cell: &mut Cell) -> bool {
    let cell_plan = &plan.cells[index];
    if !cell_plan.may_stop {
        return false;
    }
    let mut found = Found::default();
    of_cell(plan, index, cell, &mut found);
    let Found { rows, asked, .. } = found;
    let mut all = !asked.is_empty();
    for Asked { claim, row, question, foreseen } in &asked {
        let Row { estimand, channel, samples, .. } = rows[*row];
        let known = cell.decided.iter().any(|d| (d.estimand, d.channel) == (estimand, channel));
        if known {
            continue;
        }
        match decide(question, level(plan, *claim)) {
            Verdict::Inconclusive => all &= foreseen.is_some() && estimand != Estimand::Mean,
            verdict => cell.decided.push(Decided { estimand, channel, verdict, samples }),
        }
    }
    all
}

/// The worst that is concluded of a finished cell by itself, while others are still running; `None` if its mean was not
/// judged. Each question has the level that it has at least in the end, so that PASS and FAIL will stay what they are, but
/// for comparisons with other cells, which are still to come.
pub fn so_far(plan: &Plan, index: usize, cell: &Cell) -> Option<Verdict> {
    let mut found = Found::default();
    of_cell(plan, index, cell, &mut found);
    let Found { rows, asked, suspicions } = found;
    let one = |Asked { claim, row, question, foreseen }: &Asked| {
        let (row, level) = (&rows[*row], level(plan, *claim));
        let verdict = match (decide(question, level), earlier(cell, row)) {
            (Verdict::Inconclusive, Some(decided)) => decided.verdict,
            (verdict, _) => verdict,
        };
        let is_vague = verdict == Verdict::Pass && inexact(question, level).is_some();
        let verdict = if is_vague { Verdict::Inconclusive } else { verdict };
        let in_vain = verdict == Verdict::Inconclusive && foreseen.is_some();
        (!in_vain).then_some((row.estimand, verdict))
    };
    let refuted =
        |s: &Suspicion| (s.p <= level(plan, s.claim)).then_some((rows[s.row].estimand, Verdict::Fail));
    let found = asked.iter().filter_map(one).chain(suspicions.iter().filter_map(refuted));
    let found: Vec<(Estimand, Verdict)> = found.collect();
    let worst = found.iter().map(|(_, verdict)| *verdict).max()?;
    let judged = found.iter().any(|(estimand, _)| *estimand == Estimand::Mean);
    Some(worst).filter(|&worst| judged || worst != Verdict::Pass)
}

/// What was decided of a row before the cell's last sample.
fn earlier<'a>(cell: &'a Cell, row: &Row) -> Option<&'a Decided> {
    cell.decided.iter().find(|d| (d.estimand, d.channel) == (row.estimand, row.channel))
}

/// Asks each claim's questions as one family.
fn answer(plan: &Plan, cells: &[Option<Cell>], rows: &mut [Row], asked: Vec<Asked>) {
    for (index, claim) in plan.spec.claim.iter().enumerate() {
        let family: Vec<&Asked> = asked.iter().filter(|a| a.claim == index).collect();
        let questions: Vec<Question> = family.iter().map(|a| a.question.clone()).collect();
        let level = claim.alpha() / family.len() as f64;
        for (asked, answer) in family.iter().zip(judge(&questions, claim.alpha())) {
            let row = &mut rows[asked.row];
            row.claim = Some(index);
            take(row, answer);
            let decided = cells[row.cell].as_ref().and_then(|cell| earlier(cell, row));
            if let Some(decided) = decided.filter(|_| !row.estimand.is_agreement()) {
                settle(row, decided);
            }
            let undecided = matches!(row.verdict, Some(Verdict::Pass | Verdict::Inconclusive));
            if let Some(why) =
                inexact(&asked.question, level).filter(|_| undecided && !row.estimand.is_agreement())
            {
                row.verdict = Some(Verdict::Inconclusive);
                row.note = why;
            }
            if let Some(why) = asked.foreseen.as_ref().filter(|_| row.verdict == Some(Verdict::Inconclusive))
            {
                row.verdict = None;
                row.note.clone_from(why);
            }
        }
    }
}

/// Writes an answer into its row.
fn take(row: &mut Row, answer: Answer) {
    let shift = row.expected_bias.unwrap_or(0.0);
    let ci = (answer.ci.0 + shift, answer.ci.1 + shift);
    row.ci = Some(ci).filter(|ci| ci.0.is_finite() && ci.1.is_finite());
    row.p_value = Some(answer.p_different).filter(|p| p.is_finite());
    row.e_value = answer.e_value;
    row.mde = Some(answer.mde).filter(|mde| mde.is_finite());
    row.verdict = Some(answer.verdict);
    row.engine = (answer.verdict != Verdict::Invalid).then_some(answer.engine);
    row.note = answer.reason;
    if row.truth.is_some_and(|truth| truth > 0.0 && row.expected_bias == Some(-truth)) {
        row.note = format!("this estimator cannot find the light {}", row.note).trim_end().to_owned();
    }
}

/// What was decided at a look stays decided: its error probability was paid for.
fn settle(row: &mut Row, decided: &Decided) {
    if row.verdict == Some(Verdict::Inconclusive) {
        row.verdict = Some(decided.verdict);
        row.note = format!("decided after {} samples, open again after more", decided.samples);
    }
    if row.verdict == Some(decided.verdict) {
        row.needed = Some(decided.samples);
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
    /// The level of each claim's questions.
    pub levels: Vec<f64>,
    pub rows: &'a mut Vec<Row>,
    pub asked: &'a mut Vec<Asked>,
    pub suspicions: &'a mut Vec<Suspicion>,
}

impl Sheet<'_> {
    /// The first claim of a kind about this scene: its index and margin.
    pub fn claim(&self, kind: impl Fn(&Claim) -> Option<&Limits>) -> Option<(usize, f64)> {
        self.claims.iter().enumerate().find_map(|(i, claim)| {
            let limits = kind(claim)?;
            limits.covers(self.scene).then_some((i, limits.margin))
        })
    }

    /// The first claim of a kind about this scene that can only be refuted.
    pub fn chance(&self, kind: impl Fn(&Claim) -> bool) -> Option<usize> {
        let here = |claim: &Claim| claim.scene().is_none_or(|scene| scene == self.scene);
        self.claims.iter().position(|claim| kind(claim) && here(claim))
    }

    /// States a row and what speaks against it.
    pub fn suspect(&mut self, row: Row, claim: usize, p: f64, engine: Engine) {
        self.rows.push(row);
        self.suspicions.push(Suspicion { claim, row: self.rows.len() - 1, p, engine });
    }

    pub fn state(&mut self, row: Row) {
        self.rows.push(row);
    }

    pub fn ask(&mut self, claim: usize, question: Question) {
        self.ask_in_vain(claim, question, None);
    }

    /// Asks although theory has foreseen that it cannot be shown to be right.
    pub fn ask_in_vain(&mut self, claim: usize, question: Question, foreseen: Option<String>) {
        self.asked.push(Asked { claim, row: self.rows.len() - 1, question, foreseen });
    }
}
