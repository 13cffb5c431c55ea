//! One finished cell: every estimand beside its truth, and what may be asked about it.

use super::agree;
use super::cell::Cell;
use super::plan::CellPlan;
use super::row::{Estimand, Row};
use super::run::LOOKS_IN_ALL;
use super::spec::Claim;
use super::stakes;
use super::verdict::{MIN_EFFECTIVE, Sheet};
use crate::estimator::BINS;
use crate::stats::tails::Light;
use crate::stats::{Bets, Moments, Question, skewed};
use crate::truth::{Counted, Known, Source, Truth, Value};

/// A finished cell and what is right for it.
pub(super) struct Subject<'a> {
    pub index: usize,
    pub plan: &'a CellPlan,
    pub cell: &'a Cell,
    pub truth: &'a Truth,
}

/// Probability with which samples must suffice for a bounce to be judged: of some thousand of them, none should stay open.
const POWER: f64 = 0.9999;

/// Level at which the tail of a mean is looked at that nobody claims anything of.
const UNCLAIMED: f64 = 1e-3;

/// The bounces that a bin holds.
pub(super) fn counted(bin: usize) -> Counted {
    if bin + 1 == BINS { Counted::From(bin as u32) } else { Counted::Only(bin as u32) }
}

impl Subject<'_> {
    pub(super) fn row(&self, estimand: Estimand, channel: Option<usize>, mean: f64) -> Row {
        Row::new(self.index, estimand, channel, self.cell.cost.n, mean)
    }

    /// Means, total and per bounce.
    pub fn means(&self, sheet: &mut Sheet<'_>) {
        for channel in 0..3 {
            self.total(channel, sheet);
            self.wrong(channel, sheet);
            for bin in 0..BINS {
                self.bounce(channel, bin, sheet);
            }
        }
        if self.plan.pixels == 1 {
            let share = self.cell.zeros as f64 / self.cell.cost.n as f64;
            sheet.state(self.row(Estimand::Zeros, None, share));
        }
    }

    /// What theory says of the variance of one realization.
    fn known_variance(&self, channel: usize, counted: Counted) -> Known {
        self.truth.theory().map_or(Known::Unknown, |theory| theory.central(channel, counted, 2))
    }

    fn total(&self, channel: usize, sheet: &mut Sheet<'_>) {
        let total = &self.cell.total[channel];
        let mut row = self.row(Estimand::Mean, Some(channel), total.mean);
        let variance = self.known_variance(channel, Counted::All);
        let claim = sheet.claim(Claim::unbiased);
        row.rays = Some(self.cell.cost.mean);
        row.note = self.truth.refused().unwrap_or_default().to_owned();
        let mut question = Question::about(total, self.cell.invalid(), 0.0, 0.0);
        let mut foreseen = None;
        if variance == Known::Infinite {
            let tail = self.truth.theory().and_then(|theory| theory.tail_index(channel));
            let tail = tail.map_or_else(String::new, |alpha| format!(" (tail index {alpha:.2})"));
            row.note =
                format!("infinite variance{tail}: no standard error; only \"too bright\" can be shown");
            (foreseen, question.unfit) = (Some(row.note.clone()), Some(row.note.clone()));
        } else {
            row.std_error = total.std_error();
            if variance == Known::Value(0.0) {
                (row.variance, row.note) = (total.variance(), "noise-free".to_owned());
            } else if variance == Known::Unknown && self.cell.tails[channel].guard().0 == Light::Red {
                row.note = "variance and efficiency are not estimable: the tail is too heavy".to_owned();
            } else {
                row.variance = total.variance();
                row.rate(total.variance_std_error());
            }
            question.skewness = self.skewness(channel);
            let level = claim.map_or(UNCLAIMED, |(claim, _)| sheet.levels[claim]);
            question.unfit = self.unfit(channel, variance, level);
            if let Some(why) = &question.unfit {
                row.note.clone_from(why);
            }
        }
        self.compare(row, question, Counted::All, (claim, foreseen), sheet);
    }

    /// Skewness of the distribution of the mean: by theory where it is known, else as measured.
    fn skewness(&self, channel: usize) -> f64 {
        let known = self.truth.theory().and_then(|theory| theory.skewness(channel, Counted::All));
        let of_sample = known.or(self.cell.total[channel].skewness()).unwrap_or(0.0);
        of_sample / (self.cell.cost.n as f64).sqrt()
    }

    /// States a row beside the right mean and asks about it under a claim, where both are known.
    fn compare(
        &self,
        mut row: Row,
        question: Question,
        counted: Counted,
        (claim, mut foreseen): (Option<(usize, f64)>, Option<String>),
        sheet: &mut Sheet<'_>,
    ) {
        let channel = row.channel.expect("means have a colour");
        let expected = self.truth.expected(channel, counted);
        // margins are relative to the whole, or where that is not known to the part
        let whole = self.truth.mean(channel, Counted::All).or(expected);
        if let Some(right) = self.truth.mean(channel, counted) {
            row.against(&right, expected.map(|e| e.value));
        }
        let estimand = row.estimand;
        sheet.state(row);
        let (Some((claim, margin)), Some(expected), Some(whole)) = (claim, expected, whole) else { return };
        let margin = margin * whole.value.abs();
        let variance = self.known_variance(channel, counted);
        let bets = self.bets(estimand, channel);
        if bets.is_none() && foreseen.is_some() {
            return;
        }
        if let Known::Value(variance) = variance
            && foreseen.is_none()
            && estimand != Estimand::Mean
            && bets.is_some_and(|bets| bets.stake.bound.is_some())
        {
            let level = sheet.levels[claim];
            let bin = estimand.index();
            let needed = stakes::samples(self.plan, bin, channel, variance).needed(margin, level, POWER);
            let n = self.cell.cost.n.max(self.plan.samples) as f64;
            foreseen = (needed > n).then(|| format!("{needed:.1e} samples would be needed: not judged"));
        }
        let question = Question {
            expected: expected.value,
            expected_std_error: expected.std_error,
            expected_df: expected.df,
            systematic: expected.bound + self.plan.core.rounding() * expected.value.abs(),
            noise_free: variance == Known::Value(0.0),
            margin,
            bets: bets.cloned(),
            looks: self.looks(),
            ..question
        };
        sheet.ask_in_vain(claim, question, foreseen);
    }

    /// How many times a t test about this cell is looked at: all that may end a cell is.
    pub(super) fn looks(&self) -> u32 {
        if self.plan.may_stop { LOOKS_IN_ALL } else { 1 }
    }

    /// What was won by betting on an estimand.
    fn bets(&self, estimand: Estimand, channel: usize) -> Option<&Bets> {
        let bin = match estimand {
            Estimand::Mean => None,
            Estimand::Bounce(bin) => Some(bin),
            _ => return None,
        };
        let stream = self.plan.streams.iter().position(|s| (s.bin, s.channel) == (bin, channel))?;
        self.cell.bets.get(stream)
    }

    /// Why no t test may decide about the mean: too few samples for the known skewness, or where that is not known too
    /// few paths that count.
    fn unfit(&self, channel: usize, variance: Known, level: f64) -> Option<String> {
        let theory = self.truth.theory().and_then(|theory| theory.skewness(channel, Counted::All));
        let Some(skewness) = theory else {
            let (light, why) = self.cell.tails[channel].guard();
            if light == Light::Red && variance == Known::Unknown {
                return Some(format!("the tail is too heavy for a t test: {why}"));
            }
            let expected = self.truth.expected(channel, Counted::All)?;
            return self.rare(variance, expected.value, &self.cell.blocks[channel]);
        };
        let needed = skewed::enough(skewness, level);
        let few = (self.cell.cost.n as f64) < needed;
        few.then(|| format!("skewness {skewness:.0}: a t interval needs {needed:.0} samples"))
    }

    fn bounce(&self, channel: usize, bin: usize, sheet: &mut Sheet<'_>) {
        let blocks = &self.cell.bounces[bin][channel];
        let counted = counted(bin);
        let mut row = self.row(Estimand::Bounce(bin), Some(channel), blocks.mean);
        let mut question = Question::about(blocks, self.cell.invalid(), 0.0, 0.0);
        let variance = self.known_variance(channel, counted);
        if variance != Known::Infinite {
            row.std_error = blocks.std_error();
        }
        question.skewness = blocks.skewness().unwrap_or(0.0) / (blocks.n as f64).sqrt();
        if let Some(expected) = self.truth.expected(channel, counted) {
            question.unfit = self.rare(variance, expected.value, blocks);
        }
        if question.unfit.is_none() && self.known_variance(channel, Counted::All) == Known::Infinite {
            // a single bounce has a variance, but nothing says how many samples would do for a t test
            question.unfit = Some("infinite variance of the whole: not judged".to_owned());
        }
        let bounded = self.bets(row.estimand, channel).is_some_and(|bets| bets.stake.bound.is_some());
        let foreseen = question.unfit.clone().filter(|_| !bounded);
        row.note = foreseen.clone().unwrap_or_default();
        self.compare(row, question, counted, (sheet.claim(Claim::unbiased), foreseen), sheet);
    }

    /// Why what a bounce adds cannot be judged by a t test.
    fn rare(&self, variance: Known, expected: f64, blocks: &Moments) -> Option<String> {
        let effective = match variance {
            Known::Infinite => return Some("infinite variance: not judged".to_owned()),
            Known::Value(variance) => self.cell.cost.n as f64 * expected * expected / variance,
            Known::Unknown => agree::effective(blocks),
        };
        (effective < MIN_EFFECTIVE)
            .then(|| format!("about {effective:.0} paths get here, fewer than {MIN_EFFECTIVE}: not judged"))
    }

    /// Variance and cost against theory.
    pub fn spread(&self, sheet: &mut Sheet<'_>) {
        let cost = &self.cell.cost;
        let mut row = self.row(Estimand::Cost, None, cost.mean);
        row.std_error = cost.std_error();
        row.variance = cost.variance();
        let rays = self.truth.theory().and_then(|theory| theory.rays());
        if let Some(rays) = rays {
            row.against(&Value::exact(rays, Source::ClosedForm), Some(rays));
        }
        sheet.state(row);
        if let (Some((claim, margin)), Some(rays)) = (sheet.claim(Claim::cost), rays) {
            let mut question = Question::about(cost, self.cell.invalid(), rays, margin * rays);
            question.noise_free = self.truth.theory().is_some_and(|theory| theory.rays_are_certain());
            question.looks = self.looks();
            sheet.ask(claim, question);
        }
        for channel in 0..3 {
            self.variance(channel, sheet);
        }
    }

    fn variance(&self, channel: usize, sheet: &mut Sheet<'_>) {
        let Some(theory) = self.truth.theory() else { return };
        let central = |order| theory.central(channel, Counted::All, order);
        let (Some(variance), Some(expected)) = (self.cell.total[channel].variance(), central(2).value())
        else {
            return; // the row of the mean says why
        };
        let mut row = self.row(Estimand::Variance, Some(channel), variance);
        row.against(&Value::exact(expected, Source::ClosedForm), Some(expected));
        let n = self.cell.cost.n as f64;
        let (fourth, total) = (central(4), &self.cell.total[channel]);
        let error = match fourth {
            Known::Value(mu4) => Some(((mu4 - expected * expected * (n - 3.0) / (n - 1.0)) / n).sqrt()),
            // samples may know what theory does not, unless their tail is heavy
            Known::Unknown if self.cell.tails[channel].guard().0 == Light::Green => {
                total.variance_std_error()
            }
            _ => None,
        };
        row.std_error = error;
        if fourth == Known::Infinite {
            row.note = "infinite fourth moment: the variance has no interval, not judged".to_owned();
        }
        sheet.state(row);
        let claim = sheet.claim(Claim::variance);
        if let (Some((claim, margin)), Some(std_error), true) = (claim, error, expected > 0.0) {
            let question = Question::about(&self.cell.total[channel], self.cell.invalid(), expected, 0.0);
            let (df, margin) = (f64::INFINITY, margin * expected);
            sheet.ask(
                claim,
                Question { mean: variance, std_error, df, margin, looks: self.looks(), ..question },
            );
        }
    }
}
