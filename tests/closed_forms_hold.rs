//! `ClosedForm`, which follows raw moments numerically from bounce to bounce, against the formulas that the theory
//! prints, written down here once more from the paper: the two share no code. Nothing is sampled.

use furnace::estimator::{Estimator, Explicit, Implicit, Pick, Recursive, Roulette, Rule, Technique};
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Rgb};
use furnace::truth::{ClosedForm, Counted, Known};
use std::f64::consts::PI;

const LE: f64 = 1.7;
/// Directions with c = E U^2 of their weight.
const DIRECTIONS: [(Directions, f64); 2] = [(Directions::Cosine, 1.0), (Directions::Uniform, 4.0 / 3.0)];

fn walk(directions: Directions, roulette: Roulette) -> Estimator {
    Estimator::Implicit(Implicit { directions, roulette })
}

fn implicit(rule: Rule, from: u32) -> Estimator {
    walk(Directions::Cosine, Roulette { rule, from, clamp: None })
}

fn explicit(rule: Rule) -> Estimator {
    let (lights, directions) = (LightSampling::Area, Directions::Cosine);
    Estimator::Explicit(Explicit {
        lights,
        directions,
        roulette: Roulette::unclamped(rule),
        technique: Technique::Light,
        pick: Pick::Power,
    })
}

fn constant(q: f64) -> Rule {
    Rule::Constant { q }
}

fn furnace(albedo: Rgb, estimator: Estimator) -> ClosedForm {
    let scene = SceneKind::Furnace { albedo, emission: Rgb::splat(LE), view: View::Probe };
    ClosedForm::of(&scene, &estimator).unwrap()
}

fn gray(rho: f64, estimator: Estimator) -> ClosedForm {
    furnace(Rgb::splat(rho), estimator)
}

#[track_caller]
fn same(got: f64, printed: f64) {
    assert!((got - printed).abs() <= 1e-10 * printed.abs(), "{got} instead of {printed}");
}

fn variance(form: &ClosedForm, channel: usize) -> f64 {
    form.central(channel, Counted::All, 2).value().expect("a finite variance")
}

#[track_caller]
fn has(form: &ClosedForm, mean: f64, var: f64, rays: f64) {
    same(form.expected(0, Counted::All), mean);
    same(variance(form, 0), var);
    same(form.rays().unwrap(), rays);
}

fn mean(rho: f64) -> f64 {
    LE / (1.0 - rho)
}

/// Theory B: Var of the implicit estimator with constant q and cosine sampling.
fn var_constant(rho: f64, q: f64) -> f64 {
    mean(rho).powi(2) * rho * rho * (1.0 - q) / (q - rho * rho)
}

#[test]
fn furnace_with_constant_q() {
    for (rho, q) in [(0.5_f64, 0.3_f64), (0.5, 0.7), (0.8, 0.65), (0.8, 0.95), (0.2, 0.05), (0.95, 0.91)] {
        let (m, var) = (mean(rho), var_constant(rho, q));
        has(&gray(rho, explicit(constant(q))), m, rho * rho * var, 2.0 / (1.0 - q));
        for b in [0, 1, 3, 6] {
            let rays = f64::from(b) + 1.0 / (1.0 - q);
            has(&gray(rho, implicit(constant(q), b)), m, rho.powi(2 * b as i32) * var, rays);
        }
        // throughput that shrinks has no power-law tail
        let alpha = (q < rho).then(|| q.ln() / (q.ln() - rho.ln()));
        match (gray(rho, implicit(constant(q), 0)).tail_index(0), alpha) {
            (Some(got), Some(alpha)) => same(got, alpha),
            (got, alpha) => assert_eq!(got, alpha),
        }
        // one bounce alone: Le rho^k / q^k with probability q^k
        for k in [1, 4] {
            let one = gray(rho, implicit(constant(q), 0)).central(0, Counted::Only(k), 2).value();
            let k = k as i32;
            same(one.unwrap(), LE * LE * rho.powi(2 * k) * (q.powi(-k) - 1.0));
        }
    }
}

