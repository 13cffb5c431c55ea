//! FLIP: the difference that is seen when two images are flipped back and forth, from 0 to 1 at each pixel.
//!
//! After Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating
//! Images", 2020, and, for images brighter than a screen, Andersson, Nilsson, Shirley and Akenine-Möller, "Visualizing
//! Errors in Rendered High Dynamic Range Images", 2021. In double precision, so it differs from the authors' own program
//! in the seventh digit of a pixel or so.

use super::colour::{Colours, hyab};
use super::filter::{filter, normalised, taps};
use super::{Image, assert_same_size};
use crate::scene::Rgb;
use glam::DVec3;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Of the reader's sight: a screen 3840 pixels and 0.7 m wide, seen from 0.7 m. About 67.02.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// How far colours blur, fitted to how sensitive sight is to each frequency: weights exp(-π² x²/b) at a distance of x
/// degrees, for brightness and for red against green.
const BRIGHTNESS: f64 = 0.0047;
const RED_GREEN: f64 = 0.0053;

/// For blue against yellow, pairs (a, b): the sum of a √(π/b) exp(-π² x²/b).
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];

/// Differences of colour are raised to this power; those of features to a half.
const COLOUR_POWER: f64 = 0.7;

/// Colour differences up to this share of the largest fill this part of the range: small ones count more.
const KNEE: (f64, f64) = (0.4, 0.95);

/// Width of the edges and points that are looked for [degrees].
const FEATURE: f64 = 0.082;

/// Mean over the pixels of a map.
pub fn mean(map: &[f64]) -> f64 {
    map.iter().sum::<f64>() / map.len() as f64
}

/// LDR-FLIP at each pixel, of colours that a screen shows: linear, clipped to 0 ... 1.
///
/// # Panics
///
/// If the two differ in size.
pub fn ldr(image: Image<'_>, reference: Image<'_>) -> Vec<f64> {
    assert_same_size(&image, &reference);
    let eye = Eye::new();
    let clipped = |image: Image<'_>| -> Vec<Rgb> {
        image.pixels.iter().map(|colour| colour.clamp(Rgb::ZERO, Rgb::ONE)).collect()
    };
    eye.difference(&clipped(image), &clipped(reference), image.width)
}

/// HDR-FLIP at each pixel: the largest LDR-FLIP over exposures, from one that shows the reference's brightest pixel well to
/// one that shows its median so, about a stop apart. Negative radiance counts as 0. A median of 0 counts as the
/// smallest difference from 1 in single precision, 1.2e-7, as in the authors' program; here a black reference does too.
///
/// # Panics
///
/// If the two differ in size.
pub fn hdr(image: Image<'_>, reference: Image<'_>) -> Vec<f64> {
    assert_same_size(&image, &reference);
    let eye = Eye::new();
    let mut worst = vec![0.0; image.pixels.len()];
    for stops in exposures(reference.pixels) {
        let shown = |image: Image<'_>| -> Vec<Rgb> {
            image.pixels.iter().map(|&colour| shown(colour * libm::exp2(stops))).collect()
        };
        let map = eye.difference(&shown(image), &shown(reference), image.width);
        worst.iter_mut().zip(map).for_each(|(worst, here)| *worst = here.max(*worst));
    }
    worst
}

/// The film curve that Narkowicz (2015) fitted to ACES, of 0.6 times the radiance: (a x² + b x) / (c x² + d x + e).
const FILM: [f64; 5] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];

/// What a screen shows of a radiance.
fn shown(colour: Rgb) -> Rgb {
    let [a, b, c, d, e] = FILM;
    let curve = |x: f64| ((a * x + b) * x / ((c * x + d) * x + e)).clamp(0.0, 1.0);
    Rgb::from_array(colour.max(Rgb::ZERO).to_array().map(curve))
}

/// Exposures in stops, from that of the brightest pixel to that of the median, at least two.
fn exposures(reference: &[Rgb]) -> impl Iterator<Item = f64> {
    /// Of a screen's white.
    const WELL_SHOWN: f64 = 0.85;
    let [a, b, c, d, e] = FILM;
    // the radiance that is shown so: the positive root of a quadratic
    let (p, q, r) = (a - WELL_SHOWN * c, b - WELL_SHOWN * d, -WELL_SHOWN * e);
    let well = (-q + (q * q - 4.0 * p * r).sqrt()) / (2.0 * p);
    let luminance = |colour: &Rgb| colour.dot(Rgb::new(0.2126, 0.7152, 0.0722));
    let mut sorted: Vec<f64> = reference.iter().map(luminance).collect();
    sorted.sort_by(f64::total_cmp);
    let stops = |luminance: f64| libm::log2(well / luminance.max(f64::from(f32::EPSILON)));
    let (start, stop) = (stops(sorted[sorted.len() - 1]), stops(sorted[sorted.len() / 2]));
    let count = (stop - start).ceil().max(2.0);
    (0..count as usize).map(move |i| start + (stop - start) * i as f64 / (count - 1.0))
}

