//! Every combination of a file's scenes, estimators and termination rules, each refused where it cannot work.

use super::bounds;
use super::choices::{self, Choice};
use super::core::Core;
use super::error::Error;
use super::plan::{CellPlan, LeftOut};
use super::reach;
use super::runs;
use super::spec::{Grid, Spec, Streams};
use crate::estimator::{Estimator, Roulette, Rule};
use crate::faults::Fault;
use crate::sampling::Address;
use crate::scene::Scene;
use crate::scene::library::SceneKind;
use crate::truth::ClosedForm;
use serde::Serialize;
use std::cell::LazyCell;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// A choice and the place where it is written.
struct Written<T> {
    choice: Choice<T>,
    span: Range<usize>,
}

type Axis<S> = Spanned<Vec<Spanned<super::input::Named<S>>>>;

/// What a file asks for.
#[derive(Default)]
pub struct Resolved {
    /// All cells, without their samples.
    pub cells: Vec<CellPlan>,
    /// Cells that cannot be run, and why.
    pub left_out: Vec<LeftOut>,
    /// Names of the swept parameters.
    pub swept: Vec<String>,
    /// Surfaces that scenes are told to have, that they were built of, and that cells keep a copy of.
    named: usize,
    built: usize,
    copied: usize,
}

/// All that the file asks for.
pub fn resolve(spec: &Spec, file: &Path, source: &str) -> Result<Resolved, Error> {
    let at = |span: Range<usize>, message: String| Error::at(file, source, span, message);
    let mut resolved = Resolved::default();
    for grid in &spec.grid.0 {
        grid_cells(spec, grid, &at, &mut resolved)?;
    }
    if resolved.cells.is_empty() {
        let why = resolved.left_out.first().map_or("an empty list of grids", |out| out.why.as_str());
        return Err(Error::Refused(format!("{}: {why} leaves nothing to run", file.display())));
    }
    runs::are_there(spec, &resolved.cells).map_err(|(span, message)| at(span, message))?;
    Ok(resolved)
}

fn grid_cells(
    spec: &Spec,
    grid: &Grid,
    at: &dyn Fn(Range<usize>, String) -> Error,
    resolved: &mut Resolved,
) -> Result<(), Error> {
    let scenes = axis(&grid.scene, "scenes", at, choices::scenes)?;
    let estimators = axis(&grid.estimator, "estimators", at, |s| choices::estimators(s, spec.faults))?;
    let roulettes = axis(&grid.roulette, "termination rules", at, |s| Ok(choices::roulettes(s)))?;
    let combined = [estimators.len(), roulettes.len()];
    fits(grid, &scenes, combined, at, resolved)?;
    for scene in &scenes {
        let built = scene.choice.value.build();
        resolved.built += built.surfaces().len();
        bounds::surfaces(resolved.built, "scenes have").map_err(|e| at(scene.span.clone(), e))?;
        let seen = LazyCell::new(|| reach::sees_smooth(&built));
        for estimator in &estimators {
            for roulette in &roulettes {
                let (untermined, fault) = estimator.choice.value;
                let whole = untermined.with(roulette.choice.value, pixels(&built));
                lit(&whole, &built).map_err(|e| at(scene.span.clone(), e))?;
                ends(&whole, &built).map_err(|e| at(roulette.span.clone(), e))?;
                bounds::landed(&whole, ray_bound(&whole, &built))
                    .map_err(|e| at(estimator.span.clone(), e))?;
                let run = runs::realizations(spec, grid, &whole, &estimator.span)
                    .map_err(|(span, message)| at(span, message))?;
                let point =
                    Point { scene: &scene.choice, estimator: &estimator.choice, roulette: &roulette.choice };
                for name in point.params().filter(|param| param.2).map(|param| param.0) {
                    if !resolved.swept.iter().any(|s| s == name) {
                        resolved.swept.push(name.to_owned());
                    }
                }
                let cell = point.cell(spec, grid, &built, (whole, fault), run, || *seen);
                match reach::out_of(&cell, &built) {
                    Some(why) => resolved.left_out.push(LeftOut { cell, why }),
                    None => resolved.cells.push(cell),
                }
            }
        }
    }
    Ok(())
}

