//! Pictures, side by side.

use super::Picture;
use crate::report::difference::FULL;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

/// All pictures; nothing where there are none.
pub fn section(pictures: &[Picture]) -> Markup {
    html! {
        @if !pictures.is_empty() {
            section #images { h2 { "Images" } (gallery(pictures)) }
        }
    }
}

fn gallery(pictures: &[Picture]) -> Markup {
    let data = |png: &[u8]| format!("data:image/png;base64,{}", STANDARD.encode(png));
    html! {
        p {
            "Same exposure for all pictures; the EXR files hold mean, variance, samples and bias against the reference. "
            @if pictures.iter().any(|picture| picture.map.is_some()) {
                "The maps show the signed difference from the reference in units of its standard error, block by block: "
                "red, green, and below them blue; white is none, blue means too dark by " (FULL) " standard errors or "
                "more, orange too bright. Noise alone colours one block of 16,000 fully, more where few paths find light: "
                "there the standard error is itself not well known, and most often too small."
            }
        }
        div.gallery { @for picture in pictures {
            figure {
                div {
                    img src=(data(&picture.png)) alt=(picture.label);
                    @if let Some(map) = &picture.map {
                        img src=(data(map)) alt={ "signed difference of " (picture.label) " from the reference" };
                    }
                }
                figcaption { (picture.label) " · " a href={ (picture.name) ".exr" } { "EXR" } }
            }
        } }
    }
}
