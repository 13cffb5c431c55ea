//! `Walk` over finite Markov chains and with multiple importance sampling, against the formulas that the theory prints
//! (B, C-iv, C-v) and a solver of linear equations written here: the two share no code. Nothing but the geometry of the
//! enclosures is sampled.

use furnace::estimator::{Estimator, Explicit, Heuristic, Implicit, Roulette, Rule, Technique};
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, LightSampling, Pick, Points, Rgb};
use furnace::truth::gain::{OneLight, largest_light_worth_sampling};
use furnace::truth::{ClosedForm, Counted, Enclosure, Known, Walk, Wall};

fn implicit(rule: Rule) -> Estimator {
    Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette: Roulette::unclamped(rule) })
}

fn explicit(rule: Rule, technique: Technique, pick: Pick) -> Estimator {
    let (lights, directions) = (LightSampling { points: Points::Area, pick }, Directions::Cosine);
    Estimator::Explicit(Explicit { technique, lights, directions, roulette: Roulette::unclamped(rule) })
}

fn constant(q: f64) -> Rule {
    Rule::Constant { q }
}

fn gray(albedo: f64, le: f64) -> Wall {
    Wall { albedo: Rgb::splat(albedo), le: Rgb::splat(le) }
}

#[track_caller]
fn same(got: f64, printed: f64) {
    assert!((got - printed).abs() <= 1e-11 * printed.abs(), "{got} instead of {printed}");
}

/// x = A x + b, by Gaussian elimination with row exchanges.
fn solved(a: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let row = |i: usize| -> Vec<f64> {
        (0..n).map(|j| f64::from(u8::from(i == j)) - a[i][j]).chain([b[i]]).collect()
    };
    let mut m: Vec<Vec<f64>> = (0..n).map(row).collect();
    for k in 0..n {
        let largest = (k..n).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs())).unwrap();
        m.swap(k, largest);
        let pivot = m[k].clone();
        for row in (0..n).filter(|&i| i != k) {
            let factor = m[row][k] / pivot[k];
            (0..=n).for_each(|j| m[row][j] -= factor * pivot[j]);
        }
    }
    (0..n).map(|i| m[i][n] / m[i][i]).collect()
}

/// Spectral radius of a matrix without negative entries, by squaring it: rho = lim |A^n|^(1/n).
fn spectral_radius(a: &[Vec<f64>]) -> f64 {
    let n = a.len();
    let (mut a, mut log, mut steps) = (a.to_vec(), 0.0, 1.0);
    for _ in 0..60 {
        let norm: f64 = a.iter().flatten().sum();
        log += norm.ln() / steps;
        a.iter_mut().flatten().for_each(|x| *x /= norm);
        let entry = |i: usize, j: usize| (0..n).map(|k| a[i][k] * a[k][j]).sum::<f64>();
        a = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        steps *= 2.0;
    }
    log.exp()
}

fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
}

/// diag(d) A.
fn scaled(d: &[f64], a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    a.iter().zip(d).map(|(row, d)| row.iter().map(|x| d * x).collect()).collect()
}

/// Chains with rows that differ, with light that escapes, with patches that do not see each other both ways, with a
/// black one, and of one to five patches.
fn chains() -> Vec<(Vec<Wall>, Vec<Vec<f64>>)> {
    let color = |r, g, b, le| Wall { albedo: Rgb::new(r, g, b), le: Rgb::new(le, 0.5 * le, 2.0 * le) };
    let (a, b, c) = (color(0.7, 0.3, 0.5, 0.0), color(0.4, 0.6, 0.2, 3.0), color(0.2, 0.65, 0.6, 0.7));
    let black = color(0.0, 0.0, 0.0, 5.0);
    vec![
        (vec![b], vec![vec![0.6]]),
        (vec![a, b], vec![vec![0.0, 1.0], vec![1.0, 0.0]]),
        (vec![a, c, b], vec![vec![0.2, 0.5, 0.3], vec![0.1, 0.0, 0.6], vec![0.25, 0.25, 0.5]]),
        (vec![a, b, black], vec![vec![0.3, 0.6, 0.1], vec![0.0, 0.4, 0.5], vec![0.5, 0.5, 0.0]]),
        (
            vec![a, b, c, a, black],
            vec![
                vec![0.1, 0.2, 0.3, 0.4, 0.0],
                vec![0.0, 0.0, 0.5, 0.2, 0.1],
                vec![0.7, 0.0, 0.0, 0.2, 0.1],
                vec![0.2, 0.2, 0.2, 0.2, 0.2],
                vec![1.0, 0.0, 0.0, 0.0, 0.0],
            ],
        ),
    ]
}

