//! How often the deciding instruments are wrong about a mean that is known, and how often they find it wrong when it is.
//!
//! Each run draws fresh samples of a [`Law`] and judges them as the bench would: bets looked at after every few samples,
//! the interval at a time that has nothing to do with the samples, t tests at the end. Where nothing is wrong, the share
//! of runs that reject is an error rate. Samples multiplied by 1 + bias show what is found, at the price of a product.

use super::bets::{Bets, PER_BET, Stake, Table};
use super::binomial::clopper_pearson;
use super::nulls::Law;
use super::power::reach;
use super::question::{Engine, Question};
use super::sides::{POWER, Sides};
use super::skewed;
use super::source::Source;
use super::student::one_sided_p;
use super::tails::{Light, Tail};
use super::{Moments, calibrate_rows};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};

pub use calibrate_rows::{NullRow, rows};

/// Confidence of the intervals of all rates.
pub const CONFIDENCE: f64 = 0.999;

/// Looks at the bets of a run, at most.
const MOST_LOOKS: u64 = 4096;

/// Looks of the t test that peeks: at the end and after a half, a quarter, ... of the samples.
const PEEKS: u32 = 10;

/// What judges, and on which side: *above* says that the mean is larger than it should be, *below* that it is smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Instrument {
    /// Bets, ever worth 1/level. Exact.
    BetsAbove,
    /// Likewise; only where there is a bound.
    BetsBelow,
    /// The limits of the bets do not contain the mean at a random time. Exact.
    Interval,
    /// The corrected t with the skewness of theory, where by that the samples suffice: decides where theory is known.
    KnownBelow,
    /// Likewise.
    KnownAbove,
    /// The corrected t with the sample's skewness, where its tail is not red and by its skewness the samples suffice.
    GuardedBelow,
    /// Likewise.
    GuardedAbove,
    /// The same in every run.
    CorrectedBelow,
    /// Likewise.
    CorrectedAbove,
    /// Student's t; a sample without spread that differs from the mean is rejected.
    StudentBelow,
    /// Likewise.
    StudentAbove,
    /// Student's two-sided t at each of ten doublings, without correction: decides nothing, and shows why.
    Peeks,
    /// The tail guard is red; no test.
    Red,
}

impl Instrument {
    /// All of them, those that decide first.
    pub const ALL: [Instrument; 13] = [
        Instrument::BetsAbove,
        Instrument::BetsBelow,
        Instrument::Interval,
        Instrument::KnownBelow,
        Instrument::KnownAbove,
        Instrument::GuardedBelow,
        Instrument::GuardedAbove,
        Instrument::CorrectedBelow,
        Instrument::CorrectedAbove,
        Instrument::StudentBelow,
        Instrument::StudentAbove,
        Instrument::Peeks,
        Instrument::Red,
    ];

    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Instrument::BetsAbove => "bets, above",
            Instrument::BetsBelow => "bets, below",
            Instrument::Interval => "interval at a random time",
            Instrument::KnownBelow => "t with theory's skewness, below",
            Instrument::KnownAbove => "t with theory's skewness, above",
            Instrument::GuardedBelow => "guarded t, below",
            Instrument::GuardedAbove => "guarded t, above",
            Instrument::CorrectedBelow => "corrected t, below",
            Instrument::CorrectedAbove => "corrected t, above",
            Instrument::StudentBelow => "Student, below",
            Instrument::StudentAbove => "Student, above",
            Instrument::Peeks => "Student, ten peeks",
            Instrument::Red => "red guard",
        }
    }

    /// Whether its error probability is promised for any number of samples of any law.
    pub fn is_exact(self) -> bool {
        matches!(self, Instrument::BetsAbove | Instrument::BetsBelow | Instrument::Interval)
    }
}

/// In how many runs an instrument rejected, of those that it had anything to say about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Count {
    /// Runs in which it rejected.
    pub rejected: u64,
    /// Runs.
    pub of: u64,
}

