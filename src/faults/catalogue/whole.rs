//! Mistakes in the whole of an estimate.

use crate::faults::slip::{Averaging, Density, Streams};
use crate::faults::{Effect, Fault, Slip};

/// All of them.
pub const FAULTS: &[Fault] = &[
    Fault {
        name: "fireflies_clamped",
        about: "no path is brighter than 4",
        seen: "smallpt; rpt renderer.rs, lines 165 to 167; three-gpu-pathtracer#825",
        number: "M41, models 7",
        slip: Slip::Averaging(Averaging::Clamped),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "stops_when_it_looks_right",
        about: "a realization is the mean of 4 to 64 paths, as soon as they seem to agree",
        seen: "Kirk & Arvo 1991 on adaptive sampling",
        number: "M44",
        slip: Slip::Averaging(Averaging::Adaptive),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "blocks_share_a_seed",
        about: "each 4096 realizations draw the same numbers again",
        seen: "SORT#35; smallpt",
        number: "M35, models 12",
        slip: Slip::Streams(Streams::Shared),
        effect: Effect::Streams,
        printed: false,
    },
    Fault {
        name: "stream_repeats",
        about: "realizations repeat after 65,536",
        seen: "pbrt-v4 7098c7e7",
        number: "M37",
        slip: Slip::Streams(Streams::Wraps),
        effect: Effect::Streams,
        printed: false,
    },
    Fault {
        name: "final_algorithm_as_printed",
        about: "the lecture's last path tracer to the letter: roulette as printed, and no emission",
        seen: "lecture, slide \"Explicit Path Tracing w/ Russian Roulette\"",
        number: "A-7, A-8",
        slip: Slip::Printed,
        effect: Effect::Mean,
        printed: true,
    },
    Fault {
        name: "photon_density",
        about: "no mistake inside a sphere: one photon and the light that it leaves nearby",
        seen: "lecture, slide \"Photon Mapping\", put right",
        number: "",
        slip: Slip::Density(Density::Sound),
        effect: Effect::Equivalent,
        printed: false,
    },
    Fault {
        name: "photon_cosine_twice",
        about: "a cosine that the density of photons contains already",
        seen: "lecture, slide \"Photon Mapping\": f_r cos theta_p; RTProgressivePhotonMapper#1",
        number: "A-18, M45",
        slip: Slip::Density(Density::Cosine),
        effect: Effect::Mean,
        printed: true,
    },
    Fault {
        name: "photon_without_emission",
        about: "what the point itself emits is left out",
        seen: "lecture, slide \"Photon Mapping\": no L_e",
        number: "A-19",
        slip: Slip::Density(Density::NoEmission),
        effect: Effect::Mean,
        printed: true,
    },
    Fault {
        name: "photon_per_stored",
        about: "the power of photons is divided by how many were stored, not sent",
        seen: "lecture, slide \"Photon Mapping\": the sum is over N photons and says not which",
        number: "A-20, M46",
        slip: Slip::Density(Density::ByStored),
        effect: Effect::Mean,
        printed: true,
    },
];
