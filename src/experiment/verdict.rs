//! From cells to verdicts: states every estimand beside its truth, asks the legal questions of each claim as one
//! family, and lets `stats` answer. A pure function of plan and cells.

use super::agree;
use super::cell::{Cell, TILES};
use super::plan::{CellPlan, Plan};
use super::row::{Estimand, Row};
use super::spec::{Claim, Limits};
use crate::estimator::{BINS, Rule};
use crate::stats::{Moments, Question, Verdict, judge};
use crate::truth::reference::{self, Stored};
use crate::truth::{ClosedForm, Counted, Known, Reference};

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
        let closed = ClosedForm::of(&cell_plan.scene, &cell_plan.estimator);
        let subject = Subject { index, plan: cell_plan, cell, closed: closed.as_ref() };
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
        for (asked, answer) in family.iter().zip(judge(&questions, claim.alpha())) {
            let row = &mut rows[asked.row];
            let shift = row.expected_bias.unwrap_or(0.0);
            row.ci = Some((answer.ci.0 + shift, answer.ci.1 + shift)).filter(|ci| ci.0.is_finite());
            row.p_value = Some(answer.p_different).filter(|p| p.is_finite());
            row.mde = Some(answer.mde).filter(|mde| mde.is_finite());
            row.verdict = Some(answer.verdict);
            row.note = answer.reason;
        }
    }
}

/// Where rows and questions are collected.
struct Sheet<'a> {
    scene: &'a str,
    claims: &'a [Claim],
    rows: &'a mut Vec<Row>,
    asked: &'a mut Vec<Asked>,
}

impl Sheet<'_> {
    /// The first claim of a kind about this scene: its index and margin.
    fn claim(&self, kind: impl Fn(&Claim) -> Option<&Limits>) -> Option<(usize, f64)> {
        self.claims.iter().enumerate().find_map(|(i, claim)| {
            let limits = kind(claim)?;
            limits.covers(self.scene).then_some((i, limits.margin))
        })
    }

    fn state(&mut self, row: Row) {
        self.rows.push(row);
    }

    fn ask(&mut self, claim: usize, question: Question) {
        self.asked.push(Asked { claim, row: self.rows.len() - 1, question });
    }
}

/// A finished cell and what theory says of it.
struct Subject<'a> {
    index: usize,
    plan: &'a CellPlan,
    cell: &'a Cell,
    closed: Option<&'a ClosedForm>,
}

/// The bounces that a bin holds.
pub(super) fn counted(bin: usize) -> Counted {
    if bin + 1 == BINS { Counted::From(bin as u32) } else { Counted::Only(bin as u32) }
}

