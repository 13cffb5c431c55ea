//! Promise: without any epsilon, a ray never meets the surface that it leaves, closed scenes do not leak, and a shadow
//! ray sees what a traced ray sees, at every scale.
//!
//! Nothing here is statistical: what is asserted holds for every ray, and the random rays only choose examples.

use furnace::sampling::warp::{self, Frame};
use furnace::sampling::{Address, Stream};
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch, Triangle};
use furnace::scene::library::{Patch, SceneKind, View};
use furnace::scene::spheres::Spheres;
use furnace::scene::{Bsdf, Carried, Directions, Material, Ray, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;

const GREY: Material = Material { bsdf: Bsdf::Lambert { albedo: Rgb::splat(0.5) }, le: Rgb::ZERO };
/// Builds a scene, its lengths times the argument.
type Build = fn(f64) -> Scene;
const SCENES: [(&str, Build); 2] = [("mixed", mixed), ("cornell", cornell)];
const SENSOR: Sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };

fn stream(name: &str) -> Stream {
    Address::of(&["geometry_is_exact", name]).stream(0, 0)
}

/// The Cornell box without the bottoms of its blocks: they lie in the floor, and between the two rounding decides.
fn cornell(k: f64) -> Scene {
    let larger = |s: &Surface| {
        let Shape::Rectangle(r) = s.shape else { unreachable!("the box is made of rectangles") };
        let is_bottom = r.normal().y < -0.5 && r.center.y < -0.999;
        let r = Rectangle { center: r.center * k, half_u: r.half_u * k, half_v: r.half_v * k };
        (!is_bottom).then(|| Surface::new(Shape::Rectangle(r), GREY))
    };
    let scene = SceneKind::CornellBox { resolution: 1 }.build();
    Scene::new(scene.surfaces().iter().filter_map(larger).collect(), SENSOR)
}

/// Every shape, both ways round: balls and a bowl in a sphere of two bands, flat shapes between.
fn mixed(k: f64) -> Scene {
    let at = |x, y, z| k * DVec3::new(x, y, z);
    let axis = DVec3::new(0.36, 0.48, 0.8);
    let sphere = |center, radius, (low, high), inward| {
        Shape::Sphere(SpherePatch { center, radius: radius * k, axis, low, high, inward })
    };
    let (a, b, c) = (at(-1.5, -1.0, -1.0), at(0.9, -1.3, -0.8), at(0.1, 1.6, -1.2));
    let (center, half_u, half_v) = (at(0.4, -0.9, 0.9), at(0.6, 0.8, 0.0), at(0.4, -0.3, 0.2));
    let normal = DVec3::new(0.48, 0.6, -0.64);
    let shapes = [
        sphere(at(0.1, 0.2, 0.0), 3.0, (-1.0, 0.2), true),
        sphere(at(0.1, 0.2, 0.0), 3.0, (0.2, 1.0), true),
        sphere(at(1.0, 0.3, -0.4), 0.6, (-1.0, 1.0), false),
        sphere(at(-0.9, 0.7, 0.5), 0.8, (-1.0, -0.1), false),
        sphere(at(-0.6, -1.2, 0.3), 0.7, (-0.3, 0.4), true),
        Shape::Disk(Disk { center: at(0.2, 0.1, 1.1), normal, radius: 0.7 * k }),
        Shape::Triangle(Triangle { a, b, c }),
        Shape::Rectangle(Rectangle { center, half_u, half_v }),
    ];
    Scene::new(shapes.map(|shape| Surface::new(shape, GREY)).to_vec(), SENSOR)
}

/// Bands of one sphere, seen from inside; their limits are no round numbers.
fn bands() -> Scene {
    let patch = |fraction| Patch { fraction, albedo: Rgb::splat(0.5), emission: Rgb::ONE };
    let patches = [0.1, 0.3, 1.0 / 7.0, 0.4 - 1.0 / 7.0, 0.2].map(patch).to_vec();
    SceneKind::IntegratingSphere { patches, looks_at: 1, view: View::Probe }.build()
}

