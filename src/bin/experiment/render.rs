//! One image.

use crate::args::{Options, Render};
use crate::run::pool;
use crate::{HELD, INTERRUPTED, subject};
use anstream::{eprintln, println};
use furnace::experiment::plan::PATIENCE;
use furnace::experiment::{CellPlan, Error, run_cell};
use furnace::report::images;
use furnace::sampling::Address;
use furnace::truth::Truth;
use std::sync::atomic::AtomicBool;

/// Renders `args.scene` and writes an EXR with a PNG beside it.
pub fn render(args: &Render, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    subject::must_be_exr(&args.output)?;
    let scene = subject::scene(&args.scene, args.resolution, options)?;
    let (width, height) = scene.build().sensor.resolution();
    let estimator = subject::estimator(&args.estimator, (width, height))?;
    if width * height == 1 {
        return Err(Error::Refused(format!("{} has no camera, so there is no image to render", args.scene)));
    }
    let core = options.core.unwrap_or_default().if_offered(&scene.build(), &estimator);
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
        core,
        params: Default::default(),
        samples: args.spp.div_ceil(2) * 2,
        block: 2,
        traced: false,
        runs: 1,
        rays: 0.0,
        finds_all: true,
        fault: None,
        paired: false,
        streams: Vec::new(),
        may_stop: false,
        studied: false,
        patience: PATIENCE,
        pixels: u64::from(width) * u64::from(height),
        scene,
        estimator,
    };
    let Some(cell) = pool(options)?.install(|| run_cell(&plan, stop, &|_| (), &|_| false)) else {
        eprintln!("interrupted: nothing was written");
        return Ok(INTERRUPTED);
    };
    if let Some(failure) = &cell.failure {
        return Err(Error::Refused(format!("{}: {failure}", args.scene)));
    }
    let truth = Truth::of(&plan.scene, &plan.estimator, &[]);
    let exr = images::exr(&cell.pixels, truth.reference());
    exr.map_err(|e| std::io::Error::other(e.to_string()))
        .and_then(|bytes| std::fs::write(&args.output, bytes))
        .map_err(|e| Error::io("cannot write", &args.output, e))?;
    let preview = args.output.with_extension("png");
    let png = images::png(&cell.pixels, images::exposure(cell.pixels.mean.iter().map(|v| v.max_element())));
    std::fs::write(&preview, png).map_err(|e| Error::io("cannot write", &preview, e))?;
    println!("{} and {}", args.output.display(), preview.display());
    Ok(HELD)
}
