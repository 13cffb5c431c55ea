//! `ClosedForm` against two simulations that share nothing but the question: a toy written here, which knows no rays and
//! draws patches one after the other, and the real estimators in the real scenes. Means, variances, third and fourth
//! moments and rays, in total and (mean and variance) bounce by bounce.
//!
//! False alarms: about 3600 t tests with 63 degrees of freedom, each beyond [`LIMIT`] with probability 1.2e-14, together
//! 5e-11; the rest up to 1e-9 is left for what skewness does to t. Cases are such that all moments to the eighth are finite.

use furnace::estimator::{BINS, Estimator, Explicit, Implicit, Recursive, Roulette, Rule, Technique};
use furnace::experiment::sample;
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use furnace::stats::Moments;
use furnace::truth::{ClosedForm, Counted};
use std::f64::consts::PI;

const BATCHES: u64 = 64;
const SAMPLES: u64 = 2048;
const LIMIT: f64 = 10.0;

/// What a batch of samples yields: moments of each bounce and, last, of the total, by channel; and of the rays.
struct Batch {
    values: Vec<[Moments; 3]>,
    rays: Moments,
}

fn real(scene: &SceneKind, estimator: &Estimator) -> Vec<Batch> {
    let built = scene.build();
    let batch = |b: u64| {
        let address = Address::of(&["real", &format!("{scene:?} {estimator:?} {b}")]);
        // blocks of one sample, so that moments of block means are moments of samples
        let cell = sample(&built, estimator, &address, SAMPLES, 1);
        assert_eq!(cell.invalid(), None);
        Batch { values: cell.bounces.into_iter().chain([cell.total]).collect(), rays: cell.cost }
    };
    (0..BATCHES).map(batch).collect()
}

/// A walk over patches that are drawn independently, each with its fraction's probability.
struct Toy {
    patches: Vec<Patch>,
    roulette: Roulette,
    samples: u32,
    uniform: bool,
    explicit: bool,
    bounces: [Rgb; BINS],
    rays: u32,
    rng: u64,
}

