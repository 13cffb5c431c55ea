//! What axes are called, with units.

use super::figure::Axis;
use crate::experiment::CellPlan;
use crate::experiment::spec::Quantity;
use crate::scene::library::SceneKind;

/// A quantity's name.
pub fn title(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Bias => "Bias",
        Quantity::Variance => "Variance",
        Quantity::Cost => "Cost",
        Quantity::Efficiency => "Efficiency",
        Quantity::Zeros => "Paths that return zero",
        Quantity::Added => "What the last bounce adds",
        Quantity::Mse => "Mean squared error",
    }
}

/// A quantity's axis.
pub fn of_quantity(quantity: Quantity) -> Axis {
    match quantity {
        Quantity::Bias => Axis::linear("bias / truth  [%]"),
        Quantity::Variance => Axis::log("variance of one sample  [(W m⁻² sr⁻¹)²]"),
        Quantity::Cost => Axis::log("rays a sample"),
        Quantity::Efficiency => Axis::log("1 / (variance × rays)  [(W m⁻² sr⁻¹)⁻²]"),
        Quantity::Zeros => Axis::linear("share of paths  [%]"),
        Quantity::Added => Axis::log("last bounce / right total  [%]"),
        Quantity::Mse => Axis::log("(bias² + variance of one sample) / truth²"),
    }
}

/// The axis of a swept parameter of this cell.
pub fn of_parameter(cell: &CellPlan, parameter: &str, log: bool) -> Axis {
    let label = meaning(&cell.scene, parameter).map_or_else(|| parameter.to_owned(), str::to_owned);
    match parameter {
        "q" => Axis::linear(&label).within(0.0, 1.0),
        _ if log => Axis::log(&label),
        _ => Axis::linear(&label),
    }
}

/// What a parameter is in a scene, with its unit; lengths without a unit are in that of the scene.
fn meaning(scene: &SceneKind, parameter: &str) -> Option<&'static str> {
    let exhibit = match scene {
        SceneKind::Exhibit { name, .. } => name.as_str(),
        _ => "",
    };
    Some(match (exhibit, parameter) {
        (_, "q") => "survival probability q",
        (_, "k") => "k: photons gathered",
        (_, "photons") => "photons sent for a map",
        ("", "radius") => "radius of the gather",
        (_, "light_fraction") => "light_fraction: light's share of the sphere",
        (_, "reflectance") => "reflectance of the mirror",
        (_, "light") => "half the edge of the light  [m]",
        (_, "aperture") => "radius of the lens  [m]",
        (_, "travel") => "way during the exposure  [m]",
        (_, "ior") => "index of refraction",
        ("disk_light" | "unequal_lights", "radius") => "radius of the light  [m]",
        ("concentric_spheres", "radius") => "radius of the ball / radius of the sphere",
        ("dome", "fraction") => "fraction of a whole sphere",
        ("parallel_plates", "albedo") => "albedo of the lower plate",
        ("point_in_sphere" | "point_near_wall", "offset") => "offset of the light / radius of the sphere",
        ("pixel_edge", "distance") => "distance of the edge from the pixel's middle  [pixels]",
        ("pool_caustic", "distance") => "distance from under the light  [m]",
        ("lens_edge", "focus") => "focus: distance in focus  [m]",
        ("moving_edge", "way") => "way of the edge during the exposure  [pixels]",
        ("rising_light", "way") => "way of the light during the exposure  [m]",
        ("hidden_light", "edge") => "edge of the plate  [m]",
        ("turned_light", "radius") => "radius of the turned light  [m]",
        ("sphere_light", "height") => "height of the ball's middle over the horizon  [m]",
        ("polygon_light" | "point_over_plane", "height") => "height of the light  [m]",
        _ => return None,
    })
}
