//! Whatever q is, roulette and splitting leave the mean alone: every rule, every estimator of the catalogue, without a
//! clamp. And q is what each rule says it is.
//!
//! False alarms: about 400 t tests with 255 degrees of freedom, each beyond [`LIMIT`] with probability 6e-15, together
//! 3e-12; the rest up to 1e-9 is left for what skewness does to t.

use furnace::estimator::{Ctx, Estimator, Roulette, Rule, Tally};
use furnace::experiment::sample;
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, Rgb};
use furnace::stats::Moments;
use furnace::truth::{ClosedForm, Counted, Known, Reference};

const LIMIT: f64 = 8.3;
const BLOCKS: u64 = 256;

const RULES: [Rule; 5] = [
    Rule::Constant { q: 0.45 },
    Rule::Constant { q: 0.8 },
    Rule::Albedo,
    Rule::Throughput { floor: 0.05 },
    Rule::Throughput { floor: 0.3 },
];

fn directions(estimator: &Estimator) -> Directions {
    match estimator {
        Estimator::Implicit(e) => e.directions,
        Estimator::Explicit(e) => e.directions,
        Estimator::Recursive(e) => e.directions,
        Estimator::LightTracing(e) => e.directions,
        Estimator::PhotonMap(e) => e.directions,
    }
}

/// The catalogue under all rules. The recursive estimator follows two samples, each with q, so its tree ends only if
/// q < 1/2 in the long run: throughput sees to that by itself, as it is halved at each vertex.
fn catalogue(max_albedo: f64) -> Vec<Estimator> {
    let ends = |estimator: &Estimator| match (estimator, estimator.roulette().rule) {
        (Estimator::Recursive(_), Rule::Constant { q }) => q < 0.5,
        (Estimator::Recursive(_), Rule::Albedo) => max_albedo < 0.5,
        _ => true,
    };
    let all = RULES.iter().flat_map(|&rule| Estimator::catalogue(Roulette::unclamped(rule)));
    all.filter(ends).collect()
}

#[track_caller]
fn unbiased(scene: &SceneKind, estimator: &Estimator, block: u64, expected: Rgb, error: Rgb) {
    let address = Address::of(&["roulette_keeps_the_mean", &format!("{scene:?} {estimator:?}")]);
    let cell = sample(&scene.build(), estimator, &address, BLOCKS * block, block);
    assert_eq!(cell.invalid(), None);
    for c in 0..3 {
        let (mean, se) = (cell.blocks[c].mean, cell.blocks[c].std_error().unwrap().hypot(error[c]));
        let t = (mean - expected[c]) / se;
        assert!(t.abs() < LIMIT, "{estimator:?} in {scene:?}: {mean} instead of {}, t = {t}", expected[c]);
        // power: a bias of 20 % is seen; survivors that are weighted wrongly change each later bounce by a factor
        assert!(LIMIT * se < 0.2 * expected[c], "{estimator:?} in {scene:?} is too noisy: {se} of {mean}");
    }
}

#[test]
fn where_there_is_a_closed_form() {
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let (albedo, emission, view) = (Rgb::new(0.4, 0.3, 0.2), Rgb::new(1.0, 2.0, 0.5), View::Probe);
    let patches = vec![
        patch(0.6, albedo, Rgb::ZERO),
        patch(0.15, Rgb::new(0.2, 0.4, 0.1), emission),
        patch(0.25, Rgb::new(0.1, 0.35, 0.4), Rgb::new(0.2, 0.5, 1.0)),
    ];
    let scenes = [
        SceneKind::Furnace { albedo, emission, view },
        SceneKind::FurnaceBox { albedo, emission, view },
        SceneKind::IntegratingSphere { patches, looks_at: 0, view },
    ];
    let mut infinite = 0;
    for (scene, estimator) in scenes.iter().flat_map(|s| catalogue(0.4).into_iter().map(move |e| (s, e))) {
        let form = ClosedForm::of(scene, &estimator).unwrap();
        if form.central(0, Counted::All, 2) == Known::Infinite {
            infinite += 1; // no sound test of a mean
            continue;
        }
        let right = [0, 1, 2].map(|c| form.truth(c, Counted::All));
        unbiased(scene, &estimator, 96, Rgb::from_array(right), Rgb::ZERO);
    }
    // light sampled over the area of the box, whose walls touch: two kinds of directions and of picks under each rule
    assert_eq!(infinite, 4 * RULES.len());
}

