//! What files claim of cells, and what they want drawn.

use crate::experiment::input::{self, schema};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

/// What is claimed of every cell for which it is legal.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Claim {
    /// The mean, total and per bounce, is what theory or a reference says (for a clamped cell: theory's biased mean).
    Unbiased(Limits),
    /// The means of the image's tiles are those of the reference; the margin is relative to the
    /// larger of the tile's and the image's mean.
    Tiles(Limits),
    /// The sample variance is theory's.
    Variance(Limits),
    /// The rays a realization are theory's.
    Cost(Limits),
    /// The error of cells that are cut into runs falls as theory says: as which power of the number of samples. The margin
    /// is absolute, in exponents.
    Rate(#[schemars(with = "Limits")] Spanned<Limits>),
    /// Paths have the lengths that theory's law of roulette gives; can be refuted, never shown.
    Length(Chance),
    /// Realizations are independent: no block repeats another or follows from the one before; can be refuted, never shown.
    Independent(Chance),
    /// All unbiased cells of a scene have the mean of one of them, total and per bounce.
    Agree {
        /// Label of the estimator that the others are compared with.
        estimator: String,
        /// Label of its termination rule.
        roulette: String,
        /// The only scene it is about; all scenes if left out.
        #[serde(default)]
        scene: Option<String>,
        /// Probability of any false alarm among all questions of this claim.
        #[serde(deserialize_with = "input::inside_unit")]
        #[schemars(schema_with = "schema::inside_unit")]
        alpha: f64,
        /// Largest difference that counts as none, relative to the total.
        #[serde(deserialize_with = "input::inside_unit")]
        #[schemars(schema_with = "schema::inside_unit")]
        margin: f64,
    },
}

impl Claim {
    /// Probability of any false alarm among its questions.
    pub fn alpha(&self) -> f64 {
        match self {
            Claim::Unbiased(l) | Claim::Tiles(l) | Claim::Variance(l) | Claim::Cost(l) => l.alpha,
            Claim::Rate(l) => l.get_ref().alpha,
            Claim::Length(c) | Claim::Independent(c) => c.alpha,
            Claim::Agree { alpha, .. } => *alpha,
        }
    }

    /// The only scene it is about, if it names one.
    pub fn scene(&self) -> Option<&String> {
        match self {
            Claim::Unbiased(l) | Claim::Tiles(l) | Claim::Variance(l) | Claim::Cost(l) => l.scene.as_ref(),
            Claim::Rate(l) => l.get_ref().scene.as_ref(),
            Claim::Length(c) | Claim::Independent(c) => c.scene.as_ref(),
            Claim::Agree { scene, .. } => scene.as_ref(),
        }
    }

    /// Its limits, if it claims the mean.
    pub fn unbiased(&self) -> Option<&Limits> {
        if let Claim::Unbiased(limits) = self { Some(limits) } else { None }
    }

    /// Its limits, if it claims the means of tiles.
    pub fn tiles(&self) -> Option<&Limits> {
        if let Claim::Tiles(limits) = self { Some(limits) } else { None }
    }

    /// Its limits, if it claims the variance.
    pub fn variance(&self) -> Option<&Limits> {
        if let Claim::Variance(limits) = self { Some(limits) } else { None }
    }

    /// Its limits, if it claims the cost.
    pub fn cost(&self) -> Option<&Limits> {
        if let Claim::Cost(limits) = self { Some(limits) } else { None }
    }

    /// Its limits, if it claims rates.
    pub fn rate(&self) -> Option<&Limits> {
        if let Claim::Rate(limits) = self { Some(limits.get_ref()) } else { None }
    }
}

/// Error probability of a claim that can only be refuted.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chance {
    /// The only scene it is about; all scenes if left out.
    #[serde(default)]
    pub scene: Option<String>,
    /// Probability of any false alarm among all questions of this claim.
    #[serde(deserialize_with = "input::inside_unit")]
    #[schemars(schema_with = "schema::inside_unit")]
    pub alpha: f64,
}

impl Limits {
    /// Whether a claim with these limits is about this scene.
    pub fn covers(&self, scene: &str) -> bool {
        self.scene.as_ref().is_none_or(|only| only == scene)
    }
}

/// Error probability and margin of a claim.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The only scene it is about; all scenes if left out.
    #[serde(default)]
    pub scene: Option<String>,
    /// Probability of any false alarm among all questions of this claim.
    #[serde(deserialize_with = "input::inside_unit")]
    #[schemars(schema_with = "schema::inside_unit")]
    pub alpha: f64,
    /// Largest difference that counts as none, relative to the right total.
    #[serde(deserialize_with = "input::inside_unit")]
    #[schemars(schema_with = "schema::inside_unit")]
    pub margin: f64,
}

/// A figure for each scene.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Plot {
    /// Quantities over a swept parameter, with theory's curves.
    Over {
        /// The swept parameter.
        parameter: String,
        /// What is drawn, a panel each.
        show: Vec<Quantity>,
        /// What tells the curves of a panel apart: `channel`, `estimator`, or another swept parameter (then the red
        /// channel is shown).
        #[serde(default = "channel")]
        series: String,
        /// Logarithmic parameter axis.
        #[serde(default)]
        log: bool,
    },
    /// Efficiency of every cell of a scene as bars.
    Bars {
        /// Name of the scene.
        scene: String,
    },
    /// Light that every cell of a scene found, relative to the first cell of one estimator, and how heavy its tails look.
    Shares {
        /// Name of the scene.
        scene: String,
        /// Label of the estimator that is taken for all of it.
        of: String,
    },
    /// Bias of every cell with its interval, against the margin.
    Bias {},
    /// How the error of every cell of a scene that is cut into runs falls, in the red channel.
    Convergence {
        /// Name of the scene.
        scene: String,
        /// What is drawn, a panel each.
        #[serde(default = "errors")]
        show: Vec<ErrorKind>,
    },
}

fn errors() -> Vec<ErrorKind> {
    vec![ErrorKind::Mse, ErrorKind::Variance, ErrorKind::Bias]
}

/// A part of the error of a mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ErrorKind {
    /// Mean squared error.
    Mse,
    /// Variance.
    Variance,
    /// Bias.
    Bias,
}

fn channel() -> String {
    "channel".to_owned()
}

/// What a figure can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Mean less the right value, relative to it.
    Bias,
    /// Variance of one realization.
    Variance,
    /// Rays a realization.
    Cost,
    /// 1 / (variance x cost).
    Efficiency,
    /// Share of realizations that return zero.
    Zeros,
    /// What the last bounce of a clamped walk adds, relative to the right total.
    Added,
    /// Squared bias and variance of one realization together, relative to the squared truth.
    Mse,
}
