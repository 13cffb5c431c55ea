//! A Cornell box for closed forms: the unit cube, y up, open at z = 0; the light lies in the plane of the ceiling, which
//! is four strips around it, so that nothing overlaps and nothing casts a shadow.

use super::geometry::{Rectangle, Triangle};
use super::{Material, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;
use std::ops::Range;

/// Albedo of floor, ceiling, back wall and blocks.
pub const WHITE: Rgb = Rgb::splat(0.73);
/// Albedo of the wall x = 0.
pub const GREEN: Rgb = Rgb::new(0.12, 0.45, 0.15);
/// Albedo of the wall x = 1.
pub const RED: Rgb = Rgb::new(0.65, 0.05, 0.05);
/// The light in x and z: it emits radiance 1 downwards and reflects nothing.
pub const LIGHT: [Range<f64>; 2] = [213.0 / 555.0..343.0 / 555.0, 227.0 / 555.0..332.0 / 555.0];

/// What is measured: the radiance that leaves one of these six squares. Which axis is constant, its value, and the
/// ranges of the two other axes, in the order of their letters.
pub const TILES: [(usize, f64, Range<f64>, Range<f64>); 6] = [
    (1, 0.0, 0.375..0.625, 0.375..0.625), // floor
    (1, 0.0, 0.75..1.0, 0.75..1.0),       // floor, far corner at the red wall
    (2, 1.0, 0.375..0.625, 0.375..0.625), // back wall
    (0, 1.0, 0.25..0.5, 0.5..0.75),       // red wall
    (1, 1.0, 0.0..0.25, 0.0..0.25),       // ceiling, near corner at the green wall
    (0, 0.0, 0.75..1.0, 0.5..0.75),       // green wall
];

/// A block: corner on the floor (x, z), two edges (x, z) from there, and height, in 1/555.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// The corner.
    pub corner: [f64; 2],
    /// One edge.
    pub u: [f64; 2],
    /// The other edge; u x v points up.
    pub v: [f64; 2],
    /// Height.
    pub height: f64,
}

/// The short and the tall block, white; they have no bottom face.
pub const BLOCKS: [Block; 2] = [
    Block { corner: [130.0, 65.0], u: [-48.0, 160.0], v: [160.0, 49.0], height: 165.0 },
    Block { corner: [423.0, 247.0], u: [-158.0, 49.0], v: [49.0, 159.0], height: 330.0 },
];

/// How far in front of its tile the sensor stands: so little that it sees the tile even where a block stands on it, which
/// is dark.
const LIFT: f64 = 0.01;

/// The box, with or without its blocks; the sensor looks straight at one of the [`TILES`].
pub fn cornell_flush(tile: usize, blocks: bool) -> Scene {
    let wall = |axis, at, a: &Range<f64>, b: &Range<f64>, albedo| {
        let material = Material::lambert(albedo, Rgb::ZERO);
        Surface::new(Shape::Rectangle(plate(axis, at, a, b)), material)
    };
    let (all, [x, z]) = (0.0..1.0, LIGHT);
    let mut surfaces = vec![
        Surface::new(Shape::Rectangle(plate(1, 1.0, &x, &z)), Material::lambert(Rgb::ZERO, Rgb::ONE)),
        wall(1, 0.0, &all, &all, WHITE),
        wall(0, 0.0, &all, &all, GREEN),
        wall(0, 1.0, &all, &all, RED),
        wall(2, 1.0, &all, &all, WHITE),
        wall(1, 1.0, &(0.0..x.start), &all, WHITE),
        wall(1, 1.0, &(x.end..1.0), &all, WHITE),
        wall(1, 1.0, &x, &(0.0..z.start), WHITE),
        wall(1, 1.0, &x, &(z.end..1.0), WHITE),
    ];
    if blocks {
        surfaces.extend(BLOCKS.iter().flat_map(Block::faces));
    }
    let (axis, at, a, b) = &TILES[tile];
    let target = plate(*axis, *at, a, b);
    let direction = -target.normal();
    let center = target.center - LIFT * direction;
    let sensor = Sensor::Parallel { center, direction, half_u: target.half_u, half_v: target.half_v };
    Scene::new(surfaces, sensor)
}

/// A rectangle of a wall of the cube, its front towards the inside.
pub fn plate(axis: usize, at: f64, a: &Range<f64>, b: &Range<f64>) -> Rectangle {
    let [first, second] = [[1, 2], [0, 2], [0, 1]][axis].map(|i| DVec3::AXES[i]);
    let middle = |r: &Range<f64>| 0.5 * (r.start + r.end);
    let (half_u, half_v) = (0.5 * (a.end - a.start) * first, 0.5 * (b.end - b.start) * second);
    let center = at * DVec3::AXES[axis] + middle(a) * first + middle(b) * second;
    let inward = DVec3::splat(0.5) - center;
    let faces_in = half_u.cross(half_v).dot(inward) > 0.0;
    let (half_u, half_v) = if faces_in { (half_u, half_v) } else { (half_v, half_u) };
    Rectangle { center, half_u, half_v }
}

impl Block {
    /// The faces that show, their fronts outside.
    fn faces(&self) -> Vec<Surface> {
        let on_floor = |p: [f64; 2]| DVec3::new(p[0], 0.0, p[1]) / 555.0;
        let (corner, u, v) = (on_floor(self.corner), on_floor(self.u), on_floor(self.v));
        let up = DVec3::Y * (self.height / 555.0);
        let middle = corner + 0.5 * (u + v + up);
        let white = |shape| Surface::new(shape, Material::lambert(WHITE, Rgb::ZERO));
        let side = |center: DVec3, along: DVec3| {
            let (a, b) = (0.5 * along, 0.5 * up);
            let out = a.cross(b).dot(center - middle) > 0.0;
            let (half_u, half_v) = if out { (a, b) } else { (b, a) };
            white(Shape::Rectangle(Rectangle { center, half_u, half_v }))
        };
        // the footprint is a parallelogram: its corners are not quite right angles
        let top = corner + up;
        vec![
            white(Shape::Triangle(Triangle { a: top, b: top + u, c: top + u + v })),
            white(Shape::Triangle(Triangle { a: top, b: top + u + v, c: top + v })),
            side(middle - 0.5 * u, v),
            side(middle + 0.5 * u, v),
            side(middle - 0.5 * v, u),
            side(middle + 0.5 * v, u),
        ]
    }
}
