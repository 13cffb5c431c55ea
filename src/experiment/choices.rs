//! From what a file says to what it means: each written choice becomes one value for every point of its sweeps.

use super::input::Sweep;
use super::spec::{
    EstimatorSpec, FurnaceSpec, LooksAt, PrimitiveSpec, PrimitivesSpec, RouletteSpec, SceneSpec, SensorSpec,
    ShapeSpec, SphereSpec,
};
use crate::estimator::{Estimator, Explicit, Implicit, Pick, Recursive, Roulette, Rule, Technique};
use crate::scene::geometry::{Disk, SpherePatch};
use crate::scene::library::{Patch, Primitive, SceneKind};
use crate::scene::{Directions, LightSampling, Rgb, Sensor, Shape};
use glam::DVec3;

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

/// The scenes that `spec` means, or what is wrong with it.
pub fn scenes(spec: &SceneSpec) -> Result<Vec<Choice<SceneKind>>, String> {
    let plain = |base: &str, value| Ok(vec![Choice::new(base, &[], Vec::new(), value)]);
    match spec {
        SceneSpec::Furnace(f) => {
            bounded(f.albedo, f.emission)?;
            let FurnaceSpec { albedo, emission, view } = *f;
            plain("furnace", SceneKind::Furnace { albedo, emission, view })
        }
        SceneSpec::FurnaceBox(f) => {
            bounded(f.albedo, f.emission)?;
            let FurnaceSpec { albedo, emission, view } = *f;
            plain("furnace_box", SceneKind::FurnaceBox { albedo, emission, view })
        }
        SceneSpec::IntegratingSphere(s) => {
            points("light_fraction", &s.light_fraction).map(|p| integrating_sphere(s, p)).collect()
        }
        SceneSpec::CornellBox(c) => plain("cornell_box", SceneKind::CornellBox { resolution: c.resolution }),
        SceneSpec::CornellEmpty(c) => {
            plain("cornell_empty", SceneKind::CornellEmpty { resolution: c.resolution })
        }
        SceneSpec::Primitives(p) => plain(&p.name, primitives(p)?),
    }
}

fn bounded(albedo: Rgb, emission: Rgb) -> Result<(), String> {
    let endless = (0..3).any(|c| albedo[c] >= 1.0 && emission[c] > 0.0);
    if endless {
        return Err("a closed scene of albedo 1 that emits has infinite radiance; \
                    the albedo must be below 1 in every channel that emits"
            .to_owned());
    }
    Ok(())
}

