//! Making references of our own: samples added to what is stored, so that stopping and going on leads to the same bits
//! as not stopping. Which realizations a block holds, and after which blocks the error is looked at, depends on the
//! number of pixels only.

use super::cell::{self, Block};
use super::error::Error;
use super::file;
use super::grid;
use super::pixels::Pixels;
use super::reach;
use super::run::block_of;
use crate::estimator::{Estimate, Estimator, Property};
use crate::sampling::Address;
use crate::scene::library::SceneKind;
use crate::truth::Own;
use crate::truth::own::Provenance;
use rayon::prelude::*;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Paths a block.
const BLOCK_PATHS: u64 = 4096;

/// When a reference is good enough.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Relative standard error of the image's mean, worst channel.
    pub error: f64,
    /// Realizations, rounded up to whole blocks.
    pub most: u64,
}

/// Paths between two looks at the error and the stop flag.
const WAVE_PATHS: u64 = 1 << 18;

/// Why sampling ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The error is small enough.
    Precise,
    /// All samples that were allowed are taken.
    Exhausted,
    /// Someone raised the flag.
    Stopped,
}

/// A reference without samples.
pub fn begin(scene: &SceneKind, estimator: &Estimator, seed: u64) -> Result<Own, Error> {
    let built = scene.build();
    let (width, height) = built.sensor.resolution();
    if width != height {
        return Err(Error::Refused(format!("an image of {width} x {height} pixels; references are square")));
    }
    if estimator.property() != Property::Unbiased {
        let why = "a reference is made by an unbiased estimator: without a clamp, and not by photon density";
        return Err(Error::Refused(why.to_owned()));
    }
    if !reach::finds_all(estimator, &built, || reach::sees_smooth(&built)) {
        let why = "this estimator misses light from the scene's points, so it makes no reference";
        return Err(Error::Refused(why.to_owned()));
    }
    grid::lit(estimator, &built).and_then(|()| grid::ends(estimator, &built)).map_err(Error::Refused)?;
    let provenance = Provenance::new(scene, estimator, seed);
    Ok(Own { provenance, size: width as usize, mean: Vec::new(), m2: Vec::new() })
}

/// The reference stored at `path`, if it is a beginning of `wanted`; `wanted` itself if there is no file.
pub fn resume(path: &Path, wanted: Own) -> Result<Own, Error> {
    if !path.exists() {
        return Ok(wanted);
    }
    let bytes = file::bytes(path, file::STORED).map_err(|e| Error::io("cannot read", path, e))?;
    let refused = |why: String| {
        Error::Refused(format!("{} cannot be continued: {why}; choose another -o", path.display()))
    };
    let stored = Own::read(&bytes).map_err(|e| refused(e.to_string()))?;
    match stored.provenance.difference(&wanted.provenance) {
        Some(difference) => Err(refused(format!("it was made for {difference}"))),
        None if stored.size != wanted.size => {
            Err(refused(format!("it has {} pixels along each edge, not {}", stored.size, wanted.size)))
        }
        None => Ok(stored),
    }
}

/// Samples until the goal, on the current thread pool; `progress` sees each stage.
pub fn extend(
    own: &mut Own,
    goal: &Goal,
    stop: &AtomicBool,
    progress: &mut (dyn FnMut(&Own) + Send),
) -> Result<Ended, Error> {
    let Provenance { scene, estimator, seed, .. } = own.provenance.clone();
    let json = |value: Result<String, _>| value.expect("plain numbers and names have a JSON form");
    let (name, by) = (json(serde_json::to_string(&scene)), json(serde_json::to_string(&estimator)));
    let address = Address::of(&[&seed.to_string(), &name, &by, "reference"]);
    let built = scene.build();
    let pixels = (own.size * own.size) as u64;
    let block = (BLOCK_PATHS / pixels).max(2);
    let wave = (WAVE_PATHS / (block * pixels)).max(8);
    let most = goal.most.div_ceil(block);
    loop {
        let first = own.provenance.samples / block;
        // looked at after whole waves only: looking where someone happened to stop would change where it ends
        if first.is_multiple_of(wave) && own.relative_error() <= goal.error {
            return Ok(Ended::Precise);
        }
        if first >= most {
            return Ok(Ended::Exhausted);
        }
        if stop.load(Ordering::Relaxed) {
            return Ok(Ended::Stopped);
        }
        let last = ((first / wave + 1) * wave).min(most);
        let draw = |number, pixel| address.stream(number, pixel);
        let run = |b: u64| block_of(&built, &estimator, &draw, &[], b * block..(b + 1) * block);
        let blocks: Vec<Block> = (first..last).into_par_iter().map(run).collect();
        add(own, blocks)?;
        progress(own);
    }
}

/// Adds finished blocks in their order.
fn add(own: &mut Own, blocks: Vec<Block>) -> Result<(), Error> {
    let size = own.size as u32;
    let mut pixels = Pixels {
        width: size,
        height: size,
        n: own.provenance.samples,
        mean: std::mem::take(&mut own.mean),
        m2: std::mem::take(&mut own.m2),
    };
    for block in blocks {
        let tally = &block.tally;
        if let Some(why) = cell::complaint([tally.non_finite, tally.negative, tally.runaway, tally.starved]) {
            return Err(Error::Refused(format!("no reference can be made of this: {why}")));
        }
        pixels.merge(&block.into_pixels());
    }
    own.provenance.samples = pixels.n;
    own.provenance.version = env!("CARGO_PKG_VERSION").to_owned();
    (own.mean, own.m2) = (pixels.mean, pixels.m2);
    Ok(())
}

/// Writes the whole file beside its place and then puts it there: whatever happens, a whole one is at `path`.
pub fn save(path: &Path, own: &Own) -> Result<(), Error> {
    let failed = |e: std::io::Error| Error::io("cannot write", path, e);
    let bytes = own.bytes().map_err(|e| failed(std::io::Error::other(e.to_string())))?;
    let mut file = beside(path).map_err(failed)?;
    file.write_all(&bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
}

/// Fails at once, before anything is sampled, if [`save`] could not work.
pub fn writable(path: &Path) -> Result<(), Error> {
    beside(path).map(drop).map_err(|e| Error::io("cannot write", path, e))
}

/// A temporary file in the folder of `path`, readable as other files are.
fn beside(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".unfinished-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o644));
    }
    builder.tempfile_in(folder)
}
