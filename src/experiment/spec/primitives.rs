//! Scenes that files write out, primitive by primitive.

use crate::experiment::input::{self, schema};
use crate::scene::Rgb;
use crate::scene::camera::Lens;
use crate::scene::geometry::{Disk, Rectangle, Triangle};
use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A scene written out in the file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrimitivesSpec {
    /// What it is called in results.
    pub name: String,
    /// Its surfaces.
    pub primitives: Vec<PrimitiveSpec>,
    /// Lights without extent.
    #[serde(default)]
    pub points: Vec<PointSpec>,
    /// Light from infinity.
    #[serde(default)]
    pub sky: Option<SkySpec>,
    /// What is measured.
    pub sensor: SensorSpec,
}

/// A surface written out in the file.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrimitiveSpec {
    /// Where it is.
    pub shape: ShapeSpec,
    /// What it reflects as a Lambert surface.
    #[serde(default, deserialize_with = "input::optional_albedo")]
    #[schemars(schema_with = "schema::optional_albedo")]
    pub albedo: Option<Rgb>,
    /// What it is made of, if it is no Lambert surface.
    #[serde(default)]
    pub bsdf: Option<BsdfSpec>,
    /// What it emits.
    #[serde(default, deserialize_with = "input::radiance")]
    #[schemars(schema_with = "schema::radiance")]
    pub emission: Rgb,
    /// Way that it goes while the shutter is open.
    #[serde(default, deserialize_with = "input::vector")]
    #[schemars(schema_with = "schema::vector")]
    pub velocity: DVec3,
}

/// What a surface is made of.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum BsdfSpec {
    /// A perfect mirror.
    Mirror {
        /// Fraction reflected at all angles.
        #[serde(deserialize_with = "input::albedo")]
        #[schemars(schema_with = "schema::albedo")]
        reflectance: Rgb,
    },
    /// A polished metal.
    Conductor {
        /// Real part of the refractive index.
        #[serde(deserialize_with = "input::index")]
        #[schemars(schema_with = "schema::index")]
        eta: Rgb,
        /// Imaginary part.
        #[serde(deserialize_with = "input::index")]
        #[schemars(schema_with = "schema::index")]
        k: Rgb,
    },
    /// A rough metal.
    Glossy {
        /// Roughness of the GGX distribution.
        #[serde(deserialize_with = "input::roughness")]
        #[schemars(schema_with = "schema::roughness")]
        alpha: f64,
        /// Real part of the refractive index.
        #[serde(deserialize_with = "input::index")]
        #[schemars(schema_with = "schema::index")]
        eta: Rgb,
        /// Imaginary part.
        #[serde(deserialize_with = "input::index")]
        #[schemars(schema_with = "schema::index")]
        k: Rgb,
    },
    /// A clear interface, seen from both sides.
    Dielectric {
        /// Refractive index behind it, relative to the one in front.
        #[serde(deserialize_with = "input::relative_index")]
        #[schemars(schema_with = "schema::relative_index")]
        ior: f64,
    },
}

/// A light without extent.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSpec {
    /// Where it is.
    #[serde(deserialize_with = "input::vector")]
    #[schemars(schema_with = "schema::vector")]
    pub position: DVec3,
    /// Radiant intensity [W sr^-1].
    #[serde(deserialize_with = "input::radiance")]
    #[schemars(schema_with = "schema::radiance")]
    pub intensity: Rgb,
}

/// Light from infinity.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SkySpec {
    /// The same from everywhere.
    Uniform {
        /// Radiance.
        #[serde(deserialize_with = "input::radiance")]
        #[schemars(schema_with = "schema::radiance")]
        radiance: Rgb,
    },
    /// radiance cos^exponent of the angle to `up`.
    Cosine {
        /// Radiance from straight above.
        #[serde(deserialize_with = "input::radiance")]
        #[schemars(schema_with = "schema::radiance")]
        radiance: Rgb,
        /// Exponent, 0 or above.
        #[serde(deserialize_with = "input::exponent")]
        #[schemars(schema_with = "schema::exponent")]
        exponent: f64,
        /// Where it is brightest.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        up: DVec3,
    },
}

/// A shape written out in the file; it shows one side, the front, and is black from behind.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeSpec {
    /// Front = half_u x half_v.
    Rectangle(Rectangle),
    /// Counter-clockwise as seen from the front.
    Triangle(Triangle),
    /// A circular plate.
    Disk(Disk),
    /// A whole sphere.
    Sphere {
        /// Centre.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        center: DVec3,
        /// Radius.
        #[serde(deserialize_with = "input::length")]
        #[schemars(schema_with = "schema::length")]
        radius: f64,
        /// Whether the front is the inside.
        #[serde(default)]
        inward: bool,
    },
    /// A band of a sphere.
    SpherePatch {
        /// Centre.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        center: DVec3,
        /// Radius.
        #[serde(deserialize_with = "input::length")]
        #[schemars(schema_with = "schema::length")]
        radius: f64,
        /// The pole.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        axis: DVec3,
        /// Cosine to the axis at the lower edge.
        low: f64,
        /// Cosine to the axis at the upper edge.
        high: f64,
        /// Whether the front is the inside.
        #[serde(default)]
        inward: bool,
    },
}

/// A sensor written out in the file.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SensorSpec {
    /// One ray.
    Probe {
        /// Where the eye is.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        origin: DVec3,
        /// Where it looks.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        direction: DVec3,
    },
    /// A small plate in free space.
    Irradiance {
        /// Where it is.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        point: DVec3,
        /// Where it faces.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        normal: DVec3,
    },
    /// Parallel rays through a rectangle.
    Parallel {
        /// The rectangle's centre.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        center: DVec3,
        /// Where it looks.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        direction: DVec3,
        /// Half of one edge.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        half_u: DVec3,
        /// Half of the other edge.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        half_v: DVec3,
    },
    /// A camera with square images.
    Camera {
        /// Where the eye is.
        #[serde(deserialize_with = "input::vector")]
        #[schemars(schema_with = "schema::vector")]
        origin: DVec3,
        /// Where it looks.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        direction: DVec3,
        /// Which way is up.
        #[serde(deserialize_with = "input::direction")]
        #[schemars(schema_with = "schema::direction")]
        up: DVec3,
        /// Full field of view in degrees.
        #[serde(deserialize_with = "input::field_of_view")]
        #[schemars(schema_with = "schema::field_of_view")]
        fov: f64,
        /// Pixels along each edge.
        #[serde(deserialize_with = "input::resolution")]
        #[schemars(schema_with = "schema::resolution")]
        resolution: u32,
        /// A thin lens instead of the pinhole.
        #[serde(default)]
        lens: Option<Lens>,
    },
}
