//! Random numbers and maps of the unit square: where all chance comes from.

pub mod measure;
pub mod stream;
pub mod warp;

pub use measure::{PdfA, PdfW};
pub use stream::{Address, Stream};
