//! Nearest neighbours against integrals over the order statistic and against photons on spheres.

use crate::common::{Random, close, distance, has_mean, has_variance, integrate};
use furnace::truth::Counted;
use furnace::truth::density::nearest::{self, Stored};

const CENTRE: [f64; 3] = [0.0, 0.0, 1.0];

/// Mean and mean square of 1 / (n u), where u is the k-th smallest of n uniform numbers, by quadrature.
fn inverse(k: u64, n: u64) -> (f64, f64) {
    let (before, after) = (k as i32 - 1, (n - k) as i32);
    let mean = |order: i32| {
        let integrand = |u: f64| u.powi(before - order) * (1.0 - u).powi(after);
        integrate(0.0, 1.0, integrand) / (n as f64).powi(order)
    };
    let whole = mean(0);
    (mean(1) / whole, mean(2) / whole)
}

#[test]
fn forms_agree_with_the_order_statistic() {
    for (k, n) in [(3, 3), (3, 50), (4, 9), (10, 40), (25, 60)] {
        let (mean, square) = inverse(k, n);
        let (all, but) = (k as f64, k as f64 - 1.0);
        close(nearest::factor_of_all(k), all * mean, 1e-10);
        close(nearest::factor_without_last(k), but * mean, 1e-10);
        close(nearest::variance_of_all(k, n), all * all * (square - mean * mean), 1e-10);
        close(nearest::variance_without_last(k, n), but * but * (square - mean * mean), 1e-10);
    }
    for k in [3, 7, 100] {
        close(nearest::limit_of_all(k), nearest::variance_of_all(k, 1 << 40), 1e-9);
        close(nearest::limit_without_last(k), nearest::variance_without_last(k, 1 << 40), 1e-9);
    }
}

#[test]
fn few_neighbours_have_no_variance_or_mean() {
    assert_eq!(nearest::factor_of_all(1), f64::INFINITY);
    assert_eq!(nearest::factor_without_last(1), 0.0);
    assert_eq!(nearest::factor_of_all(2), 2.0);
    for infinite in [
        nearest::variance_of_all(2, 9),
        nearest::variance_without_last(2, 2),
        nearest::limit_of_all(2),
        nearest::limit_without_last(2),
    ] {
        assert_eq!(infinite, f64::INFINITY);
    }
    let two = Stored { albedo: 0.5, q: 0.5, photons: 9, k: 2 };
    assert_eq!(two.variance_without_last(Counted::All), f64::INFINITY);
    let wild = Stored { albedo: 0.8, q: 0.6, photons: 9, k: 5 };
    assert_eq!(wild.variance_of_all(Counted::All), f64::INFINITY);
    assert!(wild.variance_of_all(Counted::Only(1)).is_finite());
}

/// Deviations of 1 % of the mean and 8 % of the variance are noticed.
#[test]
fn forms_agree_with_points_on_a_sphere() {
    let (k, n) = (9, 24);
    let mut random = Random::new(11);
    let mut inverse = || {
        let mut distances: Vec<f64> = (0..n).map(|_| distance(random.direction(), CENTRE)).collect();
        distances.sort_by(f64::total_cmp);
        4.0 / (n as f64 * distances[k - 1] * distances[k - 1])
    };
    let samples: Vec<f64> = (0..100_000).map(|_| inverse()).collect();
    let scaled = |by: usize| samples.iter().map(|x| by as f64 * x).collect::<Vec<_>>();
    let (k64, n64) = (k as u64, n as u64);
    has_mean(&scaled(k), nearest::factor_of_all(k64), 0.01);
    has_variance(&scaled(k), nearest::variance_of_all(k64, n64), 0.08);
    has_mean(&scaled(k - 1), nearest::factor_without_last(k64), 0.01);
    has_variance(&scaled(k - 1), nearest::variance_without_last(k64, n64), 0.08);
}

/// Photons whose weights are all 1: their hits are counted by the negative binomial law, and each count has the law above.
#[test]
fn random_counts_are_averaged_over() {
    for (q, photons, k) in [(0.3, 4, 3), (0.5, 12, 12), (0.6, 10, 5)] {
        let mut probability = f64::powi(1.0 - q, photons as i32);
        let mut squares = 0.0;
        for n in photons..photons + 250 {
            squares += probability * (n * n) as f64 * inverse(k, n).1;
            probability *= q * n as f64 / (n + 1 - photons) as f64;
        }
        let stored = Stored { albedo: q, q, photons, k };
        let (truth, count) = (photons as f64 / (1.0 - q), k as f64);
        let relative = |form: f64, mean: f64| form * form * squares / (truth * truth) - mean * mean;
        let factor = count / (count - 1.0);
        close(stored.variance_of_all(Counted::All), relative(count, factor), 1e-8);
        close(stored.variance_without_last(Counted::All), relative(count - 1.0, 1.0), 1e-8);
    }
}

/// One map of weighted hits; the estimates without the last hit and of all, for all hits, the second and those after the
/// first, in units of the photons' power over the sphere's area.
fn map(random: &mut Random, stored: &Stored) -> [f64; 6] {
    let mut hits = Vec::new();
    for _ in 0..stored.photons {
        let (mut position, mut carried) = ([0.0, 0.6, 0.8], 1.0);
        for hit in 0.. {
            position = random.next_hit(position);
            hits.push((distance(position, CENTRE), hit, carried));
            if random.uniform() >= stored.q {
                break;
            }
            carried *= stored.albedo / stored.q;
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let last = stored.k as usize - 1;
    let scale = 4.0 / (hits[last].0 * hits[last].0 * stored.photons as f64);
    let sum = |count: usize, counts: fn(u32) -> bool| {
        scale * hits[..count].iter().filter(|hit| counts(hit.1)).map(|hit| hit.2).sum::<f64>()
    };
    let both = |counts: fn(u32) -> bool| [sum(last, counts), sum(last + 1, counts)];
    let (all, second, later) = (both(|_| true), both(|hit| hit == 1), both(|hit| hit >= 1));
    [all[0], all[1], second[0], second[1], later[0], later[1]]
}

/// Deviations of 2 % of the mean and 9 % of the variance are noticed.
#[test]
fn maps_of_weighted_hits_have_that_variance() {
    let cases = [
        Stored { albedo: 0.5, q: 0.5, photons: 12, k: 12 },
        Stored { albedo: 0.4, q: 0.6, photons: 14, k: 10 },
        Stored { albedo: 0.6, q: 0.56, photons: 11, k: 11 },
    ];
    for (seed, stored) in (20..).zip(cases) {
        let mut random = Random::new(seed);
        let maps: Vec<[f64; 6]> = (0..100_000).map(|_| map(&mut random, &stored)).collect();
        let column = |i: usize| maps.iter().map(|map| map[i]).collect::<Vec<_>>();
        let albedo = stored.albedo;
        let (all, second) = (1.0 / (1.0 - albedo), albedo);
        let counted = [(Counted::All, all), (Counted::Only(1), second), (Counted::From(1), all - 1.0)];
        for (i, (counted, truth)) in counted.into_iter().enumerate() {
            has_mean(&column(2 * i), truth, 0.02);
            has_mean(&column(2 * i + 1), truth * nearest::factor_of_all(stored.k), 0.02);
            let square = truth * truth;
            has_variance(&column(2 * i), square * stored.variance_without_last(counted), 0.09);
            has_variance(&column(2 * i + 1), square * stored.variance_of_all(counted), 0.09);
        }
    }
}