/// Distance to a band by the textbook's solution, with the epsilon that the code does without.
fn sphere_distance(s: &SpherePatch, ray: &Ray) -> f64 {
    let oc = ray.o - s.center;
    let half_b = oc.dot(ray.d);
    let root = (half_b * half_b - oc.length_squared() + s.radius * s.radius).sqrt();
    let height = |t: f64| (oc + t * ray.d).dot(s.axis) / s.radius;
    let is_hit = |t: &f64| *t > 1e-9 && height(*t) >= s.low - 1e-15 && height(*t) <= s.high + 1e-15;
    [-half_b - root, -half_b + root].into_iter().find(is_hit).unwrap_or(f64::INFINITY)
}

/// Distance and number of the nearest surface, front or back, by asking each in turn.
fn nearest(scene: &Scene, ray: &Ray) -> (f64, u32) {
    let distance = |(id, s): (u32, &Surface)| match &s.shape {
        Shape::Sphere(s) => (sphere_distance(s, ray), id),
        _ if id == ray.from => (f64::INFINITY, id),
        flat => (flat.intersect_flat(ray), id),
    };
    let hits = (0u32..).zip(scene.surfaces()).map(distance);
    hits.fold((f64::INFINITY, NOWHERE), |a, b| if b.0 < a.0 { b } else { a })
}

/// A ray from a random point of surface `id` into its front.
fn leave(scene: &Scene, id: usize, stream: &mut Stream) -> Ray {
    let surface = &scene.surfaces()[id];
    let (p, frame) = surface.sample_area(stream.u2());
    let d = GREY.bsdf.sample(Carried::Radiance, Directions::Uniform, &frame, DVec3::Z, stream.u2()).wi;
    Ray { o: p, d, from: id as u32 }
}

/// What is met is the nearest of all other surfaces, or the far end of a chord inside a sphere; a hit on the surface
/// itself would hide it.
#[test]
fn rays_never_hit_the_surface_that_they_leave() {
    for (name, build) in SCENES {
        let (mut stream, scene) = (stream(name), build(1.0));
        for (id, own) in scene.surfaces().iter().enumerate().cycle().take(200_000) {
            let ray = leave(&scene, id, &mut stream);
            let (t, other) = nearest(&scene, &ray);
            let front = |p| scene.surfaces()[other as usize].at(p).1.n.dot(ray.d) < 0.0;
            let seen = t.is_finite() && front(ray.o + t * ray.d);
            let hit = scene.intersect(&ray, 0.0);
            assert_eq!(hit.map(|h| h.surface), seen.then_some(other), "{name}: {ray:?} at {t}");
            // where a ray grazes a sphere, the textbook's root has half of its digits
            assert!(hit.is_none_or(|h| h.p.distance(ray.o + t * ray.d) < 1e-7), "{name}: {ray:?} at {t}");
            let chord = matches!(&own.shape, Shape::Sphere(s) if s.inward);
            assert!(chord || other != ray.from, "{name}: {ray:?} meets itself at {t}");
        }
    }
}

/// A million bounces, in which each ray meets a front and walks on a sphere do not creep away from it.
#[test]
fn closed_scenes_do_not_leak() {
    let (albedo, emission, view) = (Rgb::splat(0.5), Rgb::ONE, View::Probe);
    let furnace = SceneKind::Furnace { albedo, emission, view }.build();
    let furnace_box = SceneKind::FurnaceBox { albedo, emission, view }.build();
    for (name, scene) in [("furnace", furnace), ("furnace_box", furnace_box), ("bands", bands())] {
        let mut stream = stream(name);
        let (mut ray, _) = scene.sensor.ray((0, 0), &mut stream);
        let mut drift = 0f64;
        for bounce in 0..333_334 {
            let Some(hit) = scene.intersect(&ray, 0.0) else {
                panic!("{name}: bounce {bounce} leaks: {ray:?}")
            };
            if let Shape::Sphere(s) = &scene.surfaces()[hit.surface as usize].shape {
                drift = drift.max((hit.p.distance(s.center) / s.radius - 1.0).abs());
            }
            ray = hit.spawn(
                GREY.bsdf.sample(Carried::Radiance, Directions::Cosine, &hit.frame, DVec3::Z, stream.u2()).wi,
            );
        }
        assert!(drift < 1e-12, "{name}: {drift:e} off the sphere");
    }
}

