//! Promise: however direct light is found - on emitters, by continued directions, or by both, weighted - it is the same
//! light, bounce by bounce: no part twice, none left out, not even what only a mirror or glass shows.
//!
//! Means of 128 blocks are compared in pairs and by bounce where both are known to 4 % (standard error), and none that
//! matters may be less well known. About 6000 comparisons, each beyond LIMIT standard errors with a probability of 7e-13
//! (Student's t of 127 degrees of freedom): false alarms of the file below 1e-8. Everything else here holds sample by
//! sample, without chance.

use furnace::estimator::{
    BINS, Ctx, Estimate, Estimator, Explicit, Heuristic, Implicit, Roulette, Rule, Tally, Technique,
};
use furnace::experiment::{Cell, sample};
use furnace::sampling::{Address, PdfW, warp};
use furnace::scene::camera::Camera;
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch};
use furnace::scene::{
    Bsdf, Directions, LightSampling, Material, Pick, PointLight, Points, Ray, Rgb, Scene, Sensor, Shape, Sky,
    Start, Surface,
};
use glam::DVec3;
use std::f64::consts::PI;

const LIMIT: f64 = 8.0;
const BLOCKS: u64 = 128;
const TECHNIQUES: [Technique; 4] = [
    Technique::Light,
    Technique::Direction,
    Technique::Both(Heuristic::Balance),
    Technique::Both(Heuristic::Power),
];

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn explicit(technique: Technique, lights: LightSampling, roulette: Roulette) -> Estimator {
    Estimator::Explicit(Explicit { technique, lights, directions: Directions::Cosine, roulette })
}

// ---------------------------------------------------------------------------------------------------------- weights

/// The two weights of one direction.
fn weights(technique: Technique, light: f64, direction: f64) -> (f64, f64) {
    let of_light = technique.of_light(Some(PdfW(light)), || Some(PdfW(direction)));
    let of_hit = technique.of_hit(Some(PdfW(direction)), || PdfW(light));
    (of_light, of_hit)
}

#[test]
fn weights_sum_to_one() {
    let densities = [1e-30, 1e-3, 0.08, 1.0, 3.0, 1e5, 1e200];
    for (l, d) in densities.into_iter().flat_map(|l| densities.map(|d| (l, d))) {
        for technique in TECHNIQUES {
            let (of_light, of_hit) = weights(technique, l, d);
            assert!((of_light + of_hit - 1.0).abs() < 1e-15, "{technique:?} {l} {d}: {of_light} {of_hit}");
            assert!(of_light >= 0.0 && of_hit >= 0.0);
        }
    }
    let [light, direction, balance, power] = TECHNIQUES.map(|technique| weights(technique, 3.0, 4.0));
    assert_eq!((light, direction), ((1.0, 0.0), (0.0, 1.0)));
    assert!((balance.0 - 3.0 / 7.0).abs() < 1e-15 && (power.0 - 9.0 / 25.0).abs() < 1e-15);
    for technique in TECHNIQUES {
        // only one technique can find it
        assert_eq!(technique.of_hit(None, || unreachable!()), 1.0);
        assert_eq!(technique.of_light(None, || unreachable!()), 1.0);
        if technique != Technique::Light {
            assert_eq!(technique.of_hit(Some(PdfW(0.3)), || PdfW(0.0)), 1.0, "{technique:?}");
        }
    }
}

