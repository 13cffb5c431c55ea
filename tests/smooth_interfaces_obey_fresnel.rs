//! Promise: mirrors, metals and clear interfaces send light where Snell's law says and as much of it as Fresnel's
//! equations say, from both sides, there and back; nothing is lost or made, and nothing but themselves can hit their
//! directions.
//!
//! Held to formulas that share nothing with the code: metals to complex arithmetic, clear interfaces to Fresnel's own
//! sines and tangents. Nothing here is statistical: frequencies are counted over equally spaced numbers.

use furnace::estimator::{Ctx, Estimate, Implicit, Roulette, Rule, Tally};
use furnace::sampling::{Address, Stream, warp};
use furnace::scene::geometry::{NOWHERE, Rectangle, SpherePatch};
use furnace::scene::{
    Bsdf, Carried, Directions, Hit, Material, Ray, Rgb, Scene, Sensor, Shape, Sky, Surface, fresnel,
};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use warp::Frame;

const MIRROR: Bsdf = Bsdf::Mirror { reflectance: Rgb::new(0.9, 0.5, 0.0) };
/// Gold, roughly, and two extremes: nearly no loss, and all of it.
const METAL: Bsdf = Bsdf::Conductor { eta: Rgb::new(0.14, 0.05, 3.0), k: Rgb::new(3.98, 4.2, 30.0) };
const IORS: [f64; 5] = [1.5, 1.0 / 1.5, 2.4, 1.0003, 0.2];
const NORMALS: [DVec3; 2] = [DVec3::new(0.36, 0.48, 0.8), DVec3::new(0.64, -0.48, -0.6)];

/// A complex number.
type C = (f64, f64);

