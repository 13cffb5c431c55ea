//! Keys and mouse.

use super::Page;
use serde_json::json;

/// Shift, in the protocol's set of modifiers.
const SHIFT: u32 = 8;

impl Page {
    /// Presses and releases a key: a single character, or a name such as "Tab", "Enter", "ArrowLeft", "Escape"; with
    /// "Shift+" before it held with shift.
    pub fn press(&self, key: &str) {
        let (modifiers, name) = key.strip_prefix("Shift+").map_or((0, key), |name| (SHIFT, name));
        let (number, text) = match name {
            "Backspace" => (8, None),
            "Tab" => (9, None),
            "Enter" => (13, Some("\r")),
            "Escape" => (27, None),
            "PageUp" => (33, None),
            "PageDown" => (34, None),
            "End" => (35, None),
            "Home" => (36, None),
            "ArrowLeft" => (37, None),
            "ArrowUp" => (38, None),
            "ArrowRight" => (39, None),
            "ArrowDown" => (40, None),
            "Delete" => (46, None),
            _ => {
                assert_eq!(name.chars().count(), 1, "no such key: {name}");
                (name.to_uppercase().chars().next().map_or(0, u32::from), Some(name))
            }
        };
        let first = name.chars().next().unwrap();
        let code = match first {
            ' ' => "Space".to_owned(),
            _ if name.len() > 1 => name.to_owned(),
            '0'..='9' => format!("Digit{name}"),
            'a'..='z' | 'A'..='Z' => format!("Key{}", name.to_uppercase()),
            _ => String::new(),
        };
        let mut event = json!({ "type": if text.is_some() { "keyDown" } else { "rawKeyDown" }, "key": name,
            "code": code, "windowsVirtualKeyCode": number, "modifiers": modifiers });
        if let Some(text) = text {
            event["text"] = json!(text);
        }
        self.call("Input.dispatchKeyEvent", event.clone());
        event["type"] = json!("keyUp");
        self.call("Input.dispatchKeyEvent", event);
    }

    /// Types text into what has the focus.
    pub fn write(&self, text: &str) {
        for letter in text.chars() {
            self.press(&letter.to_string());
        }
    }

    /// Clicks into the middle of the first element that matches, which must be there and not covered.
    pub fn click(&self, selector: &str) {
        let (x, y) = self.middle(selector);
        self.mouse("mouseMoved", x, y, "none");
        self.mouse("mousePressed", x, y, "left");
        self.mouse("mouseReleased", x, y, "left");
    }

    /// Moves the mouse over a place of what is seen, in CSS pixels from its top left.
    pub fn hover(&self, x: f64, y: f64) {
        self.mouse("mouseMoved", x, y, "none");
    }

    /// Presses at one place, moves to another, and lets go.
    pub fn drag(&self, from: (f64, f64), to: (f64, f64)) {
        self.mouse("mouseMoved", from.0, from.1, "none");
        self.mouse("mousePressed", from.0, from.1, "left");
        self.mouse("mouseMoved", (from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0, "left");
        self.mouse("mouseMoved", to.0, to.1, "left");
        self.mouse("mouseReleased", to.0, to.1, "left");
    }

    /// Turns the wheel over a place; positive is towards the reader, which scrolls down.
    pub fn wheel(&self, x: f64, y: f64, turn: f64) {
        let event = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": turn });
        self.call("Input.dispatchMouseEvent", event);
    }

    /// The middle of the first element that matches, scrolled into sight.
    pub fn middle(&self, selector: &str) -> (f64, f64) {
        let place = self.js(&format!(
            "(() => {{
               const found = document.querySelector({});
               if (!found) return 'there is none';
               found.scrollIntoView({{ block: 'center', inline: 'center', behavior: 'instant' }});
               const box = found.getBoundingClientRect();
               const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
               const hit = document.elementFromPoint(x, y);
               return found.contains(hit) ? [x, y] : `covered by ${{hit && hit.outerHTML.slice(0, 80)}}`;
             }})()",
            json!(selector)
        ));
        let at = |i: usize| place[i].as_f64().unwrap_or_else(|| panic!("{selector}: {place}"));
        (at(0), at(1))
    }

    fn mouse(&self, kind: &str, x: f64, y: f64, button: &str) {
        let held = u32::from(button == "left" && kind != "mouseReleased");
        let clicks = u32::from(kind != "mouseMoved");
        let event =
            json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": held, "clickCount": clicks });
        self.call("Input.dispatchMouseEvent", event);
    }
}
