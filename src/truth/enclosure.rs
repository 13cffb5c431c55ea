//! Closed forms for enclosures in which every vertex sees the patches with the same probabilities: a sphere seen from
//! inside (a cosine-weighted direction lands uniformly on it), and any closed enclosure of a single material.
//!
//! A path is then an i.i.d. sequence of patches, and an estimator is the random recursion
//! X_k = A + (1/N) sum_N (1/q) sum_copies W X_{k+1}. Its moments to the fourth order follow
//! step by step from the last bounce to the first, or from the fixed point where the walk never ends.

use super::moments::{Central, fixed_sum, power, random_sum};
use crate::estimator::{Estimator, Roulette, Rule};
use crate::scene::library::Patch;
use crate::scene::{Directions, Rgb};

/// Patches, one of which is seen from everywhere with probability `fraction`.
#[derive(Clone, Debug)]
pub struct Enclosure {
    /// The patches; fractions sum to 1.
    pub patches: Vec<Patch>,
}

/// Which bounces count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// All.
    All,
    /// One.
    Only(u32),
    /// This one and all later ones.
    From(u32),
}

impl Counted {
    fn contains(self, bounce: u32) -> bool {
        match self {
            Counted::All => true,
            Counted::Only(b) => bounce == b,
            Counted::From(b) => bounce >= b,
        }
    }

    /// From here on, all bounces are treated alike.
    fn settled(self) -> u32 {
        match self {
            Counted::All => 0,
            Counted::Only(b) => b + 1,
            Counted::From(b) => b,
        }
    }
}

/// An estimator as the recursion sees it.
pub struct Walk<'a> {
    enclosure: &'a Enclosure,
    roulette: Roulette,
    /// N, samples at each vertex.
    branches: u32,
    directions: Directions,
    /// Whether direct light is sampled on the emitters.
    explicit: bool,
}

impl<'a> Walk<'a> {
    /// The recursion of `estimator`, or `None` where it has no closed form: random throughput that steers the roulette,
    /// or uniform directions among several patches (weight and landing place are then dependent).
    pub fn new(enclosure: &'a Enclosure, estimator: &Estimator) -> Option<Self> {
        let roulette = *estimator.roulette();
        let (branches, directions, explicit) = match estimator {
            Estimator::Implicit(e) => (1, e.directions, false),
            Estimator::Recursive(e) => (e.samples, e.directions, false),
            Estimator::Explicit(e) => (1, e.directions, true),
        };
        let walk = Walk { enclosure, roulette, branches, directions, explicit };
        let uniform = directions == Directions::Uniform;
        let throughput = matches!(roulette.rule, Rule::Throughput { .. });
        let random = (uniform && (throughput || !enclosure.is_single()))
            || (throughput && !walk.throughput_is_deterministic());
        (!random).then_some(walk)
    }

    /// Throughput is the same number on all paths, or its roulette amounts to q = albedo.
    fn throughput_is_deterministic(&self) -> bool {
        self.enclosure.has_one_albedo() || self.throughput_is_albedo()
    }

    /// One channel leads on every patch, so that after each survival its throughput is 1 again.
    fn throughput_is_albedo(&self) -> bool {
        let Rule::Throughput { floor } = self.roulette.rule else { return false };
        let leads = |c: usize| {
            self.enclosure.patches.iter().all(|p| {
                p.albedo[c] == p.albedo.max_element() && (p.albedo == Rgb::ZERO || p.albedo[c] >= floor)
            })
        };
        self.roulette.from == 0 && self.branches == 1 && (0..3).any(leads)
    }

    /// q after a vertex on `patch` at depth `bounce`.
    fn q(&self, bounce: u32, patch: &Patch) -> f64 {
        let beta = match self.roulette.rule {
            Rule::Throughput { .. } if !self.throughput_is_albedo() => self.beta(bounce, patch.albedo),
            _ => Rgb::ONE,
        };
        self.roulette.q(bounce, beta, patch.albedo)
    }

    /// Throughput on arrival at depth `bounce` where all patches share one albedo.
    fn beta(&self, bounce: u32, albedo: Rgb) -> Rgb {
        (0..bounce).fold(Rgb::ONE, |beta, k| {
            beta * albedo / (self.roulette.q(k, beta, albedo) * f64::from(self.branches))
        })
    }