/// Against the image means of an independent renderer, with its standard errors added.
#[test]
fn in_the_cornell_box() {
    let scene = SceneKind::CornellBox { resolution: 8 };
    let stored = Reference::of(&scene).unwrap().image();
    for estimator in catalogue(scene.build().max_albedo()) {
        // uniform directions weigh up to twice the albedo / q; only where throughput decides is the product bounded,
        // and without bounds higher moments are infinite and no t test is sound
        let bounded = matches!(estimator.roulette().rule, Rule::Throughput { .. });
        // with q = .45 and an albedo of .89 the second moment is infinite for one walk
        let small_q = estimator.roulette().rule == RULES[0] && !matches!(estimator, Estimator::Recursive(_));
        if !small_q && (bounded || directions(&estimator) == Directions::Cosine) {
            let passes = if estimator.samples_lights() { 8 } else { 14 };
            unbiased(&scene, &estimator, passes, stored.mean, stored.std_error);
        }
    }
}

#[test]
fn q_is_what_the_rule_says() {
    let (beta, albedo) = (Rgb::new(0.5, 2.0, 0.1), Rgb::new(0.6, 0.2, 0.3));
    let q = |rule, beta, albedo| Roulette::unclamped(rule).q(3, beta, albedo);
    let throughput = |floor| Rule::Throughput { floor };
    assert_eq!(q(Rule::None, beta, albedo), 1.0);
    for constant in [0.1, 0.5, 1.0, 2.7] {
        assert_eq!(q(Rule::Constant { q: constant }, beta, albedo), constant);
    }
    assert_eq!(q(Rule::Albedo, beta, albedo), 0.6);
    assert_eq!(q(throughput(0.05), beta, albedo), 0.4); // green: 2 x 0.2
    assert_eq!(q(throughput(0.7), beta, albedo), 0.7);
    assert_eq!(q(throughput(0.05), 10.0 * beta, albedo), 1.0);
    assert_eq!(q(throughput(0.05), Rgb::new(1e-9, 0.0, 0.0), albedo), 0.05);
    assert_eq!(q(throughput(0.05), Rgb::ZERO, albedo), 0.0); // nor does a path that carries nothing
    for rule in RULES.into_iter().chain([Rule::None, Rule::Constant { q: 2.7 }]) {
        assert_eq!(q(rule, beta, Rgb::ZERO), 0.0); // nothing goes on from black, not even at the floor
        for from in [1, 4] {
            let roulette = Roulette { rule, from, clamp: None };
            for bounce in 0..8 {
                let later = q(rule, beta, albedo);
                assert_eq!(roulette.q(bounce, beta, albedo), if bounce < from { 1.0 } else { later });
                assert_eq!(roulette.q(bounce, beta, Rgb::ZERO), 0.0);
            }
        }
    }
}

#[test]
fn a_clamp_counts_bounces() {
    for bounce in 0..10 {
        assert!(Roulette::unclamped(Rule::Albedo).reaches(bounce));
        for clamp in 0..10 {
            assert_eq!(Roulette::depth_clamp(clamp).reaches(bounce), bounce <= clamp);
        }
    }
}

/// floor(q + u) copies: one of the two integers next to q, and q on average. The count less its floor is a Bernoulli
/// variable of known variance; each z is beyond 8 with probability 1e-15.
#[test]
fn copies_are_q_on_average() {
    let scene = SceneKind::CornellEmpty { resolution: 1 }.build();
    for q in [0.0_f64, 0.1, 0.5, 1.0, 1.5, 2.0, 2.7] {
        let (mut tally, mut counts) = (Tally::default(), Moments::default());
        let mut stream = Address::of(&["copies", &q.to_string()]).stream(0, 0);
        let start = scene.start((0, 0), &mut stream);
        let mut cx = Ctx::new(&scene, stream, &mut tally, &start);
        for _ in 0..1 << 18 {
            let copies = f64::from(cx.copies(q));
            assert!(copies == q.floor() || copies == q.ceil());
            counts.push(copies);
        }
        let error = (q.fract() * (1.0 - q.fract()) / counts.n as f64).sqrt();
        assert!((counts.mean - q).abs() <= 8.0 * error, "{} copies instead of {q}", counts.mean);
    }
}
