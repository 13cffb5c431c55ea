//! Which truth is used: the one place that knows their order.

use super::deterministic::Deterministic;
use super::enclosure::Counted;
use super::own::kind;
use super::reference::{Reference, Stored};
use super::{After, ClosedForm, Known};
use crate::estimator::{Estimate, Estimator, Property, Rates};
use crate::scene::library::SceneKind;
use std::fmt;
use std::sync::Arc;

/// Where a right value comes from, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Theory; exact to rounding.
    ClosedForm,
    /// A solver without chance; its error is bounded.
    Deterministic,
    /// A stored image of another renderer.
    Independent,
    /// A stored image that an estimator of this program made.
    Own,
}

impl Source {
    /// What it is called in results.
    pub fn name(self) -> &'static str {
        match self {
            Source::ClosedForm => "closed form",
            Source::Deterministic => "deterministic",
            Source::Independent => "independent renderer",
            Source::Own => "own reference",
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A right value and how well it is known, in the estimand's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// The value.
    pub value: f64,
    /// Its standard error; 0 if it has no noise.
    pub std_error: f64,
    /// Degrees of freedom of the standard error; infinite if there is none.
    pub df: f64,
    /// Bound on the absolute systematic error.
    pub bound: f64,
    /// Where it comes from.
    pub source: Source,
}

impl Value {
    /// A value without error.
    pub fn exact(value: f64, source: Source) -> Self {
        Value { value, std_error: 0.0, df: f64::INFINITY, bound: 0.0, source }
    }
}

/// What is right for one estimator in one scene.
pub struct Truth {
    /// Best first; a later one speaks where those before it know nothing.
    origins: Vec<Origin>,
    property: Property,
    refused: Option<String>,
}

enum Origin {
    ClosedForm(Box<ClosedForm>),
    Deterministic(Deterministic),
    Stored(Arc<Reference>),
}

impl Truth {
    /// The best truth there is: a closed form, a deterministic solution, an independent renderer's image (one of
    /// `stored` before that which comes with the program), an image of our own by another kind of estimator.
    /// `stored` are the references of this scene, in their order.
    pub fn of(scene: &SceneKind, estimator: &Estimator, stored: &[Arc<Reference>]) -> Self {
        let made_by = |r: &Reference| r.provenance.as_ref().map(|p| kind(&p.estimator));
        let given = || stored.iter().find(|r| made_by(r).is_none()).cloned();
        let embedded = || Reference::of(scene).map(Arc::new);
        let own = || stored.iter().find(|r| made_by(r).is_some_and(|k| k != kind(estimator))).cloned();
        let image = || given().or_else(embedded).or_else(own);
        let origins: Vec<Origin> = match ClosedForm::of(scene, estimator) {
            Some(closed) => vec![Origin::ClosedForm(Box::new(closed))],
            None => {
                let solution = Deterministic::of(scene).map(Origin::Deterministic);
                solution.into_iter().chain(image().map(Origin::Stored)).collect()
            }
        };
        let knows_all =
            origins.iter().any(|origin| matches!(origin, Origin::ClosedForm(_) | Origin::Stored(_)));
        let same_kind = !knows_all && !stored.is_empty();
        let refused = same_kind.then(|| {
            let kind = kind(estimator);
            format!(
                "the reference was made by `{kind}`, which it cannot judge: both would share its mistakes"
            )
        });
        Truth { origins, property: estimator.property(), refused }
    }

    /// Theory of the estimator's moments and cost, where there is one.
    pub fn theory(&self) -> Option<&ClosedForm> {
        self.origins.iter().find_map(|origin| match origin {
            Origin::ClosedForm(closed) => Some(&**closed),
            _ => None,
        })
    }

    /// The stored image that is used.
    pub fn reference(&self) -> Option<&Reference> {
        self.origins.iter().find_map(|origin| match origin {
            Origin::Stored(reference) => Some(&**reference),
            _ => None,
        })
    }

    /// Why a reference that there is was not used.
    pub fn refused(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    /// The right mean: radiance [W m^-2 sr^-1], or irradiance [W m^-2] on a plate. A stored image knows no bounces.
    pub fn mean(&self, channel: usize, counted: Counted) -> Option<Value> {
        self.origins.iter().find_map(|origin| origin.mean(channel, counted))
    }

    /// The mean that this estimator should have: the right one, less what a clamp leaves out. `None` for a clamped
    /// estimator where the bounces are not known one by one, and for a consistent one whose bias has no closed form.
    pub fn expected(&self, channel: usize, counted: Counted) -> Option<Value> {
        self.origins.iter().find_map(|origin| match (origin, self.property) {
            (Origin::ClosedForm(closed), _) => {
                Some(Value::exact(closed.mean(channel, counted)?, Source::ClosedForm))
            }
            (_, Property::Consistent { .. }) => None,
            (Origin::Deterministic(solution), Property::Clamped { bounces }) => {
                solution.clamped(channel, counted, bounces)
            }
            (Origin::Stored(_), Property::Clamped { .. }) => None,
            (_, Property::Unbiased) => origin.mean(channel, counted),
        })
    }

    /// What the mean of the first `n` realizations is like, n being at most the passes of one picture.
    pub fn after(&self, channel: usize, n: u64) -> After {
        if let Some(closed) = self.theory() {
            return closed.after(channel, n);
        }
        let (right, expected) = (self.mean(channel, Counted::All), self.expected(channel, Counted::All));
        let bias = right.zip(expected).map(|(right, expected)| expected.value - right.value);
        After { bias, variance: Known::Unknown }
    }

    /// How bias and variance fall in the long run, where the variance is finite.
    pub fn rates(&self) -> Rates {
        match self.property {
            Property::Consistent { rates } => rates,
            Property::Unbiased | Property::Clamped { .. } => Rates { variance: 1.0, bias: 0.0 },
        }
    }

    /// The right mean over one of `tiles` x `tiles` squares of the image.
    pub fn tile(&self, x: usize, y: usize, tiles: usize, channel: usize) -> Option<Value> {
        let reference = self.reference().filter(|r| r.size.is_multiple_of(tiles))?;
        Some(value(reference, &reference.tile(tiles, x, y), channel))
    }
}

impl Origin {
    fn mean(&self, channel: usize, counted: Counted) -> Option<Value> {
        match self {
            Origin::ClosedForm(closed) => {
                Some(Value::exact(closed.truth(channel, counted), Source::ClosedForm))
            }
            Origin::Deterministic(solution) => solution.mean(channel, counted),
            Origin::Stored(reference) if counted == Counted::All => {
                Some(value(reference, &reference.image(), channel))
            }
            Origin::Stored(_) => None,
        }
    }
}

fn value(reference: &Reference, stored: &Stored, channel: usize) -> Value {
    let source = if reference.provenance.is_some() { Source::Own } else { Source::Independent };
    Value {
        value: stored.mean[channel],
        std_error: stored.std_error[channel],
        df: reference.df,
        bound: stored.systematic[channel],
        source,
    }
}
