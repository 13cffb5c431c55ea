//! Pictures, in a viewer that the scripts `viewer*.js` make of the data here.

use super::packed;
use crate::report::difference::FULL;
use crate::report::lookup::Lookup;
use crate::report::pictures::{self, MAP, Picture};
use crate::report::raster::Raster;
use crate::report::tilemap::{self, RATE};
use maud::{Markup, html};
use serde_json::{Value, json};

/// All pictures; nothing where there are none.
pub fn section(lookup: &Lookup<'_>, pictures: &[Picture]) -> Markup {
    html! {
        @if !pictures.is_empty() {
            section #images {
                h2 { "Images" }
                (explanation(pictures))
                div #viewer {}
                noscript { (files(lookup, pictures)) }
                (data(lookup, pictures))
            }
        }
    }
}

fn explanation(pictures: &[Picture]) -> Markup {
    html! {
        p {
            "Same exposure for all pictures, here and in the PNG files; the EXR files hold mean, variance, samples and bias "
            "against the reference. Values under the pointer are those of the EXR files, their standard errors to 3 %."
        }
        @if pictures.iter().any(|picture| picture.reference.is_some()) {
            p {
                "Differences in standard errors are those of the picture and of the reference together, pixel by pixel or, "
                "where the reference is coarser, block by block: white is none, blue means too dark by " (FULL) " standard "
                "errors or more, orange too bright. Noise alone colours one block of 16,000 fully in each channel, more where few paths "
                "find light: there the standard error is itself not well known, and most often too small. The files that "
                "end in " code { (MAP) } " show the same in blocks: red, green, and below them blue."
            }
        }
    }
}

/// For those without scripts.
fn files(lookup: &Lookup<'_>, pictures: &[Picture]) -> Markup {
    html! {
        ul { @for picture in pictures {
            li {
                (label(lookup, picture)) ": "
                a href={ (picture.name) ".png" } { "PNG" } " · " a href={ (picture.name) ".exr" } { "EXR" }
                @if picture.has_map { " · " a href={ (picture.name) (MAP) } { "difference" } }
            }
        } }
    }
}

fn label(lookup: &Lookup<'_>, picture: &Picture) -> String {
    lookup.plan.label(&lookup.plan.cells[picture.cell])
}

/// What the viewer reads: a description of all, then the pixels of each picture and of each reference.
fn data(lookup: &Lookup<'_>, pictures: &[Picture]) -> Markup {
    let mut references: Vec<&Raster> = Vec::new();
    let mut described = Vec::new();
    for picture in pictures {
        let reference = picture.reference.as_ref().map(|wanted| {
            references.iter().position(|known| *known == wanted).unwrap_or_else(|| {
                references.push(wanted);
                references.len() - 1
            })
        });
        described.push(described_as(lookup, picture, reference));
    }
    let size = |r: &&Raster| json!({ "width": r.width, "height": r.height });
    let all = json!({
        "exposure": pictures::exposure(pictures),
        "full": FULL,
        "rate": RATE,
        "map": MAP,
        "pictures": described,
        "references": references.iter().map(size).collect::<Vec<_>>(),
    });
    html! {
        (packed::json("viewer-data", &all))
        @for (i, picture) in pictures.iter().enumerate() {
            (packed::bytes(&format!("viewer-picture-{i}"), &picture.raster.packed()))
        }
        @for (i, reference) in references.iter().enumerate() {
            (packed::bytes(&format!("viewer-reference-{i}"), &reference.packed()))
        }
    }
}

fn described_as(lookup: &Lookup<'_>, picture: &Picture, reference: Option<usize>) -> Value {
    let cell = &lookup.plan.cells[picture.cell];
    json!({
        "short": format!("{} {}", cell.estimator_label, lookup.plan.rule_label(cell)),
        "scene": cell.scene_label,
        "name": picture.name,
        "width": picture.raster.width,
        "height": picture.raster.height,
        "samples": picture.raster.samples,
        "paired": cell.paired,
        "map": picture.has_map,
        "reference": reference,
        "tiles": tiles(lookup, picture.cell),
    })
}

/// The deviation of each tile and channel in standard errors, and whether it is told to be wrong; nothing where no tile
/// has a right value. JSON knows no infinity, so numbers go as text.
fn tiles(lookup: &Lookup<'_>, cell: usize) -> Option<Value> {
    let map = tilemap::of(lookup, cell)?;
    let z: Vec<[String; 3]> = map.tiles.iter().map(|tile| tile.map(|t| number(t.z))).collect();
    let wrong: Vec<[bool; 3]> = map.tiles.iter().map(|tile| tile.map(|t| t.is_wrong)).collect();
    Some(json!({ "z": z, "wrong": wrong, "claimed": map.is_claimed, "words": map.words() }))
}

/// As scripts read it.
fn number(z: f64) -> String {
    if z.is_infinite() {
        if z > 0.0 { "Infinity" } else { "-Infinity" }.to_owned()
    } else {
        format!("{z:.3}")
    }
}
