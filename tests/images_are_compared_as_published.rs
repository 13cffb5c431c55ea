//! Promise: FLIP and HDR-FLIP are what their authors' program gives; relative mean squared errors are what they are said to
//! be, with errors that tell how far they scatter.

use furnace::report::metrics::{self, Image, Metrics, flip, rel_mse};
use furnace::scene::Rgb;
use rand::RngExt;
use rand_pcg::Pcg64;
use std::time::Instant;

/// Mean, largest value, and values at a third and two thirds of the pixels of the map; from `golden/flip.py`.
const GOLDEN: [(&str, &str, [f64; 4]); 13] = [
    ("noise", "LDR", [0.3988245, 0.8978248, 0.3232554, 0.4154438]),
    ("noise", "HDR", [0.3606324, 0.8694177, 0.304901, 0.3011014]),
    ("edge", "LDR", [0.1252823, 0.6786063, 0.07506423, 0.04257486]),
    ("edge", "HDR", [0.0752927, 0.4058874, 0.05503278, 0.01872986]),
    ("box", "LDR", [0.1303017, 0.4354499, 0.2132934, 0.1432127]),
    ("box", "HDR", [0.1807061, 0.4322091, 0.1993339, 0.1721359]),
    ("large box", "LDR", [0.1181338, 0.4771511, 0.1514172, 0.1376926]),
    ("large box", "HDR", [0.1735427, 0.4696696, 0.1651634, 0.1962606]),
    ("steep", "LDR", [0.1217467, 0.4554453, 0.09453094, 0.119057]),
    ("steep", "HDR", [0.1576024, 0.3668021, 0.2111645, 0.09876005]),
    ("black", "LDR", [0.971283, 0.9827995, 0.9658523, 0.9701827]),
    ("alike", "LDR", [0.0, 0.0, 0.0, 0.0]),
    ("alike", "HDR", [0.0, 0.0, 0.0, 0.0]),
];

/// What single precision leaves of a mean, and of a pixel, where roots of small differences are taken.
const OF_MEAN: f64 = 4e-6;
const OF_PIXEL: f64 = 1.5e-5;

/// In 0 ... 1, with 24 bits.
fn random(i: usize) -> f64 {
    let mut x = (i as u32).wrapping_mul(2_654_435_761);
    x ^= x >> 16;
    x = x.wrapping_mul(2_246_822_519);
    x ^= x >> 13;
    f64::from(x >> 8) / f64::from(1 << 24)
}

/// A picture's size and the place of a pixel.
#[derive(Clone, Copy)]
struct At {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
}

fn noise(seed: usize, at: At) -> Rgb {
    let first = seed * 1_000_003 + 3 * (at.y * at.width + at.x);
    Rgb::from_array([0, 1, 2].map(|c| random(first + c)))
}

fn edge(place: usize, at: At) -> Rgb {
    if at.x < place { Rgb::new(0.875, 0.25, 0.125) } else { Rgb::new(0.125, 0.25, 0.75) }
}

fn cornell(at: At) -> Rgb {
    let At { x, y, width, height } = at;
    if 8 * y < height && (3 * width..5 * width).contains(&(8 * x)) {
        return Rgb::new(16.0, 12.0, 8.0);
    }
    let wall = match 4 * x / width {
        0 => Rgb::new(0.5, 0.0625, 0.0625),
        3 => Rgb::new(0.0625, 0.5, 0.0625),
        _ => Rgb::splat(0.5),
    };
    wall * (height - y) as f64 / height as f64
}

fn steep(at: At) -> Rgb {
    let stops = (16.0 * noise(4, at).x - 8.0) as i32;
    f64::from(stops).exp2() * (0.5 + noise(5, at))
}

fn noisy(picture: fn(At) -> Rgb, seed: usize, at: At) -> Rgb {
    picture(at) * (0.5 + noise(seed, at))
}

/// In the precision of a file.
fn picture(width: usize, height: usize, formula: impl Fn(At) -> Rgb) -> Vec<Rgb> {
    let pixel = |i: usize| formula(At { x: i % width, y: i / width, width, height }).as_vec3().as_dvec3();
    (0..width * height).map(pixel).collect()
}

fn image(width: usize, pixels: &[Rgb]) -> Image<'_> {
    Image { width, height: pixels.len() / width, pixels, std_error: None }
}

/// Width, reference and image of a pair.
fn pair(name: &str) -> (usize, Vec<Rgb>, Vec<Rgb>) {
    let of = |width, height, reference: &dyn Fn(At) -> Rgb, image: &dyn Fn(At) -> Rgb| {
        (width, picture(width, height, reference), picture(width, height, image))
    };
    match name {
        "noise" => of(32, 32, &|at| noise(1, at), &|at| noise(2, at)),
        "edge" => of(48, 20, &|at| edge(24, at), &|at| edge(27, at)),
        "box" => of(32, 32, &cornell, &|at| noisy(cornell, 3, at)),
        "large box" => of(128, 128, &cornell, &|at| noisy(cornell, 3, at)),
        "steep" => of(24, 40, &steep, &|at| noisy(steep, 6, at)),
        "black" => of(16, 8, &|_| Rgb::ZERO, &|at| noise(7, at)),
        _ => of(16, 8, &cornell, &cornell),
    }
}

