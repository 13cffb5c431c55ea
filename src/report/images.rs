//! Images: EXR with everything in it, PNG to look at.

use crate::experiment::cell::Pixels;
use crate::scene::Rgb;
use crate::scene::library::SceneKind;
use crate::truth::Reference;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage,
};
use std::path::Path;

/// Channels `R G B` (mean), `variance.*` (of one sample), `bias.*` (signed, against the stored reference, tile by tile
/// of its pixels) and `samples`, in single precision.
pub fn write_exr(path: &Path, pixels: &Pixels, scene: &SceneKind) -> exr::error::UnitResult {
    let (width, height) = (pixels.width as usize, pixels.height as usize);
    let mut list: SmallVec<[AnyChannel<FlatSamples>; 4]> = SmallVec::new();
    let mut add = |name: &str, values: Vec<f32>| list.push(AnyChannel::new(name, FlatSamples::F32(values)));
    let mut add_rgb = |prefix: &str, values: &[Rgb]| {
        for (c, letter) in ["R", "G", "B"].into_iter().enumerate() {
            add(&format!("{prefix}{letter}"), values.iter().map(|v| v[c] as f32).collect());
        }
    };
    add_rgb("", &pixels.mean);
    add_rgb("variance.", &pixels.variance());
    if let Some(bias) = bias(pixels, scene) {
        add_rgb("bias.", &bias);
    }
    add("samples", vec![pixels.n as f32; width * height]);
    // the default encoding writes tiles in the order its threads finish: other bytes at each run
    let layer = Layer::new(
        (width, height),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list),
    );
    Image::from_layer(layer).write().non_parallel().to_file(path)
}

/// Mean less reference at the reference's resolution, spread over our pixels; `None` if the grids do not match.
fn bias(pixels: &Pixels, scene: &SceneKind) -> Option<Vec<Rgb>> {
    let reference = Reference::of(scene)?;
    let width = pixels.width as usize;
    let edge = width / reference.size;
    if edge * reference.size != width || pixels.width != pixels.height {
        return None;
    }
    let mut bias = vec![Rgb::ZERO; width * width];
    for (i, &right) in reference.mean.iter().enumerate() {
        let (x0, y0) = (i % reference.size * edge, i / reference.size * edge);
        let inside = || (y0..y0 + edge).flat_map(move |y| (x0..x0 + edge).map(move |x| y * width + x));
        let mean = inside().map(|j| pixels.mean[j]).sum::<Rgb>() / (edge * edge) as f64;
        inside().for_each(|j| bias[j] = mean - right);
    }
    Some(bias)
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
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().expect("a Vec takes all");
    writer.write_image_data(&bytes).expect("as many bytes as pixels");
    writer.finish().expect("a Vec takes all");
    file
}

/// The exposure at which all but the brightest hundredth of an image's pixels fit.
pub fn exposure(pixels: &Pixels) -> f64 {
    let mut brightest: Vec<f64> = pixels.mean.iter().map(|v| v.max_element()).collect();
    brightest.sort_by(f64::total_cmp);
    let high = brightest[(brightest.len() * 97 / 100).min(brightest.len() - 1)];
    if high > 0.0 { 0.9 / high } else { 1.0 }
}

/// IEC 61966-2-1.
fn srgb(linear: f64) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}
