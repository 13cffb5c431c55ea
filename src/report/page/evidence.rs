//! Whether the numbers of a cell can be trusted: guard lights and MCNP's ten checks.

use crate::experiment::Cell;
use crate::experiment::row::CHANNELS;
use crate::report::number;
use crate::stats::Moments;
use crate::stats::tails::Light;
use crate::stats::tally::{self, Check};
use serde_json::{Value, json};

/// The channel whose checks are shown in full.
const SHOWN: usize = 1;

/// Guard of each channel as `[channel, light, why]`, the checks of one channel as `[light, name, what was found]`, and
/// the worst of all.
pub fn of(cell: &Cell) -> Value {
    let guard = |channel: usize| {
        let (light, why) = cell.tails[channel].guard();
        [CHANNELS[channel].to_owned(), light.to_string(), why]
    };
    let of_channel = |channel: usize| {
        let history: Vec<Moments> = cell.history.iter().map(|snapshot| snapshot.total[channel]).collect();
        tally::checks(&history, &cell.tails[channel], cell.cost.mean)
    };
    let all = [0, 1, 2].map(of_channel);
    let guards = [0, 1, 2].map(guard);
    let told = |check: &Check| [check.light.to_string(), check.name.to_string(), check.text.to_string()];
    json!({
        "guards": guards,
        "channel": CHANNELS[SHOWN],
        "checks": all[SHOWN].iter().map(told).collect::<Vec<_>>(),
        "worst": worst(&all),
    })
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