fn mul(a: C, b: C) -> C {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn add(a: C, b: C) -> C {
    (a.0 + b.0, a.1 + b.1)
}

fn sub(a: C, b: C) -> C {
    (a.0 - b.0, a.1 - b.1)
}

/// |a / b|²
fn ratio(a: C, b: C) -> f64 {
    (a.0 * a.0 + a.1 * a.1) / (b.0 * b.0 + b.1 * b.1)
}

/// The root in the upper half plane.
fn root(a: C) -> C {
    let (modulus, half) = (a.0.hypot(a.1).sqrt(), 0.5 * libm::atan2(a.1, a.0));
    (modulus * libm::cos(half), modulus * libm::sin(half))
}

/// Fresnel's amplitudes for the complex index `n`, squared and averaged over both polarizations.
fn complex_fresnel(cos: f64, n: C) -> f64 {
    let (cos, squared) = ((cos, 0.0), mul(n, n));
    let w = root(sub(squared, (1.0 - cos.0 * cos.0, 0.0))); // n cos θ_t
    let perpendicular = ratio(sub(cos, w), add(cos, w));
    let parallel = ratio(sub(mul(squared, cos), w), add(mul(squared, cos), w));
    0.5 * (perpendicular + parallel)
}

/// Reflectance of a clear interface by sines and tangents of the two angles, and the cosine of the second.
fn sines_and_tangents(cos: f64, eta: f64) -> (f64, f64) {
    let i = libm::acos(cos);
    if libm::sin(i) >= eta {
        return (1.0, 0.0);
    }
    let t = libm::asin(libm::sin(i) / eta);
    let perpendicular = libm::sin(i - t) / libm::sin(i + t);
    let parallel = libm::tan(i - t) / libm::tan(i + t);
    (0.5 * (perpendicular * perpendicular + parallel * parallel), libm::cos(t))
}

/// Angles of incidence: cosines off both ends.
fn cosines() -> impl Iterator<Item = f64> {
    (1..200).map(|i| libm::cos(FRAC_PI_2 * f64::from(i) / 200.0))
}

fn stream(name: &str) -> Stream {
    Address::of(&["smooth_interfaces_obey_fresnel", name]).stream(0, 0)
}

/// A unit vector at the angle of the given cosine to `n`, on its other side if that is negative.
fn inclined(n: DVec3, cos: f64, turn: f64) -> DVec3 {
    let (s, (sin, c)) = (n.cross(DVec3::X).normalize(), libm::sincos(turn));
    (n * cos + (s * c + n.cross(s) * sin) * (1.0 - cos * cos).sqrt()).normalize()
}

fn sample(bsdf: Bsdf, n: DVec3, wo: DVec3, u: f64) -> (DVec3, Rgb) {
    let s = bsdf.sample(Carried::Radiance, Directions::Cosine, &Frame::around(n), wo, (u, 0.3));
    assert!(s.pdf.is_none() && (s.wi.length() - 1.0).abs() < 1e-15, "{s:?}");
    (s.wi, s.weight)
}

/// Nearly the largest u: whatever can be refracted is.
const LAST: f64 = 1.0 - f64::EPSILON;

#[test]
fn mirrors_and_metals_reflect_into_the_mirror_direction() {
    let mut stream = stream("mirror");
    for n in NORMALS {
        for _ in 0..10_000 {
            let (cos, turn, u) = (1.0 - stream.u1(), 7.0 * stream.u1(), stream.u1());
            let wo = inclined(n, cos, turn);
            for bsdf in [MIRROR, METAL] {
                let (wi, weight) = sample(bsdf, n, wo, u);
                // the plane's reflection is minus a half turn around the normal
                let image = n * n.dot(wo) - (wo - n * n.dot(wo));
                assert!((wi - image).abs().max_element() < 1e-15, "{wo} {wi}");
                assert_eq!(weight, bsdf.albedo(n.dot(wo)));
            }
            assert_eq!(sample(MIRROR, n, wo, u).1, Rgb::new(0.9, 0.5, 0.0));
        }
    }
}

#[test]
fn metals_reflect_what_complex_arithmetic_says() {
    let Bsdf::Conductor { eta, k } = METAL else { unreachable!() };
    let n = NORMALS[0];
    for cos in cosines() {
        let weight = sample(METAL, n, inclined(n, cos, 1.0), 0.4).1;
        for c in 0..3 {
            let exact = complex_fresnel(cos, (eta[c], k[c]));
            assert!((weight[c] - exact).abs() < 1e-13 && weight[c] <= 1.0, "{cos}: {} {exact}", weight[c]);
        }
    }
    // Born & Wolf, eq. 14.2.21: normal incidence; and all light at grazing incidence
    let normal = ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k);
    assert!((METAL.albedo(1.0) - normal).abs().max_element() < 1e-15);
    assert!((METAL.albedo(1e-9) - Rgb::ONE).abs().max_element() < 1e-6);
}

/// A metal that does not absorb is a clear medium, total reflection included.
#[test]
fn metals_without_absorption_are_clear() {
    for (cos, ior) in cosines().flat_map(|cos| IORS.map(|ior| (cos, ior))) {
        let metal = fresnel::conductor(cos, Rgb::splat(ior), Rgb::ZERO);
        let clear = fresnel::dielectric(cos, ior).0;
        assert!((metal - clear).abs().max_element() < 1e-13, "{cos} {ior}: {metal} {clear}");
    }
}

#[test]
fn clear_interfaces_reflect_as_often_as_fresnel_says() {
    const N: u32 = 10_000;
    let n = NORMALS[1];
    for (ior, side) in IORS.into_iter().flat_map(|ior| [1.0, -1.0].map(|side| (ior, side))) {
        let eta = if side > 0.0 { ior } else { 1.0 / ior };
        for cos in cosines().step_by(7) {
            let (exact, cos_t) = sines_and_tangents(cos, eta);
            let (computed, other) = fresnel::dielectric(cos, eta);
            // near the critical angle a root magnifies rounding
            let tolerance = if cos_t < 0.05 { 1e-11 } else { 1e-13 };
            assert!((computed - exact).abs() < tolerance, "{cos} {eta}: {computed} {exact}");
            assert!((other - cos_t).abs() < 10.0 * tolerance, "{cos} {eta}: {other} {cos_t}");
            assert!((exact - complex_fresnel(cos, (eta, 0.0))).abs() < 1e-11, "the test's own formulas");
            let wo = inclined(n, side * cos, 2.0);
            let reflected = |i: u32| {
                let u = (f64::from(i) + 0.5) / f64::from(N);
                sample(Bsdf::Dielectric { ior }, n, wo, u).0.dot(n) * side > 0.0
            };
            let share = (0..N).filter(|&i| reflected(i)).count() as f64 / f64::from(N);
            assert!((share - exact).abs() <= 0.51 / f64::from(N) + 1e-11, "{cos} {eta}: {share} {exact}");
        }
    }
}

