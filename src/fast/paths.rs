//! Sixteen paths under way.

use super::outcome::Outcomes;
use super::rays::Rays;
use super::stage::Meeting;
use super::stream::Streams;
use super::vector::{F, M, U, V3, WIDTH, lanes};
use crate::sampling::Stream;
use crate::scene::Start;
use fearless_simd::{Simd, prelude::*};
use glam::DVec3;

/// Sixteen paths, a lane each.
pub struct Paths<S: Simd> {
    /// Those that go on.
    pub alive: M<S>,
    /// Where they go.
    pub rays: Rays<S>,
    /// Their throughput.
    pub beta: V3<S>,
    /// Density of their last direction [1/sr]; infinite for the first one.
    pub pdf: F<S>,
    /// How often they were scattered.
    pub bounce: U<S>,
    /// Rays traced so far.
    pub rays_traced: U<S>,
    /// Paths that were cut because they traced more rays than any sound walk.
    pub runaway: u64,
    /// Where their chance comes from.
    pub streams: Streams<S>,
    /// Copies that wait for their turn.
    waiting: [Vec<Waiting>; WIDTH],
    waits: bool,
}

/// A vertex from which further copies are to go on, once the present one has ended.
#[derive(Clone, Copy)]
struct Waiting {
    p: DVec3,
    n: DVec3,
    albedo: DVec3,
    id: u32,
    beta: DVec3,
    bounce: u32,
    copies: u32,
}

impl<S: Simd> Paths<S> {
    /// Nothing under way.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let (zero, none) = (V3::splat(simd, [0.0; 3]), U::splat(simd, 0));
        Paths {
            alive: M::splat(simd, false),
            rays: Rays { o: zero, d: zero, from: none },
            beta: zero,
            pdf: F::splat(simd, 0.0),
            bounce: none,
            rays_traced: none,
            runaway: 0,
            streams: Streams::new(simd),
            waiting: Default::default(),
            waits: false,
        }
    }

    /// Counts a ray for each path of a mask.
    #[inline(always)]
    pub fn count(&mut self, traced: M<S>) {
        self.rays_traced = traced.select(self.rays_traced + 1, self.rays_traced);
    }

    /// Takes up a new path.
    #[inline(always)]
    pub fn start(&mut self, lane: usize, start: &Start, stream: &Stream) {
        self.rays.o.set(lane, start.ray.o);
        self.rays.d.set(lane, start.ray.d);
        self.rays.from[lane] = start.ray.from;
        self.beta.set(lane, DVec3::ONE);
        self.pdf[lane] = f32::INFINITY;
        (self.bounce[lane], self.rays_traced[lane]) = (0, 0);
        self.streams.set(lane, stream.narrow_state().expect("lanes draw from narrow streams"));
        self.alive.set(lane, true);
    }

    /// Lets copies of a path wait until it has ended.
    pub fn wait(&mut self, lane: usize, x: &Meeting<S>, copies: u32) {
        self.waits = true;
        self.waiting[lane].push(Waiting {
            p: x.p.of(lane),
            n: x.n.of(lane),
            albedo: x.albedo.of(lane),
            id: x.id[lane],
            beta: self.beta.of(lane),
            bounce: self.bounce[lane],
            copies,
        });
    }

    /// Where a path has ended whose copies wait, one of them goes on from its vertex.
    #[inline(always)]
    pub fn resume(&mut self, x: &mut Meeting<S>) {
        if !self.waits {
            return;
        }
        for lane in lanes(!self.alive) {
            let Some(waiting) = self.waiting[lane].last_mut() else { continue };
            waiting.copies -= 1;
            let vertex = *waiting;
            if vertex.copies == 0 {
                self.waiting[lane].pop();
            }
            x.p.set(lane, vertex.p);
            x.n.set(lane, vertex.n);
            x.albedo.set(lane, vertex.albedo);
            x.id[lane] = vertex.id;
            self.beta.set(lane, vertex.beta);
            self.bounce[lane] = vertex.bounce;
            self.alive.set(lane, true);
        }
        self.waits = self.waiting.iter().any(|waiting| !waiting.is_empty());
    }

    /// Notes what paths have come to that were under way and are so no longer.
    #[inline(always)]
    pub fn end(&self, before: M<S>, out: &mut Outcomes) {
        lanes(before & !self.alive).for_each(|lane| out.finish(lane, self.rays_traced[lane]));
    }
}