/// Refuses a grid of too many cells, or of scenes that are too large, before it takes time and memory.
fn fits(
    grid: &Grid,
    scenes: &[Written<SceneKind>],
    combined: [usize; 2],
    at: &dyn Fn(Range<usize>, String) -> Error,
    resolved: &mut Resolved,
) -> Result<(), Error> {
    let counts = [scenes.len(), combined[0], combined[1]];
    bounds::combinations(&counts, "scenes, estimators and termination rules")
        .and_then(|()| {
            let before = resolved.cells.len() + resolved.left_out.len();
            bounds::combinations(&[before + counts.iter().product::<usize>()], "all grids")
        })
        .map_err(|e| at(grid.scene.span(), e))?;
    for scene in scenes {
        let kind = &scene.choice.value;
        resolved.named += kind.named();
        resolved.copied += kind.written() * combined[0] * combined[1];
        bounds::surfaces(resolved.named, "scenes have")
            .and_then(|()| bounds::surfaces(resolved.copied, "cells keep a copy of"))
            .map_err(|e| at(scene.span.clone(), e))?;
    }
    Ok(())
}

/// One value of each axis.
struct Point<'a> {
    scene: &'a Choice<SceneKind>,
    estimator: &'a Choice<choices::Tested>,
    roulette: &'a Choice<Roulette>,
}

impl Point<'_> {
    /// Numeric parameters: name, value, and whether it is swept.
    fn params(&self) -> impl Iterator<Item = (&'static str, f64, bool)> {
        [&self.scene.params, &self.estimator.params, &self.roulette.params].into_iter().flatten().copied()
    }

    fn cell(
        &self,
        spec: &Spec,
        grid: &Grid,
        built: &Scene,
        (whole, fault): (Estimator, Option<&'static Fault>),
        run: Option<u64>,
        sees_smooth: impl Fn() -> bool,
    ) -> CellPlan {
        let scene = &self.scene.value;
        CellPlan {
            scene: scene.clone(),
            scene_label: self.scene.label.clone(),
            estimator: whole,
            fault,
            estimator_label: self.estimator.label.clone(),
            roulette_label: self.roulette.label.clone(),
            params: self.params().map(|(name, value, _)| (name.to_owned(), value)).collect(),
            core: match fault {
                None => spec.core.if_offered(built, &whole),
                Some(_) => Core::Textbook,
            },
            samples: grid.samples.unwrap_or(spec.samples),
            block: run.unwrap_or(0),
            traced: run.is_some(),
            runs: 1,
            pixels: pixels(built),
            rays: rays(scene, built, &whole),
            finds_all: reach::finds_all(&whole, built, sees_smooth),
            address: address(spec, scene, &whole, fault),
            paired: spec.streams == Streams::Paired,
            streams: Vec::new(),
            may_stop: false,
        }
    }
}

/// The choices of one axis of the grid, their sweeps written out.
fn axis<S, T>(
    written: &Axis<S>,
    what: &str,
    at: &dyn Fn(Range<usize>, String) -> Error,
    resolve: impl Fn(&S) -> Result<Vec<Choice<T>>, String>,
) -> Result<Vec<Written<T>>, Error> {
    if written.get_ref().is_empty() {
        let message = format!("an empty list of {what} leaves nothing to run; give at least one");
        return Err(at(written.span(), message));
    }
    let mut all = Vec::new();
    for one in written.get_ref() {
        let choices = resolve(&one.get_ref().0).map_err(|message| at(one.span(), message))?;
        bounds::combinations(&[all.len() + choices.len()], what)
            .map_err(|message| at(one.span(), message))?;
        all.extend(choices.into_iter().map(|choice| Written { choice, span: one.span() }));
    }
    Ok(all)
}

