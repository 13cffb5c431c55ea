//! `furnace` is a test bench for Monte Carlo light-transport estimators. Of each one it tells whether it is right (with a
//! stated error probability and the smallest bias it could have missed), what it costs, and where it is wrong.
//!
//! ```text
//! experiments/x.toml --Spec--> Plan --> Block --merge--> Cell --judge--> Row, Verdict --> reports/x/{results.csv, index.html, *.svg, *.exr}
//!   (what was said)   (resolved grid)  (pure function)  (in block order)   (pure)          (pure: rebuilt without sampling)
//! ```
//!
//! Every arrow is one function, every word a plain struct. Imports go downwards only (`tests/layers.rs` holds this):
//!
//! ```text
//! bin -> report -> experiment -> { faults -> truth, fast, stats };   faults, truth, fast -> estimator -> scene -> sampling
//! ```
//!
//! To test an estimator of your own, implement [`estimator::Estimate`] and look at `examples/my_estimator.rs`.
//!
//! # Words
//!
//! | word | meaning |
//! |---|---|
//! | `beta` | throughput: product of f cos / pdf (and 1/q) along a path |
//! | `wo`, `wi` | known and sampled direction, both leaving the surface |
//! | `le` | emitted radiance [W m^-2 sr^-1] |
//! | `bounce` | scattering events between emission and sensor; 0 = emission seen directly |
//! | `q` | expected number of continuations: survival probability up to 1, splitting above; the lecture's chi is 1 - q |
//! | `PdfW`, `PdfA`, `pmf` | density per solid angle [1/sr], per area [1/m²], probability |
//! | `weight` | f cos / pdf of a sampled direction |
//! | implicit, explicit, recursive | light found by chance; direct light sampled; N samples at each vertex |
//! | realization | one independent draw of the whole measurement: a path for a probe, an image pass for a camera |
//! | block, cell | a fixed run of realizations; one point of the grid |
//! | fault | an estimator with a known mistake, by which the bench shows that it notices one |
//! | truth | the right value with its error: from a closed form, an independent renderer, or another kind of estimator |
//! | reference | a stored image with standard errors |
//! | claim, verdict | what is promised; Pass (shown equivalent), Fail (shown different), Inconclusive, Invalid |
//! | bets, e-value | evidence that holds at any stopping time: a fortune that is unlikely to grow if all is right |
//! | exact, asymptotic | decided by bets, or by a t test whose error probability holds for many samples |
//! | guard | whether the largest samples leave a variance, and so a t test, any meaning |
//! | fault | an estimator with a known mistake, made to be found |
//! | study, instrument | cells run with many seeds; what looks for mistakes there |
//! | cost, efficiency | rays a realization; 1 / (variance x cost) |

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod sampling;
pub mod scene;

pub mod estimator;

pub mod fast;

pub mod stats;
pub mod truth;

pub mod faults;

pub mod experiment;

pub mod report;

/// The guide's Rust, which the tests of documentation compile and run.
#[cfg(doctest)]
mod guide {
    #[doc = include_str!("../docs/src/own_estimator.md")]
    struct OwnEstimator;
}
