//! A new experiment file, which runs as it is and says in comments what can be changed.

use crate::args::{New, is_command};
use crate::subject::{self, Details};
use crate::{HELD, files};
use anstream::println;
use furnace::estimator::{Estimator, Explicit, Roulette, Rule, Technique};
use furnace::experiment::{Error, Overrides, Plan, reach, spec};
use furnace::scene::{Directions, LightSampling};
use furnace::truth::{Counted, Truth};
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The schema of experiment files, beside them.
const SCHEMA: &str = "schema.json";

/// Pixels along an image's edge: few, so that a first run takes seconds.
const RESOLUTION: u32 = 16;

/// Writes it.
pub fn write(args: &New) -> Result<u8, Error> {
    let name = args.name.strip_suffix(".toml").unwrap_or(&args.name);
    sound(name)?;
    let usual = ["furnace".to_owned()];
    let scenes = if args.scenes.is_empty() { &usual[..] } else { &args.scenes };
    let scenes = scenes.iter().map(|scene| Scene::new(scene)).collect::<Result<Vec<_>, _>>()?;
    let folder = files::folder().unwrap_or_else(|| PathBuf::from("experiments"));
    let path = folder.join(format!("{name}.toml"));
    let text = text(&scenes);
    // nothing is written that would be refused
    Plan::new(name, &path, &text, &Overrides::default())?;
    fs::create_dir_all(&folder).map_err(|e| Error::io("cannot create", &folder, e))?;
    create(&path, &text)?;
    let schema = folder.join(SCHEMA);
    if !schema.exists() {
        create(&schema, &spec::schema())?;
    }
    println!("{} is written. It runs as it is:\n", path.display());
    println!("  experiment plan {name}    what will be run\n  experiment {name}         runs it");
    Ok(HELD)
}

/// Refuses what could not be called by its name.
fn sound(name: &str) -> Result<(), Error> {
    let is_plain = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let refuse = |why: &str| Err(Error::Refused(format!("`{name}` {why}")));
    match name {
        _ if is_command(name) => refuse("is a command; choose another name"),
        "" => refuse("is no name; take letters, digits, _ and -"),
        _ if !name.chars().all(is_plain) || name.starts_with('-') || name.chars().count() > 80 => refuse(
            "is no name of an experiment; take at most 80 letters, digits, _ and -, and no - at the start",
        ),
        _ => Ok(()),
    }
}

/// Writes a file, never over another.
fn create(path: &Path, text: &str) -> Result<(), Error> {
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    if file.as_ref().is_err_and(|e| e.kind() == ErrorKind::AlreadyExists) {
        let why = "exists and will not be overwritten; choose another name";
        return Err(Error::Refused(format!("{} {why}", path.display())));
    }
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|e| Error::io("cannot create", path, e))
}

/// A scene with what can be asked there.
struct Scene<'a> {
    name: &'a str,
    written: String,
    is_image: bool,
    /// Whether the right value is known.
    is_known: bool,
    /// Whether walks end by their throughput: not where a surface reflects everything.
    fades: bool,
}

impl<'a> Scene<'a> {
    fn new(name: &'a str) -> Result<Self, Error> {
        let is_image = subject::is_image(name);
        let resolution = is_image.then_some(RESOLUTION);
        let kind = subject::named(name, Details { resolution, ..Details::default() })?;
        let built = kind.build();
        let explicit = explicit();
        let is_known = Truth::of(&kind, &explicit, &[]).mean(0, Counted::All).is_some();
        if !is_known && !reach::finds_all(&explicit, &built, || reach::sees_smooth(&built)) {
            let why = "its right value is not known, and paths do not find all of its light: nothing could be claimed";
            return Err(Error::Refused(format!("{name}: {why}; take another scene")));
        }
        let (width, height) = built.sensor.resolution();
        Ok(Scene {
            name,
            written: subject::written(name, RESOLUTION),
            is_image: width * height > 1,
            is_known,
            fades: built.max_albedo() < 1.0,
        })
    }

    /// Two that can be compared within seconds: images take long where light is found by chance.
    fn estimators(&self) -> &'static str {
        match self.is_image {
            true => r#"["explicit", { explicit = { technique = "both" } }]"#,
            false => r#"["implicit", "explicit"]"#,
        }
    }

    /// Termination rules.
    fn rules(&self) -> &'static str {
        if self.fades {
            "[\"throughput\", { constant = { q = 0.9 } }]"
        } else {
            "[{ constant = { q = 0.9 } }]"
        }
    }
}

/// The estimator with which others are compared.
fn explicit() -> Estimator {
    let roulette = Roulette { rule: Rule::Constant { q: 0.9 }, from: 0, clamp: None };
    let (lights, directions) = (LightSampling::AREA, Directions::Cosine);
    Estimator::Explicit(Explicit { technique: Technique::Light, lights, directions, roulette })
}

/// The file.
fn text(scenes: &[Scene<'_>]) -> String {
    let names: Vec<&str> = scenes.iter().map(|scene| scene.name).collect();
    let mut text = format!(include_str!("new/head.toml"), scenes = names.join(", "));
    for (i, scene) in scenes.iter().enumerate() {
        let samples = if scene.is_image { "2_048" } else { "262_144" };
        let Scene { written, .. } = scene;
        let (estimators, rules) = (scene.estimators(), scene.rules());
        text += "\n";
        text += &match i {
            0 => format!(
                include_str!("new/grid.toml"),
                scene = written,
                estimators = estimators,
                rules = rules,
                samples = samples
            ),
            _ => format!(
                "[[grid]]\nscene = [{written}]\nestimator = {estimators}\nroulette = {rules}\n\
                 samples = {samples}\n"
            ),
        };
    }
    if scenes.iter().any(|scene| scene.is_known) {
        text += include_str!("new/unbiased.toml");
    }
    for (i, scene) in scenes.iter().filter(|scene| !scene.is_known).enumerate() {
        if i == 0 {
            text += include_str!("new/agree.toml");
        }
        text += &format!(
            "[[claim]]\nagree = {{ scene = \"{}\", estimator = \"explicit\", roulette = \"constant(q=0.9)\", \
             alpha = 1e-3, margin = 0.05 }}\n",
            scene.name
        );
    }
    text + include_str!("new/tail.toml")
}
