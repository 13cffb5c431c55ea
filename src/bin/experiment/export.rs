//! A scene file for another renderer.

use crate::HELD;
use crate::args::{Export, Format, Options};
use crate::subject::{Details, named};
use anstream::print;
use furnace::experiment::Error;
use furnace::report::mitsuba::{self, Placement};
use std::path::Path;

/// Writes `args.scene` to a file, with its meshes beside it, or to standard output.
pub fn export(args: &Export, options: &Options) -> Result<u8, Error> {
    if options.format == Format::Json {
        return Err(Error::Refused("export writes --format mitsuba".to_owned()));
    }
    let details = Details { resolution: args.resolution, tile: args.tile, blocks: args.blocks };
    let scene = named(&args.scene, details)?.build();
    let placement = args.scale.map_or(Placement::SAME, |scale| Placement::centred(&scene, scale));
    let stem = args.output.as_deref().map_or(Ok(""), stem)?;
    let export = mitsuba::export(&scene, placement, stem)
        .map_err(|why| Error::Refused(format!("{}: {why}", args.scene)))?;
    let Some(output) = &args.output else {
        if !export.meshes.is_empty() {
            let why =
                "this scene has triangles, which go into files beside it; give it a name with -o FILE.xml";
            return Err(Error::Refused(format!("{}: {why}", args.scene)));
        }
        print!("{}", export.xml);
        return Ok(HELD);
    };
    // the scene last: where it is, its meshes are
    for mesh in &export.meshes {
        write(&output.with_file_name(&mesh.name), &mesh.text)?;
    }
    write(output, &export.xml)?;
    Ok(HELD)
}

/// The name of `FILE.xml` without its ending.
fn stem(output: &Path) -> Result<&str, Error> {
    let is_xml = output.extension().is_some_and(|extension| extension == "xml");
    let stem = output.file_stem().filter(|_| is_xml).and_then(|stem| stem.to_str());
    stem.ok_or_else(|| {
        Error::Refused(format!("{} must be a name in Unicode that ends in .xml", output.display()))
    })
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    std::fs::write(path, text).map_err(|e| Error::io("cannot write", path, e))
}