/// L = (I - diag(rho) P)^-1 Le, S = (I - diag(rho^2/q) P)^-1 (Le^2 + 2 Le rho P L), Var = S - L^2; a walk has 1 + V rays,
/// V = (I - diag(q) P)^-1 q.
#[test]
fn chains_have_the_moments_of_their_matrices() {
    for ((patches, sees), c) in chains().into_iter().flat_map(|chain| [0, 1, 2].map(|c| (chain.clone(), c))) {
        for rule in [constant(0.8), constant(0.5), Rule::Albedo] {
            let q = |p: &Wall| match rule {
                _ if p.albedo == Rgb::ZERO => 0.0,
                Rule::Constant { q } => q,
                _ => p.albedo.max_element(),
            };
            let of = |f: &dyn Fn(&Wall) -> f64| patches.iter().map(f).collect::<Vec<f64>>();
            let (rho, le, q) = (of(&|p| p.albedo[c]), of(&|p| p.le[c]), of(&q));
            let each = |f: &dyn Fn(usize) -> f64| (0..rho.len()).map(f).collect::<Vec<f64>>();
            let scattering = scaled(&rho, &sees);
            let l = solved(&scattering, &le);
            let pl = times(&sees, &l);
            let squares = each(&|i| if rho[i] == 0.0 { 0.0 } else { rho[i] * rho[i] / q[i] });
            assert!(spectral_radius(&scaled(&squares, &sees)) < 1.0);
            let own = each(&|i| le[i] * (le[i] + 2.0 * rho[i] * pl[i]));
            let s = solved(&scaled(&squares, &sees), &own);
            let rays = solved(&scaled(&q, &sees), &q);
            let enclosure = Enclosure::new(patches.clone(), sees.clone());
            let estimator = implicit(rule);
            let walk = Walk::new(&enclosure, &estimator).unwrap();
            let twice = times(&scattering, &times(&scattering, &le));
            for i in 0..patches.len() {
                same(enclosure.radiance(i, c, Counted::All), l[i]);
                same(enclosure.radiance(i, c, Counted::Only(2)), twice[i]);
                same(enclosure.radiance(i, c, Counted::From(2)), solved(&scattering, &twice)[i]);
                let moments = walk.moments(c, Counted::All).unwrap()[i];
                same(moments.mean, l[i]);
                let variance = s[i] - l[i] * l[i];
                assert!((moments.central[0] - variance).abs() <= 1e-12 * s[i], "{moments:?}, {variance}");
                same(walk.rays().unwrap()[i], 1.0 + rays[i]);
            }
        }
    }
}

/// The n-th moment is finite exactly if the matrix q (rho/q)^n P has a spectral radius below 1, and its index is where
/// that is 1. Constant q: rho^n's radius r and q^(1-n) r < 1.
#[test]
fn moments_of_chains_are_infinite_exactly_where_they_should() {
    let (patches, sees) = chains().swap_remove(2);
    let enclosure = Enclosure::new(patches.clone(), sees.clone());
    for (c, order) in [0, 1, 2].into_iter().flat_map(|c| [2, 3, 4].map(|order| (c, order))) {
        let weights: Vec<f64> = patches.iter().map(|p| p.albedo[c].powi(order)).collect();
        let limit = spectral_radius(&scaled(&weights, &sees)).powf(1.0 / f64::from(order - 1));
        for (q, finite) in [(limit * (1.0 - 1e-9), false), (limit * (1.0 + 1e-9), true)] {
            let estimator = implicit(constant(q));
            let walk = Walk::new(&enclosure, &estimator).unwrap();
            for (on_patch, alpha) in walk.moments(c, Counted::All).unwrap().iter().zip(walk.tail_index(c)) {
                assert_eq!(on_patch.finite >= order as usize, finite, "{on_patch:?}");
                assert!((alpha.unwrap() - f64::from(order)).abs() < 1e-6, "{alpha:?}");
            }
        }
    }
}

