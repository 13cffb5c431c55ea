//! Promise: the instruments that decide are wrong as seldom as they say, and find what they say they find, on samples
//! whose mean is known exactly. Fixed seeds: the counts are the same on every machine.
//!
//! Bets keep their level everywhere, by far as a rule. No t test does so exactly; how near it comes, and where it does
//! not, is told in `stats::calibrate`.

use furnace::stats::Engine;
use furnace::stats::nulls::{Count, Instrument, Law, Rates, Setting, measure, measure_at, predicted};
use std::sync::atomic::AtomicBool;

const LEVELS: [f64; 2] = [0.05, 1e-3];

const RARE: Law = Law::Rare { p: 0.01 };
const LOGNORMAL: Law = Law::Lognormal { sigma: 1.0 };
const BOUNDED: Law = Law::Walk { albedo: 0.8, q: 0.9 };
const GEOMETRIC: Law = Law::Walk { albedo: 0.5, q: 0.5 };
/// Tail index 1.76.
const INFINITE: Law = Law::Walk { albedo: 0.5, q: 0.2 };

/// What is measured of a law without bias, at each of [`LEVELS`].
fn rates(law: Law, samples: u64, runs: u64) -> Vec<Rates> {
    let setting = Setting { law, samples, runs, bias: 0.0, seed: 1 };
    measure_at(&setting, &LEVELS, &AtomicBool::new(false)).unwrap()
}

fn low(count: Count) -> f64 {
    count.interval().0
}

fn high(count: Count) -> f64 {
    count.interval().1
}

#[test]
fn bets_keep_their_level() {
    for law in [Law::Rare { p: 1e-3 }, RARE, LOGNORMAL, GEOMETRIC, INFINITE, BOUNDED] {
        for rates in rates(law, 1024, 20_000) {
            for instrument in Instrument::ALL.into_iter().filter(|i| i.is_exact()) {
                let count = rates.count(instrument);
                let exists = instrument != Instrument::BetsBelow || law.bound().is_some();
                assert_eq!(count.of, if exists { 20_000 } else { 0 }, "{law}");
                // not just compatible with the level: shown to lie below it
                let shown = !exists || high(count) <= rates.level;
                assert!(shown, "{law} at {}: {} {count:?}", rates.level, instrument.name());
            }
        }
    }
}

/// That no excess of a tenth is shown. So many runs would show one of a third at 5 %, at 0.1 % only one of three times.
#[test]
fn the_t_that_may_decide_is_near_its_level() {
    use Instrument::*;
    for law in [Law::Rare { p: 0.05 }, LOGNORMAL, GEOMETRIC, BOUNDED] {
        for rates in rates(law, 2048, 6000) {
            for instrument in [KnownBelow, KnownAbove, GuardedBelow, GuardedAbove] {
                let (count, level) = (rates.count(instrument), rates.level);
                assert!(low(count) <= 1.1 * level, "{law} at {level}: {} {count:?}", instrument.name());
            }
        }
    }
}

#[test]
fn what_decides_nothing_shows_why() {
    use Instrument::*;
    let [five, thousandth] = &rates(INFINITE, 2048, 20_000)[..] else { panic!("two levels") };
    assert!(low(five.count(StudentBelow)) > 0.15 && high(five.count(StudentAbove)) < 0.01);
    assert!(low(five.count(CorrectedBelow)) > 0.1);
    assert!(low(five.count(Peeks)) > 0.5 && low(thousandth.count(Peeks)) > 0.25);
    // the guard warns of most samples, but those of which it does not are those that are wrong
    assert!(low(five.count(Red)) > 0.78 && low(five.count(GuardedBelow)) > 0.4);
    let all = |rates: &Rates| Count { of: rates.runs, ..rates.count(GuardedBelow) };
    assert!(low(all(five)) <= 0.05, "{:?}", all(five));
    // more than was promised, even so
    assert!(low(all(thousandth)) > 1e-3 && high(all(thousandth)) <= 4e-3, "{:?}", all(thousandth));
    // theory knows better, and lets no t test decide
    assert_eq!(five.count(KnownBelow).of, 0);
    let skewed = &rates(RARE, 2048, 4000)[0];
    assert!(low(skewed.count(StudentBelow)) > 0.075 && high(skewed.count(StudentAbove)) < 0.04);
    let tame = &rates(BOUNDED, 2048, 1000)[0];
    assert!(low(tame.count(Peeks)) > 0.25);
}

/// What is found of a law with shares of the bias that should be found in 90 % of the runs: a half, all, and more.
fn curve(law: Law, samples: u64, runs: u64, instrument: Instrument) -> [Count; 3] {
    let level = 1e-3;
    let (below, above) = predicted(&law, samples, Engine::Exact, level).unwrap();
    let unit = if instrument == Instrument::BetsBelow { below } else { above };
    [0.5, 1.0, 1.25].map(|share| measure(&law, samples, runs, level, share * unit, 2).count(instrument))
}

/// At the predicted bias nine of ten runs find it, and few at half of it. Rare events seen from below are the exception:
/// with 80 of them expected it is three of four, as the prediction knows no skewness.
#[test]
fn bets_find_what_is_predicted() {
    use Instrument::*;
    for (law, samples, runs, instrument, share) in [
        // few bets, which are as bold as can be; and many
        (BOUNDED, 2048, 1000, BetsAbove, 0.9),
        (BOUNDED, 2048, 1000, BetsBelow, 0.9),
        (BOUNDED, 32_768, 100, BetsAbove, 0.9),
        (LOGNORMAL, 2048, 1000, BetsAbove, 0.9),
        (GEOMETRIC, 2048, 1000, BetsAbove, 0.9),
        (RARE, 8192, 400, BetsAbove, 0.9),
        (RARE, 8192, 400, BetsBelow, 0.75),
        (RARE, 32_768, 200, BetsBelow, 0.9),
    ] {
        let curve = curve(law, samples, runs, instrument);
        assert!(curve[0].rejected <= curve[1].rejected && curve[1].rejected <= curve[2].rejected, "{law}");
        assert!(high(curve[1]) >= share && low(curve[2]) > share, "{law} {}: {curve:?}", instrument.name());
        // not because a smaller one would have been found as well
        assert!(high(curve[0]) < 0.9, "{law} {}: {curve:?}", instrument.name());
    }
}

/// A bias multiplies samples: by powers of two without any rounding, so that nothing changes for what knows no scale.
#[test]
fn biases_multiply_exactly() {
    for law in [LOGNORMAL, GEOMETRIC] {
        let sound = measure(&law, 500, 200, 0.01, 0.0, 3);
        for bias in [1.0, 3.0, -0.5] {
            let biased = measure(&law, 500, 200, 0.01, bias, 3);
            for instrument in [Instrument::Red, Instrument::GuardedBelow, Instrument::GuardedAbove] {
                let of = |rates: &Rates| match instrument {
                    Instrument::Red => rates.count(instrument).rejected,
                    _ => rates.count(instrument).of,
                };
                assert_eq!(of(&biased), of(&sound), "{law} {bias}");
            }
            let side = if bias > 0.0 { Instrument::StudentAbove } else { Instrument::StudentBelow };
            assert!(biased.count(side).rejected > 150, "{law} {bias}: {:?}", biased.count(side));
        }
    }
}