/// Along each direction that is sampled on a light, what the two techniques weigh sums to 1, with the densities that the
/// scene itself states.
#[test]
fn weights_sum_to_one_along_sampled_directions() {
    let scene = open_air();
    let ray = Ray { o: at(0.1, 2.0, 0.2), d: -DVec3::Y, from: NOWHERE };
    let x = scene.intersect(&ray, 0.0).unwrap();
    let start = Start { ray, response: 1.0, time: 0.0, pixel: 0 };
    for (points, pick) in [Points::Area, Points::SolidAngle]
        .into_iter()
        .flat_map(|points| [Pick::Power, Pick::Uniform].map(|pick| (points, pick)))
    {
        let (how, mut tally, mut found) = (LightSampling { points, pick }, Tally::default(), 0);
        let stream = Address::of(&["techniques_agree", &format!("{how:?}")]).stream(0, 0);
        let mut cx = Ctx::new(&scene, stream, &mut tally, &start);
        for directions in [Directions::Cosine, Directions::Uniform] {
            for _ in 0..10_000 {
                let Some(light) = cx.direct(&x, how) else { continue };
                let along = x.spawn(light.wi);
                let hit = cx.hit(&along).expect("the light");
                let direction = || x.material.bsdf.pdf(directions, x.frame.n, x.wo, light.wi);
                for technique in TECHNIQUES {
                    let of_light = technique.of_light(light.pdf, direction);
                    let of_hit = technique.of_hit(direction(), || cx.light_pdf(&along, &hit, how));
                    assert!((of_light + of_hit - 1.0).abs() < 1e-10, "{technique:?} {how:?} {light:?}");
                }
                // and both find the same radiance
                let pdf = light.pdf.unwrap().0;
                let f_cos = x.material.bsdf.f(x.frame.n, x.frame.n, x.frame.n) * x.frame.n.dot(light.wi);
                assert!((f_cos * hit.le / pdf).abs_diff_eq(light.radiance, 1e-9 / pdf), "{light:?} {hit:?}");
                found += 1;
            }
        }
        assert!(found > 5_000, "{found} are too few to tell");
    }
}

// ------------------------------------------------------------------------------------------------------------ scenes

fn rectangle(center: DVec3, half_u: DVec3, half_v: DVec3, material: Material) -> Surface {
    Surface::new(Shape::Rectangle(Rectangle { center, half_u, half_v }), material)
}

fn ball(center: DVec3, radius: f64, material: Material) -> Surface {
    let (axis, low, high) = (DVec3::Z, -1.0, 1.0);
    Surface::new(Shape::Sphere(SpherePatch { center, radius, axis, low, high, inward: false }), material)
}

fn grey(albedo: Rgb) -> Material {
    Material::lambert(albedo, Rgb::ZERO)
}

fn looking(from: DVec3, to: DVec3) -> Sensor {
    Sensor::Camera(Camera::pinhole(from, to - from, DVec3::Y, 60.0, (8, 8)))
}

/// A floor with a ball on it, under a large dim light, a small bright one and a sky that is brightest aslant.
fn open_air() -> Scene {
    let floor = grey(Rgb::new(0.8, 0.7, 0.5));
    let surfaces = vec![
        rectangle(at(0.0, 0.0, 0.0), 2.0 * DVec3::Z, 2.0 * DVec3::X, floor),
        rectangle(
            at(-0.8, 1.6, 0.0),
            0.7 * DVec3::X,
            0.6 * DVec3::Z,
            Material::lambert(Rgb::new(0.3, 0.5, 0.1), at(1.0, 0.6, 0.2)),
        ),
        rectangle(
            at(0.8, 1.0, 0.3),
            0.28 * at(0.8, 0.0, 0.6),
            0.28 * at(-0.6, 0.0, 0.8),
            Material::lambert(Rgb::ZERO, at(2.0, 4.5, 6.0)),
        ),
        ball(at(0.2, 0.3, -0.3), 0.3, grey(Rgb::new(0.4, 0.8, 0.7))),
    ];
    let facing: Vec<Surface> = surfaces
        .into_iter()
        .map(|s| match s.shape {
            // lights look down
            Shape::Rectangle(r) if s.material.le != Rgb::ZERO && r.normal().y > 0.0 => {
                rectangle(r.center, r.half_v, r.half_u, s.material)
            }
            _ => s,
        })
        .collect();
    let sky = Sky::Cosine { radiance: at(0.3, 0.5, 1.0), exponent: 4.0, up: at(0.48, 0.8, 0.36) };
    Scene::lit_by(facing, &[], Some(sky), looking(at(0.2, 0.7, 2.0), at(0.0, 0.95, 0.0)))
}

