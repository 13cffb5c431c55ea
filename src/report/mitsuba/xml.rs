//! As much of XML as a scene file needs.

use glam::{DMat4, DVec3};
use std::fmt::{self, Display, Formatter};

/// An element with its attributes, in order, and what it contains.
pub struct Element {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    /// `<tag />`
    pub fn new(tag: &'static str) -> Self {
        Element { tag, attributes: Vec::new(), children: Vec::new() }
    }

    /// `<tag type="kind" />`: a sensor, an emitter, a shape of this kind.
    pub fn plugin(tag: &'static str, kind: &str) -> Self {
        Element::new(tag).attribute("type", kind)
    }

    /// The same with one more attribute.
    pub fn attribute(mut self, name: &'static str, value: impl Display) -> Self {
        self.attributes.push((name, value.to_string()));
        self
    }

    /// The same with one more element inside.
    pub fn with(mut self, child: Element) -> Self {
        self.children.push(child);
        self
    }

    /// The same with these elements inside as well.
    pub fn with_all(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }

    /// The same with a property `<tag name="name" value="value" />`.
    pub fn set(self, tag: &'static str, name: &str, value: impl Display) -> Self {
        self.with(Element::new(tag).attribute("name", name).attribute("value", value))
    }

    /// The same with a number, in the shortest digits that read back to it.
    pub fn number(self, name: &str, value: f64) -> Self {
        self.set("float", name, format_args!("{value:?}"))
    }

    /// The same with a `point`, a `vector` or a colour `rgb`.
    pub fn triple(self, tag: &'static str, name: &str, value: DVec3) -> Self {
        self.set(tag, name, numbers(&value.to_array()))
    }

    /// The same with the transform that takes the unit vectors to `columns` and the origin to `origin`.
    pub fn placed(self, columns: [DVec3; 3], origin: DVec3) -> Self {
        let [x, y, z] = columns.map(|c| c.extend(0.0));
        // by rows
        let rows = DMat4::from_cols(x, y, z, origin.extend(1.0)).transpose().to_cols_array();
        let matrix = Element::new("matrix").attribute("value", numbers(&rows));
        self.with(Element::new("transform").attribute("name", "to_world").with(matrix))
    }

    fn write(&self, f: &mut Formatter<'_>, depth: usize) -> fmt::Result {
        write!(f, "{:1$}<{2}", "", 2 * depth, self.tag)?;
        for (name, value) in &self.attributes {
            write!(f, " {name}=\"{}\"", escaped(value))?;
        }
        if self.children.is_empty() {
            return writeln!(f, "/>");
        }
        writeln!(f, ">")?;
        self.children.iter().try_for_each(|child| child.write(f, depth + 1))?;
        writeln!(f, "{:1$}</{2}>", "", 2 * depth, self.tag)
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.write(f, 0)
    }
}

/// Numbers in the shortest digits that read back to them, with spaces between.
pub fn numbers(values: &[f64]) -> String {
    let digits: Vec<String> = values.iter().map(|v| format!("{v:?}")).collect();
    digits.join(" ")
}

/// The text as it stands between quotation marks.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c => safe.push(c),
        }
    }
    safe
}
