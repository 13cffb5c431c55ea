//! The verdicts of a run as tables for LaTeX, which need no package but booktabs.

mod escape;

use super::budget;
use super::lookup::Lookup;
use super::number;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Row};
use escape::text;
use std::fmt::Write;

/// Rows of a table that fit on a page beside its caption.
const MOST: usize = 45;

/// Neighbouring cells of one scene.
struct Block<'a> {
    scene: &'a str,
    /// The scene has begun in an earlier block.
    continued: bool,
    cells: &'a [usize],
}

/// A row a cell, under the name of its scene; a new table where a page is full.
pub fn tables(lookup: &Lookup<'_>) -> String {
    let plan = lookup.plan;
    let scenes: Vec<(&str, Vec<usize>)> = lookup.scenes().iter().map(|s| (*s, lookup.of_scene(s))).collect();
    let blocks = scenes.iter().flat_map(|(scene, cells)| {
        let parts = cells.chunks(MOST).enumerate();
        parts.map(|(part, cells)| Block { scene, continued: part > 0, cells })
    });
    let mut pages: Vec<Vec<Block<'_>>> = Vec::new();
    for block in blocks {
        let rows = |page: &Vec<Block<'_>>| page.iter().map(|block| block.cells.len() + 2).sum::<usize>();
        match pages.last_mut().filter(|page| rows(page) + block.cells.len() <= MOST) {
            Some(page) => page.push(block),
            None => pages.push(vec![block]),
        }
    }
    let mut out = format!(
        "% The verdicts of {}, seed {}, by furnace {}. Needs \\usepackage{{booktabs}}, and\n% as much room as two columns have, 160 mm or so.\n",
        text(&plan.name),
        plan.spec.seed,
        env!("CARGO_PKG_VERSION")
    );
    for (page, blocks) in pages.iter().enumerate() {
        table(&mut out, lookup, blocks, (page, pages.len()));
    }
    out
}

fn table(out: &mut String, lookup: &Lookup<'_>, blocks: &[Block<'_>], (page, pages): (usize, usize)) {
    let caption = if page == 0 { caption(lookup) } else { format!("Continued ({} of {pages}).", page + 1) };
    let name = super::plots::file_name(&[&lookup.plan.name]);
    let label = if pages == 1 { name } else { format!("{name}-{}", page + 1) };
    let _ = write!(
        out,
        "\\begin{{table*}}\n  \\centering\n  \\caption{{{caption}}}\n  \\label{{tab:{label}}}\n  \\smallskip\n  \\scriptsize\n  \
         \\begin{{tabular}}{{@{{}}llrlrlrr@{{}}}}\n    \\toprule\n    estimator & rule & samples & bias [\\%] & mde [\\%] & \
         verdict & rays & efficiency \\\\\n"
    );
    for block in blocks {
        let scene = text(block.scene);
        let continued = if block.continued { " (continued)" } else { "" };
        let _ = writeln!(
            out,
            "    \\midrule\n    \\multicolumn{{8}}{{@{{}}l}}{{\\emph{{{scene}}}{continued}}} \\\\"
        );
        for &cell in block.cells {
            let _ = writeln!(out, "    {} \\\\", row(lookup, cell).join(" & "));
        }
    }
    out.push_str("    \\bottomrule\n  \\end{tabular}\n\\end{table*}\n");
}

/// Question, what the columns are, and the error budget.
fn caption(lookup: &Lookup<'_>) -> String {
    let plan = lookup.plan;
    let mut caption = format!(
        "{} Bias of the mean relative to the truth, in the channel where its simultaneous interval (in brackets) reaches \
         farthest; mde: the smallest bias that would have been found with a probability of 90\\,\\%; rays a sample; \
         efficiency: $1/(\\mathrm{{variance}}\\times\\mathrm{{rays}})$, channels added.",
        text(&plan.spec.question)
    );
    if plan.spec.claim.is_empty() {
        caption.push_str(" Nothing is claimed.");
    } else {
        let total = budget::plain(budget::total(lookup));
        let _ = write!(
            caption,
            " Error budget: any false alarm in this run has a probability of at most {}.",
            numeral(&total)
        );
    }
    if (0..plan.cells.len()).any(|cell| as_predicted(lookup, cell)) {
        caption.push_str(" $^\\ast$: judged against the bias that theory predicts.");
    }
    caption
}