/// (n - 1)² / (n + 1)² at normal incidence, half of one polarization at Brewster's angle, all beyond the critical angle.
#[test]
fn known_angles_reflect_known_shares() {
    for ior in IORS {
        let normal = ((ior - 1.0) / (ior + 1.0)).powi(2);
        assert!((fresnel::dielectric(1.0, ior).0 - normal).abs() < 1e-15, "{ior}");
        let s = (ior * ior - 1.0) / (ior * ior + 1.0);
        let brewster = fresnel::dielectric(1.0 / (1.0 + ior * ior).sqrt(), ior).0;
        assert!((brewster - 0.5 * s * s).abs() < 1e-14, "{ior}: {brewster}");
        if ior < 1.0 {
            let critical = (1.0 - ior * ior).sqrt();
            assert_eq!(fresnel::dielectric(critical * 0.999, ior), (1.0, 0.0));
            assert!(fresnel::dielectric(critical * 1.001, ior).0 < 1.0);
        }
        assert!(fresnel::dielectric(1e-12, ior).0 > 1.0 - 1e-9, "grazing light is reflected");
    }
}

/// Snell's law as vectors: n_i (wo x n) = - n_t (wi x n), in the plane of incidence, on the other side. Radiance over the
/// squared index is kept, so that the way there times the way back is 1; both ways reflect alike.
#[test]
fn refraction_obeys_snell_and_goes_back() {
    let (mut stream, mut total) = (stream("snell"), 0);
    for (ior, n) in IORS.into_iter().flat_map(|ior| NORMALS.map(|n| (ior, n))) {
        let glass = Bsdf::Dielectric { ior };
        for _ in 0..10_000 {
            let (cos, turn) = (1.0 - stream.u1(), 7.0 * stream.u1());
            let side = if stream.u1() < 0.5 { 1.0 } else { -1.0 };
            let wo = inclined(n, side * cos, turn);
            let (wi, weight) = sample(glass, n, wo, LAST);
            let (from, to) = if side > 0.0 { (1.0, ior) } else { (ior, 1.0) };
            if wo.cross(n).length() * from > to * (1.0 + 1e-12) {
                total += 1;
                let image = n * (2.0 * n.dot(wo)) - wo;
                assert!((wi - image).abs().max_element() < 1e-15 && weight == Rgb::ONE, "{wo} {wi}");
                continue;
            }
            if wo.cross(n).length() * from > to * (1.0 - 1e-6) {
                continue; // within rounding of the critical angle, where either is right
            }
            assert!(wi.dot(n) * side < 0.0, "{wo} {wi}");
            let snell = from * wo.cross(n) + to * wi.cross(n);
            // rounding of the direction grows with the index it is multiplied with
            let scale = from.max(to).max(from / to);
            assert!(snell.abs().max_element() < 1e-14 * scale, "{ior} {wo} {wi}: {snell}");
            let expected = (from / to) * (from / to);
            assert!((weight / expected - 1.0).abs().max_element() < 1e-14, "{weight} {expected}");

            let (back, factor) = sample(glass, n, wi, LAST);
            assert!((weight * factor - 1.0).abs().max_element() < 1e-14, "{weight} {factor}");
            let steep = 1e-13 / (wi.dot(n) * wo.dot(n)).abs(); // grazing light magnifies rounding
            assert!((back - wo).length() < steep, "{wo} {back}");
            let eta = to / from;
            let there = fresnel::dielectric(wo.dot(n).abs(), eta).0;
            let again = fresnel::dielectric(wi.dot(n).abs(), 1.0 / eta).0;
            assert!((there - again).abs() < steep * scale, "{there} {again}");
        }
    }
    assert!(total > 5_000, "{total} total reflections are too few to tell");
}

