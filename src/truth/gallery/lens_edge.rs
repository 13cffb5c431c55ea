//! The edge of a light, out of focus: a thin lens blurs it, and a pixel averages that.

use super::props::{DISTANCE, Frame, LE, half_plane};
use super::{Exhibit, Parameter, Series, Theory, covered, nothing_missed};
use crate::scene::camera::Lens;
use crate::truth::optics::exposure::{blur, edge_through_lens_and_pixel};

const APERTURE: f64 = 0.3;
/// Where the edge is, in pixels from the middle.
const EDGE: f64 = 0.35;

/// One pixel on a blurred edge.
pub const EXHIBIT: Exhibit = Exhibit {
    name: "lens_edge",
    about: "A pixel on the edge of a light through a thin lens that is focused at another distance, `focus`",
    parameter: Parameter { name: "focus", usual: 1.1, range: 0.3..=10.0 },
    setting: |focus| {
        let frame = Frame { lens: Some(Lens { radius: APERTURE, focus }) };
        frame.shows(half_plane([1.0, 0.0], EDGE * frame.pixel()))
    },
    theory: Theory::Series {
        mean: |focus| Series::finite(vec![LE * coverage(focus)]),
        missed: nothing_missed,
        variance: |focus, _| Some(covered(LE, coverage(focus))),
    },
};

fn coverage(focus: f64) -> f64 {
    let disc = blur(&Lens { radius: APERTURE, focus }, DISTANCE);
    let pixel = Frame { lens: None }.pixel();
    edge_through_lens_and_pixel(EDGE * pixel, disc, pixel)
}