impl Toy {
    /// SplitMix64 [Steele, Lea & Flood 2014].
    fn random(&mut self) -> f64 {
        self.rng = self.rng.wrapping_add(0x9e3779b97f4a7c15);
        let z = (self.rng ^ (self.rng >> 30)).wrapping_mul(0xbf58476d1ce4e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d049bb133111eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// An index drawn with probability in proportion to `weight`.
    fn draw(&mut self, weight: impl Fn(&Patch) -> f64) -> usize {
        let mut left = self.random() * self.patches.iter().map(&weight).sum::<f64>();
        let found = self.patches.iter().position(|p| {
            left -= weight(p);
            left < 0.0
        });
        found.unwrap_or(0)
    }

    fn add(&mut self, bounce: u32, value: Rgb) {
        self.bounces[(bounce as usize).min(BINS - 1)] += value;
    }

    fn vertex(&mut self, patch: usize, beta: Rgb, bounce: u32) {
        let patch = self.patches[patch];
        let last = self.roulette.clamp.unwrap_or(u32::MAX);
        self.rays += 1;
        if bounce == 0 || !self.explicit {
            self.add(bounce, beta * patch.emission);
        }
        if self.explicit && bounce < last {
            let power = |p: &Patch| p.fraction * p.emission.element_sum();
            let light = self.draw(power);
            let light = self.patches[light];
            let total: f64 = self.patches.iter().map(power).sum();
            self.rays += 1;
            self.add(
                bounce + 1,
                beta * patch.albedo * light.emission * light.fraction * total / power(&light),
            );
        }
        if bounce + u32::from(self.explicit) >= last {
            return;
        }
        let q = match self.roulette.rule {
            _ if patch.albedo == Rgb::ZERO => 0.0,
            _ if bounce < self.roulette.from => 1.0,
            Rule::None => 1.0,
            Rule::Constant { q } => q,
            Rule::Albedo => patch.albedo.max_element(),
            Rule::Throughput { floor } => (beta * patch.albedo).max_element().min(1.0).max(floor),
        };
        for _ in 0..self.samples {
            let (mut copies, fraction) = (q.trunc() as u32, q.fract());
            copies += u32::from(self.random() < fraction);
            for _ in 0..copies {
                let u = if self.uniform { 2.0 * self.random() } else { 1.0 };
                let next = self.draw(|p| p.fraction);
                self.vertex(next, beta * patch.albedo * u / (q * f64::from(self.samples)), bounce + 1);
            }
        }
    }

    fn run(scene: &SceneKind, estimator: &Estimator) -> Vec<Batch> {
        let (patches, looks_at, view) = match scene.clone() {
            SceneKind::IntegratingSphere { patches, looks_at, view } => (patches, looks_at, view),
            SceneKind::Furnace { albedo, emission, view }
            | SceneKind::FurnaceBox { albedo, emission, view } => {
                (vec![Patch { fraction: 1.0, albedo, emission }], 0, view)
            }
            _ => unreachable!("no closed form"),
        };
        let (samples, directions, explicit) = match estimator {
            Estimator::Implicit(e) => (1, e.directions, false),
            Estimator::Explicit(e) => (1, e.directions, true),
            Estimator::Recursive(e) => (e.samples, e.directions, false),
            Estimator::LightTracing(_) | Estimator::PhotonMap(_) => unreachable!("no path from the eye"),
        };
        let (roulette, uniform) = (*estimator.roulette(), directions == Directions::Uniform);
        let (bounces, rays, rng) = ([Rgb::ZERO; BINS], 0, 1);
        let mut toy = Toy { patches, roulette, samples, uniform, explicit, bounces, rays, rng };
        let mut batch = |_| {
            let mut batch = Batch { values: vec![Default::default(); BINS + 1], rays: Moments::default() };
            for _ in 0..SAMPLES {
                (toy.bounces, toy.rays) = (bounces, 0);
                let plate = view == View::Irradiance;
                let first = if plate { toy.draw(|p| p.fraction) } else { looks_at };
                toy.vertex(first, Rgb::splat(if plate { PI } else { 1.0 }), 0);
                let total = toy.bounces.iter().sum::<Rgb>();
                for (moments, value) in batch.values.iter_mut().zip(toy.bounces.into_iter().chain([total])) {
                    (0..3).for_each(|c| moments[c].push(value[c]));
                }
                batch.rays.push(f64::from(toy.rays));
            }
            batch
        };
        (0..BATCHES).map(&mut batch).collect()
    }
}

/// Averages of (x - about)^k, k = 1 to 4: with the true mean they are unbiased, unlike moments about the sample's mean.
fn powers(x: &Moments, about: f64) -> [f64; 4] {
    let (n, d) = (x.n as f64, x.mean - about);
    let (m2, m3, m4) = (x.m2 / n, x.m3 / n, x.m4 / n);
    [d, m2 + d * d, m3 + 3.0 * d * m2 + d.powi(3), m4 + 4.0 * d * m3 + 6.0 * d * d * m2 + d.powi(4)]
}

/// Compares the average over batches with theory; `scale` only absorbs rounding where there is no noise.
fn near(what: &str, batches: impl Iterator<Item = f64>, theory: f64, scale: f64) {
    let mut m = Moments::default();
    batches.for_each(|x| m.push(x));
    let (distance, error) = (m.mean - theory, m.std_error().unwrap());
    assert!(distance.abs() <= LIMIT * error + 1e-12 * scale, "{what}: {} ± {error}, theory {theory}", m.mean);
}

fn holds(scene: SceneKind, estimator: Estimator) {
    let form = ClosedForm::of(&scene, &estimator).unwrap();
    for (who, batches) in [("toy", Toy::run(&scene, &estimator)), ("real", real(&scene, &estimator))] {
        let what = format!("{who} {estimator:?} in {scene:?}");
        near(&format!("{what}: rays"), batches.iter().map(|b| b.rays.mean), form.rays().unwrap(), 1.0);
        for (i, c) in (0..=BINS).flat_map(|i| [0, 1, 2].map(|c| (i, c))) {
            let (counted, orders) = match i {
                BINS => (Counted::All, 4),
                i if i == BINS - 1 => (Counted::From(i as u32), 2),
                i => (Counted::Only(i as u32), 2),
            };
            let mean = form.expected(c, counted);
            for order in 1..=orders {
                let central = || form.central(c, counted, order).value().expect("a finite moment");
                let theory = if order == 1 { 0.0 } else { central() };
                let what = format!("{what}: order {order} of {counted:?}, channel {c}, mean {mean}");
                let measured = batches.iter().map(|b| powers(&b.values[i][c], mean)[order - 1]);
                near(&what, measured, theory, mean.powi(order as i32));
            }
        }
    }
}

fn furnace(albedo: Rgb) -> SceneKind {
    SceneKind::Furnace { albedo, emission: Rgb::new(1.0, 0.3, 2.0), view: View::Probe }
}

fn implicit(roulette: Roulette) -> Estimator {
    Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette })
}

