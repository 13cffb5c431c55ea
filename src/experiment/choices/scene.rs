//! Scenes as they are meant.

use super::lecture::{self, caustic, dof, motion};
use super::{Choice, points};
use crate::experiment::bounds;
use crate::experiment::input::Sweep;
use crate::experiment::spec::{
    BsdfSpec, FlushSpec, FurnaceSpec, LooksAt, ManySpheresSpec, PrimitiveSpec, PrimitivesSpec, SceneSpec,
    SensorSpec, ShapeSpec, SkySpec, SphereSpec,
};
use crate::scene::camera::Camera;
use crate::scene::geometry::{Disk, SpherePatch};
use crate::scene::lecture::Lecture;
use crate::scene::library::{Patch, Primitive, SceneKind, Setting};
use crate::scene::{Bsdf, Material, PointLight, Rgb, Sensor, Shape, Sky};
use crate::truth::gallery;
use glam::DVec3;

/// The scenes that `spec` means, or what is wrong with it.
pub fn scenes(spec: &SceneSpec) -> Result<Vec<Choice<SceneKind>>, String> {
    let plain = |base: &str, value| Ok(vec![Choice::new(base, &[], Vec::new(), value)]);
    match spec {
        SceneSpec::Furnace(f) => {
            bounded(f.albedo, f.emission)?;
            let FurnaceSpec { albedo, emission, view } = *f;
            plain("furnace", SceneKind::Furnace { albedo, emission, view })
        }
        SceneSpec::FurnaceBox(f) => {
            bounded(f.albedo, f.emission)?;
            let FurnaceSpec { albedo, emission, view } = *f;
            plain("furnace_box", SceneKind::FurnaceBox { albedo, emission, view })
        }
        SceneSpec::IntegratingSphere(s) => {
            points("light_fraction", &s.light_fraction).map(|p| integrating_sphere(s, p)).collect()
        }
        SceneSpec::CornellBox(c) => plain("cornell_box", SceneKind::CornellBox { resolution: c.resolution }),
        SceneSpec::CornellEmpty(c) => {
            plain("cornell_empty", SceneKind::CornellEmpty { resolution: c.resolution })
        }
        SceneSpec::CornellFlush(FlushSpec { tile, blocks }) => {
            let one = |tile: (&'static str, f64, bool)| {
                let value = SceneKind::CornellFlush { tile: tile.1 as usize - 1, blocks: *blocks };
                let base = if *blocks { "cornell_flush_blocks" } else { "cornell_flush" };
                Choice::new(base, &[], vec![tile], value)
            };
            Ok(points("tile", tile).map(one).collect())
        }
        SceneSpec::ManySpheres(m) => Ok(many_spheres(m)),
        SceneSpec::CausticGlass(c) => {
            caustic(["caustic_glass", "caustic_glass_point"], c, |source, resolution| Lecture::CausticGlass {
                source,
                resolution,
            })
        }
        SceneSpec::CausticMirror(c) => {
            caustic(["caustic_mirror", "caustic_mirror_point"], c, |source, resolution| {
                Lecture::CausticMirror { source, resolution }
            })
        }
        SceneSpec::Indirect(i) => {
            Ok(lecture::plain("indirect", Lecture::Indirect { resolution: i.resolution }))
        }
        SceneSpec::Smallpt(s) => Ok(lecture::plain("smallpt", Lecture::Smallpt { resolution: s.resolution })),
        SceneSpec::VeachMis(v) => {
            Ok(lecture::plain("veach_mis", Lecture::VeachMis { resolution: v.resolution }))
        }
        SceneSpec::Dof(d) => Ok(dof(d)),
        SceneSpec::Motion(m) => Ok(motion(m)),
        SceneSpec::Exhibit { name, parameter } => exhibit(name, parameter.as_ref()),
        SceneSpec::Primitives(p) => plain(&p.name, primitives(p)?),
    }
}

fn bounded(albedo: Rgb, emission: Rgb) -> Result<(), String> {
    let endless = (0..3).any(|c| albedo[c] >= 1.0 && emission[c] > 0.0);
    if endless {
        return Err("a closed scene of albedo 1 that emits has infinite radiance; \
                    the albedo must be below 1 in every channel that emits"
            .to_owned());
    }
    Ok(())
}

