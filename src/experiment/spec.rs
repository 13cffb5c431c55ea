//! An experiment file, exactly as it was written.

use super::error::Error;
use super::input::{self, Named, Sweep, Tables};
use crate::scene::camera::Pinhole;
use crate::scene::geometry::{Disk, Rectangle, Triangle};
use crate::scene::library::View;
use crate::scene::{Directions, LightSampling, Rgb};
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;

/// An experiment file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// What the experiment asks.
    pub question: String,
    /// What was found when it was last looked at.
    #[serde(default)]
    pub answer: String,
    /// All chance follows from it.
    #[serde(default = "one")]
    pub seed: u64,
    /// Whether cells share their random numbers.
    #[serde(default)]
    pub streams: Streams,
    /// Realizations a cell: paths for a probe, image passes (samples a pixel) for a camera.
    #[serde(deserialize_with = "input::samples")]
    pub samples: u64,
    /// Where theory gives a cell's variance, it gets as many realizations as its claim needs, up to this many.
    #[serde(default, deserialize_with = "input::optional_samples")]
    pub max_samples: Option<u64>,
    /// What is run: every combination within each grid.
    pub grid: Tables<Grid>,
    /// What is claimed of the cells.
    #[serde(default)]
    pub claim: Vec<Claim>,
    /// What is drawn.
    #[serde(default)]
    pub plot: Vec<Plot>,
}

fn one() -> u64 {
    1
}

/// Whether cells share their random numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Streams {
    /// Each cell has its own.
    #[default]
    Independent,
    /// Cells of one scene share theirs (common random numbers).
    Paired,
}

/// Every combination of the listed scenes, estimators and termination rules.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Scenes.
    pub scene: Spanned<Vec<Spanned<Named<SceneSpec>>>>,
    /// Estimators.
    pub estimator: Spanned<Vec<Spanned<Named<EstimatorSpec>>>>,
    /// Termination rules.
    pub roulette: Spanned<Vec<Spanned<Named<RouletteSpec>>>>,
    /// Realizations a cell of this grid, instead of the file's.
    #[serde(default, deserialize_with = "input::optional_samples")]
    pub samples: Option<u64>,
}

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

/// A scene written out in the file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrimitivesSpec {
    /// What it is called in results.
    pub name: String,
    /// Its surfaces.
    pub primitives: Vec<PrimitiveSpec>,
    /// What is measured.
    pub sensor: SensorSpec,
}

/// A surface written out in the file.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrimitiveSpec {
    /// Where it is.
    pub shape: ShapeSpec,
    /// What it reflects.
    #[serde(default, deserialize_with = "input::albedo")]
    pub albedo: Rgb,
    /// What it emits.
    #[serde(default, deserialize_with = "input::radiance")]
    pub emission: Rgb,
}

/// A shape written out in the file; it shows one side, the front, and is black from behind.
#[derive(Clone, Copy, Debug, Deserialize)]
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
        center: DVec3,
        /// Radius.
        #[serde(deserialize_with = "input::length")]
        radius: f64,
        /// Whether the front is the inside.
        #[serde(default)]
        inward: bool,
    },
    /// A band of a sphere.
    SpherePatch {
        /// Centre.
        #[serde(deserialize_with = "input::vector")]
        center: DVec3,
        /// Radius.
        #[serde(deserialize_with = "input::length")]
        radius: f64,
        /// The pole.
        #[serde(deserialize_with = "input::direction")]
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
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SensorSpec {
    /// One ray.
    Probe {
        /// Where the eye is.
        #[serde(deserialize_with = "input::vector")]
        origin: DVec3,
        /// Where it looks.
        #[serde(deserialize_with = "input::direction")]
        direction: DVec3,
    },
    /// A small plate in free space.
    Irradiance {
        /// Where it is.
        #[serde(deserialize_with = "input::vector")]
        point: DVec3,
        /// Where it faces.
        #[serde(deserialize_with = "input::direction")]
        normal: DVec3,
    },
    /// A pinhole camera with square images.
    Camera {
        /// Where the eye is.
        #[serde(deserialize_with = "input::vector")]
        origin: DVec3,
        /// Where it looks.
        #[serde(deserialize_with = "input::direction")]
        direction: DVec3,
        /// Which way is up.
        #[serde(deserialize_with = "input::direction")]
        up: DVec3,
        /// Full field of view [degrees].
        #[serde(deserialize_with = "input::field_of_view")]
        fov: f64,
        /// Pixels along each edge.
        #[serde(deserialize_with = "input::resolution")]
        resolution: u32,
    },
}

impl SensorSpec {
    /// The camera, if it is one.
    pub fn pinhole(&self) -> Option<Pinhole> {
        match *self {
            SensorSpec::Camera { origin, direction, up, fov, resolution } => {
                Some(Pinhole::new(origin, direction, up, fov, (resolution, resolution)))
            }
            _ => None,
        }
    }
}

/// An estimator.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum EstimatorSpec {
    /// N samples at each vertex.
    Recursive {
        /// N.
        #[serde(deserialize_with = "input::positive_counts")]
        samples: Sweep,
        /// The largest number of bounces.
        #[serde(deserialize_with = "input::counts")]
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
        /// How points on emitters are drawn.
        #[serde(default)]
        lights: LightSampling,
        /// How directions are drawn.
        #[serde(default)]
        directions: Directions,
    },
}

