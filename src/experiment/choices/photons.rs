//! Estimators that start from the lights, as they are meant.

use super::{Choice, Untermined, points};
use crate::estimator::{DirectLight, Gather, Kernel, Last, PhotonMap, Roulette, Rule};
use crate::experiment::bounds;
use crate::experiment::spec::{LightTracingSpec, PhotonMapSpec, ProgressiveSpec};
use crate::scene::Directions;

type Chosen = Result<Vec<Choice<Untermined>>, String>;
type Point = (&'static str, f64, bool);

/// Particles connected to the sensor.
pub fn light_tracing(spec: &LightTracingSpec) -> Chosen {
    let details = uniform(spec.directions);
    let value = |particles| Untermined::LightTracing { particles, directions: spec.directions };
    let one =
        |params: Vec<Point>, particles| Choice::new("light_tracing", &details, params, value(particles));
    Ok(match &spec.particles {
        None => vec![one(Vec::new(), None)],
        Some(sweep) => points("particles", sweep).map(|p| one(vec![p], Some(p.1 as u64))).collect(),
    })
}

/// The density of photons.
pub fn photon_map(spec: &PhotonMapSpec) -> Chosen {
    let mut details = Vec::new();
    if spec.last == Last::Counted && spec.k.is_some() {
        details.push("k-th counted".to_owned());
    }
    details.extend(kernel(spec.kernel));
    details.extend(direct(spec.direct));
    if spec.final_gather > 0 {
        details.push(format!("final gather={}", spec.final_gather));
    }
    details.extend(uniform(spec.directions));
    let gathers: Vec<(Point, Gather)> = match (&spec.k, &spec.radius) {
        (Some(_), Some(_)) => {
            return Err("photons are gathered by number (k) or by distance (radius), not by both".to_owned());
        }
        (None, None) => {
            return Err("give k = 50, say, for the nearest photons, or a radius".to_owned());
        }
        (Some(k), None) => {
            points("k", k).map(|p| (p, Gather::Nearest { k: p.1 as u32, last: spec.last })).collect()
        }
        (None, Some(radius)) => {
            points("radius", radius).map(|p| (p, Gather::Within { radius: p.1 })).collect()
        }
    };
    bounds::combinations(&[spec.photons.0.len(), gathers.len()], "photons and what is gathered")?;
    let mut all = Vec::new();
    for photons in points("photons", &spec.photons) {
        for &(point, gather) in &gathers {
            if point.0 == "k" && point.1 > photons.1 {
                let why = "more photons are to be gathered than are sent for a map";
                return Err(format!("k = {} of {} photons: {why}", point.1, photons.1));
            }
            let map = map(photons, gather, spec.kernel, spec.direct, spec.directions);
            let map = PhotonMap { final_gather: spec.final_gather, ..map };
            all.push(Choice::new("photon_map", &details, vec![photons, point], Untermined::PhotonMap(map)));
        }
    }
    Ok(all)
}

/// A sequence of maps whose radius shrinks.
pub fn progressive(spec: &ProgressiveSpec) -> Chosen {
    let mut details = kernel(spec.kernel);
    details.extend(direct(spec.direct));
    details.extend(uniform(spec.directions));
    let counts = [&spec.photons, &spec.radius, &spec.alpha].map(|sweep| sweep.0.len());
    bounds::combinations(&counts, "photons, radius and alpha")?;
    let mut all = Vec::new();
    for photons in points("photons", &spec.photons) {
        for radius in points("radius", &spec.radius) {
            for alpha in points("alpha", &spec.alpha) {
                let gather = Gather::Shrinking { radius: radius.1, alpha: alpha.1, passes: spec.passes };
                let map = map(photons, gather, spec.kernel, spec.direct, spec.directions);
                let params = vec![photons, radius, alpha];
                all.push(Choice::new("progressive", &details, params, Untermined::PhotonMap(map)));
            }
        }
    }
    Ok(all)
}

fn map(
    photons: Point,
    gather: Gather,
    kernel: Kernel,
    direct: DirectLight,
    directions: Directions,
) -> PhotonMap {
    let roulette = Roulette::unclamped(Rule::None); // until the file's rule is known
    PhotonMap { photons: photons.1 as u64, gather, kernel, direct, final_gather: 0, directions, roulette }
}

fn kernel(kernel: Kernel) -> Vec<String> {
    match kernel {
        Kernel::Box => Vec::new(),
        Kernel::Cone { c } => vec![format!("cone={c}")],
        Kernel::Epanechnikov => vec!["epanechnikov".to_owned()],
    }
}

fn direct(direct: DirectLight) -> Option<String> {
    (direct == DirectLight::Sampled).then(|| "direct sampled".to_owned())
}

fn uniform(directions: Directions) -> Vec<String> {
    (directions == Directions::Uniform).then(|| "uniform directions".to_owned()).into_iter().collect()
}
