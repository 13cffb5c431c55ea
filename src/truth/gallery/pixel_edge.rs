//! A pixel across the slanted edge of a light: its box filter makes it the part of the pixel that the light covers.

use super::props::{Frame, LE, half_plane};
use super::{Exhibit, Parameter, Series, Theory, covered, nothing_missed};
use crate::truth::optics::exposure::Edge;

/// One pixel on an edge.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "pixel_edge",
    about: "A pixel that the slanted edge of a light crosses at `distance` pixels from its middle",
    parameter: Parameter { name: "distance", usual: 0.2, range: -1.0..=1.0 },
    setting: |distance| {
        let frame = Frame { lens: None };
        frame.shows(half_plane([0.8, 0.6], distance * frame.pixel()))
    },
    theory: Theory::Series {
        mean: |distance| Series::finite(vec![LE * coverage(distance)]),
        missed: nothing_missed,
        variance: |distance, _| Some(covered(LE, coverage(distance))),
    },
};

fn coverage(distance: f64) -> f64 {
    Edge::new(libm::atan2(0.6, 0.8), distance).coverage()
}
