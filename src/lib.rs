//! draft
#![allow(missing_docs)]
pub mod sampling; pub mod scene; pub mod estimator; pub mod truth; pub mod stats; pub mod experiment; pub mod report;
