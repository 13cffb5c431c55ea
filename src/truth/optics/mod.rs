//! What mirrors, clear interfaces, lenses and shutters do to light, in closed form.

pub mod caustic;
pub mod exposure;
pub mod interface;
pub mod mirror;
pub mod motion;