/// A walk that leaves for patches of thin tails does not suffer from those that it has left, a bounce alone never has
/// infinite moments, nor has a channel without light.
#[test]
fn infinite_moments_stay_where_they_arise() {
    let dark = Wall { le: Rgb::new(1.0, 1.0, 0.0), ..gray(0.5, 0.0) };
    let bright = Wall { le: Rgb::new(1.0, 1.0, 0.0), ..gray(0.9, 0.0) };
    let enclosure = Enclosure::new(vec![bright, dark], vec![vec![0.9, 0.1], vec![0.0, 0.8]]);
    let estimator = implicit(constant(0.6));
    let walk = Walk::new(&enclosure, &estimator).unwrap();
    let finite = |c, counted| walk.moments(c, counted).unwrap().iter().map(|m| m.finite).collect::<Vec<_>>();
    assert_eq!(finite(0, Counted::All), [1, 4]);
    assert_eq!(finite(0, Counted::From(3)), [1, 4]);
    assert_eq!(finite(0, Counted::Only(3)), [4, 4]);
    assert_eq!(finite(2, Counted::All), [4, 4]);
    assert_eq!(walk.tail_index(2), [None, None]);
    assert_eq!(walk.tail_index(0)[1], None);
    // theory B: one bounce alone is Le (rho/q)^k with probability q^k
    let furnace = Enclosure::furnace(gray(0.9, 1.0));
    let estimator = implicit(constant(0.5));
    let one = Walk::new(&furnace, &estimator).unwrap().moments(0, Counted::Only(3)).unwrap()[0];
    same(one.central[0], 0.9_f64.powi(6) * (0.5_f64.powi(-3) - 1.0));
}

/// C-v: infinite plates, concentric spheres, and the dome over its floor.
#[test]
fn enclosures_have_their_printed_radiance() {
    let (rho1, rho2, e1, e2, k, phi) = (0.6, 0.8, 0.3, 1.7, 0.2, 0.35);
    let on = |enclosure: Enclosure| [0, 1].map(|patch| enclosure.radiance(patch, 1, Counted::All));
    let (first, second) = (gray(rho1, e1), gray(rho2, e2));
    let [l1, l2] = on(Enclosure::plates(first, second));
    same(l1, (e1 + rho1 * e2) / (1.0 - rho1 * rho2));
    same(l2, (e2 + rho2 * e1) / (1.0 - rho1 * rho2));
    let [l1, l2] = on(Enclosure::concentric(first, second, k));
    same(l2, (e2 + rho2 * k * e1) / (1.0 - rho2 * (1.0 - k) - rho1 * rho2 * k));
    same(l1, e1 + rho1 * l2);
    // the same with 1 - phi for k: a lid sees the cap only, and the cap sees 1 - phi of the lid
    let [lid, cap] = on(Enclosure::cap(first, second, phi));
    same(cap, (e2 + rho2 * (1.0 - phi) * e1) / (1.0 - rho2 * phi - rho1 * rho2 * (1.0 - phi)));
    same(lid, e1 + rho1 * cap);
    let [floor, dome] = on(Enclosure::dome(first, second));
    same(dome, (e2 + rho2 * 0.5 * e1) / (1.0 - 0.5 * rho2 - 0.5 * rho1 * rho2));
    same(floor, e1 + rho1 * dome);
}