/// A room with a mirror for a wall, a ball of glass, one of metal, a pane, a large light and a sky behind the open side:
/// light comes to the floor through all of them.
fn hall_of_mirrors() -> Scene {
    let (mirror, glass) = (Bsdf::Mirror { reflectance: at(0.9, 0.8, 0.7) }, Bsdf::Dielectric { ior: 1.5 });
    let metal = Bsdf::Conductor { eta: at(0.14, 0.4, 1.4), k: at(4.0, 2.4, 1.6) };
    let of = |bsdf| Material { bsdf, le: Rgb::ZERO };
    let light = Material::lambert(Rgb::splat(0.2), at(3.0, 2.0, 1.0));
    let surfaces = vec![
        rectangle(DVec3::ZERO, 1.5 * DVec3::Z, 1.5 * DVec3::X, grey(at(0.8, 0.7, 0.5))),
        rectangle(at(0.0, 1.0, -1.5), 1.5 * DVec3::X, DVec3::Y, of(mirror)),
        rectangle(at(-1.5, 1.0, 0.0), DVec3::Y, 1.5 * DVec3::Z, grey(at(0.3, 0.6, 0.8))),
        rectangle(at(0.1, 2.0, 0.1), 1.1 * DVec3::X, 1.1 * DVec3::Z, light),
        ball(at(-0.5, 0.6, 0.2), 0.5, of(glass)),
        ball(at(0.6, 0.4, -0.4), 0.4, of(metal)),
        // a pane is one interface: what lies below it has the other index
        rectangle(at(0.7, 0.9, 0.6), 0.5 * DVec3::Z, 0.5 * DVec3::X, of(Bsdf::Dielectric { ior: 1.2 })),
    ];
    let sky = Sky::Uniform { radiance: at(0.2, 0.3, 0.6) };
    Scene::lit_by(surfaces, &[], Some(sky), looking(at(0.6, 1.1, 2.6), at(0.0, 0.9, 0.0)))
}

// --------------------------------------------------------------------------------------------------------- in the mean

fn cell(scene: &Scene, name: &str, estimator: &Estimator, passes: u64) -> Cell {
    let address = Address::of(&["techniques_agree", name, &format!("{estimator:?}")]);
    let cell = sample(scene, estimator, &address, BLOCKS * passes, passes);
    assert_eq!(cell.invalid(), None);
    cell
}

/// Every pair of cells, bounce by bounce up to the smaller of the two clamps.
fn all_pairs_agree(cells: &[(String, u32, Cell)]) {
    for (i, (one, last, a)) in cells.iter().enumerate() {
        for bounce in 0..BINS {
            for (c, bin) in a.bounces[bounce].iter().enumerate() {
                let (mean, error) = (bin.mean, bin.std_error().unwrap());
                if bounce > *last as usize {
                    assert_eq!((mean, error), (0.0, 0.0), "{one}: bounce {bounce} is beyond the clamp");
                    continue;
                }
                assert!(mean > 0.0 && error <= 0.04 * mean, "{one}: bounce {bounce}: {mean} ± {error}");
                for (other, _, b) in cells[..i].iter().filter(|(_, last, _)| bounce <= *last as usize) {
                    let (value, other_error) = (b.bounces[bounce][c].mean, b.bounces[bounce][c].std_error());
                    let t = (mean - value) / error.hypot(other_error.unwrap());
                    assert!(
                        t.abs() <= LIMIT || mean == value,
                        "bounce {bounce}, channel {c}: {mean} ± {error} of {one}, {value} of {other}: t = {t}"
                    );
                }
            }
        }
    }
}

#[test]
fn under_unequal_lights_and_a_sky() {
    let (scene, mut cells) = (open_air(), Vec::new());
    let clamped = Roulette::depth_clamp(2);
    let split = Roulette { rule: Rule::Constant { q: 1.6 }, from: 1, clamp: Some(2) };
    for (technique, points) in
        TECHNIQUES.into_iter().flat_map(|t| [Points::Area, Points::SolidAngle].map(|points| (t, points)))
    {
        for (pick, directions, roulette) in
            [(Pick::Power, Directions::Cosine, clamped), (Pick::Uniform, Directions::Uniform, split)]
        {
            let lights = LightSampling { points, pick };
            let estimator = Estimator::Explicit(Explicit { technique, lights, directions, roulette });
            let passes = if technique == Technique::Direction { 45 } else { 8 };
            cells.push((format!("{estimator:?}"), 2, cell(&scene, "open air", &estimator, passes)));
        }
    }
    all_pairs_agree(&cells);
}

