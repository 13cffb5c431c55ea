//! How far an image is from its reference, in one number: relative mean squared error, and FLIP, which looks as readers do.
//!
//! Both are pure functions of linear images; neither decides anything: verdicts rest on estimates and their errors.

mod colour;
mod filter;
pub mod flip;
pub mod rel_mse;

use crate::scene::Rgb;

/// A linear image with its noise, row by row from the top left [W m^-2 sr^-1].
#[derive(Clone, Copy, Debug)]
pub struct Image<'a> {
    /// Pixels along a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The means, all finite.
    pub pixels: &'a [Rgb],
    /// Standard errors of the means; `None` where they are not known.
    pub std_error: Option<&'a [Rgb]>,
}

/// An image against its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// [`rel_mse::rel_mse`], less the reference's own noise where that is known.
    pub rel_mse: f64,
    /// Its standard error, [`rel_mse::std_error`]; `None` where the image's noise is not known.
    pub rel_mse_error: Option<f64>,
    /// Mean of HDR-FLIP over the pixels, from 0 (alike) to 1.
    pub flip: f64,
}

/// All metrics of an image.
///
/// # Panics
///
/// If the two differ in size.
pub fn of(image: Image<'_>, reference: Image<'_>) -> Metrics {
    Metrics {
        rel_mse: rel_mse::corrected(image, reference),
        rel_mse_error: rel_mse::std_error(image, reference),
        flip: flip::mean(&flip::hdr(image, reference)),
    }
}

/// What both images must share.
fn assert_same_size(image: &Image<'_>, reference: &Image<'_>) {
    let size = |image: &Image<'_>| (image.width, image.height);
    assert_eq!(size(image), size(reference), "images of different sizes cannot be compared");
    for image in [image, reference] {
        assert_eq!(image.pixels.len(), image.width * image.height, "an image has a pixel for each place");
        let errors = image.std_error.map_or(image.pixels.len(), <[Rgb]>::len);
        assert_eq!(errors, image.pixels.len(), "each pixel has its standard error");
    }
}
