//! The Neumann series on one mesh: radiance of every element, bounce by bounce.

use super::exchange::{Exchange, Field};
use super::mesh::Grid;
use super::{BOUNCES, Room, Surface, tiles};
use std::ops::Range;

/// Relative uncertainty allowed in the sum of the bounces from the last one on.
const TAIL: f64 = 1e-11;

/// Bounces after which the series counts as divergent: closed rooms up to an albedo of about 0.99 get by with fewer.
const LONGEST: usize = 2000;

/// Piecewise constant Galerkin discretisation of a room.
pub(crate) struct Discrete {
    grids: Vec<Grid>,
    /// Position of each grid's elements among all elements.
    ranges: Vec<Range<usize>>,
    /// Each pair of grids once.
    tables: Vec<(usize, usize, Exchange)>,
    /// Per element [m^2].
    areas: Vec<f64>,
    albedo: Field,
    /// Per element [W m^-2 sr^-1].
    emission: Field,
}

impl Discrete {
    /// Walls that are black and dark are left out: nothing comes from them.
    pub fn new(room: &Room, m: usize) -> Self {
        let active = (0..6).filter(|&wall| room.is_active(wall));
        let grids: Vec<Grid> = active.map(|wall| Grid::new(wall, &tiles(), &room.panel, m)).collect();
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for grid in &grids {
            let start = ranges.last().map_or(0, |range| range.end);
            ranges.push(start..start + grid.len());
        }
        let pairs = (0..grids.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let tables = pairs.map(|(a, b)| (a, b, Exchange::new(&grids[a], &grids[b]))).collect();
        let areas = grids.iter().flat_map(Grid::areas).collect();
        let albedo = surface_field(room, &grids, |surface| &surface.albedo);
        let emission = surface_field(room, &grids, |surface| &surface.emission);
        Discrete { grids, ranges, tables, areas, albedo, emission }
    }

    /// Radiance after one more bounce: albedo times the mean radiance that arrives.
    fn scatter(&self, radiance: &Field) -> Field {
        let mut result = [(); 3].map(|()| vec![0.0; self.areas.len()]);
        for (a, b, table) in &self.tables {
            let part = |grid: usize| [0, 1, 2].map(|c| &radiance[c][self.ranges[grid].clone()]);
            let (to_a, to_b) = table.products(part(*a), part(*b));
            for (grid, sums) in [(*a, to_a), (*b, to_b)] {
                for (channel, sums) in sums.iter().enumerate() {
                    let target = &mut result[channel][self.ranges[grid].clone()];
                    target.iter_mut().zip(sums).for_each(|(target, sum)| *target += sum);
                }
            }
        }
        for (channel, result) in result.iter_mut().enumerate() {
            let factors = self.albedo[channel].iter().zip(&self.areas);
            result.iter_mut().zip(factors).for_each(|(value, (albedo, area))| *value *= albedo / area);
        }
        result
    }

    /// Mean radiance of tile `tile` [W m^-2 sr^-1].
    fn mean(&self, tile: usize, radiance: &[f64]) -> f64 {
        let Some(g) = self.grids.iter().position(|grid| grid.wall == tiles()[tile].wall) else { return 0.0 };
        let elements = self.grids[g].inside(&tiles()[tile]).map(|i| self.ranges[g].start + i);
        let sum: f64 = elements.map(|i| self.areas[i] * radiance[i]).sum();
        sum / tiles()[tile].area()
    }

    /// Tile means of all bounces up to [`BOUNCES`], and their sums from each bounce on, in the order of
    /// `Solution`. `None` if the series does not converge.
    pub fn solve(&self) -> Option<Vec<f64>> {
        let mut means: Vec<Vec<f64>> = vec![Vec::new(); tiles().len() * 3];
        let mut field = self.emission.clone();
        let tails = loop {
            for (index, means) in means.iter_mut().enumerate() {
                means.push(self.mean(index / 3, &field[index % 3]));
            }
            let next = self.scatter(&field);
            let ratios = [0, 1, 2].map(|channel| ratios(&field[channel], &next[channel]));
            let count = means[0].len();
            if count > BOUNCES
                && let Some(tails) = tails(&means, ratios)
            {
                break tails;
            }
            if count > LONGEST {
                return None;
            }
            field = next;
        };
        Some(means.iter().zip(tails).flat_map(|(means, tail)| entries(means, tail)).collect())
    }
}

/// A property of the surfaces, by element.
fn surface_field(room: &Room, grids: &[Grid], property: impl Fn(&Surface) -> &[f64; 3]) -> Field {
    [0, 1, 2].map(|channel| {
        let mut field = Vec::new();
        for grid in grids {
            let start = field.len();
            field.resize(start + grid.len(), property(&room.walls[grid.wall])[channel]);
            if room.panel.wall == grid.wall {
                let panel = property(&room.panel_surface)[channel];
                grid.inside(&room.panel).for_each(|element| field[start + element] = panel);
            }
        }
        field
    })
}

/// Smallest and largest ratio of two successive bounces. The operator is positive, hence all later ratios lie between
/// them, and so does the ratio of all that follows (Collatz 1942).
fn ratios(before: &[f64], after: &[f64]) -> [f64; 2] {
    let pairs = before.iter().zip(after).filter(|(before, after)| **before != 0.0 || **after != 0.0);
    let bounds = pairs.map(|(before, after)| after / before);
    let [low, high] = bounds.fold([f64::INFINITY, 0.0], |[low, high], r| [r.min(low), r.max(high)]);
    if low > high { [0.0; 2] } else { [low, high] }
}

/// What follows the last bounce, if it is known well enough: between the sums of two geometric series.
fn tails(means: &[Vec<f64>], ratios: [[f64; 2]; 3]) -> Option<Vec<f64>> {
    let tail = |(index, means): (usize, &Vec<f64>)| {
        let [low, high] = ratios[index % 3];
        if high >= 1.0 {
            return None;
        }
        let last = means[means.len() - 1];
        let [low, high] = [low, high].map(|ratio| last * ratio / (1.0 - ratio));
        let sum: f64 = means[BOUNCES..].iter().sum();
        (high - low <= TAIL * (sum + low)).then_some(0.5 * (low + high))
    };
    means.iter().enumerate().map(tail).collect()
}

/// All bounces, then all sums from a bounce on.
fn entries(means: &[f64], tail: f64) -> Vec<f64> {
    let mut sums: Vec<f64> = Vec::new();
    let mut sum = tail;
    for mean in means.iter().rev() {
        sum += mean;
        sums.push(sum);
    }
    sums.reverse();
    sums.truncate(BOUNCES + 1);
    means[..=BOUNCES].iter().copied().chain(sums).collect()
}
