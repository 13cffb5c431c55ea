//! What makes the page look and answer: font, styles and scripts, all of them inside the file.

use crate::report::figure;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Style sheets in their order.
const STYLES: [&str; 5] = [
    include_str!("style/page.css"),
    include_str!("style/tables.css"),
    include_str!("style/plots.css"),
    include_str!("style/viewer.css"),
    include_str!("style/print.css"),
];

/// Scripts in their order; each one defines functions and nothing else, the last one calls them.
const SCRIPTS: [&str; 17] = [
    include_str!("script/data.js"),
    include_str!("script/scale.js"),
    include_str!("script/chart.js"),
    include_str!("script/series.js"),
    include_str!("script/figure.js"),
    include_str!("script/table.js"),
    include_str!("script/details.js"),
    include_str!("script/costs.js"),
    include_str!("script/page.js"),
    include_str!("script/viewer_data.js"),
    include_str!("script/viewer_colours.js"),
    include_str!("script/viewer_fields.js"),
    include_str!("script/viewer_draw.js"),
    include_str!("script/viewer_input.js"),
    include_str!("script/viewer_controls.js"),
    include_str!("script/viewer.js"),
    include_str!("script/main.js"),
];

/// The style sheet of a page, with the font of its figures.
pub fn style() -> String {
    let font = STANDARD.encode(figure::WOFF2);
    format!(
        "@font-face{{font-family:'Furnace Sans';src:url(data:font/woff2;base64,{font}) format('woff2')}}\n{}",
        STYLES.concat()
    )
}

/// The script of a page, whose names are its own.
pub fn script() -> String {
    format!("\"use strict\";(() => {{\n{}}})();", SCRIPTS.concat())
}
