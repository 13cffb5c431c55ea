//! Mistakes in how two techniques are weighted.

use crate::faults::slip::Weighting;
use crate::faults::{Effect, Fault, Slip};

/// All of them.
pub const FAULTS: &[Fault] = &[
    Fault {
        name: "mis_density_scaled",
        about: "one of the two places that weight techniques has 0.93 of the density of directions",
        seen: "three-gpu-pathtracer#847",
        number: "M27, models 10",
        slip: Slip::Weighting(Weighting::Scaled),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "mis_of_point_light",
        about: "a light without extent is weighted as if a direction could find it",
        seen: "vk_gltf_renderer#38; bevy#21967; mitsuba3 b713e9e2",
        number: "M28",
        slip: Slip::Weighting(Weighting::PointShared),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "mis_measures_mixed_once",
        about: "where lights are sampled, a density per area stands among those per solid angle",
        seen: "bevy#24671; tungsten 597617a, 7c0dacb",
        number: "M30, models 9",
        slip: Slip::Weighting(Weighting::PerAreaOnce),
        effect: Effect::Mean,
        printed: false,
    },
    Fault {
        name: "mis_measures_mixed",
        about: "a density per area stands among those per solid angle in both places: weights still sum to 1",
        seen: "bevy#24671; tungsten 597617a, 7c0dacb",
        number: "M30, models 9",
        slip: Slip::Weighting(Weighting::PerArea),
        effect: Effect::Spread,
        printed: false,
    },
    Fault {
        name: "mis_roulette_once",
        about: "where lights are hit, the density of directions contains the probability of survival",
        seen: "SeeSharp PathTracer.cs, line 402",
        number: "models 4",
        slip: Slip::Weighting(Weighting::RouletteOnce),
        effect: Effect::Mean,
        printed: false,
    },
];
