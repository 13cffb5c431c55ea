//! A disk light straight above a point of the floor.

use super::{Exhibit, Parameter, Series};

/// A point of a floor under the middle of a disk.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "disk_light",
    about: "A point of the floor under the middle of a disk light: albedo Le r² / (r² + h²).",
    parameter: Parameter { name: "radius", usual: 0.6, range: 1e-3..=100.0 },
    setting: |radius| todo!("{radius}"),
    theory: |radius| Series::finite(vec![glam::DVec3::splat(radius)]),
    variance: |_, _| None,
};
