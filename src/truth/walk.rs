//! Closed forms for an estimator whose path is a finite Markov chain of patches.
//!
//! One sample of the radiance leaving patch i at depth k is X_i = A_i + (1/N) sum_N (1/q) sum_copies rho_i U X_J, with J
//! drawn from row i of the chain. The moments to the fourth order, one set for each patch, follow step by step from the
//! last bounce to the first, or from the fixed point where the walk never ends: there the moments of each order obey a
//! linear system whose right side the lower orders give.

use super::enclosure::{Counted, Enclosure, Wall, average};
use super::linear::{self, Matrix};
use super::moments::{Central, fixed_sum, random_sum};
use crate::estimator::{Estimator, Heuristic, Roulette, Rule, Technique};
use crate::scene::{Directions, Pick, Rgb};

/// An estimator as the recursion sees it.
pub struct Walk<'a> {
    enclosure: &'a Enclosure,
    roulette: Roulette,
    /// N, samples at each vertex.
    branches: u32,
    directions: Directions,
    technique: Technique,
    /// Probability of picking each patch as a light; zero for all of them where none is sampled.
    pmf: Vec<f64>,
}

impl<'a> Walk<'a> {
    /// The recursion of `estimator`, or `None` where it has no closed form: random throughput that steers the roulette,
    /// or uniform directions among several patches or with a weight that depends on the direction (weight and landing
    /// place are then dependent).
    pub fn new(enclosure: &'a Enclosure, estimator: &Estimator) -> Option<Self> {
        let roulette = *estimator.roulette();
        let (branches, directions, technique, pick) = match estimator {
            Estimator::Implicit(e) => (1, e.directions, Technique::Direction, Pick::Power),
            Estimator::Recursive(e) => (e.samples, e.directions, Technique::Direction, Pick::Power),
            Estimator::Explicit(e) => (1, e.directions, e.technique, e.lights.pick),
            Estimator::LightTracing(_) | Estimator::PhotonMap(_) => return None,
        };
        let pmf = pmf(enclosure, technique, pick);
        let walk = Walk { enclosure, roulette, branches, directions, technique, pmf };
        let uniform = directions == Directions::Uniform;
        let throughput = matches!(roulette.rule, Rule::Throughput { .. });
        let weighted = matches!(technique, Technique::Both(_));
        let random = (uniform && (throughput || weighted || !enclosure.is_furnace()))
            || (throughput && !walk.throughput_is_deterministic());
        (!random).then_some(walk)
    }

    pub(super) fn enclosure(&self) -> &Enclosure {
        self.enclosure
    }

    pub(super) fn branches(&self) -> u32 {
        self.branches
    }

    pub(super) fn samples_lights(&self) -> bool {
        self.technique != Technique::Direction
    }

    /// Throughput is the same number on all paths, or its roulette amounts to q = albedo.
    fn throughput_is_deterministic(&self) -> bool {
        self.enclosure.has_one_albedo() || self.throughput_is_albedo()
    }

    /// One channel leads on every patch, so that after each survival its throughput is 1 again.
    fn throughput_is_albedo(&self) -> bool {
        let Rule::Throughput { floor } = self.roulette.rule else { return false };
        let leads = |c: usize| {
            self.enclosure.patches().iter().all(|p| {
                p.albedo[c] == p.albedo.max_element() && (p.albedo == Rgb::ZERO || p.albedo[c] >= floor)
            })
        };
        self.roulette.from == 0 && self.branches == 1 && (0..3).any(leads)
    }

    /// q after a vertex on `patch` at depth `bounce`.
    fn q(&self, bounce: u32, patch: &Wall) -> f64 {
        let beta = match self.roulette.rule {
            Rule::Throughput { .. } if !self.throughput_is_albedo() => self.beta(bounce, patch.albedo),
            _ => Rgb::ONE,
        };
        self.roulette.q(bounce, beta, patch.albedo)
    }

    /// Expected number of rays continued after a vertex on `patch` at depth `bounce`.
    pub(super) fn children(&self, bounce: u32, patch: &Wall) -> f64 {
        if self.continues(bounce) { f64::from(self.branches) * self.q(bounce, patch) } else { 0.0 }
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
        let q = |bounce| self.enclosure.patches().iter().map(move |p| self.q(bounce, p));
        (first..first + 10_000).find(|&k| q(k).eq(q(k + 1)) && q(k).eq(q(k + 2))).unwrap_or(first + 10_000)
    }

    /// Whether a continued ray may still find light after depth `bounce`: where it hits an emitter, or else one bounce
    /// later where it samples one.
    fn continues(&self, bounce: u32) -> bool {
        self.roulette.reaches(bounce + 1 + u32::from(self.technique == Technique::Light))
    }

