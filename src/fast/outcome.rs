//! What paths come to, told in the order in which they set out.

use super::vector::WIDTH;
use crate::estimator::{BINS, Tally};
use crate::scene::{Rgb, Start};

/// Paths that may be under way, or wait for earlier ones to be told of.
const SLOTS: usize = 128;

/// What one path has come to.
#[derive(Clone, Copy, Debug, Default)]
struct Outcome {
    bounces: [Rgb; BINS],
    /// Number of bins that may not be zero.
    used: usize,
    rays: u64,
    response: f64,
    finished: bool,
}

/// The paths under way, in a ring.
pub struct Outcomes {
    ring: Vec<Outcome>,
    /// The number of the next path to be told of, and of the next one to set out.
    first: usize,
    next: usize,
    /// The slot of each lane.
    slot: [usize; WIDTH],
    /// What went wrong since that was last told.
    wrong: Tally,
}

impl Outcomes {
    /// Before the first path.
    pub fn new() -> Self {
        let ring = vec![Outcome::default(); SLOTS];
        Outcomes { ring, first: 0, next: 0, slot: [0; WIDTH], wrong: Tally::default() }
    }

    /// Whether another path may set out.
    #[inline(always)]
    pub fn has_room(&self) -> bool {
        self.next < self.first + SLOTS
    }

    /// A path sets out in a lane.
    #[inline(always)]
    pub fn start(&mut self, lane: usize, start: &Start) {
        self.slot[lane] = self.next % SLOTS;
        self.ring[self.slot[lane]].response = start.response;
        self.next += 1;
    }

    /// Adds radiance [W m^-2 sr^-1] of light that was scattered `bounce` times.
    #[inline(always)]
    pub fn add(&mut self, lane: usize, bounce: u32, radiance: Rgb) {
        let outcome = &mut self.ring[self.slot[lane]];
        let value = radiance * outcome.response;
        if !(value.min_element() >= 0.0 && value.is_finite()) {
            self.wrong.non_finite += u64::from(!value.is_finite());
            self.wrong.negative += u64::from(value.min_element() < 0.0);
        }
        let bin = (bounce as usize).min(BINS - 1);
        outcome.bounces[bin] += value;
        outcome.used = outcome.used.max(bin + 1);
    }

    /// The path of a lane has ended.
    #[inline(always)]
    pub fn finish(&mut self, lane: usize, rays: u32) {
        let outcome = &mut self.ring[self.slot[lane]];
        (outcome.rays, outcome.finished) = (u64::from(rays), true);
    }

    /// Tells of all paths that have ended and before which none is under way.
    #[inline(always)]
    pub fn tell(&mut self, tally: &mut Tally, told: &mut impl FnMut(&Tally)) {
        while self.first < self.next && self.ring[self.first % SLOTS].finished {
            let outcome = &mut self.ring[self.first % SLOTS];
            tally.value = Rgb::ZERO;
            for bin in 0..outcome.used {
                let added = std::mem::take(&mut outcome.bounces[bin]);
                tally.bounces[bin] += added;
                tally.value += added;
            }
            tally.rays += outcome.rays;
            (outcome.used, outcome.finished) = (0, false);
            self.first += 1;
            told(tally);
        }
        tally.non_finite += std::mem::take(&mut self.wrong.non_finite);
        tally.negative += std::mem::take(&mut self.wrong.negative);
    }
}
