//! Particles, sixteen at once: vertex by vertex what `estimator::particles` does for one, each with a narrow stream of its
//! own. What is done where they land, and all that follows, is the estimator's.

use super::paths::Paths;
use super::rays::Rays;
use super::stage::{Meeting, Stage};
use super::steps::Steps;
use super::vector::{M, U, V3, WIDTH, lanes};
use crate::estimator::particles::Particle;
use crate::estimator::{
    Ctx, Estimate, Estimator, Film, LightTracing, Pass, PhotonMap, Photons, Property, Tally, pulse,
};
use crate::sampling::{Address, Stream};
use crate::scene::{Ray, Rgb, Scene, Start};
use fearless_simd::{Level, Simd, dispatch, prelude::*};

/// An estimator whose particles go sixteen at once.
#[derive(Clone)]
pub struct Particles<'a> {
    steps: Steps<'a>,
    estimator: Estimator,
    level: Level,
}

/// What is done with particles where they land.
trait Arrival {
    fn land<S: Simd>(&mut self, stage: &Stage<'_>, x: &Meeting<S>, particles: &mut Paths<S>, emitted: &[Rgb]);
}

/// They are stored.
struct Stored<'m>(&'m PhotonMap, &'m mut Photons);

/// They are connected to the sensor, each for this share of all light.
struct Shown<'m>(f64, &'m mut Film);

impl<'a> Particles<'a> {
    /// The particles of this estimator; `None` if it sends none.
    pub(super) fn of(stage: Stage<'a>, estimator: Estimator, level: Level) -> Option<Self> {
        let (directions, roulette) = match estimator {
            Estimator::LightTracing(e) => (e.directions, e.roulette),
            Estimator::PhotonMap(e) => (e.directions, e.roulette),
            _ => return None,
        };
        Some(Particles { steps: Steps { stage, directions, roulette }, estimator, level })
    }

    /// The same with another instruction set of this machine.
    pub fn on(&self, level: Level) -> Self {
        Particles { level, ..self.clone() }
    }

    /// The map of one realization, whose particle `i` draws from the narrow stream (0, i) of an address.
    pub fn map(&self, e: &PhotonMap, realization: u64, address: &Address, tally: &mut Tally) -> Photons {
        let mut map = e.empty(realization);
        self.send(e.photons, address, tally, &mut Stored(e, &mut map));
        map.grown()
    }

    /// The film of one realization.
    pub fn film(&self, e: &LightTracing, address: &Address, tally: &mut Tally) -> Film {
        let mut film = Film::default();
        self.send(e.particles, address, tally, &mut Shown(e.share(), &mut film));
        film.developed()
    }

    fn send(&self, count: u64, address: &Address, tally: &mut Tally, arrival: &mut impl Arrival) {
        dispatch!(self.level, simd => self.send_with(simd, count, address, tally, arrival));
    }

    #[inline(always)]
    fn send_with<S: Simd>(
        &self,
        simd: S,
        count: u64,
        address: &Address,
        tally: &mut Tally,
        arrival: &mut impl Arrival,
    ) {
        let (mut particles, mut emitted) = (Paths::new(simd), [Rgb::ZERO; WIDTH]);
        let mut numbers = 0..count;
        loop {
            for lane in lanes(!particles.alive) {
                let Some(number) = numbers.next() else { break };
                pulse::beat();
                let mut stream = address.narrow_stream(0, number);
                let Some((ray, power)) = emit(self.steps.stage.scene, &mut stream) else { return };
                particles.start(lane, &Start { ray, response: 1.0, time: 0.0, pixel: 0 }, &stream);
                emitted[lane] = power;
            }
            if particles.alive.all_false() {
                tally.runaway += particles.runaway;
                return;
            }
            let before = particles.alive;
            self.vertex(&mut particles, &emitted, arrival);
            for lane in lanes(before & !particles.alive) {
                tally.rays += u64::from(particles.rays_traced[lane]);
            }
        }
    }