/// q = min(1, beta rho) from bounce b on; with a floor it is one of the deterministic schedules, for which
/// E X^2 = Le^2 sum rho^k (beta_k + 2 sum_{j<k} beta_j) and cost = sum Q_k.
#[test]
fn furnace_with_throughput_roulette() {
    for rho in [0.3, 0.8, 0.97_f64] {
        for b in [0, 1, 4] {
            let last = rho.powi(b + 1);
            let form = gray(rho, implicit(Rule::Throughput { floor: 1e-3 }, b as u32));
            let rays = f64::from(b) + 1.0 + last / (1.0 - rho);
            has(&form, mean(rho), mean(rho).powi(2) * last * (1.0 + rho - last), rays);
        }
    }
    for (rho, b, floor) in [(0.5, 2, 0.6), (0.3, 1, 0.2), (0.7, 3, 0.9_f64)] {
        let (mut square, mut rays, mut earlier) = (0.0, 0.0, 0.0);
        let (mut beta, mut alive, mut power) = (1.0, 1.0, 1.0_f64);
        for k in 0..2000 {
            square += LE * LE * power * (beta + 2.0 * earlier);
            (rays, earlier) = (rays + alive, earlier + beta);
            let q = if k < b { 1.0 } else { f64::clamp(beta * rho, floor, 1.0) };
            (beta, alive, power) = (beta * rho / q, alive * q, power * rho);
        }
        let form = gray(rho, implicit(Rule::Throughput { floor }, b));
        has(&form, mean(rho), square - mean(rho).powi(2), rays);
    }
}

#[test]
fn channels_share_one_decision() {
    let (albedo, throughput) = (Rgb::new(0.4, 0.85, 0.6), Rule::Throughput { floor: 0.01 });
    for (rule, q) in [(constant(0.75), 0.75), (Rule::Albedo, 0.85), (throughput, 0.85)] {
        for c in 0..3 {
            same(variance(&furnace(albedo, implicit(rule, 0)), c), var_constant(albedo[c], q));
        }
    }
}

/// Galton-Watson: M children of weight rho U / mu, E M = mu. Roulette is Bernoulli, splitting floor(mu + u), N samples
/// are constant, and N samples with roulette each are binomial. With at most p segments
/// Var = n sum_{j=0}^{p-2} s^j m_{p-1-j}^2, where s = c rho^2/mu and n = (c-1) rho^2/mu + rho^2 Var(M)/mu^2; without a
/// clamp Var = m^2 n / (1 - s), at 1/(1 - mu) rays, if s < mu < 1.
#[test]
fn roulette_splitting_and_n_samples_are_galton_watson() {
    #[rustfmt::skip]
    let laws = [
        (1, 0.3, 0.3 * 0.7), (1, 0.9, 0.9 * 0.1), (1, 1.25, 0.25 * 0.75), (1, 2.0, 0.0), (1, 2.7, 0.7 * 0.3),
        (2, 1.0, 0.0), (5, 1.0, 0.0), (3, 0.3, 3.0 * 0.3 * 0.7),
    ];
    for ((samples, q, var_m), (directions, c)) in laws.into_iter().flat_map(|l| DIRECTIONS.map(|d| (l, d))) {
        let mu = f64::from(samples) * q;
        let with = |roulette| match samples {
            1 => walk(directions, roulette),
            _ => Estimator::Recursive(Recursive { samples, directions, roulette }),
        };
        for rho in [0.3, 0.6, 0.9_f64] {
            let m = |p: i32| mean(rho) * (1.0 - rho.powi(p));
            let s = c * rho * rho / mu;
            let n = (c - 1.0) * rho * rho / mu + rho * rho * var_m / (mu * mu);
            for p in [2, 3, 6] {
                let clamped = Roulette { clamp: Some(p as u32 - 1), ..Roulette::unclamped(constant(q)) };
                let form = gray(rho, with(clamped));
                let sum: f64 = (0..=p - 2).map(|j| s.powi(j) * m(p - 1 - j).powi(2)).sum();
                has(&form, m(p), n * sum, (0..p).map(|k| mu.powi(k)).sum());
                same(form.truth(0, Counted::All), mean(rho));
            }
            if s < 1.0 && mu < 1.0 {
                let form = gray(rho, with(Roulette::unclamped(constant(q))));
                has(&form, mean(rho), mean(rho).powi(2) * n / (1.0 - s), 1.0 / (1.0 - mu));
            }
        }
    }
}

