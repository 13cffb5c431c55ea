//! One path tracer, written once more and line by line, with a place for each mistake that is made in one.
//!
//! Without a mistake it draws the same numbers and adds the same contributions as the sound estimator, bit for bit; so
//! what a fault changes is the fault's doing.

use super::direct::DirectLight;
use super::mis::Weighting;
use super::slip::{Emission, Offset, Slip};
use super::survival::Survival;
use crate::estimator::{BINS, Ctx, Estimator, Roulette, Technique};
use crate::sampling::PdfW;
use crate::scene::geometry::NOWHERE;
use crate::scene::{Directions, Hit, LightSampling, Material, Ray, Rgb};
use glam::DVec3;

/// What the walk does, as the sound estimator says, and its mistake.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// The mistake.
    pub slip: Slip,
    /// Which technique finds direct light.
    pub technique: Technique,
    /// How points on emitters are drawn.
    pub lights: LightSampling,
    /// The density that continued directions are believed to have.
    pub directions: Directions,
    /// When the walk ends.
    pub roulette: Roulette,
}

/// A path on its way to the next vertex.
#[derive(Clone, Copy)]
pub struct Path<'a> {
    /// Where it goes.
    pub ray: Ray,
    /// Throughput.
    pub beta: Rgb,
    /// Believed density of its last direction; `None` for a Dirac lobe and for the camera.
    pub pdf: Option<PdfW>,
    /// Scattering events so far.
    pub bounce: u32,
    /// The probability of survival at the last vertex.
    pub q: f64,
    /// What the last vertex is made of.
    pub last: Option<&'a Material>,
    /// The normal at the first vertex.
    pub first: Option<DVec3>,
}

/// Where contributions go.
pub enum Record<'r> {
    /// To the tally, as they come.
    Tally,
    /// To the tally, if they are numbers; others vanish.
    Numbers,
    /// They are held back, by bounce.
    Held(&'r mut [Rgb; BINS]),
}

impl Record<'_> {
    /// Takes a contribution.
    pub fn add(&mut self, cx: &mut Ctx<'_>, bounce: u32, radiance: Rgb) {
        match self {
            Record::Tally => cx.add(bounce, radiance),
            Record::Numbers if !radiance.is_finite() => {}
            Record::Numbers => cx.add(bounce, radiance),
            Record::Held(bins) => bins[(bounce as usize).min(BINS - 1)] += radiance,
        }
    }
}

impl Walk {
    /// The walk that `estimator` is claimed to be. One that branches is walked as one that does not.
    pub fn of(estimator: &Estimator, slip: Slip) -> Self {
        let roulette = slip.roulette(*estimator.roulette());
        let (technique, lights, directions) = match estimator {
            Estimator::Explicit(e) => (e.technique, e.lights, e.directions),
            Estimator::Implicit(e) => (Technique::Direction, LightSampling::AREA, e.directions),
            Estimator::Recursive(e) => (Technique::Direction, LightSampling::AREA, e.directions),
            Estimator::LightTracing(e) => (Technique::Light, LightSampling::AREA, e.directions),
            Estimator::PhotonMap(e) => (Technique::Light, LightSampling::AREA, e.directions),
        };
        Walk { slip, technique, lights, directions: slip.believed(directions), roulette }
    }

    /// Follows one path from the camera.
    pub fn trace<'a>(&self, ray: Ray, cx: &mut Ctx<'a>, record: &mut Record<'_>) {
        let path = Path { ray, beta: Rgb::ONE, pdf: None, bounce: 0, q: 1.0, last: None, first: None };
        self.follow(path, cx, record);
    }

    fn follow<'a>(&self, mut path: Path<'a>, cx: &mut Ctx<'a>, record: &mut Record<'_>) {
        loop {
            let Some(x) = cx.hit(&path.ray) else { return };
            path.first.get_or_insert(x.frame.n);
            self.emission(&path, &x, cx, record);
            if self.slip == Slip::Emission(Emission::Ends) && x.le != Rgb::ZERO {
                return;
            }
            path.bounce += 1;
            if !self.roulette.reaches(path.bounce) {
                return;
            }
            let x = self.leave(x);
            let cos_at_light = match self.technique.samples_lights() {
                true => self.direct(&path, &x, cx, record),
                false => None,
            };
            let sampled = self.technique == Technique::Light && !x.material.bsdf.is_dirac();
            if !self.roulette.reaches(path.bounce + u32::from(sampled)) {
                return;
            }
            let Survival { copies, q, weight } = self.survival(&path, &x, cx);
            if copies == 0 {
                return;
            }
            path.beta *= weight;
            (path.q, path.last) = (q, Some(x.material));
            for _ in 1..copies {
                let next = self.scatter(&path, &x, cos_at_light, cx);
                self.follow(next, cx, record);
            }
            path = self.scatter(&path, &x, cos_at_light, cx);
        }
    }

    /// Adds what the surface emits towards where the path comes from.
    fn emission(&self, path: &Path<'_>, x: &Hit<'_>, cx: &mut Ctx<'_>, record: &mut Record<'_>) {
        let mirrored = path.bounce > 0 && path.pdf.is_none();
        let sound = self.hit_weight(path, x, cx);
        let (beta, weight) = match self.slip.emission() {
            Some(Emission::Twice) => (path.beta, 1.0),
            Some(Emission::NotAtCamera) if path.bounce == 0 => (path.beta, 0.0),
            Some(Emission::NotAfterMirror) if mirrored && self.technique.samples_lights() => (path.beta, 0.0),
            Some(Emission::SeenFromFirst) if mirrored && path.first.is_some_and(|n| n.dot(x.wo) <= 0.0) => {
                (path.beta, 0.0)
            }
            Some(Emission::Never) => (path.beta, 0.0),
            Some(Emission::WithoutThroughput) => (Rgb::ONE, sound),
            _ => (path.beta, sound),
        };
        if weight > 0.0 {
            record.add(cx, path.bounce, beta * x.le * weight);
        }
    }

    /// Next-event estimation. Returns the cosine at the light, if one was sampled.
    fn direct(&self, path: &Path<'_>, x: &Hit<'_>, cx: &mut Ctx<'_>, record: &mut Record<'_>) -> Option<f64> {
        let DirectLight { radiance, weight, cos_at_light } = self.sample_direct(path, x, cx)?;
        record.add(cx, path.bounce, path.beta * radiance * weight);
        Some(cos_at_light)
    }

    /// The point from which rays leave: the hit itself, which rays know and do not meet again.
    fn leave<'a>(&self, x: Hit<'a>) -> Hit<'a> {
        match self.slip {
            Slip::Offset(_) if x.is_sky() => x,
            Slip::Offset(Offset::None) => Hit { surface: NOWHERE, ..x },
            Slip::Offset(Offset::Large) => Hit { p: x.p + 0.01 * x.frame.n, surface: NOWHERE, ..x },
            _ => x,
        }
    }

    /// The weighting mistake, if it is one.
    pub fn weighting(&self) -> Option<Weighting> {
        match self.slip {
            Slip::Weighting(weighting) => Some(weighting),
            _ => None,
        }
    }
}