fn integrating_sphere(s: &SphereSpec, light: (&'static str, f64, bool)) -> Result<Choice<SceneKind>, String> {
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let mut patches = vec![patch(light.1, s.light_albedo, s.emission)];
    patches.extend(s.patches.iter().map(|p| patch(p.fraction, p.albedo, p.emission)));
    let taken: f64 = patches.iter().map(|p| p.fraction).sum();
    if taken >= 1.0 {
        return Err(format!(
            "the light and the patches cover {taken} of the sphere; leave some for the wall"
        ));
    }
    patches.push(patch(1.0 - taken, s.wall_albedo, Rgb::ZERO));
    let mean = |f: &dyn Fn(&Patch) -> Rgb| patches.iter().map(|p| p.fraction * f(p)).sum::<Rgb>();
    bounded(mean(&|p| p.albedo), mean(&|p| p.emission))?;
    let looks_at = match s.looks_at {
        LooksAt::Light => 0,
        LooksAt::Wall => patches.len() - 1,
    };
    let value = SceneKind::IntegratingSphere { patches, looks_at, view: s.view };
    let params = if light.2 { vec![light] } else { Vec::new() };
    Ok(Choice::new("integrating_sphere", &[], params, value))
}

fn primitives(p: &PrimitivesSpec) -> Result<SceneKind, String> {
    if p.name.is_empty() || p.name.chars().count() > 80 {
        return Err("a scene's name has 1 to 80 characters".to_owned());
    }
    if p.primitives.is_empty() {
        return Err("a scene needs at least one primitive".to_owned());
    }
    let primitive =
        |s: &PrimitiveSpec| Ok(Primitive { shape: shape(&s.shape)?, albedo: s.albedo, emission: s.emission });
    let sensor = match p.sensor {
        SensorSpec::Probe { origin, direction } => Sensor::Probe { origin, direction },
        SensorSpec::Irradiance { point, normal } => Sensor::Irradiance { point, normal, on: None },
        SensorSpec::Camera { direction, up, .. } if direction.cross(up).length() < 1e-9 => {
            return Err("a camera's up must not be parallel to its direction".to_owned());
        }
        SensorSpec::Camera { .. } => Sensor::Camera(p.sensor.pinhole().expect("it is a camera")),
    };
    let primitives = p.primitives.iter().map(primitive).collect::<Result<_, String>>()?;
    Ok(SceneKind::Custom { primitives, sensor })
}

fn shape(spec: &ShapeSpec) -> Result<Shape, String> {
    let shape = match *spec {
        ShapeSpec::Rectangle(r) => {
            let cosine = r.half_u.normalize_or_zero().dot(r.half_v.normalize_or_zero());
            if cosine.abs() > 1e-9 {
                return Err("half_u and half_v of a rectangle must be perpendicular".to_owned());
            }
            Shape::Rectangle(r)
        }
        ShapeSpec::Triangle(t) => Shape::Triangle(t),
        ShapeSpec::Disk(d) => {
            let normal = d.normal.try_normalize().ok_or("a disk's normal must not be the zero vector")?;
            Shape::Disk(Disk { normal, ..d })
        }
        ShapeSpec::Sphere { center, radius, inward } => {
            Shape::Sphere(SpherePatch { center, radius, axis: DVec3::Z, low: -1.0, high: 1.0, inward })
        }
        ShapeSpec::SpherePatch { center, radius, axis, low, high, inward } => {
            if !(-1.0 <= low && low < high && high <= 1.0) {
                return Err("a sphere patch needs -1 <= low < high <= 1".to_owned());
            }
            Shape::Sphere(SpherePatch { center, radius, axis, low, high, inward })
        }
    };
    let radius = if let Shape::Disk(d) = &shape { d.radius } else { 1.0 };
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(format!("{radius} is out of range: a radius is finite and positive"));
    }
    if !shape.origin().is_finite() {
        return Err("coordinates are finite".to_owned());
    }
    let area = shape.area();
    if !(area.is_finite() && area > 0.0) {
        return Err(format!("this shape has an area of {area}; it must be finite and positive"));
    }
    Ok(shape)
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
    Explicit(LightSampling, Directions),
}

impl Untermined {
    /// The estimator with this rule; a recursion's depth and the rule's clamp both hold.
    pub fn with(self, roulette: Roulette) -> Estimator {
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
            Untermined::Explicit(lights, directions) => Estimator::Explicit(Explicit {
                lights,
                directions,
                roulette,
                technique: Technique::Light,
                pick: Pick::Power,
            }),
        }
    }
}

/// The estimators that `spec` means.
pub fn estimators(spec: &EstimatorSpec) -> Vec<Choice<Untermined>> {
    let uniform = |directions: &Directions| match directions {
        Directions::Cosine => Vec::new(),
        Directions::Uniform => vec!["uniform directions".to_owned()],
    };
    match spec {
        EstimatorSpec::Recursive { samples, depth, directions } => {
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
        EstimatorSpec::Explicit { lights, directions } => {
            let mut details = uniform(directions);
            if *lights == LightSampling::SolidAngle {
                details.push("by solid angle".to_owned());
            }
            let value = Untermined::Explicit(*lights, *directions);
            vec![Choice::new("explicit", &details, Vec::new(), value)]
        }
    }
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