fn sphere(patches: &[Patch], looks_at: Option<usize>, estimator: Estimator) -> ClosedForm {
    let view = if looks_at.is_some() { View::Probe } else { View::Irradiance };
    let (patches, looks_at) = (patches.to_vec(), looks_at.unwrap_or(0));
    ClosedForm::of(&SceneKind::IntegratingSphere { patches, looks_at, view }, &estimator).unwrap()
}

/// Theory C-iv, with the children's law so that splitting is covered too; lights are picked in proportion to power.
#[test]
fn integrating_sphere() {
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let patches = [
        patch(0.3, Rgb::new(0.8, 0.5, 0.3), Rgb::ZERO),
        patch(0.1, Rgb::new(0.3, 0.2, 0.6), Rgb::new(5.0, 1.0, 0.2)),
        patch(0.15, Rgb::new(0.5, 0.9, 0.7), Rgb::new(0.1, 2.0, 3.0)),
        patch(0.45, Rgb::ZERO, Rgb::ZERO),
    ];
    let rules = [(constant(0.7), Some(0.7)), (Rule::Albedo, None), (constant(1.5), Some(1.5))];
    for ((rule, common), c) in rules.into_iter().flat_map(|r| [0, 1, 2].map(|c| (r, c))) {
        let mean = |f: &dyn Fn(&Patch) -> f64| patches.iter().map(|p| p.fraction * f(p)).sum::<f64>();
        let (rho, le) = (|p: &Patch| p.albedo[c], |p: &Patch| p.emission[c]);
        let q =
            |p: &Patch| if p.albedo == Rgb::ZERO { 0.0 } else { common.unwrap_or(p.albedo.max_element()) };
        let per_q = |p: &Patch| if rho(p) == 0.0 { 0.0 } else { rho(p) * rho(p) / q(p) };
        let splits = common == Some(1.5); // then E M(M-1) = 1, and 0 otherwise
        let pairs = |p: &Patch| if splits { (rho(p) / 1.5).powi(2) } else { 0.0 };
        let (e0, k) = (mean(&le), mean(&per_q));
        let m = e0 / (1.0 - mean(&rho));
        let m2 = (mean(&|p| le(p) * (le(p) + 2.0 * m * rho(p))) + mean(&pairs) * m * m) / (1.0 - k);
        let power = |p: &Patch| p.emission.element_sum(); // per area; p_l = f_l power / <power>
        let lights = patches.iter().filter(|p| power(p) > 0.0);
        let d2: f64 = lights.map(|p| p.fraction * le(p).powi(2) * mean(&power) / power(p)).sum();
        let n1 = mean(&rho) * m;
        let n2 = mean(&|p| rho(p) * rho(p)) * (d2 + 2.0 * e0 * n1) / (1.0 - k);
        let vertices = 1.0 / (1.0 - mean(&q));
        for (j, p) in patches.iter().enumerate() {
            let form = sphere(&patches, Some(j), implicit(rule, 0));
            same(form.expected(c, Counted::All), le(p) + rho(p) * m);
            same(form.expected(c, Counted::Only(3)), rho(p) * mean(&rho).powi(2) * e0);
            same(variance(&form, c), per_q(p) * m2 + pairs(p) * m * m - (rho(p) * m).powi(2));
            same(form.rays().unwrap(), 1.0 + q(p) * vertices);
            if !splits {
                let form = sphere(&patches, Some(j), explicit(rule));
                same(variance(&form, c), rho(p).powi(2) * (d2 - e0 * e0 - n1 * n1) + per_q(p) * n2);
                same(form.rays().unwrap(), 2.0 * (1.0 + q(p) * vertices));
            }
        }
        let plate = sphere(&patches, None, implicit(rule, 0));
        same(plate.expected(c, Counted::All), PI * m);
        same(variance(&plate, c), PI * PI * (m2 - m * m));
    }
}

