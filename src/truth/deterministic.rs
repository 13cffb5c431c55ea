//! The flush Cornell box without chance: empty, all light by radiosity; with its two blocks, direct light by exact
//! visibility. Solving takes some seconds, so `references/cornell_flush.json` holds the result beside the key of all
//! that it depends on; where the key no longer fits, it is solved anew.

use super::choice::{Source, Value};
use super::direct::cornell_direct;
use super::enclosure::Counted;
use super::radiosity::{self, BOUNCES, Solution};
use crate::scene::cornell_flush::TILES;
use crate::scene::library::SceneKind;
use crate::scene::{Rgb, cornell_flush};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// Relative error to which direct light under blocks is refined.
const TOLERANCE: f64 = 1e-6;

/// What is kept of the solver's work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Solved {
    /// All that the rest depends on.
    pub key: String,
    /// Radiance of the tiles of the empty box.
    pub empty: Solution,
    /// Direct light on the tiles with blocks: visible form factor of the light, and its error.
    pub direct: Vec<(f64, f64)>,
}

impl Solved {
    /// Solves.
    pub fn new() -> Self {
        let direct = (0..TILES.len()).map(|tile| cornell_direct::direct(tile, TOLERANCE)).collect();
        Solved { key: key(), empty: radiosity::solve(), direct }
    }

    /// What comes with the program, if it still fits it.
    pub fn embedded() -> Option<Self> {
        let stored: Option<Solved> =
            serde_json::from_str(include_str!("../../references/cornell_flush.json")).ok();
        stored.filter(|stored| stored.key == key())
    }
}

impl Default for Solved {
    fn default() -> Self {
        Solved::new()
    }
}

fn key() -> String {
    let blocks = cornell_flush::BLOCKS;
    format!("{}; direct 2 to {TOLERANCE} under {blocks:?}", radiosity::key())
}

fn solved() -> &'static Solved {
    static SOLVED: OnceLock<Solved> = OnceLock::new();
    SOLVED.get_or_init(|| Solved::embedded().unwrap_or_default())
}

/// The right values of one tile.
#[derive(Clone, Copy, Debug)]
pub struct Deterministic {
    tile: usize,
    blocks: bool,
}

impl Deterministic {
    /// The solution of a scene, if there is one.
    pub fn of(scene: &SceneKind) -> Option<Self> {
        match *scene {
            SceneKind::CornellFlush { tile, blocks } => Some(Deterministic { tile, blocks }),
            _ => None,
        }
    }

    /// Radiance [W m^-2 sr^-1] and a bound on its error; with blocks, of direct light only.
    pub fn mean(&self, channel: usize, counted: Counted) -> Option<Value> {
        let value = |(value, bound)| Value { bound, ..Value::exact(value, Source::Deterministic) };
        if self.blocks {
            return match counted {
                Counted::Only(0) => Some(value((0.0, 0.0))),
                Counted::Only(1) => Some(value(self.direct(channel))),
                _ => None,
            };
        }
        let k = |k: u32| (k as usize <= BOUNCES).then_some(k as usize);
        let found = match counted {
            Counted::All => solved().empty.total(self.tile, channel),
            Counted::Only(bounce) => solved().empty.bounce(self.tile, channel, k(bounce)?),
            Counted::From(bounce) => solved().empty.from_bounce(self.tile, channel, k(bounce)?),
        };
        Some(value((found.value, found.error)))
    }

    /// The same of light scattered at most `clamp` times.
    pub fn clamped(&self, channel: usize, counted: Counted, clamp: u32) -> Option<Value> {
        let bounces = match counted {
            Counted::All => 0..=clamp,
            Counted::Only(k) => k..=k.min(clamp),
            Counted::From(k) => k..=clamp,
        };
        let none = Value::exact(0.0, Source::Deterministic);
        bounces.filter(|&k| k <= clamp).try_fold(none, |sum, k| {
            let bounce = self.mean(channel, Counted::Only(k))?;
            Some(Value { value: sum.value + bounce.value, bound: sum.bound + bounce.bound, ..sum })
        })
    }

    fn direct(&self, channel: usize) -> (f64, f64) {
        let albedo = albedo(self.tile)[channel];
        let (visible, error) = solved().direct[self.tile];
        (albedo * visible, albedo * error)
    }
}

/// Albedo of the wall that a tile lies on.
fn albedo(tile: usize) -> Rgb {
    match TILES[tile] {
        (0, at, ..) if at < 0.5 => cornell_flush::GREEN,
        (0, ..) => cornell_flush::RED,
        _ => cornell_flush::WHITE,
    }
}
