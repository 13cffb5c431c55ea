//! Scenes of lectures as files write them; see [`crate::scene::lecture`].

use crate::experiment::input::{self, Sweep, schema};
use schemars::JsonSchema;
use serde::Deserialize;

/// Pixels along each edge of an image, where the file does not say.
const RESOLUTION: u32 = 128;

/// An image without further parameters.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ImageSpec {
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    #[schemars(schema_with = "schema::resolution")]
    pub resolution: u32,
}

/// An image that is wider than high.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WideImageSpec {
    /// Pixels from top to bottom; from left to right are 4/3 of it, rounded.
    #[serde(deserialize_with = "input::wide_resolution")]
    #[schemars(schema_with = "schema::wide_resolution")]
    pub resolution: u32,
}

/// A caustic.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CausticSpec {
    /// Half the edge of the square that lights it, in metres.
    #[serde(deserialize_with = "input::half_edges")]
    #[schemars(schema_with = "schema::half_edges")]
    pub light: Option<Sweep>,
    /// A point in its place.
    pub point: bool,
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    #[schemars(schema_with = "schema::resolution")]
    pub resolution: u32,
}

/// Depth of field.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DofSpec {
    /// Radius of the lens, in metres.
    #[serde(deserialize_with = "input::apertures")]
    #[schemars(schema_with = "schema::apertures")]
    pub aperture: Option<Sweep>,
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    #[schemars(schema_with = "schema::resolution")]
    pub resolution: u32,
}

/// Motion blur.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MotionSpec {
    /// How far the board goes while the shutter is open, in metres.
    #[serde(deserialize_with = "input::travels")]
    #[schemars(schema_with = "schema::travels")]
    pub travel: Option<Sweep>,
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    #[schemars(schema_with = "schema::resolution")]
    pub resolution: u32,
}

impl Default for ImageSpec {
    fn default() -> Self {
        ImageSpec { resolution: RESOLUTION }
    }
}

impl Default for WideImageSpec {
    fn default() -> Self {
        WideImageSpec { resolution: 96 }
    }
}

impl Default for CausticSpec {
    fn default() -> Self {
        CausticSpec { light: None, point: false, resolution: RESOLUTION }
    }
}

impl Default for DofSpec {
    fn default() -> Self {
        DofSpec { aperture: None, resolution: RESOLUTION }
    }
}

impl Default for MotionSpec {
    fn default() -> Self {
        MotionSpec { travel: None, resolution: RESOLUTION }
    }
}