/// Check numbers of theory A: f = .1, rho_w = .6, rho_e = .4, Le = 5.
#[test]
fn check_numbers() {
    let patch = |fraction, rho, le| Patch { fraction, albedo: Rgb::splat(rho), emission: Rgb::splat(le) };
    let patches = [patch(0.1, 0.4, 5.0), patch(0.9, 0.6, 0.0)];
    for (looks_at, printed) in [(Some(0), 5.476190), (Some(1), 0.714286), (None, PI * 1.190476)] {
        let got = sphere(&patches, looks_at, explicit(constant(0.5))).truth(0, Counted::All);
        assert!((got - printed).abs() < 2e-6, "{got} instead of {printed}");
    }
}

/// The n-th moment is finite exactly if w_n = E W^n < 1, which is q > rho^{n/(n-1)}.
#[test]
fn moments_are_infinite_exactly_where_they_should() {
    let finite = |rho, q, order| {
        let forms = [implicit(constant(q), 0), explicit(constant(q))].map(|estimator| gray(rho, estimator));
        forms.map(|form| form.central(0, Counted::All, order) != Known::Infinite)
    };
    for (rho, order) in [0.3, 0.5, 0.9_f64].into_iter().flat_map(|rho| [2, 3, 4].map(|n| (rho, n))) {
        let limit = rho.powf(order as f64 / (order as f64 - 1.0));
        assert_eq!(finite(rho, limit * (1.0 - 1e-9), order), [false; 2]);
        assert_eq!(finite(rho, limit * (1.0 + 1e-9), order), [true; 2]);
    }
    assert_eq!(finite(0.5, 0.25, 2), [false; 2]); // exactly on the limit
}

/// Perpetuity (0.1), M_n (1 - w_n) = sum_{k<n} C(n,k) a^{n-k} w_k M_k, w_k = rho^k q^{1-k} E U^k. Explicit on the
/// sphere: a = rho Le, and Le is added at the end, which moves no central moment.
#[test]
fn higher_moments_are_those_of_the_perpetuity() {
    let central = |a: f64, rho: f64, q: f64, uniform: bool| {
        let w = |k: i32| {
            let u = if uniform { 2f64.powi(k) / f64::from(k + 1) } else { 1.0 };
            rho.powi(k) * q.powi((1 - k).min(0)) * u // w_0 = 1
        };
        let mut m = [1.0, 0.0, 0.0, 0.0, 0.0];
        let pascal = [[1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0], [1.0, 3.0, 3.0, 0.0], [1.0, 4.0, 6.0, 4.0]];
        for n in 1..=4 {
            let term = |k: usize| pascal[n - 1][k] * a.powi((n - k) as i32) * w(k as i32) * m[k];
            m[n] = (0..n).map(term).sum::<f64>() / (1.0 - w(n as i32));
        }
        let mu = m[1];
        let third = m[3] - 3.0 * mu * m[2] + 2.0 * mu.powi(3);
        [third, m[4] - 4.0 * mu * m[3] + 6.0 * mu * mu * m[2] - 3.0 * mu.powi(4)]
    };
    for (rho, q) in [(0.5, 0.6), (0.3, 0.4), (0.2, 0.2)] {
        for (estimator, a, uniform) in [
            (implicit(constant(q), 0), LE, false),
            (explicit(constant(q)), rho * LE, false),
            (walk(Directions::Uniform, Roulette::unclamped(constant(q))), LE, true),
        ] {
            for (order, printed) in [3, 4].into_iter().zip(central(a, rho, q, uniform)) {
                same(gray(rho, estimator).central(0, Counted::All, order).value().unwrap(), printed);
            }
        }
    }
}
