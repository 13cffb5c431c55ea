//! One run: samples, and what each instrument says of them.

use super::{Instrument, Setting};
use crate::stats::Moments;
use crate::stats::bets::{Bets, PER_BET, Stake, Table};
use crate::stats::nulls::Law;
use crate::stats::question::Question;
use crate::stats::sides::Sides;
use crate::stats::skewed;
use crate::stats::source::Source;
use crate::stats::student::one_sided_p;
use crate::stats::tails::{Light, Tail};

/// Looks at the bets of a run, at most.
const MOST_LOOKS: u64 = 4096;

/// Looks of the t test that peeks: at the end and after a half, a quarter, ... of the samples.
const PEEKS: u32 = 10;

/// How runs are judged.
pub(super) struct Bench<'a> {
    setting: &'a Setting,
    mean: f64,
    stake: Stake,
    /// Samples between looks.
    chunk: u64,
}

/// What was seen in one run.
pub(super) struct Seen {
    /// Logarithms of the largest fortunes.
    above: f64,
    below: f64,
    /// Bets at a random time.
    stopped: Bets,
    /// p-values of the corrected t, below and above, with the sample's and theory's skewness.
    corrected: [f64; 2],
    known: [f64; 2],
    student: [f64; 2],
    /// The smallest two-sided p-value.
    peeks: f64,
    skewness: f64,
    red: bool,
}

/// What is bet with. The bound is that of what is bet on: a bias that exceeded it would be told apart at once.
pub(super) fn stake(law: &Law, bias: f64) -> Stake {
    let bound = law.bound().map(|bound| bound * (1.0 + bias.max(0.0)));
    Stake { scale: law.mean(), bound: bound.filter(|bound| *bound > law.mean()) }
}

impl<'a> Bench<'a> {
    pub(super) fn new(setting: &'a Setting) -> Self {
        let (mean, stake) = (setting.law.mean(), stake(&setting.law, setting.bias));
        let chunk = PER_BET * setting.samples.div_ceil(PER_BET * MOST_LOOKS);
        Bench { setting, mean, stake, chunk }
    }

    pub(super) fn watch(&self, run: u64) -> Seen {
        let Setting { law, samples, bias, seed, .. } = *self.setting;
        let mut draw = law.samples(seed, run).map(|x| (1.0 + bias) * x);
        let stop = self.random_look(run);
        let (mut moments, mut tail, mut bets) = (Moments::default(), Tail::default(), Bets::new(self.stake));
        let (mut above, mut below, mut peeks) = (0.0_f64, 0.0_f64, 1.0_f64);
        let mut peeks_at: Vec<u64> = (0..PEEKS).map(|halvings| samples >> halvings).collect();
        let mut stopped = bets.clone();
        let mut values = Vec::with_capacity(self.chunk as usize);
        for look in 1..=samples.div_ceil(self.chunk) {
            let left = samples - moments.n;
            values.clear();
            values.extend(draw.by_ref().take(left.min(self.chunk) as usize));
            for &x in &values {
                moments.push(x);
                tail.push(x);
                while peeks_at.last().is_some_and(|at| *at <= moments.n) {
                    peeks_at.pop();
                    peeks = peeks.min(2.0 * self.student(&moments).into_iter().fold(1.0, f64::min));
                }
            }
            bets.merge(&self.bet(&values));
            above = above.max(bets.log_above(self.mean));
            below = below.max(bets.log_below(self.mean).unwrap_or(0.0));
            if look == stop {
                stopped.clone_from(&bets);
            }
        }
        let skewness = moments.skewness().unwrap_or(0.0);
        Seen {
            above,
            below,
            stopped,
            corrected: self.corrected(&moments, skewness),
            known: law.skewness().map_or([1.0; 2], |skewness| self.corrected(&moments, skewness)),
            student: self.student(&moments),
            peeks,
            skewness,
            red: tail.guard().0 == Light::Red,
        }
    }

    /// The number of a look, which is as likely early as late on a logarithmic scale.
    fn random_look(&self, run: u64) -> u64 {
        let looks = self.setting.samples.div_ceil(self.chunk);
        let u = Source::keyed(!self.setting.seed, run).uniform();
        (libm::exp(u * libm::log(looks as f64 + 1.0)) as u64).clamp(1, looks)
    }

    /// Bets on the samples between two looks.
    fn bet(&self, values: &[f64]) -> Bets {
        let together = self.stake.samples_per_bet() as usize;
        let mut table = Table::new(self.stake);
        let averages = values.chunks(together);
        let bets = averages.len() as u64;
        averages.for_each(|part| table.push(part.iter().sum::<f64>() / part.len() as f64));
        table.close(bets)
    }

