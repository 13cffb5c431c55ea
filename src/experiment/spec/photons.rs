//! Estimators that start from the lights, as files write them.

use crate::estimator::{DirectLight, Kernel, Last};
use crate::experiment::input::{self, Sweep, schema};
use crate::scene::Directions;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer};

/// Particles connected to the sensor.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightTracingSpec {
    /// Particles of one realization; as many as the sensor has pixels, if left out.
    #[serde(default, deserialize_with = "optional_numbers")]
    #[schemars(schema_with = "schema::photons")]
    pub particles: Option<Sweep>,
    /// How directions are drawn.
    #[serde(default)]
    pub directions: Directions,
}

/// The density of photons.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhotonMapSpec {
    /// Photons that are sent for one map.
    #[serde(default = "ten_thousand", deserialize_with = "numbers")]
    #[schemars(schema_with = "schema::photons")]
    pub photons: Sweep,
    /// So many of the nearest are gathered.
    #[serde(default, deserialize_with = "optional_nearest")]
    #[schemars(schema_with = "schema::nearest")]
    pub k: Option<Sweep>,
    /// All within this distance are gathered.
    #[serde(default, deserialize_with = "optional_lengths")]
    #[schemars(schema_with = "schema::lengths")]
    pub radius: Option<Sweep>,
    /// Whether the k-th counts.
    #[serde(default = "left_out")]
    pub last: Last,
    /// How photons count by their distance.
    #[serde(default, deserialize_with = "kernel")]
    pub kernel: Kernel,
    /// How direct light is found.
    #[serde(default)]
    pub direct: DirectLight,
    /// Rays by which indirect light is gathered.
    #[serde(default, deserialize_with = "input::bounces")]
    #[schemars(schema_with = "schema::bounces")]
    pub final_gather: u32,
    /// How directions are drawn.
    #[serde(default)]
    pub directions: Directions,
}

/// A sequence of maps whose radius shrinks.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgressiveSpec {
    /// Photons that are sent for one map.
    #[serde(default = "ten_thousand", deserialize_with = "numbers")]
    #[schemars(schema_with = "schema::photons")]
    pub photons: Sweep,
    /// Radius of the first map.
    #[serde(deserialize_with = "lengths")]
    #[schemars(schema_with = "schema::lengths")]
    pub radius: Sweep,
    /// Share of new photons that are kept.
    #[serde(default = "two_thirds", deserialize_with = "shares")]
    #[schemars(schema_with = "schema::shares")]
    pub alpha: Sweep,
    /// So many maps make one picture.
    #[serde(deserialize_with = "input::samples")]
    #[schemars(schema_with = "schema::samples")]
    pub passes: u64,
    /// How photons count by their distance.
    #[serde(default, deserialize_with = "kernel")]
    pub kernel: Kernel,
    /// How direct light is found.
    #[serde(default)]
    pub direct: DirectLight,
    /// How directions are drawn.
    #[serde(default)]
    pub directions: Directions,
}

fn ten_thousand() -> Sweep {
    Sweep(vec![10_000.0])
}

fn two_thirds() -> Sweep {
    Sweep(vec![2.0 / 3.0])
}

fn left_out() -> Last {
    Last::LeftOut
}

/// More photons than this in one map do not fit into the memory of usual machines.
const MOST_PHOTONS: f64 = 1e8;

fn numbers<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    let holds = |v: f64| v.fract() == 0.0 && (1.0..=MOST_PHOTONS).contains(&v);
    input::swept(d, "a map takes a whole number of photons, from 1 to 10^8", holds)
}

fn optional_numbers<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    numbers(d).map(Some)
}

fn optional_nearest<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    let holds = |v: f64| v.fract() == 0.0 && (2.0..=1e6).contains(&v);
    input::swept(d, "k is a whole number from 2 to 10^6: one photon alone tells no density", holds).map(Some)
}

fn lengths<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    input::swept(d, "a radius is finite and above 0", |v| v > 0.0 && v.is_finite())
}

fn optional_lengths<'de, D: Deserializer<'de>>(d: D) -> Result<Option<Sweep>, D::Error> {
    lengths(d).map(Some)
}

fn shares<'de, D: Deserializer<'de>>(d: D) -> Result<Sweep, D::Error> {
    let wanted = "alpha lies inside (0, 1): at 0 the noise would stay, at 1 the blur";
    input::swept(d, wanted, |v| v > 0.0 && v < 1.0)
}

fn kernel<'de, D: Deserializer<'de>>(d: D) -> Result<Kernel, D::Error> {
    let kernel = Kernel::deserialize(d)?;
    if let Kernel::Cone { c } = kernel
        && !(c >= 1.0 && c.is_finite())
    {
        let why =
            format!("{c} is out of range: a cone's c is finite and at least 1, or photons count below 0");
        return Err(serde::de::Error::custom(why));
    }
    Ok(kernel)
}
