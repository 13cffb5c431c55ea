//! Scenes and estimators by name, for commands without an experiment file.

use crate::args::Options;
use crate::files::Source;
use furnace::estimator::{
    DirectLight, Estimator, Explicit, Gather, Implicit, Kernel, Last, LightTracing, PhotonMap, Roulette,
    Rule, Technique,
};
use furnace::experiment::spec::{
    CausticSpec, DofSpec, FurnaceSpec, ImageSpec, ManySpheresSpec, MotionSpec, SceneSpec, SphereSpec,
    WideImageSpec,
};
use furnace::experiment::{Error, choices, plan};
use furnace::scene::library::SceneKind;
use furnace::scene::{Directions, LightSampling};
use furnace::truth::gallery::EXHIBITS;
use std::path::Path;

/// The scene that a file would name so, at this resolution if it has one; or `FILE.toml:NAME`, a scene of an
/// experiment file.
pub fn scene(name: &str, resolution: u32, options: &Options) -> Result<SceneKind, Error> {
    if let Some((file, label)) = name.rsplit_once(".toml:") {
        return scene_of_file(&format!("{file}.toml"), label, options);
    }
    // only images have a resolution
    let resolution = is_image(name).then_some(resolution);
    named(name, Details { resolution, ..Details::default() })
}

fn scene_of_file(file: &str, label: &str, options: &Options) -> Result<SceneKind, Error> {
    let source = Source::read(file, options)?;
    let cells = plan::cells(&source.file, &source.text)?;
    let mut found = cells.iter().filter(|cell| cell.scene_label == label).map(|cell| &cell.scene);
    match found.next() {
        Some(first) if found.all(|other| other == first) => Ok(first.clone()),
        Some(_) => Err(Error::Refused(format!("{file} has several scenes called `{label}`"))),
        None => Err(Error::Refused(format!("{file} has no scene called `{label}`"))),
    }
}

/// Names of all scenes.
pub fn names() -> impl Iterator<Item = &'static str> {
    NAMES.into_iter().chain(EXHIBITS.iter().map(|exhibit| exhibit.name))
}

/// Names of estimators that need no parameters.
pub const ESTIMATORS: [&str; 4] = ["explicit", "implicit", "light_tracing", "photon_map"];

/// All but those of the gallery.
const NAMES: [&str; 16] = [
    "cornell_box",
    "cornell_empty",
    "cornell_flush",
    "furnace",
    "furnace_box",
    "integrating_sphere",
    "many_spheres",
    "caustic_glass",
    "caustic_glass_point",
    "caustic_mirror",
    "caustic_mirror_point",
    "indirect",
    "smallpt",
    "veach_mis",
    "dof",
    "motion",
];

/// What can be said of a scene apart from its name.
#[derive(Clone, Copy, Default)]
pub struct Details {
    /// Pixels along each edge of the image, if it has one; of `smallpt`, from top to bottom.
    pub resolution: Option<u32>,
    /// The tile of `cornell_flush`, 1 to 6.
    pub tile: Option<u8>,
    /// Whether the blocks stand in `cornell_flush`.
    pub blocks: bool,
}

/// The scene of this name; a detail that it does not have is refused.
pub fn named(name: &str, details: Details) -> Result<SceneKind, Error> {
    let Details { resolution, tile, blocks } = details;
    let has = |option: &str, given: bool| match given {
        true => Err(Error::Refused(format!("{name} has no {option}"))),
        false => Ok(()),
    };
    let kind = match (image(name, resolution), name) {
        (Some(spec), _) => usual(&spec)?,
        (None, "cornell_box" | "cornell") => SceneKind::CornellBox { resolution: resolution.unwrap_or(32) },
        (None, "cornell_empty") => SceneKind::CornellEmpty { resolution: resolution.unwrap_or(32) },
        (None, "cornell_flush") => {
            let tile = usize::from(tile.unwrap_or(1)) - 1;
            SceneKind::CornellFlush { tile, blocks }
        }
        (None, "furnace") => usual(&SceneSpec::Furnace(FurnaceSpec::default()))?,
        (None, "furnace_box") => usual(&SceneSpec::FurnaceBox(FurnaceSpec::default()))?,
        (None, "integrating_sphere") => usual(&SceneSpec::IntegratingSphere(SphereSpec::default()))?,
        _ if EXHIBITS.iter().any(|exhibit| exhibit.name == name) => {
            usual(&SceneSpec::Exhibit { name: name.to_owned(), parameter: None })?
        }
        _ => {
            let known: Vec<&str> = names().collect();
            return Err(Error::unknown("scene", name, &known));
        }
    };
    has("--resolution", resolution.is_some() && !is_image(name))?;
    has("--tile", tile.is_some() && name != "cornell_flush")?;
    has("--blocks", blocks && name != "cornell_flush")?;
    Ok(kind)
}

