//! Scenes by name, as files call them, with everything else at its usual value.

use furnace::experiment::Error;
use furnace::experiment::choices::scenes;
use furnace::experiment::spec::{FurnaceSpec, SceneSpec, SphereSpec};
use furnace::scene::library::SceneKind;
use furnace::truth::gallery::EXHIBITS;

/// All but those of the gallery.
const NAMES: [&str; 6] =
    ["cornell_box", "cornell_empty", "cornell_flush", "furnace", "furnace_box", "integrating_sphere"];

/// What can be said of a scene apart from its name.
#[derive(Clone, Copy, Default)]
pub struct Details {
    /// Pixels along each edge of the image of a Cornell box.
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
    let is_image = matches!(name, "cornell_box" | "cornell" | "cornell_empty");
    let kind = match name {
        "cornell_box" | "cornell" => SceneKind::CornellBox { resolution: resolution.unwrap_or(32) },
        "cornell_empty" => SceneKind::CornellEmpty { resolution: resolution.unwrap_or(32) },
        "cornell_flush" => {
            let tile = usize::from(tile.unwrap_or(1)) - 1;
            SceneKind::CornellFlush { tile, blocks }
        }
        "furnace" => usual(&SceneSpec::Furnace(FurnaceSpec::default()))?,
        "furnace_box" => usual(&SceneSpec::FurnaceBox(FurnaceSpec::default()))?,
        "integrating_sphere" => usual(&SceneSpec::IntegratingSphere(SphereSpec::default()))?,
        _ if EXHIBITS.iter().any(|exhibit| exhibit.name == name) => {
            usual(&SceneSpec::Exhibit { name: name.to_owned(), parameter: None })?
        }
        _ => {
            let known: Vec<&str> = NAMES.into_iter().chain(EXHIBITS.iter().map(|e| e.name)).collect();
            return Err(Error::Refused(format!("no scene `{name}`; there are {}", known.join(", "))));
        }
    };
    has("--resolution", resolution.is_some() && !is_image)?;
    has("--tile", tile.is_some() && name != "cornell_flush")?;
    has("--blocks", blocks && name != "cornell_flush")?;
    Ok(kind)
}

fn usual(spec: &SceneSpec) -> Result<SceneKind, Error> {
    let mut choices = scenes(spec).map_err(Error::Refused)?;
    Ok(choices.swap_remove(0).value)
}
