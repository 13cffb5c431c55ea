//! Whether the numbers of a cell can be trusted: guard lights, MCNP's ten checks, and what bets have won.

use super::trajectory;
use crate::experiment::Cell;
use crate::experiment::row::CHANNELS;
use crate::report::lookup::Lookup;
use crate::report::number;
use crate::stats::Moments;
use crate::stats::tails::Light;
use crate::stats::tally::{self, Check};
use maud::{Markup, html};

/// The channel whose checks are shown in full.
const SHOWN: usize = 1;

/// Guard, checks and bets of one cell.
pub fn of(lookup: &Lookup<'_>, index: usize, cell: &Cell) -> Markup {
    let guards = [0, 1, 2].map(|channel| cell.tails[channel].guard());
    html! {
        ul.guard { @for (channel, (light, why)) in CHANNELS.iter().zip(&guards) {
            li { (lamp(*light)) " guard of " (channel) ": " (why) }
        } }
        (ten_checks(cell))
        (trajectory::figure(lookup, index, cell))
    }
}

/// A light as text with a colour.
fn lamp(light: Light) -> Markup {
    html! { span class={ "lamp " (light) } { (light) } }
}

/// One channel in full, and the worst of all.
fn ten_checks(cell: &Cell) -> Markup {
    let of_channel = |channel: usize| {
        let history: Vec<Moments> = cell.history.iter().map(|snapshot| snapshot.total[channel]).collect();
        tally::checks(&history, &cell.tails[channel], cell.cost.mean)
    };
    let all = [0, 1, 2].map(of_channel);
    html! {
        p.note {
            "MCNP's ten checks of " (CHANNELS[SHOWN]) ", diagnostics: they decide nothing. Worst of the three channels: "
            (worst(&all)) "."
        }
        ol.checks { @for check in &all[SHOWN] {
            li { (lamp(check.light)) " " (check.name) ": " (check.text) }
        } }
    }
}

/// "7 green, 2 yellow (4 in R, 8 in G), 1 red (7 in R)".
fn worst(all: &[[Check; 10]; 3]) -> String {
    let worst = |i: usize| {
        // of equals the first
        (0..3)
            .rev()
            .max_by_key(|&channel| all[channel][i].light)
            .map(|channel| (all[channel][i].light, channel))
    };
    let found: Vec<(usize, Light, usize)> =
        (0..10).filter_map(|i| worst(i).map(|(light, channel)| (i + 1, light, channel))).collect();
    let told = |light: Light| {
        let of_light: Vec<&(usize, Light, usize)> = found.iter().filter(|f| f.1 == light).collect();
        let places = of_light.iter().map(|(check, _, channel)| format!("{check} in {}", CHANNELS[*channel]));
        let places = number::list(&places.collect::<Vec<_>>(), "and");
        match (light, of_light.len()) {
            (_, 0) => None,
            (Light::Green, count) => Some(format!("{count} green")),
            (_, count) => Some(format!("{count} {light} ({places})")),
        }
    };
    let told: Vec<String> = [Light::Green, Light::Yellow, Light::Red].into_iter().filter_map(told).collect();
    told.join(", ")
}