#[test]
fn flip_is_that_of_its_authors() {
    for (name, kind, [mean, largest, third, two_thirds]) in GOLDEN {
        let (width, reference, compared) = pair(name);
        let compare = if kind == "LDR" { flip::ldr } else { flip::hdr };
        let map = compare(image(width, &compared), image(width, &reference));
        let found = [
            flip::mean(&map),
            map.iter().copied().fold(0.0, f64::max),
            map[map.len() / 3],
            map[map.len() * 2 / 3],
        ];
        for (i, (found, right)) in found.into_iter().zip([mean, largest, third, two_thirds]).enumerate() {
            let error = if i == 0 { OF_MEAN } else { OF_PIXEL };
            assert!((found - right).abs() < error, "{name}, {kind}: {found} for {right}");
        }
    }
}

#[test]
fn flip_is_quick() {
    let (width, reference, compared) = pair("large box");
    let start = Instant::now();
    let map = flip::hdr(image(width, &compared), image(width, &reference));
    let seconds = start.elapsed().as_secs_f64();
    println!("HDR-FLIP of {} pixels: {seconds:.3} s", map.len());
    // ten times what it takes
    assert!(seconds < 2.0, "{seconds} s");
}

#[test]
fn a_black_reference_has_exposures_too() {
    let (width, reference, compared) = pair("black");
    let map = flip::hdr(image(width, &compared), image(width, &reference));
    assert!(map.iter().all(|&value| (0.9..=1.0).contains(&value)), "{map:?}");
    assert!(flip::hdr(image(width, &reference), image(width, &reference)).iter().all(|&value| value == 0.0));
}

#[test]
fn relative_errors_are_as_defined() {
    let (x, r) = ([Rgb::new(1.0, 2.0, 3.0), Rgb::ZERO], [Rgb::new(0.0, 2.0, 4.0), Rgb::ZERO]);
    let by_hand = (1.0 / 0.01 + 1.0 / 16.01) / 6.0;
    let (x, r) = (image(2, &x), image(2, &r));
    assert!((rel_mse::rel_mse(x, r) - by_hand).abs() < 1e-12);
    let all = metrics::of(x, r);
    let flip = flip::mean(&flip::hdr(x, r));
    assert_eq!(all, Metrics { rel_mse: rel_mse::rel_mse(x, r), rel_mse_error: None, flip });
    let error = [Rgb::splat(0.1); 2];
    let [x, r] = [x, r].map(|image| Image { std_error: Some(&error), ..image });
    let (corrected, error) = (rel_mse::corrected(x, r), rel_mse::std_error(x, r));
    assert!(error.is_some() && corrected < rel_mse::rel_mse(x, r));
    assert_eq!(metrics::of(x, r), Metrics { rel_mse: corrected, rel_mse_error: error, flip });
}

/// Of mean 0 and variance 1.
fn normal(rng: &mut Pcg64) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.random::<f64>()).cos()
}

/// Mean and standard deviation.
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0)).sqrt())
}

#[test]
fn errors_of_relative_errors_tell_how_they_scatter() {
    const RUNS: usize = 2000;
    let mut rng = Pcg64::new(1, 2);
    let right = picture(16, 16, |at| 0.2 + noise(1, at));
    let bias = picture(16, 16, |at| 0.1 * (noise(2, at) - 0.3));
    let large = picture(16, 16, |at| 0.01 + 0.1 * noise(3, at));
    // a reference's noise is small, as it also shakes the denominator
    let small = picture(16, 16, |at| 0.005 + 0.01 * noise(4, at));
    let tiny: Vec<Rgb> = small.iter().map(|&error| 0.1 * error).collect();
    let none = vec![Rgb::ZERO; 256];
    for (bias, of_image, of_reference) in [
        (&bias, &large, &small),
        (&bias, &large, &none),
        (&none, &large, &none),
        (&bias, &small, &none),
        (&bias, &tiny, &small),
    ] {
        let mut run = |_| {
            let x: Vec<Rgb> = (0..256).map(|i| right[i] + bias[i] + of_image[i] * normal(&mut rng)).collect();
            let r: Vec<Rgb> = (0..256).map(|i| right[i] + of_reference[i] * normal(&mut rng)).collect();
            let x = Image { std_error: Some(of_image), ..image(16, &x) };
            let r = Image { std_error: Some(of_reference), ..image(16, &r) };
            (rel_mse::corrected(x, r), rel_mse::std_error(x, r).unwrap())
        };
        let (found, errors): (Vec<f64>, Vec<f64>) = (0..RUNS).map(&mut run).unzip();
        let ((mean, scatter), (error, _)) = (moments(&found), moments(&errors));
        let expected = rel_mse::noise(of_image, image(16, &right)) + rel_mse::noise(bias, image(16, &right));
        // what a reference's noise does to the denominator is left
        let left = if of_reference == &none { 0.0 } else { 0.03 * expected };
        let tolerance = 4.0 * scatter / (RUNS as f64).sqrt() + left;
        assert!((mean - expected).abs() < tolerance, "{mean} for {expected}, within {tolerance}");
        // a standard deviation of so many is known to 1.6 %; squares have longer tails
        assert!((error / scatter - 1.0).abs() < 0.12, "said {error}, scatters {scatter}");
    }
}

#[test]
#[should_panic(expected = "different sizes")]
fn sizes_must_agree() {
    let pixels = [Rgb::ZERO; 6];
    metrics::of(image(2, &pixels), image(3, &pixels));
}