    /// A depth from which on q depends on the patch only. Throughput below its floor grows by albedo / floor a bounce
    /// until it is 1 again, or shrinks for ever at q = floor.
    fn settled(&self) -> u32 {
        let first = self.roulette.from + 2;
        let q = |bounce| self.enclosure.patches.iter().map(move |p| self.q(bounce, p));
        (first..first + 10_000).find(|&k| q(k).eq(q(k + 1)) && q(k).eq(q(k + 2))).unwrap_or(first + 10_000)
    }

    /// Whether light scattered once more than at depth `bounce` is followed along a continued ray.
    fn continues(&self, bounce: u32) -> bool {
        self.roulette.reaches(bounce + 1 + u32::from(self.explicit))
    }

    /// Moments of what the vertex itself adds at depth `bounce`.
    fn own(&self, bounce: u32, patch: &Patch, channel: usize, counted: Counted) -> Central {
        let counts = |b: u32| counted.contains(b) && self.roulette.reaches(b);
        if !self.explicit {
            let le = if counts(bounce) { patch.emission[channel] } else { 0.0 };
            return Central::constant(le);
        }
        if !counts(bounce + 1) {
            return Central::constant(0.0);
        }
        self.enclosure.direct(channel).scaled(patch.albedo[channel])
    }

    /// Moments of the recursion at depth `bounce`, averaged over the patches or on one of them.
    fn step(&self, bounce: u32, next: &Central, channel: usize, counted: Counted) -> Vec<Central> {
        let on_patch = |patch: &Patch| {
            let own = self.own(bounce, patch, channel, counted);
            let q = self.q(bounce, patch);
            let rho = patch.albedo[channel];
            if !self.continues(bounce) || q == 0.0 || rho == 0.0 {
                return own;
            }
            let weighted = next.times(&weight(self.directions)).scaled(rho);
            let branch = random_sum(q, &weighted).scaled(1.0 / q);
            own.plus(&fixed_sum(self.branches, &branch).scaled(1.0 / f64::from(self.branches)))
        };
        self.enclosure.patches.iter().map(on_patch).collect()
    }

    /// The fixed point of the recursion, from depth `bounce` on.
    fn fixed_point(&self, bounce: u32, channel: usize, counted: Counted) -> Central {
        let mut moments = Central::constant(0.0);
        for order in 1..=4 {
            let probe = |value: f64| {
                let next = moments.with(order, value);
                self.enclosure.average(&self.step(bounce, &next, channel, counted)).get(order)
            };
            let intercept = probe(0.0);
            let slope = probe(1.0) - intercept;
            if slope >= 1.0 {
                return moments.finite_below(order);
            }
            moments = moments.with(order, intercept / (1.0 - slope));
        }
        moments
    }

    /// Moments of one sample of the radiance leaving each patch, in one channel.
    pub fn moments(&self, channel: usize, counted: Counted) -> Vec<Central> {
        let (mut next, start) = match self.roulette.clamp {
            Some(clamp) => (Central::constant(0.0), clamp + 1),
            None => {
                let settled = counted.settled().max(self.settled());
                (self.fixed_point(settled, channel, counted), settled)
            }
        };
        for bounce in (1..start).rev() {
            next = self.enclosure.average(&self.step(bounce, &next, channel, counted));
        }
        let seen_directly = |(m, patch): (Central, &Patch)| {
            let le = if self.explicit && counted.contains(0) { patch.emission[channel] } else { 0.0 };
            m.plus(&Central::constant(le))
        };
        let first = self.step(0, &next, channel, counted);
        first.into_iter().zip(&self.enclosure.patches).map(seen_directly).collect()
    }