/// How an experiment file names the scene, at this resolution if it is an image.
pub fn written(name: &str, resolution: u32) -> String {
    if EXHIBITS.iter().any(|exhibit| exhibit.name == name) {
        return format!("{{ exhibit = {{ name = \"{name}\" }} }}");
    }
    match (name.strip_suffix("_point"), is_image(name)) {
        (Some(name), _) => format!("{{ {name} = {{ point = true, resolution = {resolution} }} }}"),
        (None, true) => format!("{{ {name} = {{ resolution = {resolution} }} }}"),
        (None, false) => format!("\"{name}\""),
    }
}

/// Whether a scene is looked at by a camera whose resolution can be chosen.
pub fn is_image(name: &str) -> bool {
    matches!(name, "cornell_box" | "cornell" | "cornell_empty") || image(name, None).is_some()
}

/// A scene that is looked at by a camera, with its usual parameters.
fn image(name: &str, resolution: Option<u32>) -> Option<SceneSpec> {
    let plain = || resolution.map_or_else(ImageSpec::default, |resolution| ImageSpec { resolution });
    let caustic = |point| {
        let usual = CausticSpec::default();
        CausticSpec { point, resolution: resolution.unwrap_or(usual.resolution), ..usual }
    };
    Some(match name {
        "many_spheres" => SceneSpec::ManySpheres(ManySpheresSpec {
            resolution: plain().resolution,
            ..ManySpheresSpec::default()
        }),
        "caustic_glass" => SceneSpec::CausticGlass(caustic(false)),
        "caustic_glass_point" => SceneSpec::CausticGlass(caustic(true)),
        "caustic_mirror" => SceneSpec::CausticMirror(caustic(false)),
        "caustic_mirror_point" => SceneSpec::CausticMirror(caustic(true)),
        "indirect" => SceneSpec::Indirect(plain()),
        "smallpt" => {
            let usual = WideImageSpec::default().resolution;
            SceneSpec::Smallpt(WideImageSpec { resolution: resolution.unwrap_or(usual) })
        }
        "veach_mis" => SceneSpec::VeachMis(plain()),
        "dof" => SceneSpec::Dof(DofSpec { resolution: plain().resolution, ..DofSpec::default() }),
        "motion" => SceneSpec::Motion(MotionSpec { resolution: plain().resolution, ..MotionSpec::default() }),
        _ => return None,
    })
}

fn usual(spec: &SceneSpec) -> Result<SceneKind, Error> {
    let mut choices = choices::scenes(spec).map_err(Error::Refused)?;
    Ok(choices.swap_remove(0).value)
}

/// An estimator with parameters that do well in most scenes, for a sensor of this resolution.
pub fn estimator(name: &str, resolution: (u32, u32)) -> Result<Estimator, Error> {
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    match name {
        "explicit" => {
            Ok(Estimator::Explicit(Explicit { technique: Technique::Light, lights, directions, roulette }))
        }
        "implicit" => Ok(Estimator::Implicit(Implicit { directions, roulette })),
        "light_tracing" => {
            let (width, height) = resolution;
            let particles = u64::from(width) * u64::from(height);
            Ok(Estimator::LightTracing(LightTracing { particles, directions, roulette }))
        }
        "photon_map" => Ok(Estimator::PhotonMap(PhotonMap {
            photons: 200_000,
            gather: Gather::Nearest { k: 100, last: Last::LeftOut },
            kernel: Kernel::Box,
            direct: DirectLight::Photons,
            final_gather: 0,
            directions,
            roulette: Roulette { from: 0, ..roulette },
        })),
        other => Err(Error::unknown("estimator", other, &ESTIMATORS)),
    }
}

/// Refuses to write an EXR under another kind of name.
pub fn must_be_exr(output: &Path) -> Result<(), Error> {
    if output.extension().is_some_and(|extension| extension == "exr") {
        return Ok(());
    }
    Err(Error::Refused(format!("{} must end in .exr", output.display())))
}
