//! The catalogue of faults, by the place where the mistake is made.

mod emission;
mod light;
mod scattering;
mod survival;
mod weighting;
mod whole;

use super::Fault;

/// All parts.
pub static CATALOGUE: &[&[Fault]] = &[
    emission::FAULTS,
    survival::FAULTS,
    scattering::FAULTS,
    light::FAULTS,
    weighting::FAULTS,
    whole::FAULTS,
];
