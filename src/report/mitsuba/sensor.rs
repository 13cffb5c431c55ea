//! Sensors. All of Mitsuba's look along their +z axis, with +y up and +x to the left of the image.

use super::xml::Element;
use super::{Placement, bounds};
use crate::scene::camera::Camera;
use crate::scene::{Scene, Sensor};
use glam::DVec3;

/// Mitsuba sees nothing nearer than a near plane, and divides by its distance; this one stands at so small a fraction
/// of the far plane's distance.
const NEAR: f64 = 1e-6;

/// The scene's sensor with its film, one box a pixel.
pub fn sensor(scene: &Scene, placement: Placement) -> Result<Element, String> {
    let sensor = match &scene.sensor {
        Sensor::Irradiance { .. } => {
            return Err("Mitsuba measures irradiance as the mean over a surface, not in a point; \
                        look at the scene with a probe or a camera to export it"
                .to_owned());
        }
        Sensor::Probe { origin, direction } => Element::plugin("sensor", "radiancemeter")
            .triple("point", "origin", placement.point(*origin))
            .triple("vector", "direction", *direction),
        Sensor::Parallel { center, direction, half_u, half_v } => {
            // over the single pixel it does not matter which edge is which
            let columns = [*half_u * placement.scale, *half_v * placement.scale, *direction];
            if half_u.cross(*half_v).dot(*direction) == 0.0 {
                return Err("parallel rays that run within their own rectangle cannot be exported".to_owned());
            }
            let sensor = Element::plugin("sensor", "orthographic").placed(columns, placement.point(*center));
            clipped(sensor, scene, placement, (*center, None))
        }
        Sensor::Camera(camera) => {
            let near = (camera.near > 0.0).then_some(camera.near * placement.scale);
            clipped(perspective(camera, placement)?, scene, placement, (camera.origin, near))
        }
    };
    let (width, height) = scene.sensor.resolution();
    let film = Element::plugin("film", "hdrfilm")
        .set("integer", "width", width)
        .set("integer", "height", height)
        .set("string", "pixel_format", "rgb")
        .set("string", "component_format", "float32")
        .with(Element::plugin("rfilter", "box"));
    let sampler = Element::plugin("sampler", "independent").set("integer", "sample_count", "$spp");
    Ok(sensor.with(film).with(sampler))
}

fn perspective(camera: &Camera, placement: Placement) -> Result<Element, String> {
    let (right, up) = (camera.right.length(), camera.up.length());
    let aspect = f64::from(camera.width) / f64::from(camera.height);
    if (right - up * aspect).abs() > 1e-9 * right {
        return Err("Mitsuba's pixels are squares; this camera's are not".to_owned());
    }
    let columns = [-camera.right / right, camera.up / up, camera.forward];
    let kind = if camera.lens.is_some() { "thinlens" } else { "perspective" };
    let sensor = Element::plugin("sensor", kind)
        .placed(columns, placement.point(camera.origin))
        .set("string", "fov_axis", "y")
        .number("fov", 2.0 * libm::atan(up).to_degrees());
    Ok(match camera.lens {
        None => sensor,
        Some(lens) => sensor
            .number("aperture_radius", lens.radius * placement.scale)
            .number("focus_distance", lens.focus * placement.scale),
    })
}

/// The same with its near and far plane around all that can be seen from `eye`, or from its own near plane on.
fn clipped(
    sensor: Element,
    scene: &Scene,
    placement: Placement,
    (eye, near): (DVec3, Option<f64>),
) -> Element {
    let (low, high) = bounds(scene);
    let farthest = (eye - low).abs().max((eye - high).abs()).length() * placement.scale;
    let far = 2.0 * farthest;
    sensor.number("near_clip", near.unwrap_or(NEAR * far)).number("far_clip", far)
}