    /// Whether a vertex at depth `bounce` sends a shadow ray.
    pub(super) fn samples_light(&self, bounce: u32) -> bool {
        self.technique != Technique::Direction
            && self.enclosure.patches().iter().any(|p| p.le != Rgb::ZERO)
            && self.roulette.reaches(bounce + 1)
    }

    /// Weight of light that a continued ray finds on a patch. Per area, and on a sphere, continued rays have the density
    /// 1/A and sampled points pmf / (f A): the same everywhere on a patch [Veach 1997, sec. 9.2].
    fn hit_weight(&self, patch: usize) -> f64 {
        let (fraction, pmf) = (self.enclosure.seen_from(patch)[patch], self.pmf[patch]);
        match self.technique {
            Technique::Direction => 1.0,
            Technique::Light => 0.0,
            Technique::Both(Heuristic::Balance) => fraction / (fraction + pmf),
            Technique::Both(Heuristic::Power) => fraction * fraction / (fraction * fraction + pmf * pmf),
        }
    }

    /// Moments of a sampled light's radiance times what is left of its weight, before the vertex reflects it: patch l is
    /// picked with probability p_l, and a point uniform over a sphere's patch then gives f_l Le_l / p_l without variance.
    fn direct(&self, channel: usize) -> Central {
        let fractions = self.enclosure.seen_from(0);
        let lights = (0..self.pmf.len()).filter(|&l| self.pmf[l] > 0.0);
        Central::mixture(lights.map(|l| {
            let power = fractions[l] * self.enclosure.patches()[l].le[channel];
            (self.pmf[l], Central::constant((1.0 - self.hit_weight(l)) * power / self.pmf[l]))
        }))
    }

    /// Moments of what a vertex itself adds at depth `bounce`: light found there, and a sampled light's one bounce later.
    fn own(&self, bounce: u32, i: usize, channel: usize, counted: Counted) -> Central {
        let counts = |b: u32| counted.contains(b) && self.roulette.reaches(b);
        let patch = &self.enclosure.patches()[i];
        let weight = if bounce == 0 { 1.0 } else { self.hit_weight(i) };
        let found = Central::constant(if counts(bounce) { weight * patch.le[channel] } else { 0.0 });
        if self.samples_light(bounce) && counts(bounce + 1) {
            found.plus(&self.direct(channel).scaled(patch.albedo[channel]))
        } else {
            found
        }
    }

    /// Moments of the recursion at depth `bounce`, for each patch.
    fn step(&self, bounce: u32, next: &[Central], channel: usize, counted: Counted) -> Vec<Central> {
        let on_patch = |(i, patch): (usize, &Wall)| {
            let own = self.own(bounce, i, channel, counted);
            let (q, rho) = (self.q(bounce, patch), patch.albedo[channel]);
            if !self.continues(bounce) || q == 0.0 || rho == 0.0 {
                return own;
            }
            let seen = self.enclosure.seen_from(i).iter().copied().zip(next.iter().copied());
            let weighted = Central::mixture(seen).times(&weight(self.directions)).scaled(rho);
            let branch = random_sum(q, &weighted).scaled(1.0 / q);
            own.plus(&fixed_sum(self.branches, &branch).scaled(1.0 / f64::from(self.branches)))
        };
        self.enclosure.patches().iter().enumerate().map(on_patch).collect()
    }

    /// How the moments of one order on all patches depend on those one bounce later, from a settled depth on: mu P
    /// E (rho U / mu)^order, mu the expected number of children. Patches whose X is zero for certain are left out.
    fn slope(&self, settled: u32, channel: usize, order: f64, lit: &[bool]) -> Matrix {
        let u = match self.directions {
            Directions::Cosine => 1.0,
            Directions::Uniform => libm::exp2(order) / (order + 1.0),
        };
        self.enclosure.weighted(|patch, to| {
            let (mu, rho) = (self.children(settled, patch), patch.albedo[channel]);
            if !lit[to] || mu == 0.0 || rho == 0.0 { 0.0 } else { u * mu * libm::pow(rho / mu, order) }
        })
    }

    /// The fixed point of the recursion, from depth `bounce` on.
    fn fixed_point(&self, bounce: u32, channel: usize, counted: Counted) -> Vec<Central> {
        let patches = self.enclosure.patches().len();
        let mut moments = vec![Central::constant(0.0); patches];
        let mut lit = vec![true; patches];
        for order in 1..=4 {
            let step = self.step(bounce, &moments, channel, counted);
            let lower: Vec<f64> = step.iter().map(|m| m.get(order)).collect();
            let solved = linear::solve(&self.slope(bounce, channel, order as f64, &lit), &lower);
            for (m, solved) in moments.iter_mut().zip(solved) {
                *m = solved.map_or(m.finite_below(order), |value| m.with(order, value));
            }
            if order == 1 {
                lit = moments.iter().map(|m| m.mean > 0.0 || m.finite < 1).collect();
            }
        }
        moments
    }