/// The filters of sight, and colours.
struct Eye {
    colours: Colours,
    /// The largest difference of two colours of a screen: green and blue.
    largest: f64,
    brightness: Vec<f64>,
    red_green: Vec<f64>,
    /// With their parts of the whole.
    blue_yellow: [(f64, Vec<f64>); 2],
    blur: Vec<f64>,
    edge: Vec<f64>,
    point: Vec<f64>,
}

/// What is seen of a picture.
struct Seen {
    /// Colours in CIELAB, blurred.
    lab: Vec<DVec3>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Eye {
    fn new() -> Self {
        let widest = BLUE_YELLOW[0].1;
        let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
        let gaussian = |b: f64| {
            let degrees = |x: f64| x / PIXELS_PER_DEGREE;
            taps(radius, |x| libm::exp(-PI * PI * degrees(x) * degrees(x) / b))
        };
        let weight = |(a, b): (f64, f64)| {
            let sum: f64 = gaussian(b).iter().sum();
            a * (PI / b).sqrt() * sum * sum
        };
        let whole: f64 = BLUE_YELLOW.into_iter().map(weight).sum();
        let sigma = 0.5 * FEATURE * PIXELS_PER_DEGREE;
        let feature = |f: &dyn Fn(f64) -> f64| {
            let taps =
                taps((3.0 * sigma).ceil() as usize, |x| f(x) * libm::exp(-x * x / (2.0 * sigma * sigma)));
            normalised(taps)
        };
        let colours = Colours::new();
        let largest = hyab(colours.hunt_lab(Rgb::Y), colours.hunt_lab(Rgb::Z));
        Eye {
            largest: libm::pow(largest, COLOUR_POWER),
            colours,
            brightness: normalised(gaussian(BRIGHTNESS)),
            red_green: normalised(gaussian(RED_GREEN)),
            blue_yellow: BLUE_YELLOW.map(|part| (weight(part) / whole, normalised(gaussian(part.1)))),
            blur: feature(&|_| 1.0),
            edge: feature(&|x| -x),
            point: feature(&|x| x * x / (sigma * sigma) - 1.0),
        }
    }

    /// LDR-FLIP at each pixel of two pictures as a screen shows them.
    fn difference(&self, image: &[Rgb], reference: &[Rgb], width: usize) -> Vec<f64> {
        let (a, b) = (self.see(image, width), self.see(reference, width));
        let pixel = |i: usize| {
            let colour = self.colour_difference(a.lab[i], b.lab[i]);
            let feature = (a.edges[i] - b.edges[i]).abs().max((a.points[i] - b.points[i]).abs());
            // where features differ, a difference of colour is seen all the more
            libm::pow(colour, 1.0 - (FRAC_1_SQRT_2 * feature).sqrt().min(1.0))
        };
        (0..image.len()).map(pixel).collect()
    }

    /// From 0 to 1.
    fn colour_difference(&self, a: DVec3, b: DVec3) -> f64 {
        let difference = libm::pow(hyab(a, b), COLOUR_POWER) / self.largest;
        let (share, filled) = KNEE;
        if difference < share {
            difference * filled / share
        } else {
            filled + (difference - share) / (1.0 - share) * (1.0 - filled)
        }
    }

    fn see(&self, picture: &[Rgb], width: usize) -> Seen {
        let opponent: Vec<DVec3> = picture.iter().map(|&colour| self.colours.opponent(colour)).collect();
        let plane = |channel: usize| -> Vec<f64> { opponent.iter().map(|colour| colour[channel]).collect() };
        let brightness = plane(0);
        let both = |plane: &[f64], taps: &[f64]| filter(plane, width, taps, taps);
        let (seen, red_green) = (both(&brightness, &self.brightness), both(&plane(1), &self.red_green));
        let parts = self.blue_yellow.each_ref().map(|(part, taps)| (part, both(&plane(2), taps)));
        let lab = |i: usize| {
            let blue_yellow = parts.iter().map(|(part, plane)| *part * plane[i]).sum();
            let colour = self.colours.of_opponent(DVec3::new(seen[i], red_green[i], blue_yellow));
            self.colours.hunt_lab(colour.clamp(Rgb::ZERO, Rgb::ONE))
        };
        let feature = |taps: &[f64]| -> Vec<f64> {
            let [x, y] =
                [(taps, &self.blur[..]), (&self.blur, taps)].map(|(r, c)| filter(&brightness, width, r, c));
            // of a brightness from 0 to 116
            x.iter().zip(&y).map(|(x, y)| (x * x + y * y).sqrt() / 116.0).collect()
        };
        Seen {
            lab: (0..picture.len()).map(lab).collect(),
            edges: feature(&self.edge),
            points: feature(&self.point),
        }
    }
}