/// What a cosine-distributed ray from a point of the outer sphere or of the cap meets, by intersecting shapes: the
/// sphere of radius 1 around 0, seen from a point of it. |z| < 6 in six tests: false alarms 1e-8.
#[test]
fn enclosures_see_what_their_shapes_do() {
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let (radius, phi): (f64, f64) = (0.6, 0.3);
    let patch = gray(0.5, 1.0);
    let concentric = Enclosure::concentric(patch, patch, radius * radius);
    let (cap, dome) = (Enclosure::cap(patch, patch, phi), Enclosure::dome(patch, patch));
    let cuts = [1.0 - 2.0 * phi, 0.0]; // heights above which the sphere is a cap, a dome
    const RAYS: u32 = 200_000;
    for height in [0.45_f64, 0.98] {
        let p = [(1.0 - height * height).sqrt(), 0.0, height];
        let (mut inner, mut lids) = (0, [0, 0]);
        for _ in 0..RAYS {
            // cosine-distributed around -p: a unit vector at the tip of the normal [Lambert's law by a tangent sphere]
            let (z, turn) = (2.0 * random() - 1.0, std::f64::consts::TAU * random());
            let ring = (1.0 - z * z).sqrt();
            let d = [ring * turn.cos() - p[0], ring * turn.sin() - p[1], z - p[2]];
            let (dd, pd) =
                (d.iter().map(|x| x * x).sum::<f64>(), d.iter().zip(p).map(|(d, p)| d * p).sum::<f64>());
            inner += u32::from(1.0 - pd * pd / dd < radius * radius); // the line's distance from 0
            let end = p[2] - 2.0 * pd / dd * d[2];
            for (lid, cut) in lids.iter_mut().zip(cuts) {
                *lid += u32::from(end < cut);
            }
        }
        for (count, enclosure) in [(inner, &concentric), (lids[0], &cap), (lids[1], &dome)] {
            let p = enclosure.seen_from(1)[0];
            let n = f64::from(RAYS);
            let z = (f64::from(count) - n * p) / (n * p * (1.0 - p)).sqrt();
            assert!(z.abs() < 6.0, "{count} of {n} instead of {p}");
            same(enclosure.seen_from(1)[1], 1.0 - p);
            assert_eq!(enclosure.seen_from(0), [0.0, 1.0]);
        }
    }
}

fn one_light(f: f64, wall: f64, light: f64, le: f64) -> [Patch; 2] {
    let patch = |fraction, rho, le| Patch { fraction, albedo: Rgb::splat(rho), emission: Rgb::splat(le) };
    [patch(1.0 - f, wall, 0.0), patch(f, light, le)]
}

/// Variance on each patch and rays.
fn variances(patches: &[Patch], estimator: &Estimator, counted: Counted) -> (Vec<f64>, Vec<f64>) {
    let enclosure = Enclosure::sphere(patches);
    let walk = Walk::new(&enclosure, estimator).unwrap();
    let moments = walk.moments(0, counted).unwrap();
    for (i, m) in moments.iter().enumerate() {
        same(m.mean, enclosure.radiance(i, 0, counted));
    }
    (moments.iter().map(|m| m.finite_moment(2).unwrap()).collect(), walk.rays().unwrap())
}

/// Theory C-iv: E R_j^2 of the balance heuristic with one light patch, and B: where all of the sphere emits,
/// N2 = [A^2 + 2 A rho (Le/2 + N1) + (rho^2/q)(Le^2/4 + Le N1)]/(1 - rho^2/q).
#[test]
fn balance_heuristic_with_one_light() {
    for (f, wall, light, q) in [(0.1, 0.6, 0.4, 0.7), (0.4, 0.2, 0.8, 0.65), (0.001, 0.5, 0.5, 0.4)] {
        let le = 5.0;
        let patches = one_light(f, wall, light, le);
        let mean = |x: f64, y: f64| (1.0 - f) * x + f * y;
        let rhobar = mean(wall, light);
        let m = f * le / (1.0 - rhobar);
        let (a, b, re, n1) = (f * le / (1.0 + f), le * f / (1.0 + f), light * m, rhobar * m);
        let k2 = mean(wall * wall, light * light);
        let k = k2 / q;
        let n2 = (k2 * (a * a + 2.0 * a * (f * b + n1)) + k * (f * b * b + 2.0 * f * b * re)) / (1.0 - k);
        let balance = Technique::Both(Heuristic::Balance);
        for pick in [Pick::Power, Pick::Uniform] {
            let (var, rays) = variances(&patches, &explicit(constant(q), balance, pick), Counted::All);
            for (j, rho) in [wall, light].into_iter().enumerate() {
                let second = rho * rho * (a * a + 2.0 * a * (f * b + n1))
                    + rho * rho / q * (f * b * b + 2.0 * f * b * re + n2);
                same(var[j], second - rho * rho * m * m);
                same(rays[j], 2.0 / (1.0 - q));
            }
        }
    }
    for (rho, q, le) in [(0.5_f64, 0.6, 1.7), (0.8, 0.7, 0.3)] {
        let (m, a) = (le / (1.0 - rho), 0.5 * rho * le);
        let (n1, s) = (rho * m, rho * rho / q);
        let n2 = (a * a + 2.0 * a * rho * (0.5 * le + n1) + s * (0.25 * le * le + le * n1)) / (1.0 - s);
        let whole = [Patch { fraction: 1.0, albedo: Rgb::splat(rho), emission: Rgb::splat(le) }];
        // both densities coincide, so that both heuristics weigh one half
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let estimator = explicit(constant(q), Technique::Both(heuristic), Pick::Power);
            same(variances(&whole, &estimator, Counted::All).0[0], n2 - n1 * n1);
        }
    }
}

