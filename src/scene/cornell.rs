//! The Cornell box in explicit rectangles, read from `references/cornell.json`, the data that the independent renderer
//! was given: the light reflects, emits downwards and hangs below the ceiling; the front is open.

use super::camera::Camera;
use super::geometry::Rectangle;
use super::{Material, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;
use serde::Deserialize;
use std::collections::HashMap;

#[derive(Deserialize)]
struct Data {
    materials: HashMap<String, DVec3>,
    camera: CameraData,
    rectangles: Vec<RectangleData>,
    blocks: Vec<RectangleData>,
}

#[derive(Deserialize)]
struct CameraData {
    origin: DVec3,
    direction: DVec3,
    up: DVec3,
    fov_degrees: f64,
}

#[derive(Deserialize)]
struct RectangleData {
    center: DVec3,
    half_edge_u: DVec3,
    half_edge_v: DVec3,
    front_normal: DVec3,
    material: String,
    #[serde(default)]
    emission: Rgb,
}

/// The box, with or without its two blocks, seen at `resolution` x `resolution` pixels.
pub fn cornell(blocks: bool, resolution: u32) -> Scene {
    let data: Data = serde_json::from_str(include_str!("../../references/cornell.json"))
        .expect("references/cornell.json is part of the program");
    let mut rectangles = data.rectangles;
    if blocks {
        rectangles.extend(data.blocks);
    }
    let surface = |r: &RectangleData| {
        let material = Material::lambert(data.materials[&r.material], r.emission);
        Surface::new(Shape::Rectangle(facing(r)), material)
    };
    let c = &data.camera;
    let camera = Camera::pinhole(c.origin, c.direction, c.up, c.fov_degrees, (resolution, resolution));
    Scene::new(rectangles.iter().map(surface).collect(), Sensor::Camera(camera))
}

/// The rectangle with its edges in the order that makes their cross product the stated front.
fn facing(r: &RectangleData) -> Rectangle {
    let (u, v) = (r.half_edge_u, r.half_edge_v);
    let same_side = u.cross(v).dot(r.front_normal) > 0.0;
    Rectangle {
        center: r.center,
        half_u: if same_side { u } else { v },
        half_v: if same_side { v } else { u },
    }
}