    /// Expected rays for a camera ray that meets each patch, the camera ray included; `None` if infinite.
    pub fn rays(&self) -> Option<Vec<f64>> {
        let start = self.roulette.clamp.map_or_else(|| self.settled(), |clamp| clamp + 1);
        let step = |bounce: u32, next: f64| -> Vec<f64> {
            let shadow = f64::from(u32::from(self.explicit && self.roulette.reaches(bounce + 1)));
            let continued = |p: &Patch| {
                if self.continues(bounce) { f64::from(self.branches) * self.q(bounce, p) } else { 0.0 }
            };
            self.enclosure.patches.iter().map(|p| shadow + continued(p) * (1.0 + next)).collect()
        };
        let average = |values: &[f64]| {
            self.enclosure.patches.iter().zip(values).map(|(p, v)| p.fraction * v).sum::<f64>()
        };
        let mut next = 0.0;
        if self.roulette.clamp.is_none() {
            let intercept = average(&step(start, 0.0));
            let slope = average(&step(start, 1.0)) - intercept;
            if slope >= 1.0 {
                return None;
            }
            next = intercept / (1.0 - slope);
        }
        for bounce in (1..start).rev() {
            next = average(&step(bounce, next));
        }
        Some(step(0, next).into_iter().map(|rays| 1.0 + rays).collect())
    }

    /// The tail index alpha, P(X > x) ~ x^-alpha: the root of E W^alpha = 1 above 1 [Kesten 1973]. The variance is
    /// infinite where alpha <= 2. `None` where there is no such root: all moments are finite, or the walk is clamped.
    pub fn tail_index(&self, channel: usize) -> Option<f64> {
        if self.roulette.clamp.is_some() || self.branches > 1 {
            return None;
        }
        let settled = self.settled();
        let excess = |alpha: f64| {
            let weight = |p: &Patch| {
                let (q, rho) = (self.q(settled, p), p.albedo[channel]);
                if rho == 0.0 || q == 0.0 { 0.0 } else { q * libm::pow(rho / q, alpha) }
            };
            let c = match self.directions {
                Directions::Cosine => 1.0,
                Directions::Uniform => libm::exp2(alpha) / (alpha + 1.0),
            };
            c * self.enclosure.patches.iter().map(|p| p.fraction * weight(p)).sum::<f64>() - 1.0
        };
        let (mut low, mut high) = (1.0, 256.0);
        if excess(high) < 0.0 {
            return None;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }
}

/// The directional weight U: 1 for cosine sampling; for uniform sampling 2 cos θ, which is uniform on (0, 2).
fn weight(directions: Directions) -> Central {
    match directions {
        Directions::Cosine => Central::constant(1.0),
        Directions::Uniform => Central::new(1.0, [1.0 / 3.0, 0.0, 1.0 / 5.0]),
    }
}

impl Enclosure {
    fn has_one_albedo(&self) -> bool {
        self.patches.iter().all(|p| p.albedo == self.patches[0].albedo)
    }

    fn is_single(&self) -> bool {
        self.has_one_albedo() && self.patches.iter().all(|p| p.emission == self.patches[0].emission)
    }

    /// Average over the patches.
    pub fn average(&self, moments: &[Central]) -> Central {
        let weights = self.patches.iter().map(|p| p.fraction);
        Central::mixture(weights.zip(moments.iter().copied()))
    }

    /// Moments of direct light divided by albedo: patch l is picked with probability p_l in proportion to its
    /// power, and a point uniform over a sphere's patch then gives f_l Le_l / p_l without any variance.
    fn direct(&self, channel: usize) -> Central {
        let power = |p: &Patch| p.fraction * p.emission.element_sum();
        let total: f64 = self.patches.iter().map(power).sum();
        let lights = self.patches.iter().filter(|p| power(p) > 0.0);
        Central::mixture(lights.map(|p| {
            let pick = power(p) / total;
            (pick, Central::constant(p.fraction * p.emission[channel] / pick))
        }))
    }

    /// Radiance leaving a patch that was scattered so many times, without any simulation:
    /// Le_j, then rho_j rhobar^(k-1) E0 (rank-one radiosity).
    pub fn radiance(&self, patch: usize, channel: usize, counted: Counted) -> f64 {
        let average = |f: &dyn Fn(&Patch) -> f64| self.patches.iter().map(|p| p.fraction * f(p)).sum::<f64>();
        let e0 = average(&|p| p.emission[channel]);
        let rhobar = average(&|p| p.albedo[channel]);
        let (le, rho) = (self.patches[patch].emission[channel], self.patches[patch].albedo[channel]);
        match counted {
            Counted::All | Counted::From(0) => le + rho * e0 / (1.0 - rhobar),
            Counted::Only(0) => le,
            Counted::Only(k) => rho * power(rhobar, k - 1) * e0,
            Counted::From(k) => rho * power(rhobar, k - 1) * e0 / (1.0 - rhobar),
        }
    }
}
