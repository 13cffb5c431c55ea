//! From measurements to verdicts: bets where samples allow them, t tests elsewhere, one error rate for the family.

use super::evidence::{Evidence, too_coarse, weigh};
use super::multiplicity::{bonferroni, holm};
pub use super::question::{Answer, Engine, Question, Verdict};
use super::sides::why_no_t;

/// Answers all questions of a run as one family, in their order.
///
/// With probability 1 - `alpha` at least, no true expected value is called
/// FAIL, and likewise no difference beyond its margin PASS, over the run.
/// FAIL: bets, or else the t test (Welch 1947), find a difference larger than
/// the reference's systematic error. PASS: two one-sided tests (Schuirmann
/// 1987) find it smaller than the margin. Both after Holm (1979); an e-value e
/// counts as the p-value 1/e, which makes it e-Holm's test (Vovk & Wang 2021).
/// Where both hold, PASS needs the simultaneous interval to lie inside the
/// margin, too.
///
/// Invalid questions do not count as members of the family. Nothing panics: an
/// `alpha` outside 0..1, a margin that is not positive, and numbers that are
/// not finite are INVALID, with the reason.
pub fn judge(questions: &[Question], alpha: f64) -> Vec<Answer> {
    let defects: Vec<Option<String>> = questions.iter().map(|q| q.defect(alpha)).collect();
    let valid: Vec<usize> = (0..questions.len()).filter(|&i| defects[i].is_none()).collect();
    let level = bonferroni(alpha, valid.len());
    let evidence: Vec<Evidence> = valid.iter().map(|&i| weigh(&questions[i], level)).collect();
    let p_different: Vec<f64> = evidence.iter().map(|e| e.p_different).collect();
    let p_outside: Vec<f64> = evidence.iter().map(|e| e.p_outside).collect();
    let different = holm(&p_different, alpha);
    let equivalent = holm(&p_outside, alpha);

    let mut answers: Vec<Answer> = defects.into_iter().map(invalid).collect();
    for (k, e) in evidence.into_iter().enumerate() {
        let q = &questions[valid[k]];
        let (verdict, reason) = match e.settled {
            Some(rule) => rule,
            None => conclude(q, &e, different[k], equivalent[k]),
        };
        let Evidence { p_different, p_outside, ci, mde, e_value, engine, .. } = e;
        answers[valid[k]] = Answer { verdict, reason, p_different, p_outside, ci, mde, e_value, engine };
    }
    answers
}

/// Answers one question by itself, at `level`: for a look before the last sample is in, with the level that it will have
/// at least when its family is judged.
pub fn decide(question: &Question, level: f64) -> Verdict {
    if question.defect(level).is_some() {
        return Verdict::Invalid;
    }
    let e = weigh(question, level);
    match &e.settled {
        Some((verdict, _)) => *verdict,
        None => conclude(question, &e, e.p_different <= level, e.p_outside <= level).0,
    }
}

/// The answer to a question with a defect, and a placeholder for all others.
fn invalid(defect: Option<String>) -> Answer {
    Answer {
        verdict: Verdict::Invalid,
        reason: defect.unwrap_or_default(),
        p_different: f64::NAN,
        p_outside: f64::NAN,
        ci: (f64::NAN, f64::NAN),
        mde: f64::NAN,
        e_value: None,
        engine: Engine::Comparison,
    }
}

/// Verdict and reason, given what Holm's test rejects.
fn conclude(q: &Question, e: &Evidence, different: bool, equivalent: bool) -> (Verdict, String) {
    let difference = q.mean - q.expected;
    let Evidence { p_different, p_outside, ci: (low, high), .. } = *e;
    let margin = q.margin;
    let inside = -margin < low && high < margin;
    if equivalent && (inside || !different) {
        let shown = format!("difference {difference:.3e} within ±{margin:.3e}, p = {p_outside:.1e}");
        let caveat = "; smaller than the margin, yet significantly different from zero, p =";
        let caveat = if different { format!("{caveat} {p_different:.1e}") } else { String::new() };
        return (Verdict::Pass, shown + &caveat);
    }
    if different {
        let shown = format!("difference {difference:.3e} is significant, p = {p_different:.1e}");
        return (Verdict::Fail, shown);
    }
    let reason = match why_no_t(q) {
        _ if q.systematic >= margin => too_coarse(q),
        Some(why) if e.reach == f64::INFINITY => why,
        _ => missing(q, e.reach),
    };
    (Verdict::Inconclusive, reason)
}

