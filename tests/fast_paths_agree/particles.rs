//! Particles: each of them lands, and is connected to the sensor, where the textbook's does.

use super::ROUNDING;
use crate::common::{rules, scenes};
use furnace::estimator::{
    Ctx, DirectLight, Estimate, Estimator, Gather, Kernel, LightTracing, PhotonMap, Roulette, Tally,
};
use furnace::fast::{Fast, Level, Particles};
use furnace::sampling::Address;
use furnace::scene::{Directions, Rgb, Scene};
use glam::DVec3;

const PARTICLES: u64 = 400;
const RADIUS: f64 = 100.0;

fn photon_map(photons: u64, directions: Directions, roulette: Roulette) -> PhotonMap {
    let (gather, kernel, direct) = (Gather::Within { radius: RADIUS }, Kernel::Box, DirectLight::Photons);
    PhotonMap { photons, gather, kernel, direct, final_gather: 0, directions, roulette }
}

fn particles<'a>(scene: &'a Scene, estimator: Estimator) -> Option<Particles<'a>> {
    match Fast::of(scene, &estimator) {
        Ok(Fast::Particles(particles)) => Some(particles),
        Ok(Fast::Paths(_)) => panic!("{estimator:?} sends particles"),
        Err(_) => None,
    }
}

/// A photon: bounce, distance from a point, power.
type Seen = (u32, f64, Rgb);

/// The photons of a map.
fn seen(map: &furnace::estimator::Photons) -> Vec<Seen> {
    let near = map.near(DVec3::new(0.1, 0.2, 0.3)).unwrap();
    let mut all: Vec<Seen> =
        near.photons().map(|(t, photon)| (photon.bounce(), RADIUS * t.sqrt(), photon.power())).collect();
    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all
}

fn same(a: &[Seen], b: &[Seen]) -> bool {
    let near = |a: &Seen, b: &Seen| {
        let power = (a.2 - b.2).abs().max_element() <= ROUNDING * a.2.max_element();
        a.0 == b.0 && (a.1 - b.1).abs() <= 1e-4 * (1.0 + a.1) && power
    };
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b))
}

#[test]
fn photon_by_photon() {
    for (name, kind) in scenes() {
        let scene = kind.build();
        for (rule, roulette) in rules() {
            for directions in [Directions::Cosine, Directions::Uniform] {
                let one = photon_map(1, directions, roulette);
                let Some(fast) = particles(&scene, Estimator::PhotonMap(one)) else { continue };
                let (mut astray, mut rays) = (0, [0, 0]);
                for i in 0..PARTICLES {
                    let address = Address::of(&["photon by photon", &name, &i.to_string()]);
                    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
                    let stream = address.narrow_stream(0, 0);
                    let reference = one.begin(0, &mut Ctx::shared(&scene, stream, &mut theirs));
                    let map = fast.map(&one, 0, &address, &mut ours);
                    let agree = same(&seen(&reference), &seen(&map)) && ours.rays == theirs.rays;
                    astray += u64::from(!agree);
                    rays = [rays[0] + ours.rays, rays[1] + theirs.rays];
                }
                assert!(astray <= PARTICLES / 100, "{name} {rule} {directions:?}: {astray} go elsewhere");
                assert!(rays[0].abs_diff(rays[1]) <= rays[1] / 50, "{name} {rule}: {rays:?} rays");
            }
        }
    }
}

#[test]
fn what_is_seen_of_each_particle() {
    for (name, kind) in scenes() {
        let scene = kind.build();
        if !scene.sensor.has_extent() {
            continue;
        }
        let (width, height) = scene.sensor.resolution();
        for (rule, roulette) in rules() {
            let one = LightTracing { particles: 1, directions: Directions::Cosine, roulette };
            let Some(fast) = particles(&scene, Estimator::LightTracing(one)) else { continue };
            let mut astray = 0;
            for i in 0..PARTICLES {
                let address = Address::of(&["what is seen", &name, &i.to_string()]);
                let (mut ours, mut theirs) = (Tally::default(), Tally::default());
                let stream = address.narrow_stream(0, 0);
                let reference = one.begin(0, &mut Ctx::shared(&scene, stream, &mut theirs));
                let film = fast.film(&one, &address, &mut ours);
                let agree = (0..width * height).all(|pixel| {
                    let (a, b): (Vec<_>, Vec<_>) = (reference.at(pixel).collect(), film.at(pixel).collect());
                    let near = |a: Rgb, b: Rgb| (a - b).abs().max_element() <= ROUNDING * a.max_element();
                    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && near(a.1, b.1))
                });
                astray += u64::from(!agree || ours.rays != theirs.rays);
            }
            assert!(astray <= PARTICLES / 100, "{name} {rule}: {astray} go elsewhere");
        }
    }
}

#[test]
fn a_particle_does_not_depend_on_its_neighbours_or_the_instruction_set() {
    for (name, kind) in scenes().into_iter().take(4) {
        let scene = kind.build();
        for (rule, roulette) in rules() {
            let address = Address::of(&["neighbours", &name]);
            let map = |photons, level: Level| {
                let e = photon_map(photons, Directions::Cosine, roulette);
                let fast = particles(&scene, Estimator::PhotonMap(e)).unwrap().on(level);
                let map = fast.map(&e, 0, &address, &mut Tally::default());
                seen(&map).into_iter().map(|(k, t, power)| (k, t.to_bits(), power)).collect::<Vec<_>>()
            };
            let levels = crate::levels();
            let many = map(50, levels[0]);
            levels[1..].iter().for_each(|&level| assert_eq!(many, map(50, level), "{name} {rule} {level:?}"));
            for few in [1, 16, 17] {
                let some = map(few, levels[0]);
                assert!(some.iter().all(|photon| many.contains(photon)), "{name} {rule}: {few} of 50");
            }
        }
    }
}
