//! Images: EXR with everything in it, PNG to look at.

use super::difference::Difference;
use crate::experiment::pixels::Pixels;
use crate::truth::Reference;
use crate::truth::layers::Layers;

/// The EXR file, in single precision: `R G B` (mean), `variance.*` (of one sample), `samples`; against a stored image
/// also `bias.*` (signed, on the finest grid that both pictures have) and `bias_std_error.*`.
pub fn exr(pixels: &Pixels, reference: Option<&Reference>) -> Result<Vec<u8>, exr::error::Error> {
    let (width, height) = (pixels.width as usize, pixels.height as usize);
    let mut layers = Layers::new(width, height);
    layers.add_rgb("", &pixels.mean);
    layers.add_rgb("variance.", &pixels.variance());
    if let Some(difference) = reference.and_then(|reference| Difference::of(pixels, reference)) {
        layers.add_rgb("bias.", &difference.spread(&difference.bias, width));
        layers.add_rgb("bias_std_error.", &difference.spread(&difference.std_error, width));
    }
    layers.add("samples", vec![pixels.n as f32; width * height]);
    layers.bytes()
}

/// An 8-bit picture for the screen: scaled by `exposure`, clipped, encoded as sRGB, enlarged to at least 256 pixels.
pub fn png(pixels: &Pixels, exposure: f64) -> Vec<u8> {
    let zoom = 256u32.div_ceil(pixels.width).max(1);
    let (width, height) = (pixels.width * zoom, pixels.height * zoom);
    let mut bytes = Vec::with_capacity((width * height * 3) as usize);
    for y in 0..height {
        for x in 0..width {
            let radiance = pixels.mean[((y / zoom) * pixels.width + x / zoom) as usize] * exposure;
            bytes.extend(radiance.to_array().map(srgb));
        }
    }
    encode(width, height, &bytes)
}

/// The file of an 8-bit RGB picture.
pub(super) fn encode(width: u32, height: u32, bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().expect("a Vec takes all");
    writer.write_image_data(bytes).expect("as many bytes as pixels");
    writer.finish().expect("a Vec takes all");
    file
}

/// The exposure at which all but the brightest three hundredths of an image's pixels fit, given each pixel's brightest
/// channel; what is not finite fits at none.
pub fn exposure(brightest: impl Iterator<Item = f64>) -> f64 {
    let mut brightest: Vec<f64> = brightest.filter(|v| v.is_finite()).collect();
    brightest.sort_by(f64::total_cmp);
    let high = brightest.get(brightest.len() * 97 / 100).copied().unwrap_or(0.0);
    if high > 0.0 { 0.9 / high } else { 1.0 }
}

/// IEC 61966-2-1.
fn srgb(linear: f64) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}