    /// Moments of one sample of the radiance leaving each patch, in one channel. `None` where lights are sampled and the
    /// enclosure is no sphere: the geometry term then varies.
    pub fn moments(&self, channel: usize, counted: Counted) -> Option<Vec<Central>> {
        if self.technique != Technique::Direction && !self.enclosure.is_spherical() {
            return None;
        }
        let (mut next, start) = match self.roulette.clamp {
            Some(clamp) => (vec![Central::constant(0.0); self.enclosure.patches().len()], clamp + 1),
            None => {
                let settled = counted.settled().max(self.settled());
                (self.fixed_point(settled, channel, counted), settled)
            }
        };
        for bounce in (0..start).rev() {
            next = self.step(bounce, &next, channel, counted);
        }
        Some(next)
    }

    /// Expected rays for a camera ray that meets each patch, the camera ray included; infinity where the walk does not
    /// end. `None` where lights are sampled and the enclosure is no sphere: a light seen edge-on costs no shadow ray.
    pub fn rays(&self) -> Option<Vec<f64>> {
        if self.technique != Technique::Direction && !self.enclosure.is_spherical() {
            return None;
        }
        let patches = self.enclosure.patches();
        let step = |bounce: u32, next: &[f64]| -> Vec<f64> {
            let shadow = if self.samples_light(bounce) { 1.0 } else { 0.0 };
            let continued = |(i, patch): (usize, &Wall)| match self.children(bounce, patch) {
                0.0 => shadow,
                children => shadow + children * (1.0 + average(self.enclosure.seen_from(i), next)),
            };
            patches.iter().enumerate().map(continued).collect()
        };
        let start = self.roulette.clamp.map_or_else(|| self.settled(), |clamp| clamp + 1);
        let mut next = vec![0.0; patches.len()];
        if self.roulette.clamp.is_none() {
            let chain = self.enclosure.weighted(|patch, _| self.children(start, patch));
            let solved = linear::solve(&chain, &step(start, &next));
            next = solved.into_iter().map(|rays| rays.unwrap_or(f64::INFINITY)).collect();
        }
        for bounce in (0..start).rev() {
            next = step(bounce, &next);
        }
        Some(next.into_iter().map(|rays| 1.0 + rays).collect())
    }

    /// The tail index alpha on each patch, P(X > x) ~ x^-alpha: where the spectral radius of the matrix of weights to the
    /// power alpha is 1, above alpha = 1 [Kesten 1973]. The variance is infinite where alpha <= 2. `None` where there is
    /// no such alpha: all moments are finite, or the walk is clamped.
    pub fn tail_index(&self, channel: usize) -> Vec<Option<f64>> {
        let patches = 0..self.enclosure.patches().len();
        if self.roulette.clamp.is_some() || self.branches > 1 {
            return vec![None; patches.len()];
        }
        let settled = self.settled();
        let lit: Vec<bool> =
            patches.clone().map(|i| self.enclosure.radiance(i, channel, Counted::All) > 0.0).collect();
        let on_patch = |i: usize| {
            let finite = |alpha: f64| linear::dies_out(&self.slope(settled, channel, alpha, &lit), i);
            let (mut low, mut high) = (1.0, 256.0);
            if finite(high) {
                return None;
            }
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if finite(middle) { low = middle } else { high = middle }
            }
            Some(0.5 * (low + high))
        };
        patches.map(on_patch).collect()
    }
}

/// The directional weight U: 1 for cosine sampling; for uniform sampling 2 cos θ, which is uniform on (0, 2).
fn weight(directions: Directions) -> Central {
    match directions {
        Directions::Cosine => Central::constant(1.0),
        Directions::Uniform => Central::new(1.0, [1.0 / 3.0, 0.0, 1.0 / 5.0]),
    }
}

/// Probability of picking each patch of a sphere as a light; zero where it does not emit.
fn pmf(enclosure: &Enclosure, technique: Technique, pick: Pick) -> Vec<f64> {
    let power = |(p, fraction): (&Wall, &f64)| fraction * p.le.element_sum();
    let powers: Vec<f64> = enclosure.patches().iter().zip(enclosure.seen_from(0)).map(power).collect();
    let likely = |&power: &f64| match (technique, pick) {
        _ if power == 0.0 => 0.0,
        (Technique::Direction, _) => 0.0,
        (_, Pick::Power) => power,
        (_, Pick::Uniform) => 1.0,
    };
    let likely: Vec<f64> = powers.iter().map(likely).collect();
    let total: f64 = likely.iter().sum();
    likely.into_iter().map(|p| if p == 0.0 { 0.0 } else { p / total }).collect()
}
