//! Where it is wrong: of each cell that fails, which bounce, channel, tile, technique or instrument, and how to run it
//! again. Only cells that fail are opened; what is found in them decides nothing, so it costs no error probability.

use super::lookup::Lookup;
use super::tilemap::{self, TileMap};
use super::{budget, number, replay, table, technique};
use crate::estimator::BINS;
use crate::experiment::row::CHANNELS;
use crate::experiment::{Estimand, Row, mistake};
use crate::stats::Verdict;
use std::fmt::Write;

/// The terminal shows no more cells than this.
const SHOWN: usize = 8;

/// A cell that fails, and where.
pub struct Place {
    /// Its index.
    pub cell: usize,
    /// A sentence each, the most telling first.
    pub sentences: Vec<String>,
    /// Its tiles, if it is an image with a truth.
    pub tiles: Option<TileMap>,
    /// The command that runs it again.
    pub replay: String,
}

/// Whether the rows of a cell say that something is wrong with it.
pub fn is_wrong(lookup: &Lookup<'_>, cell: usize) -> bool {
    mistake::is_caught(lookup.cell(cell))
}

/// All cells that fail.
pub fn places(lookup: &Lookup<'_>) -> Vec<Place> {
    (0..lookup.plan.cells.len()).filter(|&c| is_wrong(lookup, c)).map(|c| place(lookup, c)).collect()
}

fn place(lookup: &Lookup<'_>, cell: usize) -> Place {
    let sentences = [
        invalid(lookup, cell),
        bounce(lookup, cell),
        channels(lookup, cell),
        spread(lookup, cell),
        technique::sentence(lookup, cell),
    ];
    Place {
        cell,
        sentences: sentences.into_iter().flatten().collect(),
        tiles: tilemap::of(lookup, cell),
        replay: replay::command(lookup.plan, cell),
    }
}

/// Why there is no number to judge.
fn invalid(lookup: &Lookup<'_>, cell: usize) -> Option<String> {
    let row = lookup.cell(cell).iter().find(|row| row.verdict == Some(Verdict::Invalid))?;
    let channel = row.channel.map_or_else(String::new, |c| format!(" {}", CHANNELS[c]));
    let index =
        row.estimand.index().map_or_else(String::new, |i| format!(" {}", table::index(row.estimand, i)));
    Some(format!("Invalid ({}{index}{channel}, to begin with): {}.", row.estimand, row.note))
}

/// The first bounce that fails, or that none does although the whole fails.
fn bounce(lookup: &Lookup<'_>, cell: usize) -> Option<String> {
    type Kind = (fn(usize) -> Estimand, Estimand, &'static str);
    let kinds: [Kind; 2] = [
        (Estimand::Bounce, Estimand::Mean, ""),
        (Estimand::AgreeBounce, Estimand::Agree, " (against another cell)"),
    ];
    let of_kind = |(bounce, mean, against): &Kind| {
        let judged = |bin: usize| rows(lookup, cell, bounce(bin));
        let first = (0..BINS).find(|&bin| judged(bin).iter().any(|row| row.verdict == Some(Verdict::Fail)));
        if let Some(first) = first {
            let name = table::index(bounce(first), first);
            let failing = failing(&judged(first));
            let before = before(first, |bin| known(lookup, &judged(bin)));
            return Some(format!("First wrong bounce{against}: {name}, {}. {before}", deviations(&failing)));
        }
        let whole = failing(&rows(lookup, cell, *mean));
        let any = (0..BINS).any(|bin| judged(bin).iter().any(|row| row.verdict.is_some()));
        let none = if any { "No single bounce is shown to be wrong" } else { "No single bounce was judged" };
        (!whole.is_empty()).then(|| format!("{none}{against}; the whole is {}.", deviations(&whole)))
    };
    kinds.iter().find_map(of_kind)
}

fn rows<'a>(lookup: &Lookup<'a>, cell: usize, estimand: Estimand) -> Vec<&'a Row> {
    (0..3).filter_map(|c| lookup.row(cell, estimand, Some(c))).collect()
}

fn failing<'a>(rows: &[&'a Row]) -> Vec<&'a Row> {
    rows.iter().filter(|row| row.verdict == Some(Verdict::Fail)).copied().collect()
}

/// What is known of a bounce or a channel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    Wrong,
    Right,
    /// Within the margin, and yet significantly different by itself.
    Suspect,
    Undecided,
    Invalid,
    Nothing,
}

/// The worst of these rows.
fn known(lookup: &Lookup<'_>, rows: &[&Row]) -> Known {
    let level = |row: &Row| Some(budget::shares(lookup).get(row.claim?)?.level());
    let is_suspect = |row: &&Row| row.p_value.zip(level(row)).is_some_and(|(p, level)| p <= level);
    match rows.iter().filter_map(|row| row.verdict).max() {
        Some(Verdict::Pass) if rows.iter().any(is_suspect) => Known::Suspect,
        Some(Verdict::Pass) => Known::Right,
        Some(Verdict::Invalid) => Known::Invalid,
        Some(Verdict::Fail) => Known::Wrong,
        Some(Verdict::Inconclusive) => Known::Undecided,
        None => Known::Nothing,
    }
}

/// What is known of the bounces before the first wrong one.
fn before(first: usize, known: impl Fn(usize) -> Known) -> String {
    if first == 0 {
        return "There is none before it.".to_owned();
    }
    let told = |(of, what): (Known, &str)| {
        let bins: Vec<usize> = (0..first).filter(|&bin| known(bin) == of).collect();
        (!bins.is_empty()).then(|| format!("{} {what}", runs(&bins)))
    };
    let parts = [
        (Known::Right, "shown to be right within the margin"),
        (Known::Suspect, "within the margin, but significantly different"),
        (Known::Undecided, "undecided"),
        (Known::Invalid, "invalid"),
        (Known::Nothing, "not judged"),
    ];
    let parts: Vec<String> = parts.into_iter().filter_map(told).collect();
    format!("Before it: {}.", parts.join("; "))
}

