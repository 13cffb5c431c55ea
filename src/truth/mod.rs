//! Reference values, always with an error: closed forms, deterministic solutions, stored images of an independent renderer
//! or of our own, and which of them is used.

pub mod bound;
pub mod choice;
mod closed_form;
pub mod density;
pub mod deterministic;
pub mod direct;
pub mod enclosure;
pub mod gain;
pub mod gallery;
pub mod layers;
mod lengths;
pub mod linear;
pub mod moments;
pub mod optics;
pub mod optimum;
pub mod own;
pub mod quadrature;
pub mod radiosity;
pub mod reference;
pub mod walk;

pub use choice::{Source, Truth, Value};
pub use closed_form::ClosedForm;
pub use enclosure::{Counted, Enclosure, Wall};
pub use layers::BadReference;
pub use optimum::{Optimum, best_constant_q};
pub use own::Own;
pub use reference::Reference;
pub use walk::Walk;

/// What theory says of a central moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Its value.
    Value(f64),
    /// It is infinite.
    Infinite,
    /// There is no closed form.
    Unknown,
}

/// What theory says of the mean of so many realizations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct After {
    /// Its expectation less the right value; none where that is not known.
    pub bias: Option<f64>,
    /// Its variance.
    pub variance: Known,
}

impl After {
    /// Mean squared error, where finite and known.
    pub fn mse(&self) -> Option<f64> {
        let bias = self.bias?;
        Some(bias * bias + self.variance.value()?)
    }
}

impl Known {
    /// The value, if theory gives one.
    pub fn value(self) -> Option<f64> {
        match self {
            Known::Value(value) => Some(value),
            _ => None,
        }
    }
}
