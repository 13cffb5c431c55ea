//! One image.

use crate::args::{Options, Render};
use crate::run::pool;
use crate::scene::{Details, named};
use crate::{HELD, INTERRUPTED};
use furnace::estimator::{Estimator, Explicit, Implicit, Roulette, Rule, Technique};
use furnace::experiment::{CellPlan, Error, run_cell};
use furnace::report::images;
use furnace::sampling::Address;
use furnace::scene::library::SceneKind;
use furnace::scene::{Directions, LightSampling};
use std::sync::atomic::AtomicBool;

/// Renders `args.scene` and writes an EXR with a PNG beside it.
pub fn render(args: &Render, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    if args.output.extension().is_none_or(|extension| extension != "exr") {
        let output = args.output.display();
        return Err(Error::Refused(format!("{output} must end in .exr; a PNG preview goes beside it")));
    }
    let resolution = args.resolution;
    let scene = match named(&args.scene, Details::default())? {
        SceneKind::CornellBox { .. } => SceneKind::CornellBox { resolution },
        SceneKind::CornellEmpty { .. } => SceneKind::CornellEmpty { resolution },
        _ => {
            return Err(Error::Refused(format!(
                "{} has no image; cornell_box and cornell_empty have one",
                args.scene
            )));
        }
    };
    let roulette = Roulette { rule: Rule::Throughput { floor: 0.05 }, from: 5, clamp: None };
    let (technique, lights, directions) = (Technique::Light, LightSampling::AREA, Directions::Cosine);
    let estimator = match args.estimator.as_str() {
        "explicit" => Estimator::Explicit(Explicit { technique, lights, directions, roulette }),
        "implicit" => Estimator::Implicit(Implicit { directions, roulette }),
        other => {
            return Err(Error::Refused(format!("no estimator `{other}`; there are explicit, implicit")));
        }
    };
    let pixels = u64::from(resolution) * u64::from(resolution);
    let plan = CellPlan {
        address: Address::of(&[
            "render",
            &options.seed.unwrap_or(1).to_string(),
            &args.scene,
            &args.estimator,
        ]),
        scene_label: args.scene.clone(),
        estimator_label: args.estimator.clone(),
        roulette_label: "throughput".to_owned(),
        params: Default::default(),
        samples: args.spp.div_ceil(2) * 2,
        block: 2,
        rays: 0.0,
        scene,
        estimator,
        pixels,
    };
    let Some(cell) = pool(options)?.install(|| run_cell(&plan, stop, &|_| ())) else {
        eprintln!("interrupted: nothing was written");
        return Ok(INTERRUPTED);
    };
    images::write_exr(&args.output, &cell.pixels, &plan.scene)
        .map_err(|e| Error::io("cannot write", &args.output, std::io::Error::other(e.to_string())))?;
    let preview = args.output.with_extension("png");
    let png = images::png(&cell.pixels, images::exposure(&cell.pixels));
    std::fs::write(&preview, png).map_err(|e| Error::io("cannot write", &preview, e))?;
    println!("{} and {}", args.output.display(), preview.display());
    Ok(HELD)
}
