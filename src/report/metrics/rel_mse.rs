//! Relative mean squared error: mean of (x - r)² / (r² + ε) over pixels and channels, after Rousselle, Knaus and Zwicker,
//! "Adaptive Sampling and Reconstruction using Greedy Error Minimization", 2011.

use super::{Image, assert_same_size};
use crate::scene::Rgb;

/// What keeps dark pixels from deciding everything [(W m^-2 sr^-1)²]: the value that has become usual.
pub const EPSILON: f64 = 0.01;

/// As published: the reference is taken for exact.
///
/// # Panics
///
/// If the two differ in size.
pub fn rel_mse(image: Image<'_>, reference: Image<'_>) -> f64 {
    assert_same_size(&image, &reference);
    let squared = image.pixels.iter().zip(reference.pixels).map(|(&x, &r)| (x - r) * (x - r));
    mean(squared, reference)
}

/// Less what the reference's own noise adds on average: the square of its standard error. So it may be negative where image
/// and reference are about as noisy. What that noise does to the denominator is left; the same as [`rel_mse`] where the
/// reference has no standard errors.
///
/// # Panics
///
/// If the two differ in size.
pub fn corrected(image: Image<'_>, reference: Image<'_>) -> f64 {
    rel_mse(image, reference) - reference.std_error.map_or(0.0, |error| noise(error, reference))
}

/// Standard error of [`corrected`]: how much it would differ from run to run, were image and reference made anew. `None`
/// where the image's noise is not known.
///
/// Means of many samples are taken for normal, and the channels of a pixel, which share their paths, for moving together:
/// with differences d = b + s z of one z a pixel, and weights w = 1 / (r² + ε), the sum of w d² varies by
/// 2 S² + 4 B², S = Σ w s², B = Σ w b s. As the mean of (Σ w d s)² is B² + S², B² is estimated without bias; its sum over all
/// pixels is not taken below 0. The denominator is taken for exact. Pixels are taken for independent, which they are not where paths are shared between
/// them, as by light tracing and photon maps: there this is too small.
///
/// # Panics
///
/// If the two differ in size.
pub fn std_error(image: Image<'_>, reference: Image<'_>) -> Option<f64> {
    assert_same_size(&image, &reference);
    let errors = image.std_error?;
    let pixel = |i: usize| {
        let (r, of_reference) =
            (reference.pixels[i], reference.std_error.map_or(Rgb::ZERO, |error| error[i]));
        let weight = 1.0 / (r * r + EPSILON);
        let squared = errors[i] * errors[i] + of_reference * of_reference;
        let error = Rgb::from_array(squared.to_array().map(f64::sqrt));
        let (noise, bias) = (weight.dot(squared), weight.dot((image.pixels[i] - r) * error));
        (noise * noise, bias * bias - noise * noise)
    };
    let (noise, bias) =
        (0..errors.len()).map(pixel).fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    Some((2.0 * noise + 4.0 * bias.max(0.0)).sqrt() / (3 * errors.len()) as f64)
}

/// The relative squared error that noise alone adds: mean of s² / (r² + ε). From the standard error of one sample, the
/// square root of its variance, it gives the noise of one, of which an image of N samples has the Nth part; to that its
/// bias adds [`noise`] of that bias.
pub fn noise(std_error: &[Rgb], reference: Image<'_>) -> f64 {
    assert_eq!(std_error.len(), reference.pixels.len(), "each pixel has its standard error");
    mean(std_error.iter().map(|&s| s * s), reference)
}

/// The mean over pixels and channels of squares, each relative to the reference there.
fn mean(squares: impl Iterator<Item = Rgb>, reference: Image<'_>) -> f64 {
    let relative = squares.zip(reference.pixels).map(|(square, &r)| square / (r * r + EPSILON));
    relative.map(|pixel| pixel.element_sum()).sum::<f64>() / (3 * reference.pixels.len()) as f64
}
