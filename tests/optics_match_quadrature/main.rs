//! Promise: what theory says of mirrors, interfaces, lenses and shutters agrees with quadrature and with simple
//! simulations that share no code with it.

mod caustic;
mod common;
mod exposure;
mod mirror;
mod motion;
mod optics;
