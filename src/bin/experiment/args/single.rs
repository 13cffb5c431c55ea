//! What is done without an experiment file: an image, a reference, a scene for another renderer.

use super::complete;
use clap::Args;
use clap_complete::ArgValueCandidates;
use std::path::PathBuf;

#[derive(Args)]
pub struct Render {
    /// A scene with a camera: its name, such as cornell_box or smallpt, or FILE.toml:NAME
    #[arg(add = ArgValueCandidates::new(complete::scenes))]
    pub scene: String,
    /// explicit, implicit, light_tracing or photon_map
    #[arg(long, default_value = "explicit", add = ArgValueCandidates::new(complete::estimators))]
    pub estimator: String,
    /// Samples a pixel
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u64).range(2..))]
    pub spp: u64,
    /// Pixels along each edge; of smallpt, whose image is 4 : 3, from top to bottom
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub resolution: u32,
    /// Where to write; a PNG preview goes beside it
    #[arg(short, long, default_value = "out.exr")]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct Reference {
    /// Name of a scene, such as cornell_box or furnace, or FILE.toml:NAME for a scene of an experiment file
    #[arg(add = ArgValueCandidates::new(complete::scenes))]
    pub scene: String,
    /// Relative standard error of the image's mean, worst channel, at which it is good enough
    #[arg(long, value_name = "ERROR", default_value_t = 1e-3, value_parser = relative_error)]
    pub until_error: f64,
    /// Stop at so many samples (a pixel) in any case
    #[arg(long, value_name = "N", default_value_t = 1_000_000_000_000,
        value_parser = clap::value_parser!(u64).range(2..=1_000_000_000_000_000))]
    pub max_samples: u64,
    /// explicit, implicit or light_tracing; the reference will not judge estimators of the same kind
    #[arg(long, default_value = "explicit", add = ArgValueCandidates::new(complete::estimators))]
    pub estimator: String,
    /// Pixels along each edge, if the scene has a camera
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub resolution: u32,
    /// Where it is, or will be; references/own/SCENE.exr if left out
    #[arg(short, long)]
    pub output: Option<PathBuf>,
}

pub fn relative_error(text: &str) -> Result<f64, String> {
    let error: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if error > 0.0 && error < 1.0 { Ok(error) } else { Err("it lies inside (0, 1)".to_owned()) }
}

#[derive(Args)]
pub struct Export {
    /// cornell_box, cornell_empty, cornell_flush, furnace, furnace_box, a scene of lectures such as veach_mis, or one of the
    /// gallery
    #[arg(add = ArgValueCandidates::new(complete::scenes))]
    pub scene: String,
    /// Where to write, instead of standard output; triangles go into OBJ files beside it
    #[arg(short, long, value_name = "FILE.xml")]
    pub output: Option<PathBuf>,
    /// Pixels along each edge of the image [default: 32 of a Cornell box, 128 of scenes of lectures, 96 rows of smallpt]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub resolution: Option<u32>,
    /// Which tile of cornell_flush is measured, 1 to 6 [default: 1]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=6))]
    pub tile: Option<u8>,
    /// cornell_flush with its two blocks
    #[arg(long)]
    pub blocks: bool,
    /// Moves the scene's middle to the origin and multiplies lengths by S, which changes no radiance, but the rounding
    /// errors of renderers in single precision
    #[arg(long, value_name = "S", value_parser = positive)]
    pub scale: Option<f64>,
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("it must be finite and positive".to_owned())
    }
}