/// R + T = 1: flux, which is radiance over the squared index of its medium, is neither made nor lost.
#[test]
fn clear_interfaces_keep_all_flux() {
    const N: u32 = 1000;
    let n = NORMALS[0];
    for (ior, side) in IORS.into_iter().flat_map(|ior| [1.0, -1.0].map(|side| (ior, side))) {
        let glass = Bsdf::Dielectric { ior };
        for cos in cosines().step_by(11) {
            let wo = inclined(n, side * cos, 0.5);
            let flux = |i: u32| {
                let (wi, weight) = sample(glass, n, wo, (f64::from(i) + 0.5) / f64::from(N));
                let squared = |w: DVec3| if w.dot(n) > 0.0 { 1.0 } else { ior * ior };
                weight * (squared(wi) / squared(wo))
            };
            let mean = (0..N).map(flux).sum::<Rgb>() / f64::from(N);
            assert!((mean - glass.albedo(cos)).abs().max_element() < 1e-12, "{ior} {cos}: {mean}");
            assert_eq!(glass.albedo(cos), Rgb::ONE);
        }
    }
}

#[test]
fn no_density_and_no_f_belong_to_single_directions() {
    let all = [MIRROR, METAL, Bsdf::Dielectric { ior: 1.5 }];
    for (bsdf, way) in all.into_iter().flat_map(|b| [Directions::Cosine, Directions::Uniform].map(|w| (b, w)))
    {
        assert!(bsdf.is_dirac());
        for cos in [-0.7, 0.0, 0.3, 1.0] {
            let wi = DVec3::new((1.0f64 - cos * cos).sqrt(), 0.0, cos);
            let (pdf, f) = (bsdf.pdf(way, DVec3::Z, wi, wi), bsdf.f(DVec3::Z, DVec3::Z, wi));
            assert_eq!((pdf, f), (None, Rgb::ZERO), "{bsdf:?}");
        }
    }
    assert!(!Bsdf::Lambert { albedo: Rgb::ONE }.is_dirac());
}

const PROBE: Sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };
const SKY: Sky = Sky::Uniform { radiance: Rgb::new(2.0, 1.0, 0.5) };

fn plate(center: DVec3, half_u: DVec3, half_v: DVec3, material: Material) -> Surface {
    Surface::new(Shape::Rectangle(Rectangle { center, half_u, half_v }), material)
}

/// From behind nothing is seen of an opaque surface, not even the sky behind it; a clear one is seen, but emits towards
/// its front only.
#[test]
fn opaque_surfaces_are_black_from_behind() {
    let white = Bsdf::Lambert { albedo: Rgb::ONE };
    for bsdf in [white, MIRROR, METAL, Bsdf::Dielectric { ior: 1.5 }] {
        let shining = Material { bsdf, le: Rgb::ONE };
        let scene =
            Scene::lit_by(vec![plate(DVec3::ZERO, DVec3::X, DVec3::Y, shining)], &[], Some(SKY), PROBE);
        let seen = |z: f64| {
            let ray = Ray { o: DVec3::new(0.1, 0.2, z), d: DVec3::Z * -z.signum(), from: NOWHERE };
            scene.intersect(&ray, 0.0).map(|hit| (hit.surface, hit.le))
        };
        assert_eq!(seen(1.0), Some((0, Rgb::ONE)), "{bsdf:?}");
        assert_eq!(seen(-1.0), bsdf.is_clear().then_some((0, Rgb::ZERO)), "{bsdf:?}");
    }
}

