//! Promise: what theory says of photon density estimation agrees with quadrature and with simulated photons, which share no
//! code with it.
//!
//! Simulations have fixed seeds. Each check states which relative deviation it must notice: six of its standard errors are
//! at most that, and 5.5 are the limit, which chance exceeds with probability 4e-8.

mod common;
mod edge;
mod gradient;
mod kernel;
mod nearest;
mod optimum;
mod progressive;
mod sphere;
