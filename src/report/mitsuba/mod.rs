//! A scene in the words of Mitsuba 3, so that an independent renderer can measure the same.
//!
//! Both have one-sided surfaces that are black from behind and emit to the front only. What Mitsuba cannot say is
//! refused with the reason. It works in single precision and offsets its rays by an amount that does not shrink with
//! the scene: a scene around the origin and some hundred units large fares best, hence [`Placement`].

mod sensor;
mod surfaces;
mod xml;

use crate::scene::{Scene, Sky};
use glam::DVec3;
use xml::Element;

/// A scene as Mitsuba reads it.
#[derive(Debug)]
pub struct Export {
    /// The scene file.
    pub xml: String,
    /// Triangles, which have to stand in files of their own, beside the scene file.
    pub meshes: Vec<Mesh>,
}

/// A file of triangles.
#[derive(Debug)]
pub struct Mesh {
    /// Its name.
    pub name: String,
    /// Its text, in the OBJ format.
    pub text: String,
}

/// Where the scene's points go: radiance depends on neither number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// This point goes to the origin.
    pub center: DVec3,
    /// Factor of all lengths.
    pub scale: f64,
}

impl Placement {
    /// Everything where it is.
    pub const SAME: Self = Placement { center: DVec3::ZERO, scale: 1.0 };

    /// The middle of the scene to the origin, lengths times `scale`.
    pub fn centred(scene: &Scene, scale: f64) -> Self {
        let (low, high) = bounds(scene);
        Placement { center: 0.5 * (low + high), scale }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        (p - self.center) * self.scale
    }
}

/// Writes `scene`, or tells why Mitsuba cannot have it; names of mesh files start with `stem`.
pub fn export(scene: &Scene, placement: Placement, stem: &str) -> Result<Export, String> {
    let default =
        |name: &str, value: &str| Element::new("default").attribute("name", name).attribute("value", value);
    let integrator = Element::plugin("integrator", "path").set("integer", "max_depth", "$max_depth").set(
        "integer",
        "rr_depth",
        "$rr_depth",
    );
    let (shapes, meshes) = surfaces::shapes(scene, placement, stem)?;
    let points = scene.points().map(|light| {
        Element::plugin("emitter", "point")
            .triple("point", "position", placement.point(light.position))
            // irradiance is intensity / distance²
            .triple("rgb", "intensity", light.intensity * (placement.scale * placement.scale))
    });
    let sky = match scene.sky() {
        None => None,
        Some(Sky::Uniform { radiance }) => {
            Some(Element::plugin("emitter", "constant").triple("rgb", "radiance", *radiance))
        }
        Some(Sky::Cosine { .. }) => {
            return Err(
                "Mitsuba has no sky that darkens as a cosine; only a uniform one can be exported".to_owned()
            );
        }
    };
    let file = Element::new("scene")
        .attribute("version", "3.0.0")
        .with_all([default("max_depth", "-1"), default("rr_depth", "5"), default("spp", "64")])
        .with(integrator)
        .with(sensor::sensor(scene, placement)?)
        .with_all(points.chain(sky))
        .with_all(shapes);
    Ok(Export { xml: format!("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n{file}"), meshes })
}

/// Lowest and highest coordinates of all surfaces.
fn bounds(scene: &Scene) -> (DVec3, DVec3) {
    let boxes = scene.surfaces().iter().map(|s| s.shape.bounds());
    boxes.reduce(|(low, high), (a, b)| (low.min(a), high.max(b))).unwrap_or_default()
}
