//! Surfaces.

use super::xml::{Element, numbers};
use super::{Mesh, Placement};
use crate::sampling::warp::Frame;
use crate::scene::geometry::{SpherePatch, Triangle};
use crate::scene::{Bsdf, Material, Rgb, Scene, Shape, Surface};
use glam::DVec3;

/// One element for each surface, or for each row of triangles of one material, and the files that these need.
pub fn shapes(scene: &Scene, placement: Placement, stem: &str) -> Result<(Vec<Element>, Vec<Mesh>), String> {
    let (mut elements, mut meshes) = (Vec::new(), Vec::new());
    let together = |a: &Surface, b: &Surface| {
        a.material == b.material && matches!((&a.shape, &b.shape), (Shape::Triangle(_), Shape::Triangle(_)))
    };
    for group in scene.surfaces().chunk_by(together) {
        let surface = &group[0];
        if surface.moves() {
            return Err(
                "Mitsuba 3 does not move what it renders; a moving surface cannot be exported".to_owned()
            );
        }
        let shape = match &surface.shape {
            Shape::Triangle(_) => {
                let name = format!("{}_mesh_{}.obj", file_name(stem)?, meshes.len() + 1);
                let mesh = Element::plugin("shape", "obj").set("string", "filename", &name);
                meshes.push(Mesh { name, text: obj(group, placement) });
                mesh.set("boolean", "face_normals", true)
            }
            Shape::Rectangle(r) => {
                let columns = [r.half_u * placement.scale, r.half_v * placement.scale, r.normal()];
                Element::plugin("shape", "rectangle").placed(columns, placement.point(r.center))
            }
            Shape::Disk(d) => {
                let (frame, radius) = (Frame::around(d.normal), d.radius * placement.scale);
                let columns =
                    [radius * frame.to_world(DVec3::X), radius * frame.to_world(DVec3::Y), d.normal];
                Element::plugin("shape", "disk").placed(columns, placement.point(d.center))
            }
            Shape::Sphere(s) => sphere(s, placement)?,
        };
        elements.push(shape.with(bsdf(&surface.material)?).with_all(emitter(&surface.material)));
    }
    Ok((elements, meshes))
}

fn sphere(s: &SpherePatch, placement: Placement) -> Result<Element, String> {
    if s.low > -1.0 || s.high < 1.0 {
        return Err("Mitsuba has no bands of a sphere; only whole spheres can be exported".to_owned());
    }
    Ok(Element::plugin("shape", "sphere")
        .triple("point", "center", placement.point(s.center))
        .number("radius", s.radius * placement.scale)
        .set("boolean", "flip_normals", s.inward))
}

/// What the file's name lends to those of its meshes. `$` would start a parameter, and XML has no control characters.
fn file_name(stem: &str) -> Result<&str, String> {
    match stem.chars().find(|&c| c == '$' || c.is_control()) {
        Some(c) => Err(format!(
            "this scene needs mesh files, whose names in Mitsuba cannot hold {c:?}; rename the file"
        )),
        None => Ok(stem),
    }
}

/// Triangles in the OBJ format; their fronts are where their corners run counter-clockwise, as here.
fn obj(surfaces: &[Surface], placement: Placement) -> String {
    let mut text = String::new();
    let mut corners = 0;
    for surface in surfaces {
        let Shape::Triangle(Triangle { a, b, c }) = &surface.shape else { continue };
        for corner in [a, b, c] {
            text += &format!("v {}\n", numbers(&placement.point(*corner).to_array()));
        }
        text += &format!("f {} {} {}\n", corners + 1, corners + 2, corners + 3);
        corners += 3;
    }
    text
}

fn bsdf(material: &Material) -> Result<Element, String> {
    Ok(match material.bsdf {
        Bsdf::Lambert { albedo } => Element::plugin("bsdf", "diffuse").triple("rgb", "reflectance", albedo),
        Bsdf::Mirror { reflectance } => Element::plugin("bsdf", "conductor")
            .set("string", "material", "none")
            .triple("rgb", "specular_reflectance", reflectance),
        Bsdf::Conductor { eta, k } => {
            Element::plugin("bsdf", "conductor").triple("rgb", "eta", eta).triple("rgb", "k", k)
        }
        Bsdf::Glossy { alpha, eta, k } => Element::plugin("bsdf", "roughconductor")
            .set("string", "distribution", "ggx")
            .number("alpha", alpha)
            .triple("rgb", "eta", eta)
            .triple("rgb", "k", k),
        Bsdf::Dielectric { .. } if material.le != Rgb::ZERO => {
            return Err("a clear interface emits to both sides here and to its front in Mitsuba; \
                        one that emits cannot be exported"
                .to_owned());
        }
        Bsdf::Dielectric { ior } => {
            Element::plugin("bsdf", "dielectric").number("int_ior", ior).number("ext_ior", 1.0)
        }
    })
}

fn emitter(material: &Material) -> Option<Element> {
    let emits = material.le != Rgb::ZERO;
    emits.then(|| Element::plugin("emitter", "area").triple("rgb", "radiance", material.le))
}
