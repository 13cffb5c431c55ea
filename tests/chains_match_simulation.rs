//! `Walk` against a simulation of the abstract chain: patch after patch is drawn from the rows, with a generator written
//! here, and sampled lights are weighted by their densities. The two share the estimators' descriptions and nothing else.
//! Means, variances, third and fourth moments and rays, in total and (mean and variance) bounce by bounce.
//!
//! False alarms: about 2000 t tests with 63 degrees of freedom, each beyond [`LIMIT`] with probability 1.2e-14, together
//! 3e-11; the rest up to 1e-9 is left for what skewness does to t. Cases are such that all moments to the eighth are
//! finite.

use furnace::estimator::{Estimator, Explicit, Heuristic, Implicit, Recursive, Roulette, Rule, Technique};
use furnace::scene::library::Patch;
use furnace::scene::{Directions, LightSampling, Pick, Points, Rgb};
use furnace::truth::{Counted, Enclosure, Walk, Wall};

const BATCHES: usize = 64;
const SAMPLES: usize = 2048;
const LIMIT: f64 = 10.0;
/// Bounces 0 to 3, the later ones, and the total.
const BINS: [Counted; 6] =
    [Counted::Only(0), Counted::Only(1), Counted::Only(2), Counted::Only(3), Counted::From(4), Counted::All];
const CHANNEL: usize = 1;

/// A chain that is walked through.
struct Chain {
    patches: Vec<Wall>,
    sees: Vec<Vec<f64>>,
    roulette: Roulette,
    branches: u32,
    technique: Technique,
    pick: Pick,
    bins: [f64; 6],
    rays: f64,
    state: u64,
}

