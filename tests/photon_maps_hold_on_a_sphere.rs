//! Inside a uniform sphere photons are uniform, and the part within a chord is a disk's area: there a photon map has its
//! closed form for every kernel and radius, by the light's every bounce.

use furnace::estimator::{BINS, DirectLight, Estimator, Gather, Kernel, Last, PhotonMap, Roulette, Rule};
use furnace::experiment::Cell;
use furnace::experiment::run::sample;
use furnace::sampling::Address;
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::{Directions, Rgb};
use furnace::truth::{ClosedForm, Counted};

const ALBEDO: Rgb = Rgb::new(0.7, 0.5, 0.2);
const RADIUS: f64 = 0.4;

fn furnace() -> SceneKind {
    SceneKind::Furnace { albedo: ALBEDO, emission: Rgb::new(1.0, 2.0, 0.5), view: View::Probe }
}

fn by_radius(kernel: Kernel) -> PhotonMap {
    PhotonMap {
        photons: 40,
        gather: Gather::Within { radius: RADIUS },
        kernel,
        direct: DirectLight::Photons,
        final_gather: 0,
        directions: Directions::Cosine,
        roulette: Roulette::unclamped(Rule::Constant { q: 0.6 }),
    }
}

fn cell(kind: &SceneKind, map: PhotonMap, samples: u64) -> Cell {
    let estimator = Estimator::PhotonMap(map);
    sample(&kind.build(), &estimator, &Address::of(&["sphere", &format!("{map:?}")]), samples, samples / 100)
}

/// Each bounce has `factor` times its closed form, within five standard errors, which are small enough to tell `share`
/// of the whole.
fn holds(kind: &SceneKind, map: PhotonMap, samples: u64, factor: f64, share: f64) {
    let cell = cell(kind, map, samples);
    assert_eq!(cell.invalid(), None);
    let closed = ClosedForm::of(kind, &Estimator::PhotonMap(map)).expect("a sphere has one");
    for channel in 0..3 {
        let whole = closed.truth(channel, Counted::All);
        for bin in 0..BINS {
            let counted = if bin + 1 == BINS { Counted::From(bin as u32) } else { Counted::Only(bin as u32) };
            let sampled = bin == 1 && map.direct == DirectLight::Sampled;
            let factor = if bin == 0 || sampled { 1.0 } else { factor };
            let right = factor * closed.truth(channel, counted);
            let found = cell.bounces[bin][channel];
            let slack = 5.0 * found.std_error().unwrap() + 1e-9 * right;
            assert!((found.mean - right).abs() <= slack, "{map:?} {bin}: {} {right} ± {slack}", found.mean);
            assert!(slack < share * whole, "{map:?} {bin}: {slack} of {whole} could not tell");
        }
    }
}

#[test]
fn any_kernel_within_a_radius() {
    for kernel in [Kernel::Box, Kernel::Cone { c: 1.0 }, Kernel::Cone { c: 1.3 }, Kernel::Epanechnikov] {
        holds(&furnace(), by_radius(kernel), 20_000, 1.0, 0.03);
    }
}

#[test]
fn the_nearest_without_the_last() {
    let map = |k| PhotonMap {
        photons: 200,
        gather: Gather::Nearest { k, last: Last::LeftOut },
        ..by_radius(Kernel::Box)
    };
    holds(&furnace(), map(5), 20_000, 1.0, 0.03);
    holds(&furnace(), map(40), 10_000, 1.0, 0.02);
}

/// Too bright by k / (k - 1), which is 25 % for k = 5.
#[test]
fn the_nearest_with_the_last() {
    let gather = Gather::Nearest { k: 5, last: Last::Counted };
    holds(&furnace(), PhotonMap { photons: 200, gather, ..by_radius(Kernel::Box) }, 40_000, 1.25, 0.025);
}

#[test]
fn direct_light_sampled_and_final_gathering() {
    let direct = PhotonMap { direct: DirectLight::Sampled, ..by_radius(Kernel::Box) };
    holds(&furnace(), direct, 20_000, 1.0, 0.03);
    // the nearest are looked for among all photons, and those of direct light then left out
    let gather = Gather::Nearest { k: 9, last: Last::LeftOut };
    holds(&furnace(), PhotonMap { photons: 200, gather, ..direct }, 20_000, 1.0, 0.03);
    for map in [direct, by_radius(Kernel::Box)] {
        holds(&furnace(), PhotonMap { final_gather: 3, ..map }, 20_000, 1.0, 0.03);
    }
}

/// Irradiance is uniform over a sphere whatever its patches are: the disk may lie across their border.
#[test]
fn patches_do_not_matter_within_a_radius() {
    let patch = |fraction, albedo, emission| Patch {
        fraction,
        albedo: Rgb::splat(albedo),
        emission: Rgb::splat(emission),
    };
    let kind = SceneKind::IntegratingSphere {
        patches: vec![patch(0.2, 0.4, 5.0), patch(0.3, 0.8, 0.0), patch(0.5, 0.6, 0.0)],
        looks_at: 1,
        view: View::Probe,
    };
    holds(&kind, by_radius(Kernel::Epanechnikov), 30_000, 1.0, 0.04);
}

/// A clamp leaves out light of later bounces, from photons too.
#[test]
fn a_clamp_holds_for_photons() {
    let roulette = Roulette { rule: Rule::None, from: 0, clamp: Some(2) };
    for final_gather in [0, 2] {
        let map = PhotonMap { roulette, final_gather, ..by_radius(Kernel::Box) };
        for (bin, of_bin) in cell(&furnace(), map, 2000).bounces.iter().enumerate() {
            assert_eq!(of_bin[0].mean > 0.0, bin <= 2, "{final_gather} {bin}");
        }
    }
}

#[test]
fn a_map_with_fewer_photons_than_are_gathered_is_no_result() {
    let gather = Gather::Nearest { k: 50, last: Last::LeftOut };
    let cell = cell(&furnace(), PhotonMap { photons: 20, gather, ..by_radius(Kernel::Box) }, 200);
    assert!(cell.invalid().is_some_and(|why| why.contains("fewer photons")));
}
