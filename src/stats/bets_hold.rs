//! [`Bets`] against the gambler's own product, and their error rates and power on samples whose law is known.

use super::bets::{BETS, Bets, Stake, Table};
use super::power::reach;
use super::{Engine, Question, Verdict, judge};
use statrs::distribution::{Binomial, DiscreteCDF};

const STAKE: Stake = Stake { scale: 1.5, bound: Some(7.0) };

/// Values in [0, 7), a third of them zero, of mean near 1.
fn values(n: u64) -> Vec<f64> {
    let value = |i: u64| {
        let u = (i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11) as f64 / (1u64 << 53) as f64;
        if i.is_multiple_of(3) { 0.0 } else { 7.0 * u * u * u }
    };
    (0..n).map(value).collect()
}

fn bets(values: &[f64], stake: Stake) -> Bets {
    let mut table = Table::new(stake);
    values.iter().for_each(|&x| table.push(x));
    table.close(values.len() as u64)
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{a} is not {b}");
}

/// The fortunes written as the gambler would: a product of 1 + λ (X/m - 1) for each share λ.
#[test]
fn fortunes_are_products() {
    let values = values(100);
    let bets = bets(&values, STAKE);
    for m in [0.3, 1.0, 1.9, 5.0] {
        let fortune = |grid: [f64; BETS], room: f64, of: &dyn Fn(f64) -> f64| {
            let share = |c: f64| c * room / (1.0 + c * room);
            let product =
                |c: f64| -> f64 { values.iter().map(|&x| 1.0 + share(c) * (of(x) / room - 1.0)).product() };
            (grid.iter().map(|&c| product(c)).sum::<f64>() / BETS as f64).ln()
        };
        close(bets.log_above(m), fortune(STAKE.above(), m, &|x| x));
        close(bets.log_below(m).unwrap(), fortune(STAKE.below(), 7.0 - m, &|x| 7.0 - x));
    }
    // at the guess itself the shares are the grid
    close(STAKE.above()[0] * 1.5, 15.0);
    close(STAKE.above()[1] * 1.5, 1.0);
}

#[test]
fn blocks_merge_by_addition() {
    let values = values(10_000);
    let whole = bets(&values, STAKE);
    let mut merged = Bets::new(STAKE);
    values.chunks(333).for_each(|block| merged.merge(&bets(block, STAKE)));
    assert_eq!((merged.n, merged.void), (10_000, 0));
    for m in [0.5, 1.1, 4.0] {
        close(merged.log_above(m), whole.log_above(m));
        close(merged.log_below(m).unwrap(), whole.log_below(m).unwrap());
    }
}

#[test]
fn limits_are_where_the_evidence_is_just_enough() {
    let bets = bets(&values(5000), STAKE);
    let (low, high) = (bets.lower_limit(1e-3), bets.upper_limit(1e-3));
    close(bets.log_above(low), 1e3_f64.ln());
    close(bets.log_below(high).unwrap(), 1e3_f64.ln());
    // the mean is 7/4 of two thirds
    assert!(0.9 < low && low < 7.0 / 6.0 && 7.0 / 6.0 < high && high < 1.4, "{low} {high}");
    assert!(bets.lower_limit(1e-9) < low && bets.upper_limit(1e-9) > high);
}

#[test]
fn the_ends_of_the_range() {
    let dark = bets(&[0.0; 1000], STAKE);
    assert_eq!((dark.lower_limit(1e-3), dark.log_above(0.0)), (0.0, 0.0));
    assert!(dark.upper_limit(1e-3) < 0.1);
    assert_eq!(dark.log_above(-1e-9), f64::INFINITY);
    let bright = bets(&[7.0; 1000], STAKE);
    assert!(bright.lower_limit(1e-3) > 6.9);
    assert_eq!(bright.upper_limit(1e-3), 7.0);
    assert_eq!(bright.log_above(0.0), f64::INFINITY);
    assert_eq!(bright.log_below(7.1), Some(f64::INFINITY));
    let nothing = Bets::new(Stake { bound: None, ..STAKE });
    assert_eq!((nothing.lower_limit(0.01), nothing.upper_limit(0.01)), (0.0, f64::INFINITY));
    assert_eq!(nothing.log_below(1.0), None);
}

#[test]
fn what_is_no_sample_voids_the_evidence() {
    for bad in [-1e-300, f64::NAN, f64::INFINITY, 7.1, 1e300] {
        assert_eq!(bets(&[1.0, bad, 2.0], STAKE).void, 1, "{bad}");
    }
    assert_eq!(bets(&[7.0 * (1.0 + 1e-10)], STAKE).void, 0);
    assert!(Stake { scale: 0.0, bound: None }.defect().is_some());
    assert!(Stake { scale: 2.0, bound: Some(2.0) }.defect().is_some());
    assert!(Stake { scale: f64::NAN, bound: None }.defect().is_some());
    assert!(STAKE.defect().is_none());
}

/// Products of thousands of factors of 1e10 and more stay numbers.
#[test]
fn fortunes_may_be_huge() {
    let bets = bets(&[1e12; 5000], Stake { scale: 1.0, bound: None });
    let expected = 5000.0 * (1e12_f64 * 15.0).ln() - 5000.0 * 16_f64.ln() - (BETS as f64).ln();
    assert!((bets.log_above(1.0) - expected).abs() < 1.0, "{} {expected}", bets.log_above(1.0));
}

/// Roulette in a furnace of albedo 1/2 and emission 1 with survival probability q: mean 2, tail index ln q / ln 2q, and
/// an infinite variance for q <= 1/4.
struct Furnace {
    q: f64,
    state: u64,
}

