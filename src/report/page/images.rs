//! Pictures, in a viewer that the scripts `viewer*.js` make of the data here.

use super::packed;
use crate::report::difference::FULL;
use crate::report::lookup::Lookup;
use crate::report::pictures::{self, MAP, Picture};
use crate::report::raster::Raster;
use crate::report::tilemap::{self, RATE};
use maud::{Markup, html};
use serde_json::{Value, json};

/// The pictures of a page take no more letters than this, so that it stays under 5 MB.
const MOST: usize = 4_200_000;

/// All pictures; nothing where there are none.
pub fn section(lookup: &Lookup<'_>, pictures: &[Picture]) -> Markup {
    let (edge, data) = fitting(pictures.iter().map(|p| (&p.raster, p.reference.as_ref())).collect());
    html! {
        @if !pictures.is_empty() {
            section #images {
                h2 { "Images" }
                (explanation(pictures, edge))
                div #viewer {}
                noscript { (files(lookup, pictures)) }
                (description(lookup, pictures, &data))
                (data.pixels)
            }
        }
    }
}

fn explanation(pictures: &[Picture], edge: usize) -> Markup {
    html! {
        @if edge > 1 {
            p.warn {
                "The page would be too large with all pixels: each one here is the mean of " (edge) " × " (edge) " of the EXR "
                "files, and so are the values under the pointer."
            }
        }
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

/// Pictures and references as the page carries them.
struct Data {
    /// Pixels of each picture from left to right and from top to bottom.
    sizes: Vec<(usize, usize)>,
    /// Which reference each picture has.
    reference_of: Vec<Option<usize>>,
    /// Those of each reference.
    reference_sizes: Vec<(usize, usize)>,
    /// The blocks that hold them.
    pixels: Markup,
}

/// The pictures in the finest means of 1, 2, 4, ... pixels along each edge that fit into the page.
fn fitting(pictures: Vec<(&Raster, Option<&Raster>)>) -> (usize, Data) {
    let mut edge = 1;
    loop {
        let data = data(&pictures, edge);
        let divides = |raster: &&Raster| [raster.width, raster.height].iter().all(|n| n % (2 * edge) == 0);
        if data.pixels.0.len() <= MOST || !pictures.iter().all(|(picture, _)| divides(picture)) {
            return (edge, data);
        }
        edge *= 2;
    }
}

fn data(pictures: &[(&Raster, Option<&Raster>)], edge: usize) -> Data {
    let size = |raster: &Raster| (raster.width, raster.height);
    let shown: Vec<Raster> = pictures.iter().map(|(picture, _)| picture.reduced(edge)).collect();
    let mut references: Vec<Raster> = Vec::new();
    let mut reference_of = Vec::new();
    for (picture, (_, reference)) in shown.iter().zip(pictures) {
        // a reference may be coarser than the picture, and is never finer
        let wanted = reference.map(|r| r.reduced(r.width.div_ceil(picture.width)));
        reference_of.push(wanted.map(|wanted| {
            references.iter().position(|known| *known == wanted).unwrap_or_else(|| {
                references.push(wanted);
                references.len() - 1
            })
        }));
    }
    let block = |kind: &str, i: usize, r: &Raster| packed::bytes(&format!("viewer-{kind}-{i}"), &r.packed());
    let pixels = html! {
        @for (i, picture) in shown.iter().enumerate() { (block("picture", i, picture)) }
        @for (i, reference) in references.iter().enumerate() { (block("reference", i, reference)) }
    };
    let (sizes, reference_sizes) = (shown.iter().map(size).collect(), references.iter().map(size).collect());
    Data { sizes, reference_of, reference_sizes, pixels }
}

/// What the viewer reads first: a description of all.
fn description(lookup: &Lookup<'_>, pictures: &[Picture], data: &Data) -> Markup {
    let size = |&(width, height): &(usize, usize)| json!({ "width": width, "height": height });
    let described = pictures.iter().zip(&data.sizes).zip(&data.reference_of);
    let described: Vec<Value> = described
        .map(|((picture, &size), &reference)| described_as(lookup, picture, size, reference))
        .collect();
    packed::json(
        "viewer-data",
        &json!({
            "exposure": pictures::exposure(pictures),
            "full": FULL,
            "rate": RATE,
            "map": MAP,
            "pictures": described,
            "references": data.reference_sizes.iter().map(size).collect::<Vec<_>>(),
        }),
    )
}

fn described_as(
    lookup: &Lookup<'_>,
    picture: &Picture,
    (width, height): (usize, usize),
    reference: Option<usize>,
) -> Value {
    let cell = &lookup.plan.cells[picture.cell];
    json!({
        "short": format!("{} {}", cell.estimator_label, lookup.plan.rule_label(cell)),
        "scene": cell.scene_label,
        "name": picture.name,
        "width": width,
        "height": height,
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise, which nothing can compress.
    fn noise(edge: usize) -> Raster {
        let mut state = 1_u32;
        let mut values = || {
            let mut next = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                1.0 + (state >> 9) as f32 / 8_388_608.0
            };
            (0..edge * edge).map(|_| next()).collect::<Vec<f32>>()
        };
        let mean = [values(), values(), values()];
        Raster { width: edge, height: edge, std_error: mean.clone(), mean, samples: 4 }
    }

    #[test]
    fn what_fits_is_carried_pixel_by_pixel_and_the_rest_in_means() {
        let (small, large) = (noise(64), noise(512));
        let (edge, data) = fitting(vec![(&small, None)]);
        assert_eq!((edge, &data.sizes[..]), (1, &[(64, 64)][..]));
        let (edge, data) = fitting(vec![(&large, Some(&large)), (&large, Some(&small)), (&small, None)]);
        assert_eq!((edge, &data.sizes[..]), (2, &[(256, 256), (256, 256), (32, 32)][..]));
        // a reference is no finer than its picture
        assert_eq!(data.reference_sizes, [(256, 256), (64, 64)]);
        assert_eq!(data.reference_of, [Some(0), Some(1), None]);
        assert!(data.pixels.0.len() <= MOST);
    }
}
