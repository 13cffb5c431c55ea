//! An experiment file, exactly as it was written.

mod claim;
mod lecture;
mod null;
mod photons;
mod primitives;
mod scene;
mod walk;

pub use claim::{Claim, ErrorKind, Limits, Plot, Quantity};
pub use lecture::{CausticSpec, DofSpec, ImageSpec, MotionSpec, WideImageSpec};
pub use null::NullSpec;
pub use photons::{LightTracingSpec, PhotonMapSpec, ProgressiveSpec};
pub use primitives::{BsdfSpec, PointSpec, PrimitiveSpec, PrimitivesSpec, SensorSpec, ShapeSpec, SkySpec};
pub use scene::{FlushSpec, FurnaceSpec, LooksAt, ManySpheresSpec, SceneSpec, SphereSpec};
pub use walk::{EstimatorSpec, FaultNames, RouletteSpec, TechniqueSpec};

use super::core::Core;
use super::error::Error;
use super::input::{self, Named, Tables, schema};
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// An experiment file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
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
    /// Whether estimators with a known mistake may be named.
    #[serde(default)]
    pub faults: bool,
    /// So many times each cell is run and judged on its own, with a seed each: not what is right is asked then, but how
    /// often the instruments say so.
    #[serde(default, deserialize_with = "input::optional_seeds")]
    #[schemars(schema_with = "schema::optional_seeds")]
    pub seeds: Option<u32>,
    /// Whether cells share their random numbers.
    #[serde(default)]
    pub streams: Streams,
    /// What follows paths.
    #[serde(default)]
    pub core: Core,
    /// Realizations a cell: paths for a probe, image passes (samples a pixel) for a camera.
    #[serde(deserialize_with = "input::samples")]
    #[schemars(schema_with = "schema::samples")]
    pub samples: u64,
    /// Where theory gives a cell's variance, it gets as many realizations as its claim needs, up to this many.
    #[serde(default, deserialize_with = "input::optional_samples")]
    #[schemars(schema_with = "schema::optional_samples")]
    pub max_samples: Option<u64>,
    /// Paths of a block, at most: fewer and larger ones make journals of very many samples small.
    #[serde(default, deserialize_with = "input::optional_block")]
    #[schemars(schema_with = "schema::optional_block")]
    pub block: Option<u64>,
    /// Each cell's samples are cut into so many runs, whose means are looked at as they grow.
    #[serde(default)]
    #[schemars(schema_with = "schema::runs")]
    pub runs: Option<Spanned<Runs>>,
    /// What is run: every combination within each grid.
    pub grid: Tables<Grid>,
    /// Stored images that scenes are compared with.
    #[serde(default, deserialize_with = "input::tables")]
    pub reference: Vec<ReferenceSpec>,
    /// Samples of known laws, on which the instruments themselves are measured.
    #[serde(default, deserialize_with = "input::tables")]
    pub null: Vec<NullSpec>,
    /// What is claimed of the cells.
    #[serde(default, deserialize_with = "input::tables")]
    pub claim: Vec<Claim>,
    /// What is drawn.
    #[serde(default, deserialize_with = "input::tables")]
    pub plot: Vec<Plot>,
}

fn one() -> u64 {
    1
}

/// Whether cells share their random numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Streams {
    /// Each cell has its own.
    #[default]
    Independent,
    /// Cells of one scene share theirs (common random numbers).
    Paired,
}

/// Every combination of the listed scenes, estimators and termination rules.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Scenes.
    #[schemars(with = "Vec<Named<SceneSpec>>", length(min = 1))]
    pub scene: Spanned<Vec<Spanned<Named<SceneSpec>>>>,
    /// Estimators.
    #[schemars(with = "Vec<Named<EstimatorSpec>>", length(min = 1))]
    pub estimator: Spanned<Vec<Spanned<Named<EstimatorSpec>>>>,
    /// Termination rules.
    #[schemars(with = "Vec<Named<RouletteSpec>>", length(min = 1))]
    pub roulette: Spanned<Vec<Spanned<Named<RouletteSpec>>>>,
    /// Realizations a cell of this grid, instead of the file's.
    #[serde(default, deserialize_with = "input::optional_samples")]
    #[schemars(schema_with = "schema::optional_samples")]
    pub samples: Option<u64>,
    /// Runs that a cell of this grid is cut into, instead of the file's.
    #[serde(default)]
    #[schemars(schema_with = "schema::runs")]
    pub runs: Option<Spanned<Runs>>,
}

/// A number of runs, which must be enough for an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Runs(pub u64);

impl<'de> Deserialize<'de> for Runs {
    fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        input::runs(d).map(Runs)
    }
}

/// A stored image of a scene, used where theory has no closed form. It stands before the one that comes with the
/// program; if this program made it, after that one, and for other kinds of estimators only.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceSpec {
    /// What the scene is called in results.
    #[schemars(with = "String")]
    pub scene: Spanned<String>,
    /// An EXR file, relative to the experiment file and in the folder of its project.
    #[schemars(with = "String")]
    pub file: Spanned<PathBuf>,
    /// Bound on the relative systematic error of tiles, such as that of a renderer in single precision.
    #[serde(default, deserialize_with = "input::relative_error")]
    #[schemars(schema_with = "schema::relative_error")]
    pub systematic: f64,
    /// Degrees of freedom of standard errors that the file states; that of 32 renderings, if left out.
    #[serde(default, deserialize_with = "input::optional_count")]
    #[schemars(schema_with = "schema::optional_count")]
    pub degrees_of_freedom: Option<u32>,
}

/// The JSON schema of experiment files, by which editors complete and check them. What it refuses is refused here too, but
/// not the other way round: no schema knows which walks end.
pub fn schema() -> String {
    // the draft that editors of TOML know
    let settings = SchemaSettings::draft07().with_transform(schema::for_files);
    let mut schema = settings.into_generator().into_root_schema_for::<Spec>();
    schema.insert("title".to_owned(), "An experiment of furnace".into());
    serde_json::to_string_pretty(&schema).expect("a schema is JSON") + "\n"
}

/// Reads an experiment file; `source` is its text.
pub fn parse(file: &Path, source: &str) -> Result<Spec, Error> {
    toml::from_str(source).map_err(|error| Error::toml(file, source, &error))
}