/// Direct light alone: implicit rho^2 Le^2 f (1 - f), none for a sampled light, and both together the implicit variance
/// times the square of the weight of a hit, f/(1 + f) or f^2/(1 + f^2).
#[test]
fn direct_light_with_both_techniques() {
    let (f, rho, le) = (0.3, 0.6, 2.5);
    let roulette = Roulette { rule: constant(0.8), from: 1, clamp: None };
    for (technique, weight) in [
        (Technique::Light, 0.0),
        (Technique::Direction, 1.0),
        (Technique::Both(Heuristic::Balance), f / (1.0 + f)),
        (Technique::Both(Heuristic::Power), f * f / (1.0 + f * f)),
    ] {
        let estimator = explicit(constant(0.8), technique, Pick::Power).with_roulette(roulette);
        let (var, _) = variances(&one_light(f, rho, rho, le), &estimator, Counted::Only(1));
        same(var[0], (rho * le * weight).powi(2) * f * (1.0 - f));
    }
}

/// d2 = sum (f_l Le_l)^2 / p_l of C-iv, for lights that are all equally likely.
#[test]
fn lights_picked_uniformly() {
    let patch =
        |fraction, rho: f64, le: f64| Patch { fraction, albedo: Rgb::splat(rho), emission: Rgb::splat(le) };
    let patches = [patch(0.3, 0.8, 0.0), patch(0.1, 0.3, 5.0), patch(0.2, 0.5, 0.4), patch(0.4, 0.6, 0.0)];
    let mean = |f: &dyn Fn(&Patch) -> f64| patches.iter().map(|p| p.fraction * f(p)).sum::<f64>();
    let (rho, le, q) = (|p: &Patch| p.albedo[0], |p: &Patch| p.emission[0], 0.75);
    let d2 = 2.0 * patches.iter().map(|p| (p.fraction * le(p)).powi(2)).sum::<f64>();
    let (e0, square) = (mean(&le), mean(&|p| rho(p) * rho(p)));
    let n1 = mean(&rho) * e0 / (1.0 - mean(&rho));
    let n2 = square * (d2 + 2.0 * e0 * n1) / (1.0 - square / q);
    let (var, _) = variances(&patches, &explicit(constant(q), Technique::Light, Pick::Uniform), Counted::All);
    for (p, var) in patches.iter().zip(var) {
        same(var, rho(p).powi(2) * (d2 - e0 * e0 + n2 / q - n1 * n1));
    }
}