#[test]
fn through_mirrors_and_glass_whatever_the_clamp() {
    let (scene, mut cells) = (hall_of_mirrors(), Vec::new());
    for clamp in 1..=4 {
        let roulette = Roulette::depth_clamp(clamp);
        let mut all: Vec<Estimator> =
            TECHNIQUES.map(|technique| explicit(technique, LightSampling::AREA, roulette)).to_vec();
        all.push(explicit(TECHNIQUES[0], LightSampling::SOLID_ANGLE, roulette));
        all.push(Estimator::Implicit(Implicit { directions: Directions::Cosine, roulette }));
        for estimator in all {
            cells.push((format!("{estimator:?}"), clamp, cell(&scene, "mirrors", &estimator, 8)));
        }
    }
    all_pairs_agree(&cells);
}

// ---------------------------------------------------------------------------------------------------- sample by sample

fn each_sample(scene: &Scene, estimator: &Estimator, check: impl Fn(&Tally)) {
    let Sensor::Probe { origin, direction } = scene.sensor else { unreachable!() };
    let ray = Ray { o: origin, d: direction, from: NOWHERE };
    let start = Start { ray, response: 1.0, time: 0.0, pixel: 0 };
    for i in 0..1000 {
        let mut tally = Tally::default();
        let stream = Address::of(&["techniques_agree", "each"]).stream(i, 0);
        estimator.estimate(
            &furnace::estimator::Pass::Nothing,
            ray,
            &mut Ctx::new(scene, stream, &mut tally, &start),
        );
        check(&tally);
    }
}

/// A probe that looks into a mirror sees the light there, and the sky, whatever the technique, also with a clamp of 1.
#[test]
fn what_a_mirror_shows_counts_once() {
    let (reflectance, le, radiance) = (at(0.9, 0.5, 0.2), at(3.0, 2.0, 1.0), at(0.1, 0.7, 0.4));
    let mirror = Material { bsdf: Bsdf::Mirror { reflectance }, le: Rgb::ZERO };
    let light = Material::lambert(Rgb::splat(0.6), le);
    for with_light in [true, false] {
        let mut surfaces = vec![rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, mirror)];
        if with_light {
            surfaces.push(rectangle(at(1.0, 0.0, 1.0), DVec3::Y, 0.3 * at(1.0, 0.0, -1.0), light));
        }
        let origin = at(-1.0, 0.1, 1.0);
        let direction = (at(0.05, 0.1, 0.0) - origin).normalize();
        let sky = Some(Sky::Uniform { radiance });
        let scene = Scene::lit_by(surfaces, &[], sky, Sensor::Probe { origin, direction });
        let shown = reflectance * if with_light { le } else { radiance };
        for technique in TECHNIQUES {
            for clamp in [1, 2, 5] {
                let estimator = explicit(technique, LightSampling::AREA, Roulette::depth_clamp(clamp));
                each_sample(&scene, &estimator, |tally| {
                    assert_eq!(tally.bounces[0], Rgb::ZERO);
                    assert!(
                        tally.bounces[1].abs_diff_eq(shown, 1e-15),
                        "{technique:?}: {}",
                        tally.bounces[1]
                    );
                    assert!(clamp > 1 || tally.value.abs_diff_eq(shown, 1e-15));
                });
            }
            let none = explicit(technique, LightSampling::AREA, Roulette::depth_clamp(0));
            each_sample(&scene, &none, |tally| assert_eq!(tally.value, Rgb::ZERO));
        }
    }
}

