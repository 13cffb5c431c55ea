//! From what a file says to what it means: each written choice becomes one value for every point of its sweeps.

mod lecture;
mod photons;
mod scene;

pub use scene::scenes;

use super::bounds;
use super::input::Sweep;
use super::spec::{EstimatorSpec, RouletteSpec, TechniqueSpec};
use crate::estimator::{
    Estimator, Explicit, Heuristic, Implicit, LightTracing, PhotonMap, Recursive, Roulette, Rule, Technique,
};
use crate::faults::{self, Fault};
use crate::scene::{Directions, LightSampling, Pick, Points};

/// One value of a choice.
#[derive(Clone, Debug)]
pub struct Choice<T> {
    /// What it is called in results, without its swept parameters.
    pub label: String,
    /// Its numeric parameters; whether each is swept.
    pub params: Vec<(&'static str, f64, bool)>,
    /// What it means.
    pub value: T,
}

impl<T> Choice<T> {
    fn new(base: &str, details: &[String], params: Vec<(&'static str, f64, bool)>, value: T) -> Self {
        let fixed = params.iter().filter(|p| !p.2).map(|(name, value, _)| format!("{name}={value}"));
        let details: Vec<String> = fixed.chain(details.iter().cloned()).collect();
        let label =
            if details.is_empty() { base.to_owned() } else { format!("{base}({})", details.join(" ")) };
        Choice { label, params, value }
    }
}

/// The points of a sweep, each with the name of its parameter.
fn points(name: &'static str, sweep: &Sweep) -> impl Iterator<Item = (&'static str, f64, bool)> {
    let swept = sweep.0.len() > 1;
    sweep.0.iter().map(move |&value| (name, value, swept))
}

/// An estimator that still lacks its termination rule.
#[derive(Clone, Copy, Debug)]
pub enum Untermined {
    /// See [`Recursive`].
    Recursive {
        /// N.
        samples: u32,
        /// The largest number of bounces.
        depth: u32,
        /// How directions are drawn.
        directions: Directions,
    },
    /// See [`Implicit`].
    Implicit(Directions),
    /// See [`Explicit`].
    Explicit(Technique, LightSampling, Directions),
    /// See [`LightTracing`].
    LightTracing {
        /// Particles of one realization; `None` for one a pixel.
        particles: Option<u64>,
        /// How directions are drawn.
        directions: Directions,
    },
    /// See [`PhotonMap`], whose rule is still to come.
    PhotonMap(PhotonMap),
}

/// An estimator, and the mistake that it makes, if any.
pub type Tested = (Untermined, Option<&'static Fault>);

impl Untermined {
    /// The estimator with this rule, for a sensor of so many pixels; a recursion's depth and the rule's clamp both hold.
    pub fn with(self, roulette: Roulette, pixels: u64) -> Estimator {
        match self {
            Untermined::Recursive { samples, depth, directions } => {
                let clamp = Some(roulette.clamp.map_or(depth, |clamp| clamp.min(depth)));
                Estimator::Recursive(Recursive {
                    samples,
                    directions,
                    roulette: Roulette { clamp, ..roulette },
                })
            }
            Untermined::Implicit(directions) => Estimator::Implicit(Implicit { directions, roulette }),
            Untermined::Explicit(technique, lights, directions) => {
                Estimator::Explicit(Explicit { technique, lights, directions, roulette })
            }
            Untermined::LightTracing { particles, directions } => {
                let particles = particles.unwrap_or(pixels);
                Estimator::LightTracing(LightTracing { particles, directions, roulette })
            }
            Untermined::PhotonMap(map) => Estimator::PhotonMap(PhotonMap { roulette, ..map }),
        }
    }
}

/// The estimators that `spec` means; those with a mistake only where the file asks for them.
pub fn estimators(spec: &EstimatorSpec, faults: bool) -> Result<Vec<Choice<Tested>>, String> {
    let EstimatorSpec::Fault { name, of } = spec else {
        let tested =
            |c: Choice<Untermined>| Choice { label: c.label, params: c.params, value: (c.value, None) };
        return Ok(sound(spec)?.into_iter().map(tested).collect());
    };
    if !faults {
        return Err(
            "estimators with a mistake are for files that say `faults = true` at their top".to_owned()
        );
    }
    let from_lights = matches!(
        of.0,
        EstimatorSpec::LightTracing(_) | EstimatorSpec::PhotonMap(_) | EstimatorSpec::Progressive(_)
    );
    if from_lights {
        return Err("faults are those of paths from the eye; `of` names one, such as \"explicit\"".to_owned());
    }
    if matches!(of.0, EstimatorSpec::Fault { .. }) {
        return Err("a fault of a fault; `of` names a sound estimator, such as \"explicit\"".to_owned());
    }
    let mut all = Vec::new();
    for name in name.as_slice() {
        bounds::combinations(&[all.len().max(1)], "faults and sweeps")?;
        let fault = faults::find(name).ok_or_else(|| faults::unknown(name))?;
        let faulty = |c: Choice<Untermined>| {
            let label = format!("{} ({})", fault.name, c.label);
            Choice { label, params: c.params, value: (c.value, Some(fault)) }
        };
        all.extend(sound(&of.0)?.into_iter().map(faulty));
    }
    Ok(all)
}

fn sound(spec: &EstimatorSpec) -> Result<Vec<Choice<Untermined>>, String> {
    let uniform = |directions: &Directions| match directions {
        Directions::Cosine => Vec::new(),
        Directions::Uniform => vec!["uniform directions".to_owned()],
    };
    Ok(match spec {
        EstimatorSpec::LightTracing(spec) => photons::light_tracing(spec)?,
        EstimatorSpec::PhotonMap(spec) => photons::photon_map(spec)?,
        EstimatorSpec::Progressive(spec) => photons::progressive(spec)?,
        EstimatorSpec::Recursive { samples, depth, directions } => {
            bounds::combinations(&[samples.0.len(), depth.0.len()], "samples and depth")?;
            let one = |n: (&'static str, f64, bool), d: (&'static str, f64, bool)| {
                let value =
                    Untermined::Recursive { samples: n.1 as u32, depth: d.1 as u32, directions: *directions };
                Choice::new("recursive", &uniform(directions), vec![n, d], value)
            };
            points("n", samples).flat_map(|n| points("depth", depth).map(move |d| one(n, d))).collect()
        }
        EstimatorSpec::Implicit { directions } => {
            let value = Untermined::Implicit(*directions);
            vec![Choice::new("implicit", &uniform(directions), Vec::new(), value)]
        }
        EstimatorSpec::Explicit { technique, heuristic, lights, pick, directions } => {
            let technique = match technique {
                TechniqueSpec::Light => Technique::Light,
                TechniqueSpec::Direction => Technique::Direction,
                TechniqueSpec::Both => Technique::Both(*heuristic),
            };
            let mut details: Vec<String> = match technique {
                Technique::Light => Vec::new(),
                Technique::Direction => vec!["direction".to_owned()],
                Technique::Both(Heuristic::Balance) => vec!["both, balance".to_owned()],
                Technique::Both(Heuristic::Power) => vec!["both, power".to_owned()],
            };
            details.extend(uniform(directions));
            details.extend((*lights == Points::SolidAngle).then(|| "by solid angle".to_owned()));
            details.extend((*pick == Pick::Uniform).then(|| "any light alike".to_owned()));
            let lights = LightSampling { points: *lights, pick: *pick };
            vec![Choice::new(
                "explicit",
                &details,
                Vec::new(),
                Untermined::Explicit(technique, lights, *directions),
            )]
        }
        EstimatorSpec::Fault { .. } => Vec::new(),
    })
}

/// The termination rules that `spec` means.
pub fn roulettes(spec: &RouletteSpec) -> Vec<Choice<Roulette>> {
    let limits = |from: u32, clamp: Option<u32>| {
        let from = (from > 0).then(|| format!("from={from}"));
        from.into_iter().chain(clamp.map(|clamp| format!("clamp={clamp}"))).collect::<Vec<_>>()
    };
    match *spec {
        RouletteSpec::None {} => {
            let roulette = Roulette::unclamped(Rule::None);
            vec![Choice::new("none", &[], Vec::new(), roulette)]
        }
        RouletteSpec::DepthClamp { ref bounces } => {
            let one = |p: (&'static str, f64, bool)| {
                Choice::new("clamp", &[], vec![p], Roulette::depth_clamp(p.1 as u32))
            };
            points("bounces", bounces).map(one).collect()
        }
        RouletteSpec::Constant { ref q, from, clamp } => {
            let one = |p: (&'static str, f64, bool)| {
                let roulette = Roulette { rule: Rule::Constant { q: p.1 }, from, clamp };
                Choice::new("constant", &limits(from, clamp), vec![p], roulette)
            };
            points("q", q).map(one).collect()
        }
        RouletteSpec::Albedo { from, clamp } => {
            let roulette = Roulette { rule: Rule::Albedo, from, clamp };
            vec![Choice::new("albedo", &limits(from, clamp), Vec::new(), roulette)]
        }
        RouletteSpec::Throughput { floor, from, clamp } => {
            let roulette = Roulette { rule: Rule::Throughput { floor }, from, clamp };
            vec![Choice::new("throughput", &limits(from, clamp), Vec::new(), roulette)]
        }
    }
}
