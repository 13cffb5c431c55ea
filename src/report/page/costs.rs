//! What light costs: errors at equal samples, equal rays and equal time, and how much faster than a chosen baseline.

use crate::report::costs::Cost;
use crate::report::lookup::Lookup;
use maud::{Markup, html};
use serde_json::{Value, json};

/// Where the page's script puts its tables; nothing where there is nothing to compare.
pub fn section(lookup: &Lookup<'_>, costs: &[Cost]) -> Markup {
    html! {
        @if compared(lookup, costs).next().is_some() {
            section #costs {
                h2 { "Costs" }
                p {
                    "Relative mean squared errors at one budget, which the baseline's samples set: everybody gets as many "
                    "samples, as many rays, or as many seconds. Speed-up is the baseline's error over a cell's own: how many "
                    "times more of the budget the baseline needs. Its interval has 99.9 % and knows the errors of both "
                    "variances and nothing of bias; seconds are those of one run, whose own scatter it does not know."
                }
                @if costs.iter().any(|cost| cost.picture.is_some()) {
                    p {
                        "relMSE of a picture, as it is, on the grid of its reference: squared error over squared reference, plus 0.01 W² m⁻⁴ sr⁻², averaged "
                        "over pixels and channels, less what the reference's own noise adds (Rousselle, Knaus and Zwicker 2011). "
                        "FLIP: how different the two look when they are flipped, from 0 to 1 (HDR-FLIP, Andersson et al. 2021). "
                        a href="pictures.csv" { "pictures.csv" } " has both."
                    }
                }
                noscript { p { "This table needs JavaScript; " a href="results.csv" { "results.csv" } " has its numbers." } }
            }
        }
    }
}

/// The numbers, scene by scene; a scene with one cell has nothing to compare.
pub fn json(lookup: &Lookup<'_>, costs: &[Cost]) -> Value {
    let one = |cost: &Cost| {
        let cell = &lookup.plan.cells[cost.cell];
        json!({
            "cell": cost.cell,
            "estimator": cell.estimator_label,
            "rule": lookup.plan.rule_label(cell),
            "samples": cost.samples,
            "rays": cost.rays,
            "channels": cost.channels.iter().map(|channel| channel.as_ref().map(|error| json!({
                "noise": error.noise, "error": error.noise_error, "floor": error.floor,
            }))).collect::<Vec<_>>(),
            "measured": cost.picture.map(|metrics| json!({
                "rel_mse": metrics.rel_mse, "error": metrics.rel_mse_error, "flip": metrics.flip,
            })),
        })
    };
    let scene = |(name, costs): (&str, Vec<&Cost>)| json!({ "scene": name, "cells": costs.into_iter().map(one).collect::<Vec<_>>() });
    Value::Array(compared(lookup, costs).map(scene).collect())
}

fn compared<'a>(lookup: &Lookup<'a>, costs: &'a [Cost]) -> impl Iterator<Item = (&'a str, Vec<&'a Cost>)> {
    let cells = lookup.plan;
    let of = move |scene: &'a str| {
        let is_there = |cost: &&Cost| cells.cells[cost.cell].scene_label == scene;
        (scene, costs.iter().filter(is_there).collect::<Vec<_>>())
    };
    lookup.scenes().into_iter().map(of).filter(|(_, costs)| costs.len() > 1)
}