impl Subject<'_> {
    fn row(&self, estimand: Estimand, channel: Option<usize>, mean: f64) -> Row {
        Row::new(self.index, estimand, channel, self.cell.cost.n, mean)
    }

    /// Means, total and per bounce.
    fn means(&self, sheet: &mut Sheet<'_>) {
        let reference = self.closed.is_none().then(|| Reference::of(&self.plan.scene)).flatten();
        for channel in 0..3 {
            self.total(channel, reference.as_ref().map(|r| r.image()), sheet);
            for bin in 0..BINS {
                self.bounce(channel, bin, sheet);
            }
        }
        if self.plan.pixels == 1 {
            let share = self.cell.zeros as f64 / self.cell.cost.n as f64;
            sheet.state(self.row(Estimand::Zeros, None, share));
        }
    }

    fn total(&self, channel: usize, stored: Option<Stored>, sheet: &mut Sheet<'_>) {
        let total = &self.cell.total[channel];
        let blocks = &self.cell.blocks[channel];
        let mut row = self.row(Estimand::Mean, Some(channel), total.mean);
        let known = self.closed.map_or(Known::Unknown, |c| c.central(channel, Counted::All, 2));
        row.rays = Some(self.cell.cost.mean);
        if known == Known::Infinite {
            let tail = self.closed.and_then(|c| c.tail_index(channel));
            let tail = tail.map_or_else(String::new, |alpha| format!(" (tail index {alpha:.2})"));
            row.note = format!("infinite variance{tail}: no standard error, no interval, not judged");
        } else {
            row.std_error = blocks.std_error();
            row.variance = total.variance();
            if known == Known::Value(0.0) {
                row.note = "noise-free".to_owned();
            } else {
                row.rate(total.variance_std_error());
            }
        }
        let question = if let Some(closed) = self.closed {
            let (truth, expected) =
                (closed.truth(channel, Counted::All), closed.expected(channel, Counted::All));
            row.against(truth, 0.0, Some(expected), "closed form");
            let mut question = Question::about(blocks, self.cell.invalid(), expected, truth.abs());
            question.noise_free = known == Known::Value(0.0);
            let enough = self.enough(&mut row, channel, closed);
            if !enough && sheet.claim(Claim::unbiased).is_some() {
                row.verdict = Some(Verdict::Inconclusive);
            }
            (enough && known != Known::Infinite).then_some(question)
        } else if let Some(stored) = stored {
            let expected = self.plan.is_unbiased().then_some(stored.mean[channel]);
            row.against(stored.mean[channel], stored.std_error[channel], expected, "independent renderer");
            expected.map(|_| self.against_stored(blocks, &stored, channel))
        } else {
            None
        };
        sheet.state(row);
        if let (Some((claim, margin)), Some(question)) = (sheet.claim(Claim::unbiased), question) {
            sheet.ask(claim, Question { margin: question.margin * margin, ..question });
        }
    }

    /// Whether there are enough samples for the known skewness.
    fn enough(&self, row: &mut Row, channel: usize, closed: &ClosedForm) -> bool {
        let Some(skewness) = closed.skewness(channel, Counted::All) else { return true };
        let needed = 25.0 * skewness * skewness;
        if (self.cell.cost.n as f64) < needed {
            row.note = format!("skewness {skewness:.0}: a t interval needs {needed:.0} samples");
            return false;
        }
        true
    }

    fn against_stored(&self, blocks: &Moments, stored: &Stored, channel: usize) -> Question {
        Question {
            expected_std_error: stored.std_error[channel],
            expected_df: reference::DF,
            systematic: stored.systematic[channel],
            ..Question::about(blocks, self.cell.invalid(), stored.mean[channel], stored.mean[channel].abs())
        }
    }

    fn bounce(&self, channel: usize, bin: usize, sheet: &mut Sheet<'_>) {
        let blocks = &self.cell.bounces[bin][channel];
        let counted = counted(bin);
        let mut row = self.row(Estimand::Bounce(bin), Some(channel), blocks.mean);
        let Some(closed) = self.closed else {
            row.std_error = blocks.std_error();
            return sheet.state(row);
        };
        let (truth, expected) = (closed.truth(channel, counted), closed.expected(channel, counted));
        row.against(truth, 0.0, Some(expected), "closed form");
        let variance = closed.central(channel, counted, 2);
        let effective = variance.value().map(|v| self.cell.cost.n as f64 * expected * expected / v);
        let mut question = Question::about(blocks, self.cell.invalid(), expected, 0.0);
        question.noise_free = variance == Known::Value(0.0);
        row.note = match (variance, effective) {
            (Known::Infinite, _) => "infinite variance: not judged".to_owned(),
            (_, Some(n)) if n < MIN_EFFECTIVE => {
                format!("about {n:.0} paths get here, fewer than {MIN_EFFECTIVE}: not judged")
            }
            _ => String::new(),
        };
        if variance != Known::Infinite {
            row.std_error = blocks.std_error();
        }
        let legal = row.note.is_empty();
        sheet.state(row);
        if let (Some((claim, margin)), true) = (sheet.claim(Claim::unbiased), legal) {
            question.margin = margin * closed.truth(channel, Counted::All).abs();
            sheet.ask(claim, question);
        }
    }

    /// Variance and cost against theory.
    fn spread(&self, sheet: &mut Sheet<'_>) {
        let cost = &self.cell.cost;
        let mut row = self.row(Estimand::Cost, None, cost.mean);
        row.std_error = cost.std_error();
        row.variance = cost.variance();
        let rays = self.closed.and_then(|c| c.rays());
        if let Some(rays) = rays {
            row.against(rays, 0.0, Some(rays), "closed form");
        }
        sheet.state(row);
        if let (Some((claim, margin)), Some(rays)) = (sheet.claim(Claim::cost), rays) {
            let mut question = Question::about(cost, self.cell.invalid(), rays, margin * rays);
            question.noise_free = self.plan.estimator.roulette().rule == Rule::None;
            sheet.ask(claim, question);
        }
        for channel in 0..3 {
            self.variance(channel, sheet);
        }
    }

    fn variance(&self, channel: usize, sheet: &mut Sheet<'_>) {
        let Some(closed) = self.closed else { return };
        let central = |order| closed.central(channel, Counted::All, order);
        let (Some(variance), Some(expected)) = (self.cell.total[channel].variance(), central(2).value())
        else {
            return; // the row of the mean says why
        };
        let mut row = self.row(Estimand::Variance, Some(channel), variance);
        row.against(expected, 0.0, Some(expected), "closed form");
        let n = self.cell.cost.n as f64;
        let fourth = central(4);
        let error =
            fourth.value().map(|mu4| ((mu4 - expected * expected * (n - 3.0) / (n - 1.0)) / n).sqrt());
        row.std_error = error;
        if fourth == Known::Infinite {
            row.note = "infinite fourth moment: the variance has no interval, not judged".to_owned();
        }
        sheet.state(row);
        let claim = sheet.claim(Claim::variance);
        if let (Some((claim, margin)), Some(std_error), true) = (claim, error, expected > 0.0) {
            let question = Question::about(&self.cell.total[channel], self.cell.invalid(), expected, 0.0);
            let (df, margin) = (f64::INFINITY, margin * expected);
            sheet.ask(claim, Question { mean: variance, std_error, df, margin, ..question });
        }
    }

    /// Tiles and the variance of pixels.
    fn image(&self, sheet: &mut Sheet<'_>) {
        let variance = &self.cell.pixel_variance;
        if variance[0].n == 0 {
            return;
        }
        let rays = self.cell.cost.mean / self.plan.pixels as f64;
        for (channel, moments) in variance.iter().enumerate() {
            let mut row = self.row(Estimand::PixelVariance, Some(channel), moments.mean);
            row.std_error = moments.std_error();
            row.variance = Some(moments.mean);
            row.rays = Some(rays);
            row.rate(moments.std_error());
            sheet.state(row);
            let mut row =
                self.row(Estimand::MedianPixelVariance, Some(channel), self.cell.median_variance[channel]);
            row.variance = Some(row.mean);
            row.rays = Some(rays);
            row.rate(None);
            sheet.state(row);
        }
        if let Some(reference) = Reference::of(&self.plan.scene) {
            (0..self.cell.tiles.len()).for_each(|tile| self.tile(tile, &reference, sheet));
        }
    }

    fn tile(&self, tile: usize, reference: &Reference, sheet: &mut Sheet<'_>) {
        let tiles = TILES as usize;
        let stored = reference.tile(tiles, tile % tiles, tile / tiles);
        let claim = sheet.claim(Claim::tiles);
        let image = reference.image().mean;
        for channel in 0..3 {
            let measured = self.cell.tiles[tile][channel];
            let mut row = self.row(Estimand::Tile(tile), Some(channel), measured.mean);
            row.std_error = Some(measured.std_error);
            let expected = self.plan.is_unbiased().then_some(stored.mean[channel]);
            row.against(stored.mean[channel], stored.std_error[channel], expected, "independent renderer");
            sheet.state(row);
            let scale = stored.mean[channel].max(image[channel]);
            if let (Some((claim, margin)), Some(_)) = (claim, expected) {
                let question = self.against_stored(&self.cell.blocks[channel], &stored, channel);
                let (mean, std_error) = (measured.mean, measured.std_error);
                sheet.ask(claim, Question { mean, std_error, margin: margin * scale, ..question });
            }
        }
    }
}
