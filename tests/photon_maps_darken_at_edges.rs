//! Near the edge of a plate a photon map is too dark by the part of the disk that hangs over, and next to a wall the
//! normals keep the wall's photons out: as theory has it, for each kernel.

use furnace::estimator::{DirectLight, Estimator, Gather, Kernel, Last, PhotonMap, Roulette, Rule};
use furnace::experiment::Cell;
use furnace::experiment::run::sample;
use furnace::sampling::Address;
use furnace::scene::geometry::Rectangle;
use furnace::scene::{Directions, Material, Rgb, Scene, Sensor, Shape, Sky, Surface};
use furnace::truth::density::{edge, nearest};
use glam::DVec3;

const ALBEDO: f64 = 0.6;
const LE: f64 = 2.0;
const RADIUS: f64 = 0.3;

/// A plate under a uniform sky, looked at so far from its edge.
fn plate(distance: f64) -> Scene {
    let floor = Shape::Rectangle(Rectangle {
        center: DVec3::new(0.2, 0.1, -0.3),
        half_u: DVec3::new(1.0, 0.0, 0.0),
        half_v: DVec3::new(0.0, 1.0, 0.0),
    });
    let surfaces = vec![Surface::new(floor, Material::lambert(Rgb::splat(ALBEDO), Rgb::ZERO))];
    let target = DVec3::new(0.2 + 1.0 - distance, 0.1, -0.3);
    let origin = target + DVec3::new(-0.05, 0.02, 0.4);
    let sensor = Sensor::Probe { origin, direction: (target - origin).normalize() };
    Scene::lit_by(surfaces, &[], Some(Sky::Uniform { radiance: Rgb::splat(LE) }), sensor)
}

fn map(photons: u64, gather: Gather, kernel: Kernel) -> Estimator {
    Estimator::PhotonMap(PhotonMap {
        photons,
        gather,
        kernel,
        direct: DirectLight::Photons,
        final_gather: 0,
        directions: Directions::Cosine,
        roulette: Roulette::unclamped(Rule::Albedo),
    })
}

fn cell(scene: &Scene, estimator: &Estimator, samples: u64) -> Cell {
    sample(scene, estimator, &Address::of(&["edges", &format!("{estimator:?}")]), samples, samples / 100)
}

/// The mean has this factor over the right one, within five standard errors that could tell five percent.
fn holds(cell: &Cell, factor: f64, what: &str) {
    assert_eq!(cell.invalid(), None);
    let right = ALBEDO * LE;
    let (mean, error) = (cell.blocks[0].mean / right, cell.blocks[0].std_error().unwrap() / right);
    assert!((mean - factor).abs() < 5.0 * error, "{what}: {mean} ± {error}, not {factor}");
    assert!(5.0 * error < 0.05, "{what}: ± {error} could not tell");
}

#[test]
fn by_the_part_of_the_disk_that_hangs_over() {
    for kernel in [Kernel::Box, Kernel::Cone { c: 1.2 }, Kernel::Epanechnikov] {
        for distance in [0.0, 0.1, 0.2, 0.35] {
            let estimator = map(200, Gather::Within { radius: RADIUS }, kernel);
            let factor = edge::straight(kernel, distance, RADIUS);
            holds(&cell(&plate(distance), &estimator, 12_000), factor, &format!("{kernel:?} at {distance}"));
        }
    }
}

/// At the edge itself half of the disk is empty whatever its radius, and k photons are too many by k / (k - 1).
#[test]
fn by_half_for_the_nearest_at_the_edge() {
    for last in [Last::Counted, Last::LeftOut] {
        let k = 8;
        let estimator = map(1000, Gather::Nearest { k, last }, Kernel::Box);
        let of_k = if last == Last::Counted { nearest::factor_of_all(u64::from(k)) } else { 1.0 };
        let factor = edge::wedge(std::f64::consts::PI) * of_k;
        holds(&cell(&plate(0.0), &estimator, 5000), factor, &format!("{last:?}"));
    }
}

/// Photons of a wall that stands on the floor do not count for the floor: beside a wall that is as bright, the floor is as
/// dark as at an edge.
#[test]
fn photons_of_a_wall_are_no_photons_of_the_floor() {
    use furnace::estimator::particles::Particle;
    use furnace::estimator::photons::Photons;
    use furnace::sampling::warp::Frame;
    use furnace::scene::Hit;
    let material = Material::lambert(Rgb::ONE, Rgb::ZERO);
    let hit = |p: DVec3, n: DVec3| Hit {
        p,
        frame: Frame::around(n),
        wo: n,
        material: &material,
        le: Rgb::ZERO,
        surface: 0,
    };
    let particle = Particle { power: Rgb::ONE, bounce: 0, diffuse: false };
    let mut map = Photons::new(3, Gather::Within { radius: 1.0 }, 0);
    let below = (DVec3::new(0.1, 0.0, 0.0), DVec3::NEG_Z);
    for (p, n) in [(DVec3::ZERO, DVec3::Z), (DVec3::new(0.0, 0.0, 0.1), DVec3::X), below] {
        map.add(&hit(p, n), particle);
    }
    let map = map.grown();
    let floor = hit(DVec3::new(0.05, 0.0, 0.0), DVec3::Z);
    let near = map.near(floor.p).unwrap();
    assert_eq!(near.photons().count(), 3);
    // neither the wall's nor the one on the other side of a thin floor
    assert_eq!(near.photons().filter(|(_, photon)| photon.lies_on(&floor)).count(), 1);
}