/// A termination rule.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RouletteSpec {
    /// No roulette; light scattered more often is left out.
    DepthClamp {
        /// The largest number of bounces.
        #[serde(deserialize_with = "input::counts")]
        bounces: Sweep,
    },
    /// The same q everywhere.
    Constant {
        /// Expected number of continuations.
        #[serde(deserialize_with = "input::survival")]
        q: Sweep,
        /// The first so many bounces are certain.
        #[serde(default)]
        from: u32,
        /// The largest number of bounces.
        #[serde(default)]
        clamp: Option<u32>,
    },
    /// q = largest channel of the albedo.
    Albedo {
        /// The first so many bounces are certain.
        #[serde(default)]
        from: u32,
        /// The largest number of bounces.
        #[serde(default)]
        clamp: Option<u32>,
    },
    /// q = largest channel of the throughput.
    Throughput {
        /// Lower limit of q.
        #[serde(default = "small", deserialize_with = "input::probability")]
        floor: f64,
        /// The first so many bounces are certain.
        #[serde(default)]
        from: u32,
        /// The largest number of bounces.
        #[serde(default)]
        clamp: Option<u32>,
    },
}

fn small() -> f64 {
    0.05
}

/// What is claimed of every cell for which it is legal.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Claim {
    /// The mean, total and per bounce, is what theory or a reference says (for a clamped cell: theory's biased mean).
    Unbiased(Limits),
    /// The means of the image's tiles are those of the reference.
    Tiles(Limits),
    /// The sample variance is theory's.
    Variance(Limits),
    /// The rays a realization are theory's.
    Cost(Limits),
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
        alpha: f64,
        /// Largest difference that counts as none, relative to the total.
        #[serde(deserialize_with = "input::inside_unit")]
        margin: f64,
    },
}

impl Claim {
    /// Probability of any false alarm among its questions.
    pub fn alpha(&self) -> f64 {
        match self {
            Claim::Unbiased(l) | Claim::Tiles(l) | Claim::Variance(l) | Claim::Cost(l) => l.alpha,
            Claim::Agree { alpha, .. } => *alpha,
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
}

impl Limits {
    /// Whether a claim with these limits is about this scene.
    pub fn covers(&self, scene: &str) -> bool {
        self.scene.as_ref().is_none_or(|only| only == scene)
    }
}

/// Error probability and margin of a claim.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The only scene it is about; all scenes if left out.
    #[serde(default)]
    pub scene: Option<String>,
    /// Probability of any false alarm among all questions of this claim.
    #[serde(deserialize_with = "input::inside_unit")]
    pub alpha: f64,
    /// Largest difference that counts as none, relative to the expected total.
    #[serde(deserialize_with = "input::inside_unit")]
    pub margin: f64,
}

/// A figure for each scene.
#[derive(Clone, Debug, Deserialize)]
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
    /// Bias of every cell with its interval, against the margin.
    Bias {},
}

fn channel() -> String {
    "channel".to_owned()
}

/// What a figure can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
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
}

/// Reads an experiment file; `source` is its text.
pub fn parse(file: &Path, source: &str) -> Result<Spec, Error> {
    toml::from_str(source).map_err(|error| Error::toml(file, source, &error))
}
