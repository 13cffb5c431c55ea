//! Where it is wrong, in full.

use crate::experiment::cell::TILES;
use crate::experiment::row::CHANNELS;
use crate::report::difference::{FULL, colour};
use crate::report::lookup::Lookup;
use crate::report::tilemap::{RATE, Tile, TileMap};
use crate::report::wrong::{self, Place};
use maud::{Markup, html};

/// Each cell that fails; nothing where none does.
pub fn section(lookup: &Lookup<'_>) -> Markup {
    let places = wrong::places(lookup);
    html! {
        @if !places.is_empty() {
            section {
                h2 { "Where is it wrong" }
                p {
                    "Only cells that fail are opened here, so what is found in them costs no error probability: it says "
                    "where to look, and decides nothing. The command below each runs that cell alone and gives it the same "
                    "samples, bit for bit; fewer questions then share the error probabilities, so that more may be decided."
                }
                @for place in &places { (one(lookup, place)) }
            }
        }
    }
}

fn one(lookup: &Lookup<'_>, place: &Place) -> Markup {
    html! {
        div.place {
            h3 { (lookup.plan.label(&lookup.plan.cells[place.cell])) }
            ul { @for sentence in &place.sentences { li { (sentence) } } }
            @if let Some(map) = &place.tiles { (tiles(map)) }
            pre.command { (place.replay) }
        }
    }
}

fn tiles(map: &TileMap) -> Markup {
    let source = if map.is_claimed {
        "the claim on tiles"
    } else {
        "normal distributions, as nothing is claimed of tiles"
    };
    html! {
        figure.tiles {
            div { @for (channel, name) in CHANNELS.iter().enumerate() {
                table {
                    caption { (name) }
                    tbody { @for row in map.tiles.chunks(TILES as usize) {
                        tr { @for tile in row { (square(tile[channel])) } }
                    } }
                }
            } }
            figcaption {
                (map.words()) " Numbers are deviations in standard errors, blue where too dark, orange where too bright, full "
                "colour from " (FULL) ". Framed: told to be wrong, at most " (100.0 * RATE) " % of them falsely, by the "
                "procedure of Benjamini and Hochberg (1995) with p-values of " (source) "; tiles are independent, and "
                "channels share their paths."
            }
        }
    }
}

/// White letters where a dark colour is full.
fn square(tile: Tile) -> Markup {
    let [r, g, b] = colour(tile.z / FULL);
    let ink = if tile.z / FULL < -0.6 { ";color:#fff" } else { "" };
    let number = if tile.z.abs() < 99.5 { format!("{:+.1}", tile.z) } else { format!("{:+.0}", tile.z) };
    html! {
        td class=[tile.is_wrong.then_some("wrong")] style={ "background:" (format!("#{r:02x}{g:02x}{b:02x}")) (ink) } { (number) }
    }
}