/// Lights can only be sampled where something emits.
pub(super) fn lit(estimator: &Estimator, scene: &Scene) -> Result<(), String> {
    match estimator {
        Estimator::Explicit(_) | Estimator::LightTracing(_) | Estimator::PhotonMap(_)
            if scene.light_count() == 0 =>
        {
            Err("this scene has no light, and this estimator starts from lights; give a surface an emission above 0, \
                 or use `implicit`"
                .to_owned())
        }
        Estimator::PhotonMap(_) if scene.surfaces().iter().all(|s| s.material.bsdf.is_dirac()) => Err("photons lie on \
             matte or glossy surfaces, and this scene has none; use a path tracer"
            .to_owned()),
        _ => Ok(()),
    }
}

/// Every walk must end by its rule: by a clamp, or because q stays below 1.
pub(super) fn ends(estimator: &Estimator, scene: &Scene) -> Result<(), String> {
    let roulette = estimator.roulette();
    if roulette.clamp.is_some() || largest_q(roulette, scene) < 1.0 {
        return Ok(());
    }
    Err(match roulette.rule {
        Rule::None => {
            "a walk without roulette cannot end in a closed scene; use depth_clamp = { bounces = 16 }, say"
                .to_owned()
        }
        Rule::Constant { q } => {
            format!("with q = {q} a walk in a closed scene cannot end; use q < 1 or add clamp = 16, say")
        }
        Rule::Albedo | Rule::Throughput { .. } => {
            "this scene has a surface of albedo 1, on which this rule never \
             ends a walk; use a constant q < 1 or add clamp = 16, say"
                .to_owned()
        }
    })
}

/// The largest q that the rule settles to.
fn largest_q(roulette: &Roulette, scene: &Scene) -> f64 {
    match roulette.rule {
        Rule::None => 1.0,
        Rule::Constant { q } => q,
        Rule::Albedo => scene.max_albedo(),
        Rule::Throughput { floor } => scene.max_albedo().max(floor),
    }
}

/// Pixels of one realization.
fn pixels(scene: &Scene) -> u64 {
    let (width, height) = scene.sensor.resolution();
    u64::from(width) * u64::from(height)
}

/// Expected rays a realization: by theory, else an upper bound from a closed scene of the largest albedo.
fn rays(kind: &SceneKind, scene: &Scene, estimator: &Estimator) -> f64 {
    let theory = ClosedForm::of(kind, estimator).and_then(|closed| closed.rays());
    let walk = || ray_bound(estimator, scene);
    let pixels = pixels(scene) as f64;
    match estimator {
        // a ray and a shadow ray a vertex; one ray for each pixel, and what mirrors show
        Estimator::LightTracing(e) => 2.0 * e.particles as f64 * walk() + 2.0 * pixels,
        Estimator::PhotonMap(e) => {
            e.photons as f64 * walk() + pixels * (2.0 + 2.0 * f64::from(e.final_gather))
        }
        _ => pixels * theory.unwrap_or_else(walk),
    }
}

fn ray_bound(estimator: &Estimator, scene: &Scene) -> f64 {
    let (branches, per_vertex) = match estimator {
        Estimator::Recursive(e) => (f64::from(e.samples), 1.0),
        Estimator::Implicit(_) => (1.0, 1.0),
        Estimator::Explicit(_) => (1.0, 2.0),
        Estimator::LightTracing(_) | Estimator::PhotonMap(_) => (1.0, 1.0),
    };
    let roulette = estimator.roulette();
    let settled = branches * largest_q(roulette, scene);
    let mut sum = 1.0;
    let mut reached = 1.0;
    let last = roulette.clamp.unwrap_or(roulette.from);
    for bounce in 0..last {
        reached *= if bounce < roulette.from { branches } else { settled };
        sum += reached;
    }
    if roulette.clamp.is_none() {
        sum += reached * settled / (1.0 - settled);
    }
    per_vertex * sum
}

/// A stream's address is its content: adding a cell changes no other cell.
fn address(spec: &Spec, scene: &SceneKind, estimator: &Estimator, fault: Option<&'static Fault>) -> Address {
    let estimator = match (spec.streams, fault) {
        (Streams::Independent, None) => json(estimator),
        (Streams::Independent, Some(fault)) => json(estimator) + fault.name,
        (Streams::Paired, _) => "paired".to_owned(),
    };
    Address::of(&[&spec.seed.to_string(), &json(scene), &estimator, "path"])
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("plain numbers and names have a JSON form")
}
