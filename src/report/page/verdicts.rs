//! What the page concludes: what the error probability is spent on, and a line a cell.

use crate::report::budget::{self, Share};
use crate::report::lookup::Lookup;
use crate::report::summary::Line;
use crate::stats::{Engine, Verdict};
use maud::{Markup, html};

/// The error budget of the run, claim by claim, and what its words mean.
pub fn claims(lookup: &Lookup<'_>) -> Markup {
    let shares = budget::shares(lookup);
    html! {
        @if shares.is_empty() {
            p { "Nothing is claimed." }
        } @else {
            p {
                "Error budget: were all well, any false alarm in this run would have a probability of at most "
                b { (budget::plain(budget::total(lookup))) } ", the sum over the claims."
            }
            div.wide { table.budget {
                thead { tr {
                    th { "claim" } th.n { "margin" } th.n { "false alarm" } th.n { "questions" } th.n { "level of one" }
                    th.n { "decided exactly" } th.n { "asymptotically" } th.n { "by comparison" } th.n { "open" }
                } }
                tbody { @for share in &shares { (budget_row(share)) } }
            } }
        }
        details.words {
            summary { "What the words mean" }
        p {
            "PASS: shown to lie within the margin. FAIL: shown to differ. INCONCLUSIVE: neither, with these samples. "
            "INVALID: NaN, infinity, negative radiance, a sample beyond its bound, or a runaway walk. No verdict: nothing is claimed, or the test's "
            "conditions do not hold (its row, opened, says why). exact: decided by bets, whose error probability holds for "
            "any number of samples; asymptotic: by a t test, whose error probability is approached as samples grow; "
            "comparison: theory and measurement are without noise. needed: samples after which all was decided, where "
            "that was before the last. All questions of a claim share its error probability by "
            "Holm's method, which is a little sharper than the simultaneous intervals that are drawn. mde: the smallest bias "
            "of the mean that would have been found with a probability of 90 %, in the worst channel. truth: its source "
            "and its own error, standard error and bound added. One bias stands for three that read alike. efficiency: "
            "1 / (variance × rays) in (W m⁻² sr⁻¹)⁻², variances of the channels added, in an image those of its pixels."
        }
        }
    }
}

fn budget_row(share: &Share) -> Markup {
    html! {
        tr {
            td { (share.what) @if let Some(scope) = &share.scope { " (" (scope) ")" } }
            td.n { @match share.margin {
                Some(margin) => { (budget::plain(100.0 * margin)) " %" }
                None => "only refuted",
            } }
            td.n { (budget::plain(share.alpha)) }
            @if share.asked == 0 {
                td colspan="6" { "nothing could be asked (its row, opened, says why)" (invalid(share)) }
            } @else {
                td.n { (share.asked) (invalid(share)) } td.n { (format!("{:.1e}", share.level())) }
                @for decided in share.decided { td.n { (decided) } }
                td.n { (share.open()) }
            }
        }
    }
}

fn invalid(share: &Share) -> Markup {
    html! { @if share.invalid > 0 { " (and " (share.invalid) " invalid)" } }
}

/// How many cells have which verdict, the worst first. Mistakes are there to be caught, and stand apart.
pub fn counts(lookup: &Lookup<'_>, lines: &[(usize, Line)]) -> Markup {
    let kinds =
        [Some(Verdict::Invalid), Some(Verdict::Fail), Some(Verdict::Inconclusive), Some(Verdict::Pass), None];
    let (tried, sound): (Vec<_>, Vec<_>) = lines.iter().partition(|(cell, _)| lookup.is_faulty(*cell));
    let count = |kind: Option<Verdict>| sound.iter().filter(|(_, line)| line.verdict == kind).count();
    html! {
        p.counts {
            @for kind in kinds { @if count(kind) > 0 {
                span { (badge(kind)) " " (count(kind)) @if kind.is_none() { " without a verdict" } } " "
            } }
            "of " (sound.len()) " cells"
            @if !tried.is_empty() { ", beside " (tried.len()) " with a known mistake, which are to be caught" }
        }
    }
}

/// A line a cell, which the page's script sorts, filters and opens.
pub fn verdicts(lines: &[(usize, Line)]) -> Markup {
    html! {
        div.wide { table #cells {
            thead { tr {
                th { "scene" } th { "estimator" } th { "rule" } th { "verdict" } th.n { "bias [%] R G B" }
                th.n { "mde [%]" } th { "truth" } th.n { "rays" } th.n { "efficiency" } th.n { "samples" }
            } }
            tbody { @for (cell, line) in lines { tr data-cell=(cell) {
                td { (line.scene) } td { (line.estimator) } td { (line.rule) }
                td { (badge(line.verdict)) " " (by(&line.by)) @if !line.note.is_empty() { div.note { (line.note) } } }
                td.n { (line.bias) } td.n { (line.mde) } td.truth { (line.truth) } td.n { (line.rays) }
                td.n { (line.efficiency) } td.n { (line.samples) @if let Some(needed) = line.needed { div.few { (needed) " needed" } } }
            } } }
        } }
    }
}

/// What a verdict rests on; bare where that is the same for all.
fn by(by: &[(Engine, usize)]) -> Markup {
    html! {
        @for (engine, count) in by {
            span class={ "by " (engine) } { @if by.len() > 1 { (count) " " } (engine) } " "
        }
    }
}

/// A verdict as text with a colour.
pub fn badge(verdict: Option<Verdict>) -> Markup {
    let class = match verdict {
        Some(Verdict::Pass) => "pass",
        Some(Verdict::Fail | Verdict::Invalid) => "fail",
        Some(Verdict::Inconclusive) => "open",
        None => "none",
    };
    html! { span class={ "badge " (class) } { @if let Some(v) = verdict { (v) } @else { "–" } } }
}
