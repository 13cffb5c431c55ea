//! Which of two cores samples a cell: the textbook, one path at a time in double precision, or the fast path.

use super::block::{Block, OpenBlock};
use super::error::Error;
use super::ledger::Stream;
use super::plan::CellPlan;
use super::run::block_of;
use crate::estimator::{Estimator, Tally, pulse};
use crate::fast::{self, Fast, PathTracer};
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// What follows the paths of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Core {
    /// The estimator itself, in double precision.
    #[default]
    Textbook,
    /// Sixteen paths side by side in single precision, where that is offered; the estimator itself elsewhere.
    Fast,
}

impl Core {
    /// Both of them.
    pub const ALL: [Core; 2] = [Core::Textbook, Core::Fast];

    /// What files and the command line call it.
    pub fn name(self) -> &'static str {
        match self {
            Core::Textbook => "textbook",
            Core::Fast => "fast",
        }
    }

    /// This core where the scene offers it to the estimator, the textbook elsewhere.
    pub fn if_offered(self, scene: &Scene, estimator: &Estimator) -> Self {
        if Fast::of(scene, estimator).is_ok() { self } else { Core::Textbook }
    }

    /// Bound on the relative error that rounding leaves in a mean, beyond that of double precision, which verdicts neglect:
    /// `cargo bench --bench rounding` measures less in every scene.
    pub fn rounding(self) -> f64 {
        match self {
            Core::Textbook => 0.0,
            Core::Fast => 1e-5,
        }
    }

    /// Its name, and of the fast one the instruction set that it finds here.
    pub fn on_this_machine(self) -> String {
        match self {
            Core::Textbook => self.to_string(),
            Core::Fast => format!("{self} {}", fast::instruction_set()),
        }
    }
}

impl fmt::Display for Core {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Core {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let named = Core::ALL.into_iter().find(|core| core.name() == name);
        named.ok_or_else(|| Error::Refused(format!("no core `{name}`; there are textbook and fast")))
    }
}

/// What samples the blocks of a cell.
pub(super) struct Sampler<'a> {
    plan: &'a CellPlan,
    scene: &'a Scene,
    fast: Option<Fast<'a>>,
}

impl<'a> Sampler<'a> {
    /// The core that the plan names.
    pub fn new(plan: &'a CellPlan, scene: &'a Scene) -> Self {
        let fast = match plan.core {
            Core::Fast => Some(Fast::of(scene, &plan.estimator).expect("planned only where it is offered")),
            Core::Textbook => None,
        };
        Sampler { plan, scene, fast }
    }

    /// One block of the cell.
    pub fn block(&self, number: u64) -> Block {
        let Sampler { plan, scene, .. } = *self;
        let realizations = number * plan.block..(number + 1) * plan.block;
        let draw = |number, pixel| plan.address.stream(number, pixel);
        match (plan.faulty(), &self.fast) {
            (None, None) => block_of(scene, &plan.estimator, &draw, &plan.streams, realizations),
            (None, Some(Fast::Paths(paths))) => {
                let draw = |number, pixel| plan.address.narrow_stream(number, pixel);
                fast_block_of(scene, paths, &draw, &plan.streams, realizations)
            }
            (None, Some(Fast::Particles(particles))) => {
                block_of(scene, particles, &draw, &plan.streams, realizations)
            }
            (Some(faulty), _) => {
                let draw = |number, pixel| draw(faulty.realization(number), pixel);
                block_of(scene, &faulty, &draw, &plan.streams, realizations)
            }
        }
    }
}

/// What [`block_of`] does, by the fast path; `draw` gives narrow streams.
pub fn fast_block_of(
    scene: &Scene,
    fast: &PathTracer<'_>,
    draw: &impl Fn(u64, u64) -> crate::sampling::Stream,
    streams: &[Stream],
    realizations: Range<u64>,
) -> Block {
    let (width, height) = scene.sensor.resolution();
    let pixels = width * height;
    let mut block = OpenBlock::new(width, height, streams);
    let mut to_start = realizations.flat_map(|r| (0..pixels).map(move |pixel| (r, pixel)));
    let mut next = || {
        pulse::beat();
        let (realization, pixel) = to_start.next()?;
        let mut stream = draw(realization, u64::from(pixel));
        let start = scene.start((pixel % width, pixel / width), &mut stream);
        Some((start, stream))
    };
    let (mut pixel, mut rays_before) = (0, 0);
    let mut tally = Tally::default();
    fast.trace(&mut tally, &mut next, &mut |tally| {
        block.pixel(pixel as usize, tally.value);
        pixel += 1;
        if pixel == pixels {
            block.realization(tally.rays - rays_before, tally);
            (pixel, rays_before) = (0, tally.rays);
        }
    });
    block.close(tally)
}