impl Count {
    /// The share, in 0..=1; NaN without runs.
    pub fn rate(&self) -> f64 {
        self.rejected as f64 / self.of as f64
    }

    /// The rate's interval of 99.9 % [Clopper & Pearson 1934].
    pub fn interval(&self) -> (f64, f64) {
        clopper_pearson(self.rejected, self.of, CONFIDENCE)
    }
}

/// What was measured of one law at one level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// The law.
    pub law: Law,
    /// Samples a run.
    pub samples: u64,
    /// Runs.
    pub runs: u64,
    /// Nominal error probability of each instrument: of each side by itself, of [`Instrument::Interval`] and
    /// [`Instrument::Peeks`] of both together.
    pub level: f64,
    /// Samples were multiplied by one more than this.
    pub bias: f64,
    /// In the order of [`Instrument::ALL`].
    pub counts: Vec<Count>,
}

impl Rates {
    /// What an instrument did.
    pub fn count(&self, instrument: Instrument) -> Count {
        self.counts[instrument as usize]
    }
}

/// Judges `runs` times `samples` samples of a law, multiplied by 1 + `bias`, against the law's mean, with the nominal
/// error probability `level` in (0, 1). The same for the same `seed`, on any number of threads.
pub fn measure(law: &Law, samples: u64, runs: u64, level: f64, bias: f64, seed: u64) -> Rates {
    let never = AtomicBool::new(false);
    let mut rates = measure_at(&Setting { law: *law, samples, runs, bias, seed }, &[level], &never);
    rates.as_mut().and_then(Vec::pop).expect("one level has one answer, as nothing stops it")
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The law.
    pub law: Law,
    /// Samples a run, from 1.
    pub samples: u64,
    /// Runs.
    pub runs: u64,
    /// Samples are multiplied by one more than this; above -1.
    pub bias: f64,
    /// All chance follows from it.
    pub seed: u64,
}

/// As [`measure`], with the same samples at several levels; `None` if `stop` was raised before the end.
pub fn measure_at(setting: &Setting, levels: &[f64], stop: &AtomicBool) -> Option<Vec<Rates>> {
    let bench = Bench::new(setting);
    let nothing = || vec![[Count::default(); Instrument::ALL.len()]; levels.len()];
    let add = |mut sums: Vec<[Count; Instrument::ALL.len()]>, more: Vec<_>| {
        for (sum, more) in sums.iter_mut().flatten().zip(more.iter().flatten()) {
            let more: &Count = more;
            sum.rejected += more.rejected;
            sum.of += more.of;
        }
        Some(sums)
    };
    let one = |run| {
        let seen = (!stop.load(Ordering::Relaxed)).then(|| bench.watch(run))?;
        let count = |says: Option<bool>| Count {
            rejected: u64::from(says == Some(true)),
            of: u64::from(says.is_some()),
        };
        Some(levels.iter().map(|level| bench.says(&seen, *level).map(count)).collect::<Vec<_>>())
    };
    // sums of whole numbers: their order does not matter
    let sums = (0..setting.runs).into_par_iter().map(one).try_reduce(nothing, add)?;
    let Setting { law, samples, runs, bias, .. } = *setting;
    let rates = |(level, counts): (&f64, [Count; Instrument::ALL.len()])| Rates {
        law,
        samples,
        runs,
        level: *level,
        bias,
        counts: counts.to_vec(),
    };
    Some(levels.iter().zip(sums).map(rates).collect())
}

/// Biases below and above 0 which an engine should find in nine of ten runs, by [`reach`]: the standard error is that of
/// the multiplied samples. The latter is infinite where the samples are too few for any, both are `None` where the
/// variance is infinite.
pub fn predicted(law: &Law, samples: u64, engine: Engine, level: f64) -> Option<(f64, f64)> {
    let se = libm::sqrt(law.variance()? / samples as f64) / law.mean();
    let shift = reach(engine, samples as f64 - 1.0, level, POWER) * se;
    let above = if shift < 1.0 { shift / (1.0 - shift) } else { f64::INFINITY };
    Some((-shift / (1.0 + shift), above))
}

