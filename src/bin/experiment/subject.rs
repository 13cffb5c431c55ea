//! Scenes and estimators by name, for commands without an experiment file.

use crate::args::Options;
use crate::files::Source;
use furnace::estimator::{Estimator, Explicit, Implicit, Roulette, Rule, Technique};
use furnace::experiment::input::Named;
use furnace::experiment::spec::SceneSpec;
use furnace::experiment::{Error, choices, plan};
use furnace::scene::library::SceneKind;
use furnace::scene::{Directions, LightSampling};
use serde::Deserialize;
use serde_json::json;
use std::path::Path;

/// The scene that a file would name so, at this resolution if it has one; or `FILE.toml:NAME`, a scene of an
/// experiment file.
pub fn scene(name: &str, resolution: u32, options: &Options) -> Result<SceneKind, Error> {
    if let Some((file, label)) = name.rsplit_once(".toml:") {
        return scene_of_file(&format!("{file}.toml"), label, options);
    }
    let name = if name == "cornell" { "cornell_box" } else { name };
    let refused = |why: String| Error::Refused(format!("no scene `{name}`: {why}"));
    // only cameras have a resolution; all scenes have their defaults
    let with_resolution = Named::<SceneSpec>::deserialize(json!({ name: { "resolution": resolution } }));
    let spec = with_resolution.or_else(|_| Named::<SceneSpec>::deserialize(json!(name)));
    let spec = spec.map_err(|e| refused(e.to_string()))?;
    let mut scenes = choices::scenes(&spec.0).map_err(refused)?;
    Ok(scenes.swap_remove(0).value)
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

/// An unbiased estimator with parameters that do well in most scenes.
pub fn estimator(name: &str) -> Result<Estimator, Error> {
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    match name {
        "explicit" => {
            Ok(Estimator::Explicit(Explicit { technique: Technique::Light, lights, directions, roulette }))
        }
        "implicit" => Ok(Estimator::Implicit(Implicit { directions, roulette })),
        other => Err(Error::Refused(format!("no estimator `{other}`; there are explicit, implicit"))),
    }
}

/// Refuses to write an EXR under another kind of name.
pub fn must_be_exr(output: &Path) -> Result<(), Error> {
    if output.extension().is_some_and(|extension| extension == "exr") {
        return Ok(());
    }
    Err(Error::Refused(format!("{} must end in .exr", output.display())))
}