/// How many times more samples would show equivalence, were there no
/// difference, with 90 % power, where the margin must be `reach` standard errors.
fn missing(q: &Question, reach: f64) -> String {
    let enough = (q.margin - q.systematic) / reach;
    // measuring longer does not make the reference any better
    let left = enough.powi(2) - q.expected_std_error.powi(2);
    let factor = q.std_error.powi(2) / left;
    if left <= 0.0 {
        let factor = (q.std_error.hypot(q.expected_std_error) / enough).powi(2);
        format!(
            "the reference is too noisy for the margin: it and the measurement \
             would need {factor:.2} times the samples to show equivalence"
        )
    } else if factor > 1.0 {
        format!(
            "{factor:.2} times the samples would be needed to show equivalence, \
             were there no difference"
        )
    } else {
        "the samples would suffice were there no difference, but the difference \
         seen is too near to the margin"
            .to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn question(mean: f64, std_error: f64, margin: f64) -> Question {
        Question { mean, std_error, margin, ..Question::example() }
    }

    #[track_caller]
    fn expect(q: Question, verdict: Verdict, reason: &str) -> Answer {
        let answer = judge(&[q], 0.05).remove(0);
        assert_eq!(answer.verdict, verdict, "{answer:?}");
        assert!(answer.reason.contains(reason), "{answer:?}");
        answer
    }

    #[test]
    fn the_four_outcomes_of_two_tests() {
        expect(question(10.1, 0.25, 2.0), Verdict::Pass, "within ±2.000e0, p = ");
        expect(question(12.0, 0.25, 1.0), Verdict::Fail, "2.000e0 is significant");
        expect(question(10.4, 0.25, 0.5), Verdict::Inconclusive, "times the samples");
        let both = expect(question(11.0, 0.25, 2.0), Verdict::Pass, "yet significantly different");
        assert!(both.ci.0 > 0.0 && both.ci.1 < 2.0);
    }

    #[test]
    fn a_significant_difference_passes_by_its_interval_only() {
        // t_15: 2.131 two-sided, 1.753 one-sided; the interval ends at 11.53
        let both = |margin| question(11.0, 0.25, margin);
        expect(both(1.54), Verdict::Pass, "smaller than the margin");
        let answer = expect(both(1.52), Verdict::Fail, "significant");
        assert!(answer.p_outside < 0.05);
    }

    #[test]
    fn the_reference_limits_what_can_be_shown() {
        let coarse = Question { systematic: 0.5, ..question(10.0, 1e-3, 0.5) };
        let answer = expect(coarse.clone(), Verdict::Inconclusive, "too coarse for the margin");
        assert_eq!(answer.p_outside, 1.0);
        expect(Question { mean: 10.6, ..coarse.clone() }, Verdict::Fail, "significant");
        expect(Question { mean: 10.4, ..coarse }, Verdict::Inconclusive, "too coarse");
        let noisy = Question { expected_std_error: 0.2, expected_df: 9.0, ..question(10.0, 0.1, 0.1) };
        expect(noisy, Verdict::Inconclusive, "too noisy for the margin");
    }

    #[test]
    fn missing_samples() {
        // ((1.753050 + 1.644854) 0.25 / 0.05)²
        expect(question(10.0, 0.25, 0.05), Verdict::Inconclusive, "288.64 times");
        // the systematic error leaves 0.05 of the margin
        let less = Question { systematic: 0.05, ..question(10.0, 0.25, 0.1) };
        expect(less, Verdict::Inconclusive, "288.64 times");
        // 0.25² / ((0.2 / (1.752683 + 1.644854))² - 0.01²)
        let noisy = Question { expected_std_error: 1e-2, ..question(10.0, 0.25, 0.2) };
        expect(noisy, Verdict::Inconclusive, "18.57 times");
        expect(question(10.45, 0.25, 0.86), Verdict::Inconclusive, "too near to the margin");
    }

    #[test]
    fn invalid_questions_do_not_burden_the_others() {
        let q = question(10.6, 0.25, 1e-3);
        let invalid = Question { invalid: Some("3 samples are NaN".to_string()), ..q.clone() };
        let alone = judge(std::slice::from_ref(&q), 0.05);
        let among = judge(&[invalid.clone(), q.clone(), invalid], 0.05);
        assert_eq!(among[1], alone[0]);
        assert_eq!(alone[0].verdict, Verdict::Fail);
        assert_eq!((among[0].verdict, among[2].reason.as_str()), (Verdict::Invalid, "3 samples are NaN"));
        assert!(among[0].p_different.is_nan() && among[0].mde.is_nan());
        // any other does, even one that is settled by a rule: p = 0.03
        let silent = Question { std_error: 0.0, ..q.clone() };
        assert_eq!(judge(&[q, silent], 0.05)[0].verdict, Verdict::Inconclusive);
    }

    #[test]
    fn the_family_is_the_run() {
        // p = 0.0305, 0.0120, 0.0180: Holm finds all three but not the first alone
        let three = [10.597, 10.714, 10.664].map(|mean| question(mean, 0.25, 1e-3));
        assert!(judge(&three, 0.05).iter().all(|a| a.verdict == Verdict::Fail));
        let four = [10.597, 10.0, 10.0, 10.664].map(|mean| question(mean, 0.25, 1e-3));
        assert!(judge(&four, 0.05).iter().all(|a| a.verdict == Verdict::Inconclusive));
        assert!(judge(&[], 0.05).is_empty());
        assert_eq!(judge(&three, f64::NAN)[0].verdict, Verdict::Invalid);
    }
}
