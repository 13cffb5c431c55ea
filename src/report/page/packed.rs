//! Data inside a page: compressed, and in letters that mean nothing to HTML, so that no name can break out of them.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use maud::{Markup, html};
use std::io::Write;

/// A block of bytes that the page's script `unpack(id)` gives back.
pub fn bytes(id: &str, bytes: &[u8]) -> Markup {
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
    let packed = zlib.write_all(bytes).and_then(|()| zlib.finish()).expect("a Vec takes all");
    html! { script type="application/octet-stream" id=(id) { (STANDARD.encode(packed)) } }
}

/// A value that the page's script `unpackJson(id)` gives back.
pub fn json(id: &str, value: &serde_json::Value) -> Markup {
    bytes(id, value.to_string().as_bytes())
}
