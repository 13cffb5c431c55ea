//! Mistakes in how paths become one value.

use super::slip::Averaging;
use super::survival::luminance;
use super::walk::{Record, Walk};
use crate::estimator::{BINS, Ctx};
use crate::scene::{Ray, Rgb};

/// Value to which [`Averaging::Clamped`] limits each channel of a path [W m^-2 sr^-1].
pub const LIMIT: f64 = 4.0;
/// Paths of one realization of [`Averaging::Adaptive`], at most and at least.
const PATHS: (u32, u32) = (64, 4);
/// The standard error, over the mean, at which it stops.
const ENOUGH: f64 = 0.2;

type Bins = [Rgb; BINS];

/// Draws one sample.
pub fn estimate(averaging: Averaging, walk: &Walk, ray: Ray, cx: &mut Ctx<'_>) {
    let bins = match averaging {
        Averaging::Clamped => clamped(path(walk, ray, cx)),
        Averaging::Adaptive => adaptive(walk, ray, cx),
    };
    (0..).zip(bins).for_each(|(bounce, radiance)| cx.add(bounce, radiance));
}

fn path(walk: &Walk, ray: Ray, cx: &mut Ctx<'_>) -> Bins {
    let mut bins = [Rgb::ZERO; BINS];
    walk.trace(ray, cx, &mut Record::Held(&mut bins));
    bins
}

fn clamped(bins: Bins) -> Bins {
    let total: Rgb = bins.iter().sum();
    let factor = |x: f64| if x > LIMIT { LIMIT / x } else { 1.0 };
    let factor = Rgb::new(factor(total.x), factor(total.y), factor(total.z));
    bins.map(|radiance| radiance * factor)
}

/// The mean of the paths so far, as soon as they seem to agree.
fn adaptive(walk: &Walk, ray: Ray, cx: &mut Ctx<'_>) -> Bins {
    let (mut sum, mut n, mut first, mut second) = ([Rgb::ZERO; BINS], 0.0, 0.0, 0.0);
    for paths in 1..=PATHS.0 {
        let bins = path(walk, ray, cx);
        let value = luminance(bins.iter().sum());
        sum.iter_mut().zip(bins).for_each(|(sum, radiance)| *sum += radiance);
        (n, first, second) = (n + 1.0, first + value, second + value * value);
        let squared_error = (second - first * first / n) / ((n - 1.0) * n);
        let mean = first / n;
        if paths >= PATHS.1 && squared_error <= ENOUGH * ENOUGH * mean * mean {
            break;
        }
    }
    sum.map(|radiance| radiance / n)
}