/// Whether a cell is right in being wrong.
fn as_predicted(lookup: &Lookup<'_>, cell: usize) -> bool {
    lookup.verdict(cell).is_some() && !lookup.finds_all(cell)
}

fn row(lookup: &Lookup<'_>, cell: usize) -> [String; 8] {
    let plan = &lookup.plan.cells[cell];
    let none = || "--".to_owned();
    let means: Vec<&Row> = (0..3).filter_map(|c| lookup.row(cell, Estimand::Mean, Some(c))).collect();
    let mde = means.iter().filter_map(|r| Some(100.0 * r.mde? / r.truth?.abs())).reduce(f64::max);
    let cost = lookup.row(cell, Estimand::Cost, None);
    let estimand = if lookup.is_image(cell) { Estimand::PixelVariance } else { Estimand::Mean };
    let efficiency = lookup.efficiency(cell, estimand).filter(|_| !lookup.is_noise_free(cell));
    let mark = if as_predicted(lookup, cell) { "$^\\ast$" } else { "" };
    [
        text(&plan.estimator_label),
        text(&lookup.plan.rule_label(plan)),
        grouped(means.first().map_or(plan.samples, |row| row.samples)),
        bias(&means).unwrap_or_else(none),
        mde.map_or_else(none, |mde| numeral(&format!("{mde:.3}"))),
        lookup.verdict(cell).map_or_else(none, |verdict| format!("{verdict}{mark}")),
        cost.map_or_else(none, |row| numeral(&format!("{:.2}", row.mean / plan.pixels as f64))),
        efficiency.map_or_else(none, |(value, _)| numeral(&number::short(value))),
    ]
}

/// "+0.012 [-0.034, 0.058] R" of the worst channel, without its letter where all read alike.
fn bias(means: &[&Row]) -> Option<String> {
    let of_row = |row: &&Row| {
        let percent = |value: f64| 100.0 * value / row.truth.unwrap_or(1.0);
        let bias = percent(row.bias.filter(|_| row.truth.is_some_and(|truth| truth != 0.0))?);
        let ci = row.ci.map(|(low, high)| (percent(low), percent(high)));
        let reach = ci.map_or(bias.abs(), |(low, high)| low.abs().max(high.abs()));
        let read = match ci {
            Some((low, high)) => format!("${}\\ [{},\\ {}]$", signed(bias), signed(low), signed(high)),
            None => format!("${}$", signed(bias)),
        };
        Some((reach, read, row.channel?))
    };
    let channels: Vec<(f64, String, usize)> = means.iter().filter_map(of_row).collect();
    let alike = channels.iter().all(|channel| channel.1 == channels[0].1);
    // of equals the first
    let (_, read, channel) = channels.into_iter().rev().max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(if alike { read } else { format!("{read} {}", CHANNELS[channel]) })
}

/// Percent with a sign, for mathematics; no sign for what rounds to nothing.
fn signed(percent: f64) -> String {
    let read = format!("{percent:+.3}");
    if read == "-0.000" || read == "+0.000" { "0.000".to_owned() } else { read }
}

/// A numeral such as "1.23e-7" in mathematics.
fn numeral(read: &str) -> String {
    match read.split_once('e') {
        Some(("1", power)) => format!("$10^{{{power}}}$"),
        Some((digits, power)) => format!("${digits}\\times10^{{{power}}}$"),
        None => format!("${read}$"),
    }
}

/// Digits in threes.
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push_str("\\,");
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numerals_are_mathematics() {
        assert_eq!(["1.23e-7", "1e-3", "0.02"].map(numeral), ["$1.23\\times10^{-7}$", "$10^{-3}$", "$0.02$"]);
        assert_eq!([0, 999, 1000, 4_194_304].map(grouped), ["0", "999", "1\\,000", "4\\,194\\,304"]);
        assert_eq!([0.0, -0.0002, -1.5, 2.0].map(signed), ["0.000", "0.000", "-1.500", "+2.000"]);
    }
}
