//! Estimators and termination rules as files write them.

use super::photons::{LightTracingSpec, PhotonMapSpec, ProgressiveSpec};
use crate::estimator::Heuristic;
use crate::experiment::input::{self, Named, Sweep, schema};
use crate::scene::{Directions, Pick, Points};
use schemars::JsonSchema;
use serde::Deserialize;

/// An estimator.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum EstimatorSpec {
    /// N samples at each vertex.
    Recursive {
        /// N.
        #[serde(deserialize_with = "input::positive_counts")]
        #[schemars(schema_with = "schema::positive_counts")]
        samples: Sweep,
        /// The largest number of bounces.
        #[serde(deserialize_with = "input::counts")]
        #[schemars(schema_with = "schema::counts")]
        depth: Sweep,
        /// How directions are drawn.
        #[serde(default)]
        directions: Directions,
    },
    /// One sample at each vertex.
    Implicit {
        /// How directions are drawn.
        #[serde(default)]
        directions: Directions,
    },
    /// Direct light sampled on the emitters.
    Explicit {
        /// Which technique finds direct light.
        #[serde(default)]
        technique: TechniqueSpec,
        /// How `both` techniques are weighted.
        #[serde(default)]
        heuristic: Heuristic,
        /// How points on emitters are drawn.
        #[serde(default)]
        lights: Points,
        /// How an emitter is picked.
        #[serde(default)]
        pick: Pick,
        /// How directions are drawn.
        #[serde(default)]
        directions: Directions,
    },
    /// Particles connected to the sensor.
    LightTracing(LightTracingSpec),
    /// The density of photons.
    PhotonMap(PhotonMapSpec),
    /// A sequence of photon maps whose radius shrinks.
    Progressive(ProgressiveSpec),
    /// An estimator with a known mistake, in files that say `faults = true`.
    Fault {
        /// Which mistake.
        name: FaultNames,
        /// What it claims to be.
        #[serde(default = "implicit")]
        of: Box<Named<EstimatorSpec>>,
    },
}

fn implicit() -> Box<Named<EstimatorSpec>> {
    Box::new(Named(EstimatorSpec::Implicit { directions: Directions::Cosine }))
}

/// Names of faults: one, or a list.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "the name of a fault, or a list of names")]
pub enum FaultNames {
    /// One.
    One(#[schemars(schema_with = "schema::fault")] String),
    /// Several.
    Several(#[schemars(schema_with = "schema::faults")] Vec<String>),
}

impl FaultNames {
    /// All of them.
    pub fn as_slice(&self) -> &[String] {
        match self {
            FaultNames::One(name) => std::slice::from_ref(name),
            FaultNames::Several(names) => names,
        }
    }
}

/// Which technique finds direct light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TechniqueSpec {
    /// Points sampled on the emitters.
    #[default]
    Light,
    /// Continued directions.
    Direction,
    /// Both, weighted by the heuristic.
    Both,
}

/// A termination rule.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RouletteSpec {
    /// Nothing but the estimator's own depth ends a walk.
    None {},
    /// No roulette; light scattered more often is left out.
    DepthClamp {
        /// The largest number of bounces.
        #[serde(deserialize_with = "input::counts")]
        #[schemars(schema_with = "schema::counts")]
        bounces: Sweep,
    },
    /// The same q everywhere.
    Constant {
        /// Expected number of continuations.
        #[serde(deserialize_with = "input::survival")]
        #[schemars(schema_with = "schema::survival")]
        q: Sweep,
        /// The first so many bounces are certain.
        #[serde(default, deserialize_with = "input::bounces")]
        #[schemars(schema_with = "schema::bounces")]
        from: u32,
        /// The largest number of bounces.
        #[serde(default, deserialize_with = "input::optional_bounces")]
        #[schemars(schema_with = "schema::optional_bounces")]
        clamp: Option<u32>,
    },
    /// q = largest channel of the albedo.
    Albedo {
        /// The first so many bounces are certain.
        #[serde(default, deserialize_with = "input::bounces")]
        #[schemars(schema_with = "schema::bounces")]
        from: u32,
        /// The largest number of bounces.
        #[serde(default, deserialize_with = "input::optional_bounces")]
        #[schemars(schema_with = "schema::optional_bounces")]
        clamp: Option<u32>,
    },
    /// q = largest channel of the throughput.
    Throughput {
        /// Lower limit of q.
        #[serde(default = "small", deserialize_with = "input::probability")]
        #[schemars(schema_with = "schema::probability")]
        floor: f64,
        /// The first so many bounces are certain.
        #[serde(default, deserialize_with = "input::bounces")]
        #[schemars(schema_with = "schema::bounces")]
        from: u32,
        /// The largest number of bounces.
        #[serde(default, deserialize_with = "input::optional_bounces")]
        #[schemars(schema_with = "schema::optional_bounces")]
        clamp: Option<u32>,
    },
}

fn small() -> f64 {
    0.05
}
