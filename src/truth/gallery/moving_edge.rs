//! The edge of a light that moves across a pixel while the shutter is open.

use super::props::{Frame, LE, TILTED, half_plane};
use super::{Exhibit, Parameter, Series, Theory, covered, nothing_missed};
use crate::scene::library::Primitive;
use crate::truth::optics::motion::edge_moving;

/// Where the edge is when the shutter opens, in pixels from the middle.
const FROM: f64 = -0.7;

/// One pixel during an exposure.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "moving_edge",
    about: "A pixel while the edge of a light moves across it, by `way` pixels",
    parameter: Parameter { name: "way", usual: 0.9, range: 0.0..=5.0 },
    setting: |way| {
        let frame = Frame { lens: None };
        let edge = half_plane([1.0, 0.0], FROM * frame.pixel());
        frame.shows(Primitive { velocity: TILTED.along(way * frame.pixel(), 0.0, 0.0), ..edge })
    },
    theory: Theory::Series {
        mean: |way| Series::finite(vec![LE * edge_moving(1.0, FROM, FROM + way)]),
        missed: nothing_missed,
        variance: |way, _| Some(covered(LE, edge_moving(1.0, FROM, FROM + way))),
    },
};
