//! What exhibits are built of, in the coordinates of a tilted place away from the origin.

use super::Primitive;
use crate::scene::camera::{Camera, Lens};
use crate::scene::geometry::{Disk, Rectangle, SpherePatch, Triangle};
use crate::scene::library::Setting;
use crate::scene::{Bsdf, Material, PointLight, Rgb, Sensor, Shape, Sky};
use glam::DVec3;

/// Albedo of floors: each channel has its own, so that channels cannot be confused.
pub const FLOOR: Rgb = Rgb::new(0.8, 0.5, 0.3);
/// Radiance of lights.
pub const LE: Rgb = Rgb::new(3.0, 5.0, 2.0);

/// Local coordinates: x and y in the plane of the floor, z up.
#[derive(Clone, Copy)]
pub struct Place {
    origin: DVec3,
    axes: [DVec3; 3],
}

/// Tilted, so that no coordinate is special.
pub const TILTED: Place = Place {
    origin: DVec3::new(0.3, -0.2, 0.5),
    axes: [DVec3::new(0.8, -0.6, 0.0), DVec3::new(0.48, 0.64, -0.6), DVec3::new(0.36, 0.48, 0.8)],
};

/// Upright, for planes so large that a tilt would cost digits.
pub const UPRIGHT: Place = Place { origin: DVec3::new(0.3, -0.2, 0.5), axes: DVec3::AXES };

/// Half the edge of a plane that stands for an infinite one: what leaves it sideways carries 1e-16 of the light.
const INFINITE: f64 = 1e8;

impl Place {
    /// A point.
    pub fn at(&self, x: f64, y: f64, z: f64) -> DVec3 {
        self.origin + self.along(x, y, z)
    }

    /// A vector.
    pub fn along(&self, x: f64, y: f64, z: f64) -> DVec3 {
        x * self.axes[0] + y * self.axes[1] + z * self.axes[2]
    }

    /// A rectangle around `center`; half edges in the order that makes their cross product the front.
    pub fn rectangle(&self, center: [f64; 3], half_u: [f64; 3], half_v: [f64; 3]) -> Shape {
        let [center, half_u, half_v] = [
            self.at(center[0], center[1], center[2]),
            self.along(half_u[0], half_u[1], half_u[2]),
            self.along(half_v[0], half_v[1], half_v[2]),
        ];
        Shape::Rectangle(Rectangle { center, half_u, half_v })
    }

    /// A triangle, counter-clockwise as seen from the front.
    pub fn triangle(&self, corners: [[f64; 3]; 3]) -> Shape {
        let [a, b, c] = corners.map(|p| self.at(p[0], p[1], p[2]));
        Shape::Triangle(Triangle { a, b, c })
    }

    /// A horizontal disk that shines down.
    pub fn disk(&self, center: [f64; 3], radius: f64) -> Shape {
        let [x, y, z] = center;
        Shape::Disk(Disk { center: self.at(x, y, z), normal: -self.axes[2], radius })
    }

    /// A ball.
    pub fn ball(&self, center: [f64; 3], radius: f64) -> Shape {
        self.band(center, radius, -1.0, 1.0, false)
    }

    /// A band of a sphere around the vertical axis.
    pub fn band(&self, center: [f64; 3], radius: f64, low: f64, high: f64, inward: bool) -> Shape {
        let center = self.at(center[0], center[1], center[2]);
        Shape::Sphere(SpherePatch { center, radius, axis: self.axes[2], low, high, inward })
    }

    /// A small square of floor around the point (0, 0, 0).
    pub fn floor(&self) -> Primitive {
        matte(self.rectangle([0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]), FLOOR)
    }

    /// A horizontal plane without end, `up` or down.
    pub fn plane(&self, height: f64, up: bool) -> Shape {
        let (u, v) = ([INFINITE, 0.0, 0.0], [0.0, INFINITE, 0.0]);
        if up { self.rectangle([0.0, 0.0, height], u, v) } else { self.rectangle([0.0, 0.0, height], v, u) }
    }

    /// A look at the point (0, 0, 0) from close by, between floor and light.
    pub fn look_at_floor(&self) -> Sensor {
        Sensor::Probe {
            origin: self.at(0.006, -0.008, 0.024),
            direction: self.along(-0.006, 0.008, -0.024) / 0.026,
        }
    }
}

/// A Lambert surface.
pub fn matte(shape: Shape, albedo: Rgb) -> Primitive {
    of(shape, Bsdf::Lambert { albedo })
}

/// A light that reflects nothing.
pub fn light(shape: Shape, le: Rgb) -> Primitive {
    glowing(shape, Rgb::ZERO, le)
}

/// A light that reflects.
pub fn glowing(shape: Shape, albedo: Rgb, le: Rgb) -> Primitive {
    Primitive { shape, material: Material::lambert(albedo, le), velocity: DVec3::ZERO }
}

/// A surface that does not emit.
pub fn of(shape: Shape, bsdf: Bsdf) -> Primitive {
    Primitive { shape, material: Material { bsdf, le: Rgb::ZERO }, velocity: DVec3::ZERO }
}

/// A setting lit by its surfaces.
pub fn setting(primitives: Vec<Primitive>, sensor: Sensor) -> Setting {
    Setting { primitives, points: Vec::new(), sky: None, sensor }
}

/// A setting under a sky.
pub fn under(sky: Sky, primitives: Vec<Primitive>, sensor: Sensor) -> Setting {
    Setting { sky: Some(sky), ..setting(primitives, sensor) }
}

/// A setting lit by a point.
pub fn lit_by(point: PointLight, primitives: Vec<Primitive>, sensor: Sensor) -> Setting {
    Setting { points: vec![point], ..setting(primitives, sensor) }
}

/// How far from the camera of a [`Frame`] its picture is.
pub const DISTANCE: f64 = 1.7;
/// Half the width of the one pixel, at unit distance.
const HALF_WIDTH: f64 = 0.2;

/// A camera of one pixel, straight above the origin.
pub struct Frame {
    /// Its lens, if any.
    pub lens: Option<Lens>,
}

impl Frame {
    /// Width of the pixel in the plane that it looks at.
    pub fn pixel(&self) -> f64 {
        2.0 * HALF_WIDTH * DISTANCE
    }

    /// The camera and what it sees.
    pub fn shows(&self, primitive: Primitive) -> Setting {
        let sensor = Sensor::Camera(Camera {
            origin: TILTED.at(0.0, 0.0, DISTANCE),
            forward: TILTED.along(0.0, 0.0, -1.0),
            right: TILTED.along(HALF_WIDTH, 0.0, 0.0),
            up: TILTED.along(0.0, HALF_WIDTH, 0.0),
            width: 1,
            height: 1,
            lens: self.lens,
            near: 0.0,
        });
        setting(vec![primitive], sensor)
    }
}

/// A light that fills the plane through the origin up to an edge: where `normal` · (x, y) <= `distance`.
pub fn half_plane(normal: [f64; 2], distance: f64) -> Primitive {
    const HALF: f64 = 50.0;
    let [c, s] = normal;
    let center = distance - HALF;
    let plate = TILTED.rectangle(
        [center * c, center * s, 0.0],
        [HALF * c, HALF * s, 0.0],
        [-HALF * s, HALF * c, 0.0],
    );
    light(plate, LE)
}
