//! What one question shows by itself, before its family is considered.

use super::question::{Engine, Question, Verdict};
use super::sides::{Side, Sides, why_no_t};

pub(super) use super::sides::POWER;

/// Rounding allowed, relative to the expected value, where theory says that
/// there is no noise.
const ROUNDING: f64 = 1e-12;

/// Tests and rules applied to one question.
pub(super) struct Evidence {
    pub(super) p_different: f64,
    pub(super) p_outside: f64,
    pub(super) ci: (f64, f64),
    pub(super) mde: f64,
    pub(super) e_value: Option<f64>,
    pub(super) engine: Engine,
    /// Standard errors by which the margin must exceed zero for equivalence to be shown nine times in ten.
    pub(super) reach: f64,
    /// Verdict of a rule that is no test.
    pub(super) settled: Option<(Verdict, String)>,
}

/// Applies the rules for missing noise, or else the tests at `level`.
pub(super) fn weigh(q: &Question, level: f64) -> Evidence {
    let rounding = ROUNDING * q.expected.abs().max(f64::MIN_POSITIVE);
    // what may be off by a systematic error, as by single precision, may vary within it
    let is_still = q.std_error <= rounding.max(q.systematic);
    let sides = Sides::of(q);
    if q.noise_free && is_still && q.expected_std_error == 0.0 {
        return compare_exactly(q, rounding);
    }
    if let Some(why) = why_no_t(q).filter(|_| sides.are_blind()) {
        return nothing(&why);
    }
    let mut evidence = test(q, &sides, level);
    if q.noise_free && !is_still {
        let se = q.std_error;
        let reason = format!("noise-free in theory, but it varies: standard error {se:.3e}");
        evidence.settled = Some((Verdict::Fail, reason));
    }
    evidence
}

/// No information: p-values of 1 are true of it and reject nothing.
fn nothing(reason: &str) -> Evidence {
    Evidence {
        p_different: 1.0,
        p_outside: 1.0,
        ci: (f64::NEG_INFINITY, f64::INFINITY),
        mde: f64::INFINITY,
        e_value: None,
        engine: Engine::Comparison,
        reach: f64::INFINITY,
        settled: Some((Verdict::Inconclusive, reason.to_string())),
    }
}

/// Theory and measurement without noise: a comparison instead of a test, the
/// p-values of which are 0 or 1.
fn compare_exactly(q: &Question, rounding: f64) -> Evidence {
    let difference = q.mean - q.expected;
    let different = difference.abs() > q.systematic + rounding;
    let inside = difference.abs() + q.systematic < q.margin;
    let rule = if different {
        (Verdict::Fail, format!("noise-free, but off by {difference:.3e}"))
    } else if inside || q.systematic == 0.0 {
        (Verdict::Pass, "noise-free, and equal to rounding or the reference's error".to_string())
    } else {
        (Verdict::Inconclusive, too_coarse(q))
    };
    Evidence {
        p_different: if different { 0.0 } else { 1.0 },
        p_outside: if inside { 0.0 } else { 1.0 },
        ci: (difference - q.systematic, difference + q.systematic),
        mde: q.systematic + rounding,
        settled: Some(rule),
        ..nothing("")
    }
}

/// Two one-sided tests for a difference, and two for equivalence.
fn test(q: &Question, sides: &Sides<'_>, level: f64) -> Evidence {
    let Sides { above, below } = sides;
    let (expected, systematic) = (q.expected, q.systematic);
    let se = q.std_error.hypot(q.expected_std_error);
    let brighter = above.p_above(expected + systematic);
    let darker = below.p_below(expected - systematic);
    // one side without evidence costs nothing
    let p_different =
        if sides.are_fit() { (2.0 * brighter.min(darker)).min(1.0) } else { brighter.min(darker) };
    let room = q.margin - systematic;
    let reaches_in = above.p_above(expected - room).max(below.p_below(expected + room));
    let half = if sides.are_fit() { level / 2.0 } else { level };
    let low = above.lower_limit(half) - expected - systematic;
    let high = below.upper_limit(half) - expected + systematic;
    let reach = |level: f64, power: f64| above.reach(level, power).max(below.reach(level, power));
    Evidence {
        p_different,
        p_outside: if room > 0.0 { reaches_in } else { 1.0 },
        ci: (low, high),
        mde: above
            .detectable(expected, se, half, POWER, true)
            .max(below.detectable(expected, se, half, POWER, false))
            + systematic,
        e_value: e_value(q, sides),
        engine: if sides.are_exact() { Engine::Exact } else { Engine::Asymptotic },
        // both one-sided tests must reject: each may miss half as often
        reach: reach(level, (1.0 + POWER) / 2.0),
        settled: None,
    }
}

/// The mean of both sides' e-values, or the only one: an e-value again, whatever their dependence.
fn e_value(q: &Question, sides: &Sides<'_>) -> Option<f64> {
    let Side::Exact(bets) = sides.above else { return None };
    let brighter = libm::exp(bets.log_above(q.expected + q.systematic));
    let darker = bets.log_below(q.expected - q.systematic).map(libm::exp);
    Some(darker.map_or(brighter, |darker| 0.5 * brighter + 0.5 * darker))
}

