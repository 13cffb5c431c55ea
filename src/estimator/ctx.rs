//! What an estimator works with: the scene, a random stream and the tally. Cost accrues here, because only here can
//! a ray be traced.

use super::pulse;
use crate::sampling::{Address, PdfW, Stream};
use crate::scene::{Carried, Directions, Emission, Hit, LightSampling, Ray, Rgb, Scene, Start};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Bounces 0 to 7 have a bin each; the last bin holds all later ones.
pub const BINS: usize = 9;

/// A realization that traces more rays than this is a runaway walk and makes its cell invalid.
pub const MAX_RAYS: u64 = 1 << 26;

/// What realizations have added up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    /// The present path's contribution, all bounces.
    pub value: Rgb,
    /// Contributions by bounce, over all paths since the tally was made.
    pub bounces: [Rgb; BINS],
    /// Rays traced: camera, continued and shadow rays count one each.
    pub rays: u64,
    /// Contributions that were not finite.
    pub non_finite: u64,
    /// Contributions that were negative.
    pub negative: u64,
    /// Walks cut at [`MAX_RAYS`].
    pub runaway: u64,
    /// Gathers of the k nearest photons from a map that holds fewer.
    pub starved: u64,
}

/// The context of one path.
pub struct Ctx<'a> {
    /// The scene, for its materials and emitters.
    scene: &'a Scene,
    /// Where chance comes from.
    stream: Stream,
    /// What is counted.
    tally: &'a mut Tally,
    /// Factor from radiance to the sensor's quantity.
    response: f64,
    /// The moment at which the path happens.
    time: f64,
    /// The pixel that it measures.
    pixel: u32,
    /// The tally's rays at which this path is cut.
    limit: u64,
}

/// Light that reaches a vertex from a sampled point.
#[derive(Clone, Copy, Debug)]
pub struct Direct {
    /// What the vertex reflects of it, f cos θ le V / pdf [W m^-2 sr^-1].
    pub radiance: Rgb,
    /// Unit direction towards the light.
    pub wi: DVec3,
    /// Density with which this direction was sampled [1/sr]; `None` for a light without extent.
    pub pdf: Option<PdfW>,
}

/// A continued path.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Where it goes.
    pub ray: Ray,
    /// f cos θ / pdf.
    pub weight: Rgb,
    /// Density of the direction [1/sr]; `None` for a Dirac lobe.
    pub pdf: Option<PdfW>,
}

// `inline(always)` here and in the scene: a hit whose address goes to a call is kept in memory, all of its 160 bytes,
// and copied at each vertex; inlined, a seventh of a path's time is saved. The compiler's own choice flips with any edit.
impl<'a> Ctx<'a> {
    /// A context for one path.
    #[inline]
    pub fn new(scene: &'a Scene, stream: Stream, tally: &'a mut Tally, start: &Start) -> Self {
        pulse::beat();
        tally.value = Rgb::ZERO;
        let limit = tally.rays + MAX_RAYS;
        let Start { response, time, pixel, .. } = *start;
        Ctx { scene, stream, tally, response, time, pixel, limit }
    }

    /// A context for what the pixels of one realization share.
    pub fn shared(scene: &'a Scene, stream: Stream, tally: &'a mut Tally) -> Self {
        pulse::beat();
        let limit = tally.rays + MAX_RAYS;
        Ctx { scene, stream, tally, response: 1.0, time: 0.0, pixel: 0, limit }
    }

    /// An address whose streams belong to this context alone, drawn from its stream.
    pub fn branch(&mut self) -> Address {
        self.stream.branch()
    }

    /// What is counted.
    pub fn tally(&mut self) -> &mut Tally {
        self.tally
    }

    /// The scene.
    #[inline]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The moment at which the path happens, in [0, 1) of the exposure.
    #[inline]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The pixel that the path measures, row by row from the top left.
    #[inline]
    pub fn pixel(&self) -> u32 {
        self.pixel
    }

