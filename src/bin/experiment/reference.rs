//! References of our own.

use crate::args::{Options, Reference};
use crate::run::pool;
use crate::{HELD, INTERRUPTED, NOT_HELD, files, subject};
use anstream::{eprintln, println};
use furnace::experiment::Error;
use furnace::experiment::making::{self, Ended, Goal};
use furnace::report::plots;
use furnace::truth::Own;
use indicatif::ProgressBar;
use std::io::{IsTerminal, stderr};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// Makes a reference of `args.scene`, or goes on with the one that is there.
pub fn reference(args: &Reference, options: &Options, stop: &AtomicBool) -> Result<u8, Error> {
    let scene = subject::scene(&args.scene, args.resolution, options)?;
    let estimator = subject::estimator(&args.estimator, scene.build().sensor.resolution())?;
    let label = args.scene.rsplit_once(".toml:").map_or(args.scene.as_str(), |(_, label)| label);
    let by_default = || files::root().join("references/own").join(plots::file_name(&[label]) + ".exr");
    let path: PathBuf = args.output.clone().unwrap_or_else(by_default);
    subject::must_be_exr(&path)?;
    let wanted = making::begin(&scene, &estimator, options.seed.unwrap_or(1))?;
    let mut own = making::resume(&path, wanted)?;
    making::writable(&path)?;

    let before = own.provenance.samples;
    let goal = Goal { error: args.until_error, most: args.max_samples };
    let terminal = stderr().is_terminal();
    let bar = if options.quiet || !terminal { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    let mut told = before;
    let mut progress = |own: &Own| {
        bar.set_message(state(own));
        bar.tick();
        // a line for each doubling, where nobody watches a bar
        if !options.quiet && !terminal && own.provenance.samples >= 2 * told {
            told = own.provenance.samples;
            eprintln!("{}", state(own));
        }
    };
    let ended = pool(options)?.install(|| making::extend(&mut own, &goal, stop, &mut progress))?;
    bar.finish_and_clear();
    if own.provenance.samples > before {
        making::save(&path, &own)?;
    }
    if own.provenance.samples == 0 {
        eprintln!("interrupted: nothing was written");
        return Ok(INTERRUPTED);
    }
    println!("{}: {}", path.display(), state(&own));
    Ok(match ended {
        Ended::Precise => HELD,
        Ended::Exhausted => NOT_HELD,
        Ended::Stopped => INTERRUPTED,
    })
}

fn state(own: &Own) -> String {
    format!("{} samples, relative standard error {:.2e}", own.provenance.samples, own.relative_error())
}