impl Chain {
    /// xorshift* [Vigna 2016].
    fn random(&mut self) -> f64 {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        (self.state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// An index drawn with these probabilities, or none with what they lack to 1.
    fn draw(&mut self, probabilities: &[f64]) -> Option<usize> {
        let mut left = self.random();
        probabilities.iter().position(|p| {
            left -= p;
            left < 0.0
        })
    }

    fn add(&mut self, bounce: u32, value: f64) {
        if self.roulette.clamp.is_none_or(|clamp| bounce <= clamp) {
            self.bins[(bounce as usize).min(4)] += value;
            self.bins[5] += value;
        }
    }

    /// How probable it is that each patch is the sampled light.
    fn lights(&self) -> Vec<f64> {
        let weight = |(p, area): (&Wall, &f64)| match self.pick {
            Pick::Uniform if p.le != Rgb::ZERO => 1.0,
            Pick::Uniform => 0.0,
            Pick::Power => area * (p.le.x + p.le.y + p.le.z),
        };
        let weights: Vec<f64> = self.patches.iter().zip(&self.sees[0]).map(weight).collect();
        let total: f64 = weights.iter().sum();
        weights.into_iter().map(|w| w / total).collect()
    }

    /// Weights of a hit and of a light sample on a patch, from densities per area of a sphere of unit area.
    fn weights(&self, patch: usize) -> (f64, f64) {
        let (direction, light) = (1.0, self.lights()[patch] / self.sees[0][patch]);
        match self.technique {
            Technique::Light => (0.0, 1.0),
            Technique::Direction => (1.0, 0.0),
            Technique::Both(heuristic) => {
                let exponent = if heuristic == Heuristic::Balance { 1 } else { 2 };
                let (a, b) = (f64::powi(direction, exponent), f64::powi(light, exponent));
                (a / (a + b), b / (a + b))
            }
        }
    }

    fn vertex(&mut self, i: usize, beta: f64, bounce: u32) {
        self.rays += 1.0;
        let Wall { albedo, le } = self.patches[i];
        let hit = if bounce == 0 { 1.0 } else { self.weights(i).0 };
        self.add(bounce, beta * hit * le[CHANNEL]);
        let may = |extra: u32| self.roulette.clamp.is_none_or(|clamp| bounce + extra <= clamp);
        let (reaches, useful) = (may(1), may(if self.technique == Technique::Light { 2 } else { 1 }));
        if self.technique != Technique::Direction && reaches {
            self.rays += 1.0;
            let lights = self.lights();
            let light = self.draw(&lights).unwrap();
            let (area, weight) = (self.sees[0][light], self.weights(light).1);
            let sampled = self.patches[light].le[CHANNEL] * area / lights[light];
            self.add(bounce + 1, beta * albedo[CHANNEL] * weight * sampled);
        }
        if !useful || albedo == Rgb::ZERO {
            return;
        }
        let q = match self.roulette.rule {
            Rule::Constant { q } => q,
            Rule::Albedo => albedo.x.max(albedo.y).max(albedo.z),
            _ => unreachable!("not among the cases"),
        };
        let row = self.sees[i].clone();
        for _ in 0..self.branches {
            let extra = if self.random() < q % 1.0 { 1 } else { 0 };
            for _ in 0..q as u32 + extra {
                match self.draw(&row) {
                    Some(next) => {
                        let weight = albedo[CHANNEL] / (q * f64::from(self.branches));
                        self.vertex(next, beta * weight, bounce + 1);
                    }
                    None => self.rays += 1.0, // into the black
                }
            }
        }
    }
}

/// Whether the average of batches is what theory says; `scale` absorbs rounding where there is no noise.
#[track_caller]
fn near(what: &str, batches: &[f64], theory: f64, scale: f64) {
    let n = batches.len() as f64;
    let mean = batches.iter().sum::<f64>() / n;
    let error = (batches.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt();
    assert!(
        (mean - theory).abs() <= LIMIT * error + 1e-12 * scale,
        "{what}: {mean} ± {error}, theory {theory}"
    );
}

fn holds(enclosure: &Enclosure, estimator: &Estimator) {
    let (branches, technique, pick) = match estimator {
        Estimator::Implicit(_) => (1, Technique::Direction, Pick::Power),
        Estimator::Recursive(e) => (e.samples, Technique::Direction, Pick::Power),
        Estimator::Explicit(e) => (1, e.technique, e.lights.pick),
        Estimator::LightTracing(_) | Estimator::PhotonMap(_) => {
            unreachable!("no chain of vertices from the eye")
        }
    };
    let patches = enclosure.patches().to_vec();
    let sees = (0..patches.len()).map(|i| enclosure.seen_from(i).to_vec()).collect();
    let (roulette, bins, rays, state) = (*estimator.roulette(), [0.0; 6], 0.0, 0x9e37_79b9);
    let mut chain = Chain { patches, sees, roulette, branches, technique, pick, bins, rays, state };
    let walk = Walk::new(enclosure, estimator).unwrap();
    let theory = BINS.map(|counted| walk.moments(CHANNEL, counted).unwrap());
    let expected_rays = walk.rays().unwrap();
    for start in 0..enclosure.patches().len() {
        let mut sums = vec![[[0.0; 4]; 6]; BATCHES];
        let mut ray_sums = vec![0.0; BATCHES];
        for (powers, rays) in sums.iter_mut().zip(&mut ray_sums) {
            for _ in 0..SAMPLES {
                (chain.bins, chain.rays) = ([0.0; 6], 0.0);
                chain.vertex(start, 1.0, 0);
                *rays += chain.rays / SAMPLES as f64;
                for (bin, powers) in powers.iter_mut().enumerate() {
                    let d = chain.bins[bin] - theory[bin][start].mean;
                    (1..=4).for_each(|n| powers[n - 1] += d.powi(n as i32) / SAMPLES as f64);
                }
            }
        }
        let what = format!("{estimator:?} from {start}");
        near(&format!("rays of {what}"), &ray_sums, expected_rays[start], 1.0);
        for (bin, counted) in BINS.into_iter().enumerate() {
            let moments = theory[bin][start];
            for order in 1..=if counted == Counted::All { 4 } else { 2 } {
                let printed = if order == 1 { 0.0 } else { moments.finite_moment(order).unwrap() };
                let batches: Vec<f64> = sums.iter().map(|powers| powers[bin][order - 1]).collect();
                let what = format!("order {order} of {counted:?}, mean {}, of {what}", moments.mean);
                near(&what, &batches, printed, moments.mean.powi(order as i32));
            }
        }
    }
}

fn color(r: f64, g: f64, b: f64, le: f64) -> Wall {
    Wall { albedo: Rgb::new(r, g, b), le: Rgb::new(2.0 * le, le, 0.1 * le) }
}

fn implicit(roulette: Roulette) -> Estimator {
    Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette })
}

const CONSTANT: Roulette = Roulette { rule: Rule::Constant { q: 0.7 }, from: 0, clamp: None };
const ALBEDO: Roulette = Roulette { rule: Rule::Albedo, from: 0, clamp: None };

#[test]
fn chains_that_leak_and_enclosures() {
    let (a, b, c) = (color(0.6, 0.5, 0.3, 0.0), color(0.3, 0.4, 0.2, 3.0), color(0.0, 0.0, 0.0, 1.0));
    let leaky = vec![vec![0.1, 0.5, 0.3], vec![0.4, 0.0, 0.3], vec![1.0, 0.0, 0.0]];
    let clamped = Roulette { clamp: Some(3), ..CONSTANT };
    let split = Roulette { rule: Rule::Constant { q: 1.4 }, ..clamped };
    let recursive =
        Estimator::Recursive(Recursive { samples: 2, directions: Directions::Cosine, roulette: clamped });
    for enclosure in [
        Enclosure::new(vec![a, b, c], leaky),
        Enclosure::dome(a, b),
        Enclosure::concentric(b, a, 0.3),
        Enclosure::plates(a, b),
    ] {
        for estimator in [implicit(CONSTANT), implicit(ALBEDO), implicit(split), recursive] {
            holds(&enclosure, &estimator);
        }
    }
}

/// Two lights of unequal size and brightness, one of which reflects more, a wall, and a black port.
#[test]
fn both_techniques_on_a_sphere() {
    let patch = |fraction, m: Wall| Patch { fraction, albedo: m.albedo, emission: m.le };
    let enclosure = Enclosure::sphere(&[
        patch(0.5, color(0.6, 0.5, 0.3, 0.0)),
        patch(0.05, color(0.3, 0.2, 0.1, 5.0)),
        patch(0.3, color(0.5, 0.6, 0.2, 0.4)),
        patch(0.15, color(0.0, 0.0, 0.0, 0.0)),
    ]);
    let both = [Heuristic::Balance, Heuristic::Power].map(Technique::Both);
    let clamped = Roulette { clamp: Some(2), ..CONSTANT };
    for technique in both.into_iter().chain([Technique::Light, Technique::Direction]) {
        for (pick, roulette) in
            [Pick::Power, Pick::Uniform].into_iter().flat_map(|p| [CONSTANT, ALBEDO, clamped].map(|r| (p, r)))
        {
            let directions = Directions::Cosine;
            holds(
                &enclosure,
                &Estimator::Explicit(Explicit {
                    technique,
                    lights: LightSampling { points: Points::Area, pick },
                    directions,
                    roulette,
                }),
            );
        }
    }
}