/// How runs are judged.
struct Bench<'a> {
    setting: &'a Setting,
    mean: f64,
    stake: Stake,
    /// Samples between looks.
    chunk: u64,
}

/// What was seen in one run.
struct Seen {
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

impl<'a> Bench<'a> {
    fn new(setting: &'a Setting) -> Self {
        let mean = setting.law.mean();
        // the bound is that of what is bet on: a bias that exceeded it would be told apart at once
        let bound = setting.law.bound().map(|bound| bound * (1.0 + setting.bias.max(0.0)));
        let stake = Stake { scale: mean, bound: bound.filter(|bound| *bound > mean) };
        let chunk = PER_BET * setting.samples.div_ceil(PER_BET * MOST_LOOKS);
        Bench { setting, mean, stake, chunk }
    }

    fn watch(&self, run: u64) -> Seen {
        let Setting { law, samples, bias, seed, .. } = *self.setting;
        let mut draw = law.samples(seed, run).map(|x| (1.0 + bias) * x);
        let stop = self.random_look(run);
        let (mut moments, mut tail, mut bets) = (Moments::default(), Tail::default(), Bets::new(self.stake));
        let (mut above, mut below, mut peeks) = (0.0_f64, 0.0_f64, 1.0_f64);
        let mut stopped = bets.clone();
        let mut values = Vec::with_capacity(self.chunk as usize);
        for look in 1..=samples.div_ceil(self.chunk) {
            let left = samples - moments.n;
            values.clear();
            values.extend(draw.by_ref().take(left.min(self.chunk) as usize));
            for &x in &values {
                moments.push(x);
                tail.push(x);
                if (0..PEEKS).any(|halvings| moments.n == samples >> halvings) {
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
        if question.std_error.is_nan() || question.std_error <= f64::EPSILON * question.mean.abs() {
            return [1.0; 2];
        }
        let question = Question { skewness: skewness / libm::sqrt(moments.n as f64), ..question };
        let sides = Sides::of(&question);
        [sides.below.p_below(self.mean), sides.above.p_above(self.mean)]
    }

    /// p-values of Student's t, below and above; NaN where there is none.
    fn student(&self, moments: &Moments) -> [f64; 2] {
        let t = moments.std_error().map_or(f64::NAN, |se| (moments.mean - self.mean) / se);
        [one_sided_p(-t, moments.n as f64 - 1.0), one_sided_p(t, moments.n as f64 - 1.0)]
    }

    /// What each of [`Instrument::ALL`] says of a run: rejected or not, or nothing.
    fn says(&self, seen: &Seen, level: f64) -> [Option<bool>; Instrument::ALL.len()] {
        let enough = -libm::log(level);
        let n = self.setting.samples;
        let bounded = self.stake.bound.is_some();
        // a side of a two-sided test
        let suffices = |skewness| skewed::trustworthy(n, skewness, (2.0 * level).min(1.0));
        let theory = self.setting.law.skewness().is_some_and(suffices);
        let guarded = !seen.red && suffices(seen.skewness);
        let half = if bounded { level / 2.0 } else { level };
        let (low, high) = (seen.stopped.lower_limit(half), seen.stopped.upper_limit(half));
        let [known_below, known_above] = seen.known.map(|p| theory.then_some(p <= level));
        let [guarded_below, guarded_above] = seen.corrected.map(|p| guarded.then_some(p <= level));
        let [corrected_below, corrected_above] = seen.corrected.map(|p| Some(p <= level));
        let [student_below, student_above] = seen.student.map(|p| Some(p <= level));
        [
            Some(seen.above >= enough),
            bounded.then_some(seen.below >= enough),
            Some(self.mean < low || self.mean > high),
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
