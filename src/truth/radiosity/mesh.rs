//! The six walls of the unit cube, rectangles on them, and tensor-product meshes that respect the rectangles' edges.

use glam::DVec3;
use std::ops::Range;

/// A face of the unit cube: all points whose coordinate `normal` (0 = x, 1 = y, 2 = z) equals `position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Index of the coordinate that is constant.
    pub normal: usize,
    /// Its value, 0 or 1 m.
    pub position: f64,
}

/// Floor, ceiling, x = 0, x = 1, back (z = 1), front (z = 0): the order of all per-wall arrays.
pub const WALLS: [Wall; 6] = [
    Wall { normal: 1, position: 0.0 },
    Wall { normal: 1, position: 1.0 },
    Wall { normal: 0, position: 0.0 },
    Wall { normal: 0, position: 1.0 },
    Wall { normal: 2, position: 1.0 },
    Wall { normal: 2, position: 0.0 },
];

impl Wall {
    /// The two coordinates that vary on the wall, ascending: all rectangles and meshes use this order.
    pub fn axes(self) -> [usize; 2] {
        match self.normal {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        }
    }

    /// The point with wall coordinates `s`, `t` in m.
    pub fn point(self, s: f64, t: f64) -> DVec3 {
        let mut point = DVec3::splat(self.position);
        let [first, second] = self.axes();
        point[first] = s;
        point[second] = t;
        point
    }
}

/// A rectangle on a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Index into [`WALLS`].
    pub wall: usize,
    /// Lower and upper bound of each of the two coordinates of [`Wall::axes`], within 0..1 in m.
    pub range: [[f64; 2]; 2],
}

impl Rect {
    /// Area [m^2].
    pub fn area(&self) -> f64 {
        self.range.iter().map(|[low, high]| high - low).product()
    }
}

/// Longest segment of the coarsest mesh in m, roughly.
pub(crate) const SPACING: f64 = 0.25;

/// Tensor-product mesh of one wall. Element (i, j) has index i * (segments of the second axis) + j.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Index into [`WALLS`].
    pub wall: usize,
    /// Ascending mesh lines of the two coordinates of [`Wall::axes`] in m.
    pub nodes: [Vec<f64>; 2],
}

impl Grid {
    /// Mesh of a whole wall, every segment of the coarsest mesh cut in `m`. Lines are drawn at the edges of `panel` if it
    /// lies on this wall, and at those of all `tiles` on whatever wall: meshes that do not match along an edge of the
    /// cube spoil the error expansion, for there one wall's radiance is a copy of the other's, steps and all.
    pub fn new(wall: usize, tiles: &[Rect], panel: &Rect, m: usize) -> Self {
        let nodes = WALLS[wall].axes().map(|axis| {
            let mut breaks = vec![0.0, 1.0];
            for rect in tiles.iter().chain((panel.wall == wall).then_some(panel)) {
                let axes = WALLS[rect.wall].axes();
                breaks.extend((0..2).filter(|&k| axes[k] == axis).flat_map(|k| rect.range[k]));
            }
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
            if breaks.len() == 2 {
                breaks.insert(1, 0.5); // both ends are graded
            }
            subdivide(&breaks, m)
        });
        Grid { wall, nodes }
    }

    /// Numbers of segments along the two axes.
    pub fn shape(&self) -> [usize; 2] {
        [self.nodes[0].len() - 1, self.nodes[1].len() - 1]
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.shape().iter().product()
    }

    /// Areas of all elements [m^2].
    pub fn areas(&self) -> impl Iterator<Item = f64> {
        let [first, second] = &self.nodes;
        first.windows(2).flat_map(move |s| second.windows(2).map(move |t| (s[1] - s[0]) * (t[1] - t[0])))
    }

    /// Indices of the elements inside `rect`, a rectangle on this wall that was given to [`Grid::new`].
    pub fn inside(&self, rect: &Rect) -> impl Iterator<Item = usize> + use<> {
        let span = |axis: usize| -> Range<usize> {
            let index = |bound: f64| self.nodes[axis].partition_point(|&node| node < bound);
            index(rect.range[axis][0])..index(rect.range[axis][1])
        };
        let (rows, columns, stride) = (span(0), span(1), self.shape()[1]);
        rows.flat_map(move |i| columns.clone().map(move |j| i * stride + j))
    }
}

/// Mesh lines from `breaks`. Radiance has unbounded derivatives at the cube's edges; quadratic grading of the first and
/// the last interval makes the error there of the same order as elsewhere.
fn subdivide(breaks: &[f64], m: usize) -> Vec<f64> {
    let last = breaks.len() - 2;
    let mut nodes = Vec::new();
    for (k, interval) in breaks.windows(2).enumerate() {
        let (start, length) = (interval[0], interval[1] - interval[0]);
        // a graded interval's longest segment is nearly twice the mean
        let stretch = if k == 0 || k == last { 2.0 } else { 1.0 };
        let count = m * (stretch * length / SPACING).ceil() as usize;
        for i in 0..count {
            let t = i as f64 / count as f64;
            let graded = match k {
                0 => t * t,
                _ if k == last => t * (2.0 - t),
                _ => t,
            };
            nodes.push(start + length * graded);
        }
    }
    nodes.push(breaks[last + 1]);
    nodes
}
