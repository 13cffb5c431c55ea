//! Scenes as files write them.

use super::{CausticSpec, DofSpec, ImageSpec, MotionSpec, PrimitivesSpec, WideImageSpec};
use crate::experiment::input::{self, Sweep, schema};
use crate::scene::Rgb;
use crate::scene::library::View;
use schemars::JsonSchema;
use serde::Deserialize;

/// A scene.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneSpec {
    /// A closed sphere of one material, seen from inside.
    Furnace(FurnaceSpec),
    /// The same in a closed box.
    FurnaceBox(FurnaceSpec),
    /// A sphere of patches, seen from inside: a light, further patches if any, and the wall.
    IntegratingSphere(SphereSpec),
    /// The Cornell box with its two blocks.
    CornellBox(CornellSpec),
    /// The Cornell box without its blocks.
    CornellEmpty(CornellSpec),
    /// A Cornell box whose light lies flush in the ceiling; measured is one of six tiles.
    CornellFlush(FlushSpec),
    /// A room full of balls.
    ManySpheres(ManySpheresSpec),
    /// A ball of glass gathers light on the floor.
    CausticGlass(CausticSpec),
    /// A mirror ring throws a bright curve on the floor within.
    CausticMirror(CausticSpec),
    /// A closed room whose lamp shines into a corner behind a partition.
    Indirect(ImageSpec),
    /// The room of smallpt, in an image that is 4 : 3.
    Smallpt(WideImageSpec),
    /// Four plates of different roughness mirror four lights of different size.
    VeachMis(ImageSpec),
    /// Balls at different depths through a thin lens.
    Dof(DofSpec),
    /// A board that moves while the shutter is open, and its shadow.
    Motion(MotionSpec),
    /// A scene of the gallery, which has a closed form.
    Exhibit {
        /// Its name in the gallery.
        #[schemars(schema_with = "schema::exhibit")]
        name: String,
        /// Its parameter, if it is not to have its usual value.
        #[serde(default)]
        parameter: Option<Sweep>,
    },
    /// Written out primitive by primitive.
    Primitives(PrimitivesSpec),
}

/// A closed enclosure of one material.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FurnaceSpec {
    /// Albedo, one number or one a channel.
    #[serde(deserialize_with = "input::albedo")]
    #[schemars(schema_with = "schema::albedo")]
    pub albedo: Rgb,
    /// Emitted radiance.
    #[serde(deserialize_with = "input::radiance")]
    #[schemars(schema_with = "schema::radiance")]
    pub emission: Rgb,
    /// `probe` or `irradiance`.
    pub view: View,
}

impl Default for FurnaceSpec {
    fn default() -> Self {
        FurnaceSpec { albedo: Rgb::splat(0.5), emission: Rgb::ONE, view: View::Probe }
    }
}

/// An integrating sphere: a light, further patches if any, and the wall that fills the rest.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SphereSpec {
    /// The light's fraction of the sphere's area.
    #[serde(deserialize_with = "input::fractions")]
    #[schemars(schema_with = "schema::fractions")]
    pub light_fraction: Sweep,
    /// What the light reflects.
    #[serde(deserialize_with = "input::albedo")]
    #[schemars(schema_with = "schema::albedo")]
    pub light_albedo: Rgb,
    /// What the light emits.
    #[serde(deserialize_with = "input::radiance")]
    #[schemars(schema_with = "schema::radiance")]
    pub emission: Rgb,
    /// What the wall reflects.
    #[serde(deserialize_with = "input::albedo")]
    #[schemars(schema_with = "schema::albedo")]
    pub wall_albedo: Rgb,
    /// Further patches.
    pub patches: Vec<PatchSpec>,
    /// What a probe looks at.
    pub looks_at: LooksAt,
    /// `probe` or `irradiance`.
    pub view: View,
}

impl Default for SphereSpec {
    fn default() -> Self {
        SphereSpec {
            light_fraction: Sweep(vec![0.05]),
            light_albedo: Rgb::splat(0.4),
            emission: Rgb::splat(5.0),
            wall_albedo: Rgb::splat(0.6),
            patches: Vec::new(),
            looks_at: LooksAt::Wall,
            view: View::Probe,
        }
    }
}

/// A patch of an integrating sphere.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchSpec {
    /// Fraction of the sphere's area.
    #[serde(deserialize_with = "input::probability")]
    #[schemars(schema_with = "schema::probability")]
    pub fraction: f64,
    /// What it reflects.
    #[serde(deserialize_with = "input::albedo")]
    #[schemars(schema_with = "schema::albedo")]
    pub albedo: Rgb,
    /// What it emits.
    #[serde(default, deserialize_with = "input::radiance")]
    #[schemars(schema_with = "schema::radiance")]
    pub emission: Rgb,
}

/// What a probe in an integrating sphere looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LooksAt {
    /// The wall.
    Wall,
    /// The light.
    Light,
}

/// A Cornell box.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CornellSpec {
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    #[schemars(schema_with = "schema::resolution")]
    pub resolution: u32,
}

impl Default for CornellSpec {
    fn default() -> Self {
        CornellSpec { resolution: 32 }
    }
}

/// A Cornell box for closed forms.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlushSpec {
    /// Which tiles are measured, 1 to 6.
    #[serde(deserialize_with = "input::tiles")]
    #[schemars(schema_with = "schema::tiles")]
    pub tile: Sweep,
    /// Whether the two blocks stand in it.
    pub blocks: bool,
}

impl Default for FlushSpec {
    fn default() -> Self {
        FlushSpec { tile: Sweep(vec![1.0]), blocks: false }
    }
}

/// A room full of balls.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ManySpheresSpec {
    /// How many.
    #[serde(deserialize_with = "input::ball_counts")]
    #[schemars(schema_with = "schema::ball_counts")]
    pub count: Option<Sweep>,
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    #[schemars(schema_with = "schema::resolution")]
    pub resolution: u32,
}

impl Default for ManySpheresSpec {
    fn default() -> Self {
        ManySpheresSpec { count: None, resolution: 128 }
    }
}
