//! What theory says of photon density estimation: means, variances and errors of irradiance that is read off the photons
//! near a point.
//!
//! N photons leave the lights, each with the power Φ/N \[W\]. A fixed radius counts those within distance r of the point,
//! `power · K(d)`, where the [`Kernel`] has unit integral over the disc; k nearest neighbours take r from the photons.
//! "Factor" is always expected estimate / truth, 1 for an unbiased estimate.

pub mod edge;
pub mod gradient;
mod kernel;
pub mod near_wall;
pub mod nearest;
pub mod optimum;
pub mod progressive;
mod sphere;

pub use kernel::Kernel;
pub use sphere::{Coated, Photons};
