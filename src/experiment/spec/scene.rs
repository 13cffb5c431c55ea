//! Scenes as files write them.

use super::{CausticSpec, DofSpec, ImageSpec, MotionSpec, PrimitivesSpec, WideImageSpec};
use crate::experiment::input::{self, Sweep};
use crate::scene::Rgb;
use crate::scene::library::View;
use serde::Deserialize;

/// A scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SceneSpec {
    /// See [`crate::scene::library::SceneKind::Furnace`].
    Furnace(FurnaceSpec),
    /// See [`crate::scene::library::SceneKind::FurnaceBox`].
    FurnaceBox(FurnaceSpec),
    /// See [`crate::scene::library::SceneKind::IntegratingSphere`].
    IntegratingSphere(SphereSpec),
    /// See [`crate::scene::library::SceneKind::CornellBox`].
    CornellBox(CornellSpec),
    /// See [`crate::scene::library::SceneKind::CornellEmpty`].
    CornellEmpty(CornellSpec),
    /// See [`crate::scene::library::SceneKind::CornellFlush`].
    CornellFlush(FlushSpec),
    /// See [`crate::scene::library::SceneKind::ManySpheres`].
    ManySpheres(ManySpheresSpec),
    /// See [`crate::scene::lecture::Lecture::CausticGlass`].
    CausticGlass(CausticSpec),
    /// See [`crate::scene::lecture::Lecture::CausticMirror`].
    CausticMirror(CausticSpec),
    /// See [`crate::scene::lecture::Lecture::Indirect`].
    Indirect(ImageSpec),
    /// See [`crate::scene::lecture::Lecture::Smallpt`].
    Smallpt(WideImageSpec),
    /// See [`crate::scene::lecture::Lecture::VeachMis`].
    VeachMis(ImageSpec),
    /// See [`crate::scene::lecture::Lecture::Dof`].
    Dof(DofSpec),
    /// See [`crate::scene::lecture::Lecture::Motion`].
    Motion(MotionSpec),
    /// A scene of the gallery, which has a closed form; see [`crate::truth::gallery`].
    Exhibit {
        /// Its name in the gallery.
        name: String,
        /// Its parameter, if it is not to have its usual value.
        #[serde(default)]
        parameter: Option<Sweep>,
    },
    /// Written out primitive by primitive.
    Primitives(PrimitivesSpec),
}

/// A closed enclosure of one material.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FurnaceSpec {
    /// Albedo, one number or one a channel.
    #[serde(deserialize_with = "input::albedo")]
    pub albedo: Rgb,
    /// Emitted radiance.
    #[serde(deserialize_with = "input::radiance")]
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
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SphereSpec {
    /// The light's fraction of the sphere's area.
    #[serde(deserialize_with = "input::fractions")]
    pub light_fraction: Sweep,
    /// What the light reflects.
    #[serde(deserialize_with = "input::albedo")]
    pub light_albedo: Rgb,
    /// What the light emits.
    #[serde(deserialize_with = "input::radiance")]
    pub emission: Rgb,
    /// What the wall reflects.
    #[serde(deserialize_with = "input::albedo")]
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
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchSpec {
    /// Fraction of the sphere's area.
    #[serde(deserialize_with = "input::probability")]
    pub fraction: f64,
    /// What it reflects.
    #[serde(deserialize_with = "input::albedo")]
    pub albedo: Rgb,
    /// What it emits.
    #[serde(default, deserialize_with = "input::radiance")]
    pub emission: Rgb,
}

/// What a probe in an integrating sphere looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LooksAt {
    /// The wall.
    Wall,
    /// The light.
    Light,
}

/// A Cornell box.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CornellSpec {
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    pub resolution: u32,
}

impl Default for CornellSpec {
    fn default() -> Self {
        CornellSpec { resolution: 32 }
    }
}

/// A Cornell box for closed forms.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FlushSpec {
    /// Which tiles are measured, 1 to 6.
    #[serde(deserialize_with = "input::tiles")]
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
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ManySpheresSpec {
    /// How many.
    #[serde(deserialize_with = "input::ball_counts")]
    pub count: Option<Sweep>,
    /// Pixels along each edge of the image.
    #[serde(deserialize_with = "input::resolution")]
    pub resolution: u32,
}

impl Default for ManySpheresSpec {
    fn default() -> Self {
        ManySpheresSpec { count: None, resolution: 128 }
    }
}