/// Each ray from inside meets exactly one band, also where it aims at the seam between two.
#[test]
fn bands_partition_their_sphere() {
    let (scene, mut stream) = (bands(), stream("bands"));
    let surfaces = scene.surfaces();
    let alone: Vec<Spheres> = surfaces.chunks(1).map(Spheres::new).collect();
    for i in 0..200_000 {
        let leaving = leave(&scene, i % surfaces.len(), &mut stream);
        let Shape::Sphere(s) = surfaces[i % surfaces.len()].shape else { unreachable!("bands of a sphere") };
        let o = s.center + warp::sphere_band(-1.0, 1.0, stream.u2()) * (0.99 * s.radius * stream.u1());
        let inside = Ray { o, d: warp::sphere_band(-1.0, 1.0, stream.u2()), from: NOWHERE };
        let seam = Frame::around(s.axis).to_world(warp::sphere_band(s.low, s.low, stream.u2()));
        let at_seam = Ray { d: (s.center + s.radius * seam - o).normalize(), ..inside };
        // alone, each band is surface 0 of the sphere that the first ray leaves
        for ray in [Ray { from: 0, ..leaving }, inside, at_seam] {
            let met = alone.iter().filter(|band| band.nearest(&ray).0.is_finite()).count();
            assert_eq!(met, 1, "{ray:?}");
            assert!(scene.intersect(&ray, 0.0).is_some(), "{ray:?}");
        }
    }
}

/// A point is visible exactly if the nearest surface along the ray, front or back, is no closer than it.
#[test]
fn shadow_rays_see_what_traced_rays_see() {
    for (name, build) in SCENES {
        let (mut stream, scene) = (stream(name), build(1.0));
        let (surfaces, n) = (scene.surfaces(), scene.surfaces().len());
        let (mut seen, mut hidden, mut backs) = (0, 0, 0);
        for pair in 0..400_000 {
            let (i, j) = (pair % n, pair / n % n);
            let (p, from) = surfaces[i].sample_area(stream.u2());
            let (q, normal) = surfaces[j].sample_area(stream.u2());
            let (segment, distance) = (Ray { o: p, d: q - p, from: i as u32 }, p.distance(q));
            let ray = Ray { d: segment.d / distance, ..segment };
            // a ray within its own plane sees nothing that matters: cos θ = 0
            if from.n.dot(ray.d).abs() < 1e-9 {
                continue;
            }
            let (t, id) = nearest(&scene, &ray);
            let visible = t > distance * (1.0 - 1e-9);
            let case = format_args!("{name}: {i} -> {j}, {segment:?}, {id} at {t}");
            assert_eq!(scene.visible(&segment, 0.0, j as u32), visible, "{case}");
            let hit = scene.intersect(&ray, 0.0);
            if visible && normal.n.dot(ray.d) < 0.0 {
                // seen from the front, and found there
                let hit = hit.unwrap();
                assert!(hit.surface == j as u32 && hit.p.distance(q) < 1e-9, "{case}");
            } else if let Some(hit) = hit {
                assert!(hit.frame.n.dot(ray.d) < 0.0, "{case} shows a back");
            } else if !visible {
                // a back shows nothing but hides what is behind it
                backs += 1;
            }
            (seen, hidden) = (seen + u32::from(visible), hidden + u32::from(!visible));
        }
        assert!(seen.min(hidden).min(backs) > 10_000, "{name}: too few cases to tell");
    }
}

/// Lengths times a power of two change no rounding, so the hits are the same bit by bit: an epsilon would show.
#[test]
fn hits_do_not_depend_on_the_unit_of_length() {
    for (name, build) in SCENES {
        // 2^20 is about 10^6
        for k in [2f64.powi(-20), 2f64.powi(20)] {
            let (scene, other) = (build(1.0), build(k));
            let mut stream = stream(name);
            for i in 0..100_000 {
                let ray = leave(&scene, i % scene.surfaces().len(), &mut stream);
                let far = Ray { o: ray.o * k, ..ray };
                let (here, there) = (scene.intersect(&ray, 0.0), other.intersect(&far, 0.0));
                let (here, there) =
                    (here.map(|h| (h.p * k, h.frame, h.surface)), there.map(|h| (h.p, h.frame, h.surface)));
                assert_eq!(here, there, "{name} x {k}: {ray:?}");
            }
        }
    }
}
