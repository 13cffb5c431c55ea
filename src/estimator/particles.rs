//! Particles: light followed from where it is emitted, for whatever is to be done where it lands.
//!
//! - follows: power, as f cos / pdf carries it from surface to surface [Arvo 1986; Dutré et al. 1993]
//! - cost: one ray a vertex

use super::{Ctx, Roulette};
use crate::scene::{Directions, Hit, Ray, Rgb};

/// How particles go on.
#[derive(Clone, Copy, Debug)]
pub struct Particles {
    /// How continued directions are drawn.
    pub directions: Directions,
    /// When a walk ends.
    pub roulette: Roulette,
}

/// What a particle has been through.
#[derive(Clone, Copy, Debug)]
pub struct Particle {
    /// The power that it carries, in watts.
    pub power: Rgb,
    /// How often it was scattered.
    pub bounce: u32,
    /// Whether it was scattered by anything but mirrors and glass.
    pub diffuse: bool,
}

impl Particles {
    /// Sends one particle; `land` is told of it wherever it meets a surface that is no mirror or glass.
    #[inline]
    pub fn send<'a>(&self, cx: &mut Ctx<'a>, land: &mut impl FnMut(&mut Ctx<'a>, &Hit<'a>, Particle)) {
        if let Some(emission) = cx.emit() {
            let particle = Particle { power: emission.power, bounce: 0, diffuse: false };
            self.walk(emission.ray, Rgb::ONE, particle, cx, land);
        }
    }

    /// `beta` is what the walk has left of the emitted power: what roulette looks at.
    fn walk<'a>(
        &self,
        mut ray: Ray,
        mut beta: Rgb,
        mut particle: Particle,
        cx: &mut Ctx<'a>,
        land: &mut impl FnMut(&mut Ctx<'a>, &Hit<'a>, Particle),
    ) {
        let emitted = particle.power;
        while let Some(x) = cx.hit(&ray) {
            if x.is_sky() || !self.roulette.reaches(particle.bounce + 1) {
                return;
            }
            let dirac = x.material.bsdf.is_dirac();
            particle.power = emitted * beta;
            if !dirac {
                land(cx, &x, particle);
            }
            let q = self.roulette.q(particle.bounce, beta, x.albedo());
            let copies = cx.copies(q);
            if copies == 0 {
                return;
            }
            beta *= 1.0 / q;
            particle.bounce += 1;
            particle.diffuse |= !dirac;
            for _ in 1..copies {
                let next = cx.scatter_particle(&x, self.directions);
                let copy = Particle { power: emitted, ..particle };
                self.walk(next.ray, beta * next.weight, copy, cx, &mut *land);
            }
            let next = cx.scatter_particle(&x, self.directions);
            (ray, beta) = (next.ray, beta * next.weight);
        }
    }
}