    /// p-values of the bench's t test, below and above; 1 where it finds no spread to judge by.
    fn corrected(&self, moments: &Moments, skewness: f64) -> [f64; 2] {
        let question = Question::about(moments, None, self.mean, self.mean);
        if !varies(moments) {
            return [1.0; 2];
        }
        let question = Question { skewness: skewness / libm::sqrt(moments.n as f64), ..question };
        let sides = Sides::of(&question);
        [sides.below.p_below(self.mean), sides.above.p_above(self.mean)]
    }

    /// p-values of Student's t, below and above.
    fn student(&self, moments: &Moments) -> [f64; 2] {
        let Some(se) = moments.std_error().filter(|_| varies(moments)) else { return [1.0; 2] };
        let t = (moments.mean - self.mean) / se;
        [one_sided_p(-t, moments.n as f64 - 1.0), one_sided_p(t, moments.n as f64 - 1.0)]
    }

    /// What each of [`Instrument::ALL`] says of a run: rejected or not, or nothing.
    pub(super) fn says(&self, seen: &Seen, level: f64) -> [Option<bool>; Instrument::ALL.len()] {
        let enough = -libm::log(level);
        let n = self.setting.samples;
        let bounded = self.stake.bound.is_some();
        // a side of a two-sided test
        let suffices = |skewness| skewed::trustworthy(n, skewness, (2.0 * level).min(1.0));
        let theory = self.setting.law.skewness().is_some_and(suffices);
        let guarded = !seen.red && suffices(seen.skewness);
        let half = if bounded { level / 2.0 } else { level };
        // the limits are where the evidence is just enough: the mean lies beyond them where it is more
        let (over, under) = (seen.stopped.log_above(self.mean), seen.stopped.log_below(self.mean));
        let misses = over.max(under.unwrap_or(0.0)) >= -libm::log(half);
        let [known_below, known_above] = seen.known.map(|p| theory.then_some(p <= level));
        let [guarded_below, guarded_above] = seen.corrected.map(|p| guarded.then_some(p <= level));
        let [corrected_below, corrected_above] = seen.corrected.map(|p| Some(p <= level));
        let [student_below, student_above] = seen.student.map(|p| Some(p <= level));
        [
            Some(seen.above >= enough),
            bounded.then_some(seen.below >= enough),
            Some(misses),
            known_below,
            known_above,
            guarded_below,
            guarded_above,
            corrected_below,
            corrected_above,
            student_below,
            student_above,
            Some(seen.peeks <= level),
            Some(seen.red),
        ]
    }
}

/// Whether there is a spread to judge by; that of rounding is none.
fn varies(moments: &Moments) -> bool {
    moments.std_error().is_some_and(|se| se > f64::EPSILON * moments.mean.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(law: Law, bias: f64) -> Setting {
        Setting { law, samples: 700, runs: 300, bias, seed: 9 }
    }

    #[test]
    fn a_mean_is_missed_where_it_lies_beyond_the_limits() {
        // 700 is no multiple of what is averaged; biases so that many are missed
        for (law, bias) in [
            (Law::Rare { p: 0.02 }, 0.8),
            (Law::Rare { p: 0.02 }, -0.5),
            (Law::Walk { albedo: 0.5, q: 0.8 }, -0.1),
            (Law::Lognormal { sigma: 1.0 }, 0.2),
        ] {
            let setting = setting(law, bias);
            let bench = Bench::new(&setting);
            let mut missed = 0;
            for run in 0..setting.runs {
                let seen = bench.watch(run);
                let half = if law.bound().is_some() { 0.1 } else { 0.2 };
                let (low, high) = (seen.stopped.lower_limit(half), seen.stopped.upper_limit(half));
                let misses = law.mean() < low || law.mean() > high;
                assert_eq!(
                    bench.says(&seen, 0.2)[Instrument::Interval as usize],
                    Some(misses),
                    "{law} {run}"
                );
                missed += u64::from(misses);
            }
            assert!((5..=295).contains(&missed), "{law}: {missed}");
        }
    }

    #[test]
    fn looks_are_few_and_random_ones_among_them() {
        let setting = Setting { samples: 1_000_000, ..setting(Law::Lognormal { sigma: 1.0 }, 0.0) };
        let bench = Bench::new(&setting);
        assert!(bench.chunk.is_multiple_of(PER_BET) && setting.samples.div_ceil(bench.chunk) <= MOST_LOOKS);
        let looks: Vec<u64> = (0..1000).map(|run| bench.random_look(run)).collect();
        assert!(
            looks.contains(&1)
                && looks.iter().any(|look| *look > 3000)
                && *looks.iter().max().unwrap() <= 4096
        );
    }
}