    /// Traces a ray: what it meets first, or `None` for the void and for black backs.
    #[inline(always)]
    pub fn hit(&mut self, ray: &Ray) -> Option<Hit<'a>> {
        self.tally.rays += 1;
        if self.tally.rays > self.limit {
            self.tally.runaway += 1;
            return None;
        }
        self.scene.intersect(ray, self.time)
    }

    /// Records a contribution [W m^-2 sr^-1] of light that was scattered `bounce` times.
    #[inline]
    pub fn add(&mut self, bounce: u32, radiance: Rgb) {
        let value = radiance * self.response;
        self.tally.non_finite += u64::from(!value.is_finite());
        self.tally.negative += u64::from(value.min_element() < 0.0);
        self.tally.value += value;
        self.tally.bounces[(bounce as usize).min(BINS - 1)] += value;
    }

    /// A uniform number in [0, 1).
    #[inline]
    pub fn u1(&mut self) -> f64 {
        self.stream.u1()
    }

    /// A point of the unit square.
    #[inline]
    pub fn u2(&mut self) -> (f64, f64) {
        self.stream.u2()
    }

    /// Russian roulette and splitting: floor(q + u) copies, q of them on average; each is to be weighted 1/q
    /// [Arvo & Kirk 1990].
    #[inline]
    pub fn copies(&mut self, q: f64) -> u32 {
        if q == 0.0 || q == 1.0 { q as u32 } else { (q + self.stream.u1()) as u32 }
    }

    /// Next-event estimation: one sampled point on an emitter [Veach 1997, eq. 8.2], `None` where nothing arrives.
    #[inline(always)]
    pub fn direct(&mut self, x: &Hit<'_>, lights: LightSampling) -> Option<Direct> {
        if x.material.bsdf.is_dirac() || x.is_sky() {
            return None;
        }
        let pick = if self.scene.light_count() > 1 { self.u1() } else { 0.0 };
        let point = self.u2();
        let light = self.scene.sample_light(lights, (x.p, self.time), pick, point)?;
        let wi = light.to_light / light.distance;
        let cos = x.frame.n.dot(wi);
        if cos <= 0.0 || !self.visible(x, light.to_light, light.surface) {
            return None;
        }
        let f = x.material.bsdf.f(x.frame.n, x.wo, wi);
        Some(Direct { radiance: f * light.le * (cos * light.weight), wi, pdf: light.pdf })
    }

    /// Density [1/sr] with which [`Ctx::direct`] at `ray.o` would have sampled what `ray` hit.
    #[inline]
    pub fn light_pdf(&self, ray: &Ray, hit: &Hit<'_>, lights: LightSampling) -> PdfW {
        self.scene.light_pdf(lights, ray, hit, self.time)
    }

    /// A continued direction at `x`.
    #[inline(always)]
    pub fn scatter(&mut self, x: &Hit<'_>, directions: Directions) -> Step {
        let s = x.material.bsdf.sample(Carried::Radiance, directions, &x.frame, x.wo, self.u2());
        Step { ray: x.spawn(s.wi), weight: s.weight, pdf: s.pdf }
    }

    /// A particle that leaves a light at its own moment; `None` in the dark.
    #[inline]
    pub fn emit(&mut self) -> Option<Emission> {
        pulse::beat();
        self.limit = self.tally.rays + MAX_RAYS;
        self.time = if self.scene.moves() { self.u1() } else { 0.0 };
        let (pick, point, direction) = (self.u1(), self.u2(), self.u2());
        self.scene.emit(self.time, pick, point, direction)
    }

    /// A direction in which a particle goes on from `x`.
    #[inline]
    pub fn scatter_particle(&mut self, x: &Hit<'_>, directions: Directions) -> Step {
        let s = x.material.bsdf.sample(Carried::Power, directions, &x.frame, x.wo, self.u2());
        Step { ray: x.spawn(s.wi), weight: s.weight, pdf: s.pdf }
    }

    /// What the sensor sees of each watt that falls on `x` from `x.wo`, and in which pixel; `None` where it sees nothing.
    #[inline]
    pub fn connect(&mut self, x: &Hit<'_>) -> Option<(u32, Rgb)> {
        let u = self.u2();
        let way = self.scene.sensor.connect(x.p, u)?;
        let cos = x.frame.n.dot(way.wo);
        if cos <= 0.0 || !self.visible(x, way.to_sensor, way.surface) {
            return None;
        }
        Some((way.pixel, x.material.bsdf.f(x.frame.n, way.wo, x.wo) * (cos * way.importance)))
    }

    /// Notes that a map held fewer photons than were to be gathered.
    #[inline]
    pub fn starve(&mut self) {
        self.tally.starved += 1;
    }

    /// Traces a shadow ray from `x` to the point `x.p + to_light` on a surface: whether nothing stands between.
    #[inline(always)]
    pub fn visible(&mut self, x: &Hit<'_>, to_light: DVec3, surface: u32) -> bool {
        self.tally.rays += 1;
        self.scene.visible(&x.spawn(to_light), self.time, surface)
    }
}
