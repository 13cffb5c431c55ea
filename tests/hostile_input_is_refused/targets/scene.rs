//! Scenes that files write out, as `FILE.toml:NAME` takes them.

use super::{NOWHERE, says_where};
use furnace::experiment::plan;
use furnace::sampling::Address;
use furnace::scene::library::SceneKind;
use std::path::Path;

/// The scenes of an experiment file: each can be stored and read again, built, and looked at.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let file = Path::new(NOWHERE).join("hostile.toml");
    let cells = match plan::cells(&file, text) {
        Ok(cells) => cells,
        Err(error) => return says_where(&error, &file),
    };
    let mut scenes: Vec<&SceneKind> = cells.iter().map(|cell| &cell.scene).collect();
    scenes.dedup();
    for kind in scenes.into_iter().take(4) {
        let stored = serde_json::to_string(kind).expect("a scene has a JSON form");
        let read: SceneKind = serde_json::from_str(&stored).expect("what is stored can be read");
        assert!(read == *kind, "a scene that is stored is another one: {stored}");
        let built = kind.build();
        let (width, height) = built.sensor.resolution();
        assert!(width > 0 && height > 0);
        let address = Address::of(&["hostile"]);
        for ray in 0..4 {
            let start = built.start((ray as u32 % width, 0), &mut address.stream(ray, 0));
            let Some(met) = built.intersect(&start.ray, start.time) else { continue };
            assert!(met.material.le.is_finite(), "light that is no number");
        }
    }
}
