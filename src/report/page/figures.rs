//! Figures: drawn by the page's script from their data, so that they answer to the pointer.

use super::Drawn;
use crate::report::figure;
use maud::{Markup, html};
use serde_json::{Value, json};

/// A place for each figure; nothing where there are none.
pub fn section(figures: &[Drawn]) -> Markup {
    html! {
        @if !figures.is_empty() {
            section #figures {
                h2 { "Figures" }
                @for drawn in figures {
                    figure.plot data-name=(drawn.name) {
                        noscript { img src={ (drawn.name) ".svg" } alt=(drawn.figure.alt); }
                    }
                }
            }
        }
    }
}

/// Their data, with the name of each one's files.
pub fn json(figures: &[Drawn]) -> Value {
    let one = |drawn: &Drawn| json!({ "name": drawn.name, "figure": figure::json(&drawn.figure) });
    Value::Array(figures.iter().map(one).collect())
}