/// "0 to 3 and 5".
fn runs(bins: &[usize]) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &bin in bins {
        match runs.last_mut() {
            Some(run) if run.1 + 1 == bin => run.1 = bin,
            _ => runs.push((bin, bin)),
        }
    }
    let told = |&(from, to): &(usize, usize)| match to - from {
        0 => from.to_string(),
        1 => format!("{from}, {to}"),
        _ => format!("{from} to {to}"),
    };
    number::list(&runs.iter().map(told).collect::<Vec<_>>(), "and")
}

/// "in R and G too bright; G by 0.0123, between 0.0110 and 0.0136".
fn deviations(failing: &[&Row]) -> String {
    let side = |bright: bool| {
        let of_side = failing.iter().filter(|row| (deviation(row) > 0.0) == bright);
        let names: Vec<String> = of_side.filter_map(|row| Some(CHANNELS[row.channel?].to_owned())).collect();
        let what = if bright { "too bright" } else { "too dark" };
        (!names.is_empty()).then(|| format!("{what} in {}", number::list(&names, "and")))
    };
    let sides: Vec<String> = [side(true), side(false)].into_iter().flatten().collect();
    let most = failing.iter().max_by(|a, b| deviation(a).abs().total_cmp(&deviation(b).abs()));
    let most = most.map_or_else(String::new, |row| {
        let shift = row.expected_bias.unwrap_or(0.0);
        let right = row.truth.map_or(f64::NAN, |truth| truth + shift);
        let channel = row.channel.map_or("", |c| CHANNELS[c]);
        let by = number::signed(deviation(row));
        let interval = row.ci.map_or_else(String::new, |(low, high)| {
            format!(", interval {} to {}", number::signed(low - shift), number::signed(high - shift))
        });
        format!("; {channel} by {by}{interval}, where {} is right", number::short(right))
    });
    format!("{}{most}", sides.join(", "))
}

/// Measured less what theory expects of this estimator.
fn deviation(row: &Row) -> f64 {
    row.bias.unwrap_or(0.0) - row.expected_bias.unwrap_or(0.0)
}

/// Which channels of the mean fail, and which do not.
fn channels(lookup: &Lookup<'_>, cell: usize) -> Option<String> {
    let mut means = rows(lookup, cell, Estimand::Mean);
    if means.iter().all(|row| row.verdict.is_none()) {
        means = rows(lookup, cell, Estimand::Agree);
    }
    let of = |wanted: Known, what: &str| {
        let names: Vec<String> = means
            .iter()
            .filter(|row| known(lookup, &[**row]) == wanted)
            .filter_map(|row| Some(CHANNELS[row.channel?].to_owned()))
            .collect();
        (!names.is_empty()).then(|| format!("{} {what}", number::list(&names, "and")))
    };
    let parts = [
        of(Known::Wrong, "wrong"),
        of(Known::Right, "right"),
        of(Known::Suspect, "within the margin, but significantly different"),
        of(Known::Undecided, "undecided"),
        of(Known::Invalid, "invalid"),
        of(Known::Nothing, "not judged"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    let judged = means.iter().any(|row| matches!(row.verdict, Some(Verdict::Fail | Verdict::Pass)));
    judged.then(|| format!("Channels of the mean: {}.", parts.join("; ")))
}

/// What fails that is no mean.
fn spread(lookup: &Lookup<'_>, cell: usize) -> Option<String> {
    let failing = lookup.cell(cell).iter().filter(|row| row.verdict == Some(Verdict::Fail));
    let told = |row: &&Row| {
        let channel = row.channel.map_or_else(String::new, |c| format!(" in {}", CHANNELS[c]));
        let off = || match row.truth.filter(|&truth| truth != 0.0) {
            Some(truth) => format!("{} % off theory's", number::signed(100.0 * deviation(row) / truth)),
            None => "not theory's".to_owned(),
        };
        match row.estimand {
            Estimand::Variance => Some(format!("the variance{channel} is {}", off())),
            Estimand::Cost => Some(format!("the number of rays is {}", off())),
            Estimand::Length => {
                Some("paths do not end with the probabilities that the rule promises".to_owned())
            }
            Estimand::Repeats => Some(format!("{} blocks repeat an earlier one, bit for bit", row.mean)),
            Estimand::Serial => {
                let r = number::signed(row.mean);
                Some(format!("each block depends on the one before{channel} (correlation {r})"))
            }
            _ => None,
        }
    };
    let told: Vec<String> = failing.filter_map(told).collect();
    (!told.is_empty()).then(|| format!("Beside the mean: {}.", told.join("; ")))
}

/// A few lines a failing cell; nothing where none fails.
pub fn text(lookup: &Lookup<'_>) -> String {
    let places = places(lookup);
    let mut text = String::new();
    if places.is_empty() {
        return text;
    }
    let _ = writeln!(text, "Where it is wrong (only cells that fail are opened):");
    for place in places.iter().take(SHOWN) {
        let _ = writeln!(text, "  {}", lookup.plan.label(&lookup.plan.cells[place.cell]));
        let tiles = place.tiles.iter().map(TileMap::words);
        for sentence in place.sentences.iter().cloned().chain(tiles) {
            let _ = writeln!(text, "    {sentence}");
        }
        let _ = writeln!(text, "    Again: {}", place.replay);
    }
    if places.len() > SHOWN {
        let _ = writeln!(text, "  and {} more on the page", places.len() - SHOWN);
    }
    text
}
