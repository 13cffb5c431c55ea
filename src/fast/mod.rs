//! The fast path: sixteen paths side by side in single precision, refilled as they end.
//!
//! The estimators of `estimator` stay the reference. This is the same walk with the same decisions, made for sixteen paths
//! by each instruction; from the same narrow streams it does what they do, path by path, to the rounding of single
//! precision (`tests/fast_paths_agree.rs`). It is offered where all of a scene is known to it, see [`Fast::of`].
//!
//! Vectors come from the crate `fearless_simd`, which picks AVX-512, AVX2, SSE or NEON by the processor; all of them give
//! the same bits, for no operation is used that IEEE 754 leaves open, and none is fused.

mod light;
mod outcome;
mod particles;
mod paths;
mod plates;
mod rays;
mod rectangles;
mod spheres;
mod stage;
mod steps;
mod stream;
mod vector;
mod walk;
mod warp;

use crate::estimator::{Estimator, Explicit, Tally, Technique};
use crate::sampling::Stream;
use crate::scene::{LightSampling, Scene, Start};
pub use fearless_simd::Level;
use fearless_simd::{Simd, dispatch, prelude::*};
use outcome::Outcomes;
pub use particles::Particles;
use paths::Paths;
use stage::Stage;
use vector::lanes;
use walk::Walk;

/// The instruction set of this machine that the fast path uses.
pub fn instruction_set() -> String {
    // `Avx2(Avx2 { .. })`
    let level = format!("{:?}", Level::new());
    level.split('(').next().unwrap_or_default().to_lowercase()
}

/// What an estimator does sixteen times at once.
pub enum Fast<'a> {
    /// Its paths.
    Paths(PathTracer<'a>),
    /// Its particles; paths from the eye, and photons that are gathered there, are the estimator's.
    Particles(Particles<'a>),
}

impl<'a> Fast<'a> {
    /// The fast path for an estimator in a scene; why there is none, where there is none.
    pub fn of(scene: &'a Scene, estimator: &Estimator) -> Result<Self, &'static str> {
        let (stage, level) = (Stage::of(scene)?, Level::new());
        let tracer = match *estimator {
            Estimator::Explicit(explicit) => explicit,
            Estimator::Implicit(e) => Explicit {
                technique: Technique::Direction,
                lights: LightSampling::AREA,
                directions: e.directions,
                roulette: e.roulette,
            },
            Estimator::LightTracing(_) | Estimator::PhotonMap(_) => {
                let particles = Particles::of(stage, *estimator, level);
                return Ok(Fast::Particles(particles.expect("it sends particles")));
            }
            Estimator::Recursive(_) => return Err("the estimator has no fast path"),
        };
        Ok(Fast::Paths(PathTracer { walk: Walk::new(stage, tracer), level }))
    }
}

/// A path tracer that follows sixteen paths at once.
#[derive(Clone)]
pub struct PathTracer<'a> {
    walk: Walk<'a>,
    /// The instruction set.
    level: Level,
}

impl PathTracer<'_> {
    /// The same with another instruction set of this machine.
    pub fn on(&self, level: Level) -> Self {
        PathTracer { level, ..self.clone() }
    }

    /// Follows all paths that `next` sets out, each with its narrow stream, and adds them to a tally, which is shown to `told`
    /// after each path, in the order in which they set out.
    pub fn trace(
        &self,
        tally: &mut Tally,
        next: &mut impl FnMut() -> Option<(Start, Stream)>,
        told: &mut impl FnMut(&Tally),
    ) {
        dispatch!(self.level, simd => self.trace_with(simd, tally, next, told));
    }

    #[inline(always)]
    fn trace_with<S: Simd>(
        &self,
        simd: S,
        tally: &mut Tally,
        next: &mut impl FnMut() -> Option<(Start, Stream)>,
        told: &mut impl FnMut(&Tally),
    ) {
        let (mut paths, mut out) = (Paths::new(simd), Outcomes::new());
        loop {
            for lane in lanes(!paths.alive) {
                if !out.has_room() {
                    break;
                }
                let Some((start, stream)) = next() else { break };
                out.start(lane, &start);
                paths.start(lane, &start, &stream);
            }
            if paths.alive.all_false() {
                tally.runaway += paths.runaway;
                return;
            }
            let before = paths.alive;
            self.walk.vertex(&mut paths, &mut out);
            paths.end(before, &mut out);
            out.tell(tally, told);
        }
    }
}