/// An explicit estimator that counts hits alone is the implicit one, also where a sampled light has no closed form.
#[test]
fn hits_alone_are_the_implicit_estimator() {
    let (albedo, emission) = (Rgb::new(0.6, 0.5, 0.3), Rgb::new(1.0, 0.3, 2.0));
    let patches = one_light(0.2, 0.6, 0.5, 3.0).to_vec();
    let (view, looks_at) = (View::Irradiance, 0);
    for scene in [
        SceneKind::FurnaceBox { albedo, emission, view },
        SceneKind::IntegratingSphere { patches, looks_at, view },
    ] {
        let form = |estimator| ClosedForm::of(&scene, &estimator).unwrap();
        let hits = form(explicit(constant(0.5), Technique::Direction, Pick::Uniform));
        let walk = form(implicit(constant(0.5)));
        for order in 2..=4 {
            assert_eq!(hits.central(0, Counted::All, order), walk.central(0, Counted::All, order));
        }
        assert_eq!((hits.rays(), hits.tail_index(0)), (walk.rays(), walk.tail_index(0)));
    }
    // both techniques in a box: bounded weights, but a geometry term that varies
    let scene = SceneKind::FurnaceBox { albedo, emission, view };
    let both = explicit(constant(0.5), Technique::Both(Heuristic::Balance), Pick::Power);
    let form = ClosedForm::of(&scene, &both).unwrap();
    assert_eq!((form.central(0, Counted::All, 2), form.rays()), (Known::Unknown, None));
    let dome = Enclosure::dome(gray(0.5, 0.0), gray(0.5, 1.0));
    for technique in [Technique::Light, Technique::Both(Heuristic::Power)] {
        let estimator = explicit(constant(0.5), technique, Pick::Power);
        let walk = Walk::new(&dome, &estimator).unwrap();
        assert_eq!((walk.moments(0, Counted::All), walk.rays()), (None, None));
    }
    let uniform = Estimator::Explicit(Explicit {
        lights: LightSampling::AREA,
        directions: Directions::Uniform,
        roulette: Roulette::unclamped(constant(0.5)),
        technique: Technique::Both(Heuristic::Balance),
    });
    assert!(Walk::new(&Enclosure::furnace(gray(0.5, 1.0)), &uniform).is_none());
}

/// Where nothing emits there is nothing to send a shadow ray to.
#[test]
fn a_dark_sphere_costs_no_shadow_rays() {
    let dark = one_light(0.2, 0.6, 0.5, 0.0);
    for technique in [Technique::Light, Technique::Both(Heuristic::Balance)] {
        let (var, rays) = variances(&dark, &explicit(constant(0.7), technique, Pick::Uniform), Counted::All);
        assert_eq!((var, rays), variances(&dark, &implicit(constant(0.7)), Counted::All));
    }
}

/// C-iv: Var_imp/Var_exp = [(1-rho)(1-rho+2f rho)/f - (q-rho^2)]/(rho^2 (1-q)), and explicit is the more efficient one
/// where that exceeds 2. It tends to 1/rho^2 at f = 1 and to (1-rho)^2/(f rho^2 (1-q)) for small lights.
#[test]
fn sampling_a_light_gains_what_theory_says() {
    for (rho, q) in [(0.3, 0.2), (0.6, 0.5), (0.6, 0.9), (0.8, 0.7), (0.9, 0.95_f64)] {
        let gain = |fraction| OneLight { fraction, albedo: rho, q };
        let limit = largest_light_worth_sampling(rho, q);
        for f in [1e-3, 0.05, 0.3, 0.9, limit * (1.0 - 1e-6), limit * (1.0 + 1e-6)]
            .into_iter()
            .filter(|f| *f < 1.0)
        {
            let patches = one_light(f, rho, rho, 2.0);
            let (imp, imp_rays) = variances(&patches, &implicit(constant(q)), Counted::All);
            let sampled = explicit(constant(q), Technique::Light, Pick::Power);
            let (exp, exp_rays) = variances(&patches, &sampled, Counted::All);
            for j in 0..2 {
                same(gain(f).variance_ratio(), imp[j] / exp[j]);
                let efficiency = (imp[j] * imp_rays[j]) / (exp[j] * exp_rays[j]);
                same(gain(f).efficiency_ratio(), efficiency);
                assert_eq!(efficiency > 1.0, f < limit, "rho {rho}, q {q}, f {f}, limit {limit}");
            }
        }
        same(gain(1.0).variance_ratio(), 1.0 / (rho * rho));
        let small = (1.0 - rho).powi(2) / (1e-9 * rho * rho * (1.0 - q));
        assert!((gain(1e-9).variance_ratio() / small - 1.0).abs() < 1e-6);
        assert_eq!(limit < 1.0, rho > std::f64::consts::FRAC_1_SQRT_2);
    }
}
