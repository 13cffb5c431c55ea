//! Promise: among many lights that one is picked whose turn it is, as if each were looked at in turn, bit by bit; and a ray
//! that meets one of them is told the probability with which it is picked.

use furnace::sampling::{Address, Stream, warp};
use furnace::scene::geometry::{NOWHERE, SpherePatch};
use furnace::scene::{
    LightSampling, Material, Pick, PointLight, Points, Ray, Rgb, Scene, Sensor, Shape, Sky, Surface, sky::SKY,
};
use glam::DVec3;
use std::f64::consts::PI;

const LIGHTS: usize = 500;
const WAYS: [Pick; 2] = [Pick::Power, Pick::Uniform];

/// Far apart on a line, so that none hides another from a point beside it; every fifth is dark.
fn balls(stream: &mut Stream) -> Vec<Surface> {
    let ball = |i| {
        let le = if i % 5 == 0 { Rgb::ZERO } else { Rgb::new(stream.u1(), stream.u1(), 0.1) };
        let center = DVec3::new(10.0 * i as f64, 0.0, 0.0);
        let whole = SpherePatch { center, radius: 1.0, axis: DVec3::Z, low: -1.0, high: 1.0, inward: false };
        Surface::new(Shape::Sphere(whole), Material::lambert(Rgb::ZERO, le))
    };
    (0..LIGHTS).map(ball).collect()
}

/// What each light is called in samples, and its power up to a factor π.
fn lights(surfaces: &[Surface], points: &[PointLight], sky: Option<Sky>) -> Vec<(u32, f64)> {
    let lit = (0u32..).zip(surfaces).map(|(id, s)| (id, 4.0 * PI * s.material.le.element_sum()));
    let half = 0.5 * DVec3::new(10.0 * (LIGHTS - 1) as f64 + 2.0, 2.0, 2.0);
    let of_sky = |sky: Sky| (SKY, half.length().powi(2) * sky.fluence().element_sum());
    lit.filter(|light| light.1 > 0.0)
        .chain(points.iter().map(|p| (NOWHERE, 4.0 * p.intensity.element_sum())))
        .chain(sky.map(of_sky))
        .collect()
}

#[test]
fn as_if_each_were_looked_at() {
    let mut stream = Address::of(&["many_lights_are_found"]).stream(0, 0);
    let surfaces = balls(&mut stream);
    let points = [0.2, 3.0].map(|x| PointLight { position: DVec3::splat(-x), intensity: Rgb::splat(x) });
    let skies = [None, Some(Sky::Uniform { radiance: Rgb::splat(1e-5) })];
    for sky in skies {
        let sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };
        let scene = Scene::lit_by(surfaces.clone(), &points, sky, sensor);
        let lights = lights(&surfaces, &points, sky);
        let total: f64 = lights.iter().map(|light| light.1).sum();
        let mut sum = 0.0;
        let ends: Vec<f64> = lights
            .iter()
            .map(|light| {
                sum += light.1 / total;
                sum
            })
            .collect();
        let exact = ends.iter().flat_map(|&end| [end.next_down(), end]).filter(|&u| u < 1.0);
        for u in exact.chain((0..2000).map(|_| stream.u1())).collect::<Vec<_>>() {
            for pick in WAYS {
                let turn = match pick {
                    Pick::Power => ends.iter().position(|&end| u < end).unwrap_or(lights.len() - 1),
                    Pick::Uniform => (u * lights.len() as f64) as usize,
                };
                let pmf = match pick {
                    Pick::Power => lights[turn].1 / total,
                    Pick::Uniform => 1.0 / lights.len() as f64,
                };
                let how = LightSampling { points: Points::SolidAngle, pick };
                // from outside all of them every point of a solid angle is seen
                let eye = DVec3::new(-3.0, 40.0, 5.0);
                let sample = scene.sample_light(how, (eye, 0.0), u, stream.u2()).expect("seen from outside");
                assert_eq!(sample.surface, lights[turn].0, "{u} {pick:?}");
                assert!((sample.pmf - pmf).abs() < 1e-12, "{u} {pick:?}: {} {pmf}", sample.pmf);
                // a ray that way meets this light, or one in front of it
                let ray = Ray { o: eye, d: sample.to_light / sample.distance, from: NOWHERE };
                let hit = scene.intersect(&ray, 0.0);
                if let (Some(hit), Some(pdf)) = (hit.filter(|hit| hit.surface == sample.surface), sample.pdf)
                {
                    let told = scene.light_pdf(how, &ray, &hit, 0.0);
                    assert!((told.0 / pdf.0 - 1.0).abs() < 1e-9, "{u} {pick:?}: {told:?} {pdf:?}");
                }
            }
        }
        // what is dark is no light
        let dark = Ray { o: DVec3::new(0.0, 5.0, 0.0), d: DVec3::NEG_Y, from: NOWHERE };
        let hit = scene.intersect(&dark, 0.0).expect("the first ball");
        for pick in WAYS {
            let how = LightSampling { points: Points::Area, pick };
            assert_eq!(scene.light_pdf(how, &dark, &hit, 0.0).0, 0.0);
        }
        // and a ray past all of them meets the sky, if there is one
        let away = Ray { d: warp::sphere_band(1.0, 1.0, (0.0, 0.0)), ..dark };
        assert_eq!(scene.intersect(&away, 0.0).map(|hit| hit.surface), sky.map(|_| SKY));
    }
}