impl Furnace {
    fn sample(&mut self) -> f64 {
        let (mut sum, mut beta) = (1.0, 1.0);
        loop {
            self.state = self.state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            if (self.state >> 11) as f64 / (1u64 << 53) as f64 >= self.q {
                return sum;
            }
            beta *= 0.5 / self.q;
            sum += beta;
        }
    }
}

/// Whether hits out of runs are not significantly more (or fewer) than the rate, at 0.1 %.
fn at_most(hits: u64, runs: u64, rate: f64) -> bool {
    hits == 0 || Binomial::new(rate, runs).unwrap().sf(hits - 1) >= 1e-3
}

fn at_least(hits: u64, runs: u64, rate: f64) -> bool {
    Binomial::new(rate, runs).unwrap().cdf(hits) >= 1e-3
}

/// In how many of 2000 runs the evidence that the mean exceeds 2, or lies below it, is ever worth 1/level, looked at
/// 64 times.
fn alarms(q: f64, bound: Option<f64>, bias: f64, level: f64) -> (u64, u64) {
    let stake = Stake { scale: 2.0, bound };
    let (mut above, mut below) = (0, 0);
    for run in 0..2000 {
        let mut law = Furnace { q, state: 7919 * run + 1 };
        let mut sum = Bets::new(stake);
        let (mut high, mut low) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for _ in 0..64 {
            let mut table = Table::new(stake);
            (0..32).for_each(|_| table.push((1.0 + bias) * law.sample()));
            sum.merge(&table.close(32));
            high = high.max(sum.log_above(2.0));
            low = low.max(sum.log_below(2.0).unwrap_or(0.0));
        }
        above += u64::from(high >= -level.ln());
        below += u64::from(low >= -level.ln());
    }
    (above, below)
}

#[test]
fn true_means_raise_few_alarms_however_often_one_looks() {
    // the bound is 1 / (1 - 1/2q) for q > 1/2; at 0.2 the variance is infinite
    for (q, bound) in [(0.2, None), (0.5, None), (0.75, Some(3.0))] {
        let (above, below) = alarms(q, bound, 0.0, 0.05);
        assert!(at_most(above, 2000, 0.05) && at_most(below, 2000, 0.05), "q = {q}: {above} {below}");
    }
}

#[test]
fn wrong_means_are_found() {
    // 2048 samples of standard deviation √2, √2 and 0.76
    for (q, bound, bias) in [(0.5, None, 0.12), (0.75, Some(3.0), 0.08)] {
        let (above, below) = alarms(q, bound.map(|b: f64| 1.1 * b), bias, 0.05);
        assert!(above > 1900 && below < 20, "q = {q}: {above} {below}");
    }
    let (above, below) = alarms(0.75, Some(3.0), -0.08, 0.05);
    assert!(below > 1900 && above < 20, "{above} {below}");
    let (above, _) = alarms(0.2, None, 0.5, 0.05);
    assert!(above > 1500, "infinite variance: {above}");
}

/// The formula for the reach, from below and above.
#[test]
fn a_difference_of_the_stated_reach_is_found_nine_times_in_ten() {
    let (level, n) = (1e-4, 4096_u64);
    let stake = Stake { scale: 2.0, bound: Some(3.0) };
    // Var = m² rho² (1 - q) / (q - rho²)
    let se = (4.0_f64 * 0.25 * 0.25 / 0.5 / n as f64).sqrt();
    let bias = reach(Engine::Exact, f64::INFINITY, level, 0.9) * se;
    let found = |m: f64, side: &dyn Fn(&Bets, f64) -> f64| {
        let hit = |run: u64| {
            let mut law = Furnace { q: 0.75, state: 104_729 * run + 3 };
            let mut table = Table::new(stake);
            (0..n).for_each(|_| table.push(law.sample()));
            u64::from(side(&table.close(n), m) >= -level.ln())
        };
        (0..1000).map(hit).sum::<u64>()
    };
    for hits in [found(2.0 - bias, &Bets::log_above), found(2.0 + bias, &|b, m| b.log_below(m).unwrap())] {
        assert!(at_least(hits, 1000, 0.9), "{hits} of 1000");
        // not by asking for much more than is needed
        assert!(at_most(hits, 1000, 0.985), "{hits} of 1000");
    }
}

/// The whole way: a question with bets is decided exactly, on both sides, and a bound that is exceeded is told.
#[test]
fn judged_by_bets() {
    let question = |bias: f64, margin: f64| {
        let stake = Stake { scale: 2.0, bound: Some(3.0 * (1.0 + bias.max(0.0))) };
        let (mut table, mut law) = (Table::new(stake), Furnace { q: 0.75, state: 11 });
        let mut moments = super::Moments::default();
        for _ in 0..20_000 {
            let x = (1.0 + bias) * law.sample();
            table.push(x);
            moments.push(x);
        }
        Question { bets: Some(table.close(20_000)), ..Question::about(&moments, None, 2.0, margin) }
    };
    let verdict = |q: Question| {
        let answer = judge(&[q], 1e-3).remove(0);
        assert_eq!(answer.engine, Engine::Exact);
        (answer.verdict, answer.e_value.unwrap())
    };
    assert_eq!(verdict(question(0.0, 0.1)).0, Verdict::Pass);
    assert_eq!(verdict(question(0.0, 1e-3)).0, Verdict::Inconclusive);
    assert_eq!(verdict(question(0.05, 0.02)).0, Verdict::Fail);
    let (fail, e) = verdict(question(-0.05, 0.02));
    assert!(fail == Verdict::Fail && e > 1e3);
    let mut exceeded = question(0.0, 0.1);
    exceeded.bets.as_mut().unwrap().void = 3;
    let answer = judge(&[exceeded], 1e-3).remove(0);
    assert!(
        answer.verdict == Verdict::Invalid && answer.reason.contains("3 samples exceed the bound"),
        "{answer:?}"
    );
}
