//! The lights of [`checks`] on simulated samples, good and bad.

use super::Moments;
use super::source::Source;
use super::tails::{Light, Tail};
use super::tally::{Check, checks};

/// Snapshots at `n` / 2^(j/8), the last of all values.
fn run(n: u64, seed: u64, law: impl Fn(&mut Source, u64) -> f64) -> [Check; 10] {
    let at: Vec<u64> = (0..40).rev().map(|j| (n as f64 * (-f64::from(j) / 8.0).exp2()) as u64).collect();
    let (mut source, mut history) = (Source(seed << 40), Vec::new());
    let (mut moments, mut tail) = (Moments::default(), Tail::default());
    for i in 1..=n {
        let x = law(&mut source, i);
        moments.push(x);
        tail.push(x);
        if at.contains(&i) {
            history.push(moments);
        }
    }
    checks(&history, &tail, 2.0)
}

fn lights(checks: &[Check; 10]) -> [Light; 10] {
    std::array::from_fn(|i| checks[i].light)
}

#[test]
fn every_light_is_green_where_nothing_is_wrong() {
    let mut green = [0; 10];
    for seed in 0..200 {
        let lights = lights(&run(100_000, seed, |s, _| s.exponential()));
        (0..10).for_each(|i| green[i] += usize::from(lights[i] == Light::Green));
    }
    assert!(green.iter().all(|&count| count >= 194), "{green:?}");
}

/// How many of 100 samples show red in variance of the variance or tail.
fn red(law: fn(&mut Source) -> f64) -> usize {
    let sees = |seed: &u64| {
        let lights = lights(&run(100_000, *seed, |s, _| law(s)));
        [4, 5, 6, 9].iter().any(|&i| lights[i] == Light::Red)
    };
    (0..100).filter(sees).count()
}

#[test]
fn an_infinite_variance_is_seen() {
    let counts = [red(|s| s.furnace(0.2)), red(|s| s.uniform().powf(-1.0 / 1.5))];
    assert!(counts[0] >= 95 && counts[1] >= 90, "{counts:?}");
}

#[test]
fn a_drift_and_a_jump_are_seen() {
    let drift = run(100_000, 1, |s, i| s.exponential() + i as f64 * 1e-5);
    assert_eq!(drift[0].light, Light::Red, "{:?}", drift[0]);
    // the two extreme ones of 8! orders
    assert!((drift[0].value.unwrap() * 20160.0 - 1.0).abs() < 1e-9, "{:?}", drift[0]);
    let jump = run(100_000, 1, |s, i| if i == 70_000 { 1e4 } else { s.exponential() });
    let jump = lights(&jump);
    for check in [2, 3, 4, 5, 6, 7] {
        assert!(jump[check] > Light::Green, "{check}");
    }
}

#[test]
fn numbers_are_right() {
    let checks = run(100_000, 3, |s, _| s.exponential());
    let value = |i: usize| checks[i].value.unwrap();
    // R = 1/√n, VOV = (9 - 1)/n, without noise
    assert!((value(1) * 316.2 - 1.0).abs() < 0.02, "{}", value(1));
    assert!((value(4) * 1e5 / 8.0 - 1.0).abs() < 0.5, "{}", value(4));
    assert!(
        checks[7].text.starts_with("figure of merit 5.0")
            || checks[7].text.starts_with("figure of merit 4.9")
    );
    assert_eq!(checks[9].value, Some(10.0));
    let pareto = run(100_000, 3, |s, _| s.uniform().powf(-1.0 / 3.0));
    assert!((pareto[9].value.unwrap() - 4.0).abs() < 1.0, "{}", pareto[9].text);
}

#[test]
fn short_or_empty_or_broken_data_do_not_panic() {
    let empty = checks(&[], &Tail::default(), 1.0);
    assert!(empty.iter().all(|check| check.light == Light::Yellow && check.value.is_none()));
    assert_eq!(lights(&run(5, 1, |s, _| s.exponential())), [Light::Yellow; 10]);
    for constant in [0.0, 0.7] {
        assert_eq!(lights(&run(1000, 1, |_, _| constant)), [Light::Yellow; 10]);
    }
    let broken = run(1000, 1, |s, i| if i == 600 { f64::NAN } else { s.exponential() });
    assert_eq!(lights(&broken), [Light::Red; 10]);
    assert!(broken.iter().all(|check| check.text.contains("not finite")));
}
