//! Mistakes in emission.

use crate::faults::slip::Emission;
use crate::faults::{Effect, Fault, Slip};

/// All of them.
pub const FAULTS: &[Fault] = &[
    Fault {
        name: "emission_counted_twice",
        about: "emission is added in full where it is hit although lights are sampled too",
        seen: "lecture, slide \"Split the Integral\": L_e + L_d + L_ind whose L(x') contains L_e again; xash3d-fwgs#51",
        number: "M5, A-4",
        slip: Slip::Emission(Emission::Twice),
        effect: Effect::Mean,
        printed: true,
    },
    Fault {
        name: "emission_not_at_camera",
        about: "emission that the camera sees directly is left out",
        seen: "lecture, slide \"Explicit Path Tracing w/ Russian Roulette\": no x.Le in it",
        number: "M6",
        slip: Slip::Emission(Emission::NotAtCamera),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "emission_not_after_mirror",
        about: "where lights are sampled, emission seen in a mirror or through glass is left out",
        seen: "lecture, slide \"Explicit Path Tracing w/ Russian Roulette\": no hit adds emission; pbrt-v4 cdccb71c",
        number: "M6, A-16",
        slip: Slip::Emission(Emission::NotAfterMirror),
        effect: Effect::Mean,
        printed: true,
    },
    Fault {
        name: "emission_never_added",
        about: "no hit adds emission, not even the camera's",
        seen: "lecture, slide \"Explicit Path Tracing w/ Russian Roulette\": no x.Le in it",
        number: "A-8",
        slip: Slip::Emission(Emission::Never),
        effect: Effect::Mean,
        printed: true,
    },
    Fault {
        name: "emission_without_throughput",
        about: "emission is added without the path's throughput",
        seen: "tungsten 0015df3",
        number: "M32",
        slip: Slip::Emission(Emission::WithoutThroughput),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "emission_judged_at_first_hit",
        about: "whether an emitter seen in a mirror shows its front is judged with the first hit's normal",
        seen: "tray_rust integrator/path.rs, line 73",
        number: "models 3",
        slip: Slip::Emission(Emission::SeenFromFirst),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "emitters_do_not_reflect",
        about: "a path ends at the first emitter, which then reflects nothing",
        seen: "lecture, slide \"Implicit Path-tracing\": if( x.Le != 0 ) return x.Le",
        number: "A-1",
        slip: Slip::Emission(Emission::Ends),
        effect: Effect::Mean,
        printed: true,
    },
];