/// So many balls, unless a file says how many.
const USUAL_COUNT: u32 = 1000;

fn many_spheres(spec: &ManySpheresSpec) -> Vec<Choice<SceneKind>> {
    let scene = |count| SceneKind::ManySpheres { count, resolution: spec.resolution };
    let one = |p: (&'static str, f64, bool)| Choice::new("many_spheres", &[], vec![p], scene(p.1 as u32));
    match &spec.count {
        None => vec![Choice::new("many_spheres", &[], Vec::new(), scene(USUAL_COUNT))],
        Some(counts) => points("count", counts).map(one).collect(),
    }
}

fn integrating_sphere(s: &SphereSpec, light: (&'static str, f64, bool)) -> Result<Choice<SceneKind>, String> {
    let (has, most) = (s.patches.len(), bounds::PATCHES);
    if has > most {
        return Err(format!("a sphere of {has} patches; at most {most} are followed from one to the next"));
    }
    let patch = |fraction, albedo, emission| Patch { fraction, albedo, emission };
    let mut patches = vec![patch(light.1, s.light_albedo, s.emission)];
    patches.extend(s.patches.iter().map(|p| patch(p.fraction, p.albedo, p.emission)));
    let taken: f64 = patches.iter().map(|p| p.fraction).sum();
    if taken >= 1.0 {
        return Err(format!(
            "the light and the patches cover {taken} of the sphere; leave some for the wall"
        ));
    }
    patches.push(patch(1.0 - taken, s.wall_albedo, Rgb::ZERO));
    let mean = |f: &dyn Fn(&Patch) -> Rgb| patches.iter().map(|p| p.fraction * f(p)).sum::<Rgb>();
    bounded(mean(&|p| p.albedo), mean(&|p| p.emission))?;
    let looks_at = match s.looks_at {
        LooksAt::Light => 0,
        LooksAt::Wall => patches.len() - 1,
    };
    let value = SceneKind::IntegratingSphere { patches, looks_at, view: s.view };
    let params = if light.2 { vec![light] } else { Vec::new() };
    Ok(Choice::new("integrating_sphere", &[], params, value))
}

/// A scene of the gallery, at its usual parameter or at those given.
fn exhibit(name: &str, parameter: Option<&Sweep>) -> Result<Vec<Choice<SceneKind>>, String> {
    let exhibit = gallery::find(name).ok_or_else(|| gallery::unknown(name))?;
    let Some(sweep) = parameter else {
        return Ok(vec![Choice::new(name, &[], Vec::new(), exhibit.scene(exhibit.parameter.usual))]);
    };
    let one = |point: (&'static str, f64, bool)| {
        let allowed = &exhibit.parameter.range;
        if !allowed.contains(&point.1) {
            let (low, high) = (allowed.start(), allowed.end());
            return Err(format!(
                "{} = {} is out of range: {name} has it from {low} to {high}",
                point.0, point.1
            ));
        }
        Ok(Choice::new(name, &[], vec![point], exhibit.scene(point.1)))
    };
    points(exhibit.parameter.name, sweep).map(one).collect()
}

fn primitives(p: &PrimitivesSpec) -> Result<SceneKind, String> {
    if p.name.is_empty() || p.name.chars().count() > 80 {
        return Err("a scene's name has 1 to 80 characters".to_owned());
    }
    if p.primitives.is_empty() {
        return Err("a scene needs at least one primitive".to_owned());
    }
    let primitives = p.primitives.iter().map(primitive).collect::<Result<_, String>>()?;
    let points =
        p.points.iter().map(|p| PointLight { position: p.position, intensity: p.intensity }).collect();
    let sky = p.sky.map(|sky| match sky {
        SkySpec::Uniform { radiance } => Sky::Uniform { radiance },
        SkySpec::Cosine { radiance, exponent, up } => Sky::Cosine { radiance, exponent, up },
    });
    Ok(SceneKind::Custom(Setting { primitives, points, sky, sensor: sensor(p.sensor)? }))
}

fn sensor(spec: SensorSpec) -> Result<Sensor, String> {
    Ok(match spec {
        SensorSpec::Probe { origin, direction } => Sensor::Probe { origin, direction },
        SensorSpec::Irradiance { point, normal } => Sensor::Irradiance { point, normal, on: None },
        SensorSpec::Parallel { center, direction, half_u, half_v } => {
            Sensor::Parallel { center, direction, half_u, half_v }
        }
        SensorSpec::Camera { direction, up, .. } if direction.cross(up).length() < 1e-9 => {
            return Err("a camera's up must not be parallel to its direction".to_owned());
        }
        SensorSpec::Camera { lens: Some(lens), .. }
            if !(lens.radius * lens.focus > 0.0 && (lens.radius + lens.focus).is_finite()) =>
        {
            return Err("a lens has a finite radius and a finite focus above 0".to_owned());
        }
        SensorSpec::Camera { origin, direction, up, fov, resolution, lens } => {
            let pinhole = Camera::pinhole(origin, direction, up, fov, (resolution, resolution));
            Sensor::Camera(Camera { lens, ..pinhole })
        }
    })
}

fn primitive(spec: &PrimitiveSpec) -> Result<Primitive, String> {
    let shape = shape(&spec.shape)?;
    if spec.velocity != DVec3::ZERO && matches!(shape, Shape::Sphere(_)) {
        return Err("only flat shapes can move; leave out the sphere's velocity".to_owned());
    }
    let bsdf = match (spec.albedo, spec.bsdf) {
        (Some(_), Some(_)) => {
            return Err("a surface has an albedo (Lambert) or a bsdf, not both".to_owned());
        }
        (albedo, None) => Bsdf::Lambert { albedo: albedo.unwrap_or(Rgb::ZERO) },
        (None, Some(BsdfSpec::Mirror { reflectance })) => Bsdf::Mirror { reflectance },
        (None, Some(BsdfSpec::Conductor { eta, k } | BsdfSpec::Glossy { eta, k, .. }))
            if (eta + k).min_element() <= 0.0 =>
        {
            return Err("eta and k of a metal must not both be 0".to_owned());
        }
        (None, Some(BsdfSpec::Conductor { eta, k })) => Bsdf::Conductor { eta, k },
        (None, Some(BsdfSpec::Glossy { alpha, eta, k })) => Bsdf::Glossy { alpha, eta, k },
        (None, Some(BsdfSpec::Dielectric { ior })) => Bsdf::Dielectric { ior },
    };
    let material = Material { bsdf, le: spec.emission };
    Ok(Primitive { shape, material, velocity: spec.velocity })
}

fn shape(spec: &ShapeSpec) -> Result<Shape, String> {
    let shape = match *spec {
        ShapeSpec::Rectangle(r) => {
            let cosine = r.half_u.normalize_or_zero().dot(r.half_v.normalize_or_zero());
            if cosine.abs() > 1e-9 {
                return Err("half_u and half_v of a rectangle must be perpendicular".to_owned());
            }
            Shape::Rectangle(r)
        }
        ShapeSpec::Triangle(t) => Shape::Triangle(t),
        ShapeSpec::Disk(d) => {
            let normal = d.normal.try_normalize().ok_or("a disk's normal must not be the zero vector")?;
            Shape::Disk(Disk { normal, ..d })
        }
        ShapeSpec::Sphere { center, radius, inward } => {
            Shape::Sphere(SpherePatch { center, radius, axis: DVec3::Z, low: -1.0, high: 1.0, inward })
        }
        ShapeSpec::SpherePatch { center, radius, axis, low, high, inward } => {
            if !(-1.0 <= low && low < high && high <= 1.0) {
                return Err("a sphere patch needs -1 <= low < high <= 1".to_owned());
            }
            Shape::Sphere(SpherePatch { center, radius, axis, low, high, inward })
        }
    };
    let radius = if let Shape::Disk(d) = &shape { d.radius } else { 1.0 };
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(format!("{radius} is out of range: a radius is finite and positive"));
    }
    if !shape.origin().is_finite() {
        return Err("coordinates are finite".to_owned());
    }
    let area = shape.area();
    if !(area.is_finite() && area > 0.0) {
        return Err(format!("this shape has an area of {area}; it must be finite and positive"));
    }
    Ok(shape)
}
