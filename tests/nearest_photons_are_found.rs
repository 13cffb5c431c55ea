//! The photons around a point are those that a search through all of them finds, whatever their places: planes, lines,
//! thousands at one point.

use furnace::estimator::kernel::{Gather, Last};
use furnace::estimator::particles::Particle;
use furnace::estimator::photons::Photons;
use furnace::sampling::warp::Frame;
use furnace::sampling::{Address, Stream};
use furnace::scene::{Hit, Material, Rgb};
use glam::DVec3;
use std::f64::consts::PI;

const WHITE: Material = Material { bsdf: furnace::scene::Bsdf::Lambert { albedo: Rgb::ONE }, le: Rgb::ZERO };

/// Photons whose power is their number, so that they can be told apart.
fn map(places: &[DVec3], gather: Gather) -> Photons {
    let mut map = Photons::new(places.len() as u64, gather, 0);
    for (number, &p) in places.iter().enumerate() {
        let (frame, wo, le) = (Frame::around(DVec3::Z), DVec3::Z, Rgb::ZERO);
        let hit = Hit { p, frame, wo, material: &WHITE, le, surface: 0 };
        map.add(&hit, Particle { power: Rgb::splat(number as f64), bounce: 0, diffuse: false });
    }
    map.grown()
}

fn places(name: &str, n: usize, stream: &mut Stream) -> Vec<DVec3> {
    let mut point = || DVec3::new(stream.u1(), stream.u1(), stream.u1());
    (0..n)
        .map(|i| match name {
            "cube" => point(),
            "plane" => point() * DVec3::new(1.0, 0.0, 1.0),
            "line" => point() * DVec3::X,
            "few places" => (point() * 3.0).floor(),
            "one place" => DVec3::splat(0.3),
            "half alike" if i % 2 == 0 => DVec3::splat(0.5),
            _ => point(),
        })
        .collect()
}

const ALL: [&str; 6] = ["cube", "plane", "line", "few places", "one place", "half alike"];

/// Squared distances of all photons, ascending.
fn by_search(places: &[DVec3], p: DVec3) -> Vec<f64> {
    let mut all: Vec<f64> = places.iter().map(|q| (*q - p).length_squared()).collect();
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn the_k_nearest() {
    let mut stream = Address::of(&["nearest"]).stream(0, 0);
    for (name, n) in ALL.iter().flat_map(|name| [1000, 20_000].map(|n| (*name, n))) {
        let places = places(name, n, &mut stream);
        for (k, last) in
            [2, 7, 12, 13, 100, 500, 1000].into_iter().flat_map(|k| [(k, Last::Counted), (k, Last::LeftOut)])
        {
            let map = map(&places, Gather::Nearest { k, last });
            for i in 0..8 {
                let p = if i % 2 == 0 { places[i * 17] } else { DVec3::new(stream.u1(), 0.0, stream.u1()) };
                let right = by_search(&places, p);
                let (near, k) = (map.near(p).expect("enough photons"), k as usize);
                let found: Vec<(f64, usize)> =
                    near.photons().map(|(t, photon)| (t, photon.power().x as usize)).collect();
                let what = format!("{name} {n} {k} {last:?}");
                assert_eq!(near.area(), PI * right[k - 1], "{what}");
                let counted = if last == Last::Counted { k } else { k - 1 };
                assert_eq!(found.len(), counted, "{what}");
                // each once, and none farther than the k-th
                let mut numbers: Vec<usize> = found.iter().map(|f| f.1).collect();
                numbers.sort_unstable();
                numbers.dedup();
                assert_eq!(numbers.len(), counted, "{what}");
                for (t, number) in found {
                    let squared = (places[number] - p).length_squared();
                    assert!(squared <= right[k - 1], "{what}");
                    assert!((t * right[k - 1] - squared).abs() <= 1e-12 * right[k - 1], "{what}");
                }
            }
        }
    }
}

#[test]
fn all_within_a_radius() {
    let mut stream = Address::of(&["within"]).stream(0, 0);
    for name in ALL {
        let places = places(name, 5000, &mut stream);
        for radius in [0.01, 0.1, 0.4, 3.0] {
            let map = map(&places, Gather::Within { radius });
            for _ in 0..20 {
                let p = DVec3::new(stream.u1(), stream.u1(), stream.u1());
                let right = by_search(&places, p).into_iter().filter(|d| *d <= radius * radius).count();
                let near = map.near(p).expect("a radius finds what there is");
                assert_eq!(near.photons().count(), right, "{name} {radius}");
                assert_eq!(near.area(), PI * (radius * radius));
            }
        }
    }
}

#[test]
fn too_few_photons_are_no_density() {
    let nearest = Gather::Nearest { k: 4, last: Last::Counted };
    let three = [DVec3::ZERO, DVec3::X, DVec3::Y];
    assert!(map(&three, nearest).near(DVec3::ZERO).is_none());
    assert!(map(&[], nearest).near(DVec3::ZERO).is_none());
    assert_eq!(map(&[], Gather::Within { radius: 1.0 }).near(DVec3::ZERO).unwrap().photons().count(), 0);
}

/// r²_{i+1} = r²_i (i + alpha) / (i + 1), anew for each picture.
#[test]
fn radii_shrink_pass_by_pass() {
    let (alpha, passes) = (0.6, 5);
    let gather = Gather::Shrinking { radius: 2.0, alpha, passes };
    let radius = |pass| gather.radius(pass).unwrap();
    assert_eq!(radius(0), 2.0);
    assert!((radius(1) / radius(0)).powi(2) - 1.6 / 2.0 < 1e-15);
    for i in 0..4u64 {
        let ratio = (radius(i + 1) / radius(i)).powi(2);
        assert!((ratio - (i as f64 + 1.0 + alpha) / (i as f64 + 2.0)).abs() < 1e-14, "{i}");
    }
    assert_eq!((radius(5), radius(9)), (radius(0), radius(4)));
}
