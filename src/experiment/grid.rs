//! Every combination of a file's scenes, estimators and termination rules, each refused where it cannot work.

use super::bounds;
use super::choices::{self, Choice};
use super::core::Core;
use super::error::Error;
use super::plan::{CellPlan, LeftOut, PATIENCE};
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
    /// Surfaces of the scenes that were built, and those that cells keep a copy of.
    surfaces: [usize; 2],
    /// Surfaces that scenes are told to have.
    named: usize,
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

impl Resolved {
    /// Counts the cells of a grid, before they are made.
    fn makes(&self, counts: &[usize]) -> Result<(), String> {
        let before = self.cells.len() + self.left_out.len();
        bounds::combinations(counts, "scenes, estimators and termination rules")?;
        bounds::combinations(&[before + counts.iter().product::<usize>()], "all grids")
    }

    /// Counts what is known of a scene before it takes time to build it.
    fn names(&mut self, scene: &Written<SceneKind>) -> Result<(), (Range<usize>, String)> {
        self.named += scene.choice.value.named();
        bounds::surfaces(self.named, "scenes have").map_err(|e| (scene.span.clone(), e))
    }

    /// Counts the surfaces of a scene, of which each cell keeps what the file wrote out.
    fn holds(&mut self, scene: &SceneKind, built: &Scene, copies: usize) -> Result<(), String> {
        self.surfaces[0] += built.surfaces().len();
        self.surfaces[1] = self.surfaces[1].saturating_add(scene.written() * copies);
        bounds::surfaces(self.surfaces[0], "scenes have")?;
        bounds::surfaces(self.surfaces[1], "cells keep a copy of")
    }

    /// Takes a cell, or leaves it out where it cannot work.
    fn take(&mut self, cell: CellPlan, built: &Scene) {
        match reach::out_of(&cell, built) {
            Some(why) => self.left_out.push(LeftOut { cell, why }),
            None => self.cells.push(cell),
        }
    }

    /// Notes that a parameter is swept.
    fn sweeps(&mut self, name: &str) {
        if !self.swept.iter().any(|swept| swept == name) {
            self.swept.push(name.to_owned());
        }
    }
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
    let counts = [scenes.len(), estimators.len(), roulettes.len()];
    resolved.makes(&counts).map_err(|e| at(grid.scene.span(), e))?;
    scenes.iter().try_for_each(|scene| resolved.names(scene)).map_err(|(span, e)| at(span, e))?;
    for scene in &scenes {
        let built = scene.choice.value.build();
        let held = resolved.holds(&scene.choice.value, &built, counts[1] * counts[2]);
        held.map_err(|e| at(scene.span.clone(), e))?;
        let seen = LazyCell::new(|| reach::sees_smooth(&built));
        for estimator in &estimators {
            for roulette in &roulettes {
                let (untermined, fault) = estimator.choice.value;
                let whole = untermined.with(roulette.choice.value, pixels(&built));
                let run = can_run(&whole, &built, [&scene.span, &estimator.span, &roulette.span])
                    .and_then(|()| runs::realizations(spec, grid, &whole, &estimator.span))
                    .map_err(|(span, message)| at(span, message))?;
                let params = [&scene.choice.params, &estimator.choice.params, &roulette.choice.params]
                    .into_iter()
                    .flatten();
                params
                    .clone()
                    .filter(|(.., is_swept)| *is_swept)
                    .for_each(|(name, ..)| resolved.sweeps(name));
                let cell = CellPlan {
                    scene: scene.choice.value.clone(),
                    scene_label: scene.choice.label.clone(),
                    estimator: whole,
                    fault,
                    estimator_label: estimator.choice.label.clone(),
                    roulette_label: roulette.choice.label.clone(),
                    params: params.map(|&(name, value, _)| (name.to_owned(), value)).collect(),
                    core: core(spec, fault, &built, &whole),
                    samples: grid.samples.unwrap_or(spec.samples),
                    block: run.unwrap_or(0),
                    traced: run.is_some(),
                    runs: 1,
                    pixels: pixels(&built),
                    rays: rays(&scene.choice.value, &built, &whole),
                    finds_all: reach::finds_all(&whole, &built, || *seen),
                    address: address(spec, &scene.choice.value, &whole, fault),
                    paired: spec.streams == Streams::Paired,
                    streams: Vec::new(),
                    may_stop: false,
                    studied: false,
                    patience: PATIENCE,
                };
                resolved.take(cell, &built);
            }
        }
    }
    Ok(())
}

/// What follows the paths of a cell: mistakes are known to the textbook only.
fn core(spec: &Spec, fault: Option<&Fault>, built: &Scene, whole: &Estimator) -> Core {
    if fault.is_some() { Core::Textbook } else { spec.core.if_offered(built, whole) }
}

/// Whether a walk in a scene finds light, ends, and takes no more memory than there may be; if not, which of the spans of
/// scene, estimator and rule is wrong, and why.
fn can_run(
    whole: &Estimator,
    built: &Scene,
    [scene, estimator, roulette]: [&Range<usize>; 3],
) -> Result<(), (Range<usize>, String)> {
    lit(whole, built).map_err(|e| (scene.clone(), e))?;
    ends(whole, built).map_err(|e| (roulette.clone(), e))?;
    bounds::landed(whole, ray_bound(whole, built)).map_err(|e| (estimator.clone(), e))
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