/// A point light beside a disk light: no direction finds the point, so that its weight is 1 with every heuristic; the
/// sum of the two irradiances is known.
#[test]
fn a_point_light_keeps_its_whole_weight() {
    let (albedo, le, intensity) = (at(0.8, 0.5, 0.3), at(2.0, 1.0, 0.5), at(0.3, 0.9, 1.5));
    let (h, radius, position) = (1.4, 0.8, at(0.6, -0.3, 0.7));
    let disk = Shape::Disk(Disk { center: DVec3::Z * h, normal: -DVec3::Z, radius });
    let surfaces = vec![
        rectangle(DVec3::ZERO, 0.01 * DVec3::X, 0.01 * DVec3::Y, grey(albedo)),
        Surface::new(disk, Material::lambert(Rgb::ZERO, le)),
    ];
    let sensor = Sensor::Probe { origin: DVec3::Z * 0.5, direction: -DVec3::Z };
    let scene = Scene::lit_by(surfaces, &[PointLight { position, intensity }], None, sensor);
    let of_disk = le * (radius * radius / (radius * radius + h * h));
    let of_point = intensity * (position.z / position.length().powi(3) / PI);
    let exact = albedo * (of_disk + of_point);
    for technique in TECHNIQUES.into_iter().filter(|t| t.samples_lights()) {
        let estimator = explicit(technique, LightSampling::AREA, Roulette::depth_clamp(1));
        let cell = cell(&scene, "point", &estimator, 2000);
        for c in 0..3 {
            let (mean, error) = (cell.blocks[c].mean, cell.blocks[c].std_error().unwrap());
            assert!(error < 0.005 * exact[c], "{technique:?}: {error} is too wide");
            assert!((mean - exact[c]).abs() < LIMIT * error, "{technique:?}: {mean} ± {error}, {}", exact[c]);
        }
    }
}

/// Emission of a clear interface: its front is found by every technique, its back by none.
#[test]
fn shining_glass_shines_to_its_front() {
    let shining = Material { bsdf: Bsdf::Dielectric { ior: 1.5 }, le: at(2.0, 1.0, 0.5) };
    let pane =
        |y: f64, front: f64| rectangle(at(0.3, y, 0.1), 0.8 * DVec3::Z * front, 0.8 * DVec3::X, shining);
    let floor = rectangle(DVec3::ZERO, 2.0 * DVec3::Z, 2.0 * DVec3::X, grey(Rgb::splat(0.5)));
    let sensor = Sensor::Probe { origin: at(0.0, 0.2, 0.0), direction: -DVec3::Y };
    let towards = Scene::new(vec![floor, pane(0.9, -1.0)], sensor);
    let mut cells = Vec::new();
    let away = Scene::new(vec![floor, pane(0.9, 1.0)], sensor);
    for technique in TECHNIQUES {
        let estimator = explicit(technique, LightSampling::AREA, Roulette::depth_clamp(1));
        cells.push((technique, cell(&towards, "glass", &estimator, 500)));
        each_sample(&away, &estimator, |tally| assert_eq!(tally.value, Rgb::ZERO, "{technique:?}"));
    }
    for (technique, cell) in &cells {
        let (a, b) = (&cells[0].1.blocks[0], &cell.blocks[0]);
        let width = LIMIT * a.std_error().unwrap().hypot(b.std_error().unwrap());
        assert!((a.mean - b.mean).abs() <= width && width < 0.1 * a.mean, "{technique:?}: {a:?} {b:?}");
    }
}

/// Directions towards nothing: neither technique finds light where there is none.
#[test]
fn black_is_black() {
    let floor = rectangle(DVec3::ZERO, DVec3::Z, DVec3::X, grey(Rgb::ONE));
    // the light's back
    let light = Material::lambert(Rgb::ONE, Rgb::ONE);
    let lamp = rectangle(DVec3::Y, DVec3::Z, DVec3::X, light);
    let direction = warp::sphere_band(-1.0, -0.9, (0.5, 0.3)).with_y(-0.9).normalize();
    let scene = Scene::new(vec![floor, lamp], Sensor::Probe { origin: DVec3::Y * 0.5, direction });
    for technique in TECHNIQUES {
        let estimator = explicit(technique, LightSampling::SOLID_ANGLE, Roulette::depth_clamp(3));
        each_sample(&scene, &estimator, |tally| assert_eq!(tally.value, Rgb::ZERO, "{technique:?}"));
    }
}