pub(super) fn too_coarse(q: &Question) -> String {
    let (systematic, margin) = (q.systematic, q.margin);
    format!(
        "the reference is too coarse for the margin: its systematic error may be \
         {systematic:.3e}, the margin is {margin:.3e}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const INF: f64 = f64::INFINITY;

    #[track_caller]
    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-11 * b.abs(), "{a} is not {b}");
    }

    #[track_caller]
    fn settled(q: &Question) -> (Verdict, String) {
        assert_eq!(q.defect(0.05), None);
        weigh(q, 0.01).settled.expect("a rule should have settled it")
    }

    #[test]
    fn numbers_are_those_of_scipy() {
        // se = hypot(.3, .4) = .5, distance 1, systematic .25, margin 3
        let q = Question {
            mean: 9.0,
            std_error: 0.3,
            expected_std_error: 0.4,
            expected_df: 7.0,
            systematic: 0.25,
            margin: 3.0,
            ..Question::example()
        };
        let e = weigh(&q, 0.01);
        close(e.p_different, 0.1545161776089954);
        close(e.p_outside, 0.0016273670145872247);
        close(e.ci.0, -2.724886902301587);
        close(e.ci.1, 0.7248869023015867);
        close(e.mde, 2.365662685073887);
    }

    #[test]
    fn without_two_blocks_nothing_is_known() {
        let one = Question { df: 0.0, std_error: f64::NAN, noise_free: true, ..Question::example() };
        let reference = Question { expected_std_error: 0.1, expected_df: 0.0, ..Question::example() };
        for q in [one, reference] {
            let (verdict, reason) = settled(&q);
            assert_eq!(verdict, Verdict::Inconclusive);
            assert!(reason.contains("fewer than two blocks"));
            let e = weigh(&q, 0.01);
            assert_eq!((e.p_different, e.p_outside, e.mde), (1.0, 1.0, INF));
        }
        // an exact reference has no blocks
        assert!(weigh(&Question { expected_df: 0.0, ..Question::example() }, 0.01).settled.is_none());
    }

    #[test]
    fn no_variation_is_not_certainty() {
        // the last is rounding, and neither bias nor a noisy reference helps
        for (mean, std_error, noise) in [(10.0, 0.0, 0.0), (17.0, 0.0, 0.1), (17.0, 3e-15, 0.0)] {
            let q = Question { mean, std_error, expected_std_error: noise, ..Question::example() };
            let (verdict, reason) = settled(&q);
            assert_eq!(verdict, Verdict::Inconclusive);
            assert!(reason.contains("no variation was seen, so there is no interval"));
        }
        let tiny = Question { std_error: 3e-14, ..Question::example() };
        assert!(weigh(&tiny, 0.01).settled.is_none());
    }

    #[test]
    fn noise_free_means_equal_and_without_variation() {
        let exact = Question { std_error: 0.0, noise_free: true, ..Question::example() };
        let verdict = |mean: f64, expected: f64, std_error: f64, systematic: f64| {
            let (verdict, _) = settled(&Question { mean, expected, std_error, systematic, ..exact.clone() });
            verdict
        };
        assert_eq!(verdict(10.0 + 9e-12, 10.0, 9e-12, 0.0), Verdict::Pass);
        assert_eq!(verdict(10.0 + 1.1e-11, 10.0, 0.0, 0.0), Verdict::Fail);
        assert_eq!(verdict(10.0, 10.0, 1.1e-11, 0.0), Verdict::Fail);
        assert_eq!(verdict(0.0, 0.0, 0.0, 0.0), Verdict::Pass);
        assert_eq!(verdict(1e-300, 0.0, 0.0, 0.0), Verdict::Fail);
        // margin 1e-3: within, possibly outside, and beyond the reference's error
        assert_eq!(verdict(10.0 + 3e-4, 10.0, 0.0, 4e-4), Verdict::Pass);
        assert_eq!(verdict(10.0 + 8e-4, 10.0, 0.0, 9e-4), Verdict::Inconclusive);
        assert_eq!(verdict(10.0 + 8e-4, 10.0, 0.0, 1e-4), Verdict::Fail);
        // a systematic error may vary
        assert_eq!(verdict(10.0, 10.0, 1e-5, 1e-5), Verdict::Pass);
        assert_eq!(verdict(10.0, 10.0, 2e-5, 1e-5), Verdict::Fail);
        let (_, reason) = settled(&Question { std_error: 0.25, ..exact.clone() });
        assert!(reason.contains("noise-free in theory, but it varies"));
        // against a noisy reference it is a test like any other
        let noisy = Question { expected_std_error: 0.1, expected_df: 9.0, ..exact };
        let e = weigh(&noisy, 0.01);
        assert!(e.settled.is_none() && e.engine == Engine::Asymptotic);
    }
}