/// Two faces of a slab, their fronts outside: what goes through keeps its direction and its radiance, shifted aside by
/// d sin θ (1 - cos θ / (n cos θ_t)).
#[test]
fn a_slab_shifts_and_does_not_turn() {
    let (u, v, thickness) = (DVec3::X * 50.0, DVec3::Y * 50.0, 0.7);
    for ior in IORS {
        let glass = Material { bsdf: Bsdf::Dielectric { ior }, le: Rgb::ZERO };
        let faces = vec![plate(DVec3::ZERO, u, v, glass), plate(DVec3::Z * -thickness, v, u, glass)];
        let scene = Scene::lit_by(faces, &[], Some(SKY), PROBE);
        for cos in cosines().step_by(9).filter(|cos| (1.0 - cos * cos).sqrt() < 0.99 * ior && *cos > 0.1) {
            let wo = inclined(DVec3::Z, cos, 0.7);
            let ray = Ray { o: wo * 2.0, d: -wo, from: NOWHERE };
            let through = |x: &Hit<'_>| {
                let (wi, weight) = sample(x.material.bsdf, x.frame.n, x.wo, LAST);
                (x.spawn(wi), weight)
            };
            let (inside, first) = through(&scene.intersect(&ray, 0.0).unwrap());
            let (out, second) = through(&scene.intersect(&inside, 0.0).unwrap());
            assert!((out.d - ray.d).length() < 1e-13, "{ior} {cos}: {} {}", out.d, ray.d);
            assert!((first * second - 1.0).abs().max_element() < 1e-14);
            let (_, cos_t) = sines_and_tangents(cos, ior);
            let exact = thickness * (1.0 - cos * cos).sqrt() * (1.0 - cos / (ior * cos_t));
            let shift = (out.o - ray.o).cross(ray.d).length();
            assert!((shift - exact.abs()).abs() < 1e-12, "{ior} {cos}: {shift} {exact}");
            assert!(scene.intersect(&out, 0.0).unwrap().is_sky());
        }
    }
}

/// A glass ball under a uniform sky is invisible, path by path, and from within the sky is n² times as bright.
#[test]
fn a_glass_ball_under_a_uniform_sky_is_not_seen() {
    let Sky::Uniform { radiance } = SKY else { unreachable!() };
    let (center, radius, ior) = (DVec3::new(0.3, -0.2, 0.5), 1.3, 1.5);
    let glass = Material { bsdf: Bsdf::Dielectric { ior }, le: Rgb::ZERO };
    let ball = SpherePatch { center, radius, axis: DVec3::Z, low: -1.0, high: 1.0, inward: false };
    let scene = Scene::lit_by(vec![Surface::new(Shape::Sphere(ball), glass)], &[], Some(SKY), PROBE);
    let estimator = Implicit { directions: Directions::Cosine, roulette: Roulette::unclamped(Rule::None) };
    let mut random = stream("ball");
    for i in 0..20_000 {
        let mut direction = || warp::sphere_band(-1.0, 1.0, random.u2());
        // from within so near to the centre that no ray is trapped: r < R / n
        let (o, expected) = if i % 2 == 0 {
            (center + 3.0 * direction(), radiance)
        } else {
            (center + 0.6 * direction(), radiance * (ior * ior))
        };
        let aim = center + 0.99 * radius * direction();
        let ray = Ray { o, d: (aim - o).normalize(), from: NOWHERE };
        let mut tally = Tally::default();
        let start = furnace::scene::Start { ray, response: 1.0, time: 0.0, pixel: 0 };
        let stream = Address::of(&["smooth_interfaces_obey_fresnel", "paths"]).stream(i, 0);
        estimator.estimate(&(), ray, &mut Ctx::new(&scene, stream, &mut tally, &start));
        assert!((tally.value / expected - 1.0).abs().max_element() < 1e-12, "{}", tally.value);
        assert!(tally.rays >= 2);
    }
}
