//! Error rates and power of [`judge`] on simulated families: normal samples,
//! block means, Student-distributed standard errors.

use super::{Moments, Question, Verdict, judge};
use statrs::distribution::{Binomial, DiscreteCDF};

const FAMILIES: u64 = 4000;
const BLOCKS: usize = 16;
const ALPHA: f64 = 0.05;
/// Standard error of a mean of `BLOCKS` standard normal block means.
const SE: f64 = 0.25;

/// Knuth's linear congruential generator with the Box-Muller transform.
struct Normals(u64);

impl Normals {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    fn estimate(&mut self, mean: f64) -> (f64, f64) {
        let mut blocks = Moments::default();
        (0..BLOCKS).for_each(|_| blocks.push(mean + self.normal()));
        (blocks.mean, blocks.std_error().unwrap())
    }

    fn question(&mut self, bias: f64, margin: f64) -> Question {
        let (mean, std_error) = self.estimate(10.0 + bias);
        Question { mean, std_error, margin, ..Question::example() }
    }
}

/// In how many families any of the questions gets the verdict.
fn count(verdict: Verdict, mut family: impl FnMut(&mut Normals) -> Vec<Question>) -> u64 {
    let mut normals = Normals(20_260_730);
    let mut hits = 0;
    for _ in 0..FAMILIES {
        let answers = judge(&family(&mut normals), ALPHA);
        hits += u64::from(answers.iter().any(|a| a.verdict == verdict));
    }
    hits
}

/// Whether the 99.8 % Clopper-Pearson interval of hits / FAMILIES reaches below
/// or above the rate: equivalent to a binomial tail of 0.1 % or more.
fn at_most(hits: u64, rate: f64) -> bool {
    hits == 0 || Binomial::new(rate, FAMILIES).unwrap().sf(hits - 1) >= 1e-3
}

fn at_least(hits: u64, rate: f64) -> bool {
    Binomial::new(rate, FAMILIES).unwrap().cdf(hits) >= 1e-3
}

fn five(n: &mut Normals, bias: f64, margin: f64) -> Vec<Question> {
    (0..5).map(|_| n.question(bias, margin)).collect()
}

#[test]
fn five_true_nulls_raise_a_false_alarm_as_often_as_promised() {
    let alarms = count(Verdict::Fail, |n| five(n, 0.0, 1e-3));
    assert!(at_most(alarms, ALPHA), "{alarms}");
    // not by being deaf: independent tests use up 1 - (1 - alpha/5)^5
    assert!(at_least(alarms, 1.0 - 0.99_f64.powi(5)), "{alarms}");
}

#[test]
fn a_noisy_reference_keeps_the_rate() {
    let alarms = count(Verdict::Fail, |n| {
        let mut family = five(n, 0.0, 1e-3);
        for q in &mut family {
            (q.expected, q.expected_std_error) = n.estimate(10.0);
            q.expected_df = (BLOCKS - 1) as f64;
        }
        family
    });
    assert!(at_most(alarms, ALPHA) && at_least(alarms, 0.035), "{alarms}");
}

#[test]
fn a_bias_as_large_as_the_systematic_error_raises_no_more_alarms() {
    let alarms = count(Verdict::Fail, |n| {
        let mut family = five(n, SE, 1e-3);
        family.iter_mut().for_each(|q| q.systematic = SE);
        family
    });
    assert!(at_most(alarms, ALPHA) && at_least(alarms, 0.015), "{alarms}");
}

#[test]
fn a_bias_of_the_stated_size_is_found_nine_times_in_ten() {
    let mut ideal = Normals(1).question(0.0, 1e-3);
    ideal.std_error = SE;
    let mde = judge(&vec![ideal; 5], ALPHA)[0].mde;
    let found = count(Verdict::Fail, |n| {
        let mut family = five(n, 0.0, 1e-3);
        family[0] = n.question(mde, 1e-3);
        // hearing an alarm from the others is not finding it
        family[1..].iter_mut().for_each(|q| q.mean = 10.0);
        family
    });
    // scipy.stats.nct.sf(t, 15, t + z): the normal z in the mde neglects that the
    // standard error has noise, too; with 32 blocks it is 0.89
    assert!(at_most(found, 0.8795) && at_least(found, 0.8795), "{found}");
}

#[test]
fn bias_at_the_margin_seldom_passes() {
    for margin in [3.0 * SE, 20.0 * SE] {
        let passes = count(Verdict::Pass, |n| five(n, margin, margin));
        assert!(at_most(passes, ALPHA), "{passes} at {margin}");
        let one = count(Verdict::Pass, |n| vec![n.question(-margin, margin)]);
        assert!(at_most(one, ALPHA), "{one} at {margin}");
        // by the interval, as the difference is significant, too
        assert!(at_least(one, 0.015), "{one} at {margin}");
    }
}

#[test]
fn the_samples_asked_for_suffice() {
    // margin at which judge asks for exactly as many samples as there are
    let margin = (1.753050 + 1.644854) * SE;
    let ask = |factor: f64| {
        let mut q = Normals(1).question(0.0, margin * factor);
        (q.mean, q.std_error) = (10.0 + 2.0 * SE, SE);
        judge(&[q], ALPHA)[0].reason.clone()
    };
    assert!(ask(0.99).contains("1.02 times") && ask(1.01).contains("would suffice"));
    let passes = count(Verdict::Pass, |n| vec![n.question(0.0, margin)]);
    assert!(at_most(passes, 0.92) && at_least(passes, 0.88), "{passes}");
}