fn explicit(roulette: Roulette) -> Estimator {
    Estimator::Explicit(Explicit {
        technique: Technique::Light,
        lights: LightSampling::AREA,
        directions: Directions::Cosine,
        roulette,
    })
}

const CONSTANT: Rule = Rule::Constant { q: 0.7 };
const THROUGHPUT: Rule = Rule::Throughput { floor: 0.05 };

#[test]
fn one_walk_in_the_furnace() {
    let albedo = Rgb::new(0.6, 0.5, 0.3);
    let (emission, view) = (Rgb::new(1.0, 0.3, 2.0), View::Irradiance);
    holds(SceneKind::FurnaceBox { albedo, emission, view }, implicit(Roulette::unclamped(CONSTANT)));
    for (rule, from, clamp) in [
        (Rule::Albedo, 0, None),
        (THROUGHPUT, 0, None),
        (THROUGHPUT, 2, None),
        (CONSTANT, 3, None),
        (CONSTANT, 1, Some(4)),
    ] {
        holds(furnace(albedo), implicit(Roulette { rule, from, clamp }));
        holds(furnace(albedo), explicit(Roulette { rule, from, clamp }));
    }
}

#[test]
fn branching_and_uniform_directions_in_the_furnace() {
    let albedo = Rgb::new(0.4, 0.3, 0.2);
    let clamped = |q, clamp| Roulette { clamp: Some(clamp), ..Roulette::unclamped(Rule::Constant { q }) };
    for directions in [Directions::Cosine, Directions::Uniform] {
        let walk = |roulette| Estimator::Implicit(Implicit { directions, roulette });
        holds(furnace(albedo), walk(clamped(1.5, 4)));
        holds(furnace(albedo), walk(Roulette::unclamped(Rule::Constant { q: 0.8 })));
        let roulette = clamped(0.6, 3);
        holds(furnace(albedo), Estimator::Recursive(Recursive { samples: 3, directions, roulette }));
    }
}

/// A wall, two lights of unequal colour that reflect, and a black port.
#[test]
fn integrating_sphere() {
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let patches = vec![
        patch(0.5, Rgb::new(0.7, 0.5, 0.6), Rgb::ZERO),
        patch(0.15, Rgb::new(0.3, 0.2, 0.1), Rgb::new(5.0, 1.0, 0.2)),
        patch(0.2, Rgb::new(0.6, 0.4, 0.5), Rgb::new(0.1, 2.0, 3.0)),
        patch(0.15, Rgb::ZERO, Rgb::ZERO),
    ];
    let cases = [
        (CONSTANT, 0, View::Probe),
        (CONSTANT, 2, View::Probe),
        (Rule::Albedo, 1, View::Probe),
        (THROUGHPUT, 0, View::Probe),
        (CONSTANT, 3, View::Irradiance),
    ];
    for (rule, looks_at, view) in cases {
        let scene = SceneKind::IntegratingSphere { patches: patches.clone(), looks_at, view };
        holds(scene.clone(), implicit(Roulette::unclamped(rule)));
        holds(scene, explicit(Roulette::unclamped(rule)));
    }
}
