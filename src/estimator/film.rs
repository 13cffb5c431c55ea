//! What particles have left on the image of one realization.

use crate::scene::Rgb;

/// Contributions by pixel and bounce.
#[derive(Clone, Debug, Default)]
pub struct Film {
    splats: Vec<(u32, u32, Rgb)>,
}

impl Film {
    /// Adds radiance [W m^-2 sr^-1] of light scattered `bounce` times to the mean of a pixel.
    #[inline]
    pub fn add(&mut self, pixel: u32, bounce: u32, radiance: Rgb) {
        self.splats.push((pixel, bounce, radiance));
    }

    /// The film once all is added: what belongs to a pixel stays in its order.
    pub fn developed(mut self) -> Self {
        self.splats.sort_by_key(|&(pixel, ..)| pixel);
        self
    }

    /// What was added to a pixel: bounce and radiance [W m^-2 sr^-1].
    pub fn at(&self, pixel: u32) -> impl Iterator<Item = (u32, Rgb)> {
        let first = self.splats.partition_point(|splat| splat.0 < pixel);
        let here = self.splats[first..].iter().take_while(move |splat| splat.0 == pixel);
        here.map(|&(_, bounce, radiance)| (bounce, radiance))
    }
}