    #[inline(always)]
    fn vertex<S: Simd>(&self, particles: &mut Paths<S>, emitted: &[Rgb], arrival: &mut impl Arrival) {
        let steps = &self.steps;
        let mut x = steps.meet(particles);
        particles.alive &= steps.reaches(particles.bounce + 1);
        arrival.land(&steps.stage, &x, particles, emitted);
        particles.bounce += 1;
        steps.roulette(&x, particles);
        particles.resume(&mut x);
        steps.scatter(&x, particles);
    }
}

/// A particle that leaves a light, drawn as `Ctx::emit` does; `None` in the dark.
#[inline(always)]
fn emit(scene: &Scene, stream: &mut Stream) -> Option<(Ray, Rgb)> {
    let (pick, point, direction) = (stream.u1(), stream.u2(), stream.u2());
    scene.emit(0.0, pick, point, direction).map(|emission| (emission.ray, emission.power))
}

/// What one of sixteen particles has been through.
#[inline(always)]
fn particle<S: Simd>(particles: &Paths<S>, lane: usize, emitted: &[Rgb]) -> Particle {
    let bounce = particles.bounce[lane];
    Particle { power: emitted[lane] * particles.beta.of(lane), bounce, diffuse: bounce > 0 }
}

impl Arrival for Stored<'_> {
    #[inline(always)]
    fn land<S: Simd>(
        &mut self,
        stage: &Stage<'_>,
        x: &Meeting<S>,
        particles: &mut Paths<S>,
        emitted: &[Rgb],
    ) {
        for lane in lanes(particles.alive) {
            let hit = stage.hit(x, lane, particles.rays.d.of(lane));
            self.0.keep(self.1, &hit, particle(particles, lane, emitted));
        }
    }
}

impl Arrival for Shown<'_> {
    #[inline(always)]
    fn land<S: Simd>(
        &mut self,
        stage: &Stage<'_>,
        x: &Meeting<S>,
        particles: &mut Paths<S>,
        emitted: &[Rgb],
    ) {
        let simd = x.id.token();
        let (u, v) = particles.streams.u2(particles.alive);
        let (mut to_sensor, mut to) = (V3::splat(simd, [0.0; 3]), U::splat(simd, 0));
        let (mut seen, mut open) = ([(0, Rgb::ZERO); WIDTH], M::splat(simd, false));
        for lane in lanes(particles.alive) {
            let point = (f64::from(u[lane]), f64::from(v[lane]));
            let Some(way) = stage.scene.sensor.connect(x.p.of(lane), point) else { continue };
            let hit = stage.hit(x, lane, particles.rays.d.of(lane));
            let cos = hit.frame.n.dot(way.wo);
            if cos > 0.0 {
                let f = hit.material.bsdf.f(hit.frame.n, way.wo, hit.wo);
                seen[lane] = (way.pixel, f * (cos * way.importance));
                to_sensor.set(lane, way.to_sensor);
                to[lane] = way.surface;
                open.set(lane, true);
            }
        }
        particles.count(open);
        let visible = open & stage.visible(&Rays { o: x.p, d: to_sensor, from: x.id }, to);
        for lane in lanes(visible) {
            let Particle { power, bounce, .. } = particle(particles, lane, emitted);
            let (pixel, of_power) = seen[lane];
            self.1.add(pixel, bounce + 1, of_power * power * self.0);
        }
    }
}

impl Estimate for Particles<'_> {
    type Pass = Pass;

    fn begin(&self, realization: u64, cx: &mut Ctx<'_>) -> Pass {
        let address = cx.branch();
        let tally = cx.tally();
        match &self.estimator {
            Estimator::PhotonMap(e) => Pass::Photons(Box::new(self.map(e, realization, &address, tally))),
            Estimator::LightTracing(e) => Pass::Film(self.film(e, &address, tally)),
            _ => unreachable!("it sends no particles"),
        }
    }

    fn estimate(&self, pass: &Pass, ray: Ray, cx: &mut Ctx<'_>) {
        self.estimator.estimate(pass, ray, cx);
    }

    fn property(&self) -> Property {
        self.estimator.property()
    }
}
