//! Promise: an image beside a stored one of another resolution shows where it is too bright and where too dark, block
//! by block, with the standard error of both; the map beside the picture has the colours that its legend states.

use furnace::experiment::pixels::Pixels;
use furnace::report::difference::{self, Difference};
use furnace::report::images;
use furnace::scene::Rgb;
use furnace::truth::Reference;
use furnace::truth::layers::Layers;
use std::io::Cursor;

/// 8 x 8 pixels of 1 with a variance of 0.75 from 4 samples, but for the left upper quarter, which is 2 in green.
fn pixels() -> Pixels {
    let mean = (0..64).map(|i| Rgb::new(1.0, if i % 8 < 4 && i / 8 < 4 { 2.0 } else { 1.0 }, 1.0));
    Pixels { width: 8, height: 8, n: 4, mean: mean.collect(), m2: vec![Rgb::splat(2.25); 64] }
}

/// `size` x `size` pixels of 1 but for blue, which is 3 in the lower half.
fn reference(size: usize, std_error: f64) -> Reference {
    let mean = (0..size * size).map(|i| Rgb::new(1.0, 1.0, if i / size < size / 2 { 1.0 } else { 3.0 }));
    let std_error = vec![Rgb::splat(std_error); size * size];
    Reference { size, mean: mean.collect(), std_error, df: 31.0, systematic: 0.0, provenance: None }
}

#[test]
fn bias_is_measured_less_right_with_both_errors() {
    // of 8 and 4, of 8 and 16, of 8 and 12 pixels: blocks that both have
    for (size, blocks) in [(4, 4), (16, 8), (12, 4)] {
        let difference = Difference::of(&pixels(), &reference(size, 0.1)).unwrap();
        assert_eq!((difference.blocks, difference.bias.len()), (blocks, blocks * blocks));
        for (i, (bias, error)) in difference.bias.iter().zip(&difference.std_error).enumerate() {
            let (left, upper) = (i % blocks < blocks / 2, i / blocks < blocks / 2);
            let green = if left && upper { 1.0 } else { 0.0 };
            assert_eq!(*bias, Rgb::new(0.0, green, if upper { 0.0 } else { -2.0 }), "{size}, block {i}");
            let (ours, theirs) = (8 / blocks, size / blocks);
            let right = (0.1875_f64 / (ours * ours) as f64 + 0.01 / (theirs * theirs) as f64).sqrt();
            assert!((*error - Rgb::splat(right)).length() < 1e-15, "{size}: {error}, not {right}");
        }
    }
}

#[test]
fn the_exr_holds_it_pixel_by_pixel() {
    let bytes = images::exr(&pixels(), Some(&reference(4, 0.1))).unwrap();
    let layers = Layers::read(&bytes).unwrap();
    let green = layers.checked("bias.G", "anything", |_| true).unwrap();
    let blue = layers.checked("bias.B", "anything", |_| true).unwrap();
    assert!((0..64).all(|i| green[i] == if i % 8 < 4 && i / 8 < 4 { 1.0 } else { 0.0 }));
    assert!((0..64).all(|i| blue[i] == if i / 8 < 4 { 0.0 } else { -2.0 }));
    assert!(layers.rgb("bias_std_error.").unwrap().iter().all(|e| e.min_element() > 0.2));
    assert_eq!(images::exr(&pixels(), Some(&reference(4, 0.1))).unwrap(), bytes, "other bytes");
    // an image is a reference for others, too
    assert_eq!(Reference::read(&bytes).unwrap().df, 3.0);
    let without = Layers::read(&images::exr(&pixels(), None).unwrap()).unwrap();
    assert!(!without.any(&["bias.R".to_owned(), "bias_std_error.R".to_owned()]));
}

#[test]
fn the_map_has_the_colours_of_its_legend() {
    let png = difference::map(&pixels(), &reference(4, 0.1));
    let mut reader = png::Decoder::new(Cursor::new(&png)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let at = |x: u32, y: u32| {
        let i = 3 * (y * info.width + x) as usize;
        [bytes[i], bytes[i + 1], bytes[i + 2]]
    };
    let (white, blue, vermilion) = ([255; 3], [0x00, 0x72, 0xB2], [0xD5, 0x5E, 0x00]);
    assert_eq!((at(10, 10), at(120, 120)), (white, white), "red is right everywhere");
    // 1 is 4.2 standard errors of a block, -2 twice as many
    assert_eq!((at(146, 10), at(250, 10), at(146, 120)), (vermilion, white, white), "green");
    assert_eq!((at(10, 146), at(10, 250), at(120, 250)), (white, blue, blue), "blue");
    assert_eq!((at(136, 200), at(263, 200)), (blue, vermilion), "the legend");
    assert!(png.len() < 20_000 && info.width <= 300);
}
