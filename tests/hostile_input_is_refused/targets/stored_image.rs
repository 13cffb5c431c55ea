//! Images that experiment files name.

use furnace::truth::layers::Layers;
use furnace::truth::{Own, Reference};

/// An EXR file: what is taken has an error for each pixel, and can be stored and read again bit by bit.
pub fn reference(bytes: &[u8]) {
    match Reference::read(bytes) {
        Ok(reference) => {
            let pixels = reference.size * reference.size;
            assert_eq!((reference.mean.len(), reference.std_error.len()), (pixels, pixels));
            assert!(reference.df >= 1.0);
            let is_sound = |v: &furnace::scene::Rgb| v.is_finite() && v.min_element() >= 0.0;
            assert!(reference.mean.iter().all(is_sound), "radiance that is none");
            assert!(reference.std_error.iter().all(is_sound), "errors that are none");
            let image = reference.image();
            assert!(image.mean.is_finite() && image.std_error.is_finite());
        }
        Err(error) => assert!(error.to_string().len() < 20_000),
    }
    if let Ok(own) = Own::read(bytes) {
        let again = Own::read(&own.bytes().expect("it can be written")).expect("what is stored can be read");
        assert!(again == own, "a reference that is stored is another one");
        let error = own.relative_error();
        assert!(error >= 0.0, "an error of {error}");
    }
    let _ = Layers::read_sized(bytes, (4, 3));
}
