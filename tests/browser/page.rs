//! A page: opening it, asking it, how it is shown, what it complained of.

use super::Browser;
use super::pipe::Session;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::cell::RefCell;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// All that happens to a page happens within this, so that no test hangs.
const LIFETIME: Duration = Duration::from_secs(45);

/// What is waited for comes within this, or never.
const PATIENCE: Duration = Duration::from_secs(15);

/// One page in a browser, which shares no storage with others. What it is asked to do and cannot fails the test.
pub struct Page {
    browser: Arc<Browser>,
    session: Session,
    context: String,
    address: RefCell<String>,
    deadline: Instant,
}

impl Page {
    pub(super) fn new(browser: &Arc<Browser>) -> Self {
        let text = |value: Value| value.as_str().unwrap().to_owned();
        let context = text(browser.call("Target.createBrowserContext", json!({}))["browserContextId"].take());
        let target = json!({ "url": "about:blank", "browserContextId": context });
        let target = text(browser.call("Target.createTarget", target)["targetId"].take());
        let attach = json!({ "targetId": target, "flatten": true });
        let session = text(browser.call("Target.attachToTarget", attach)["sessionId"].take());
        let session = Session::new(&browser.pipe, &session);
        let deadline = Instant::now() + LIFETIME;
        let page =
            Page { browser: Arc::clone(browser), session, context, address: RefCell::default(), deadline };
        for domain in ["Page", "Runtime", "Log", "Network"] {
            page.call(&format!("{domain}.enable"), json!({}));
        }
        // pages side by side all take themselves for the one in front
        page.call("Emulation.setFocusEmulationEnabled", json!({ "enabled": true }));
        page.resize(1280, 800, 1.0);
        let (folder, context) = (page.downloads(), &page.context);
        let save = json!({ "behavior": "allow", "downloadPath": folder, "browserContextId": context });
        browser.call("Browser.setDownloadBehavior", save);
        page
    }

    /// Where it saves files.
    fn downloads(&self) -> PathBuf {
        self.browser.folder.path().join(&self.context)
    }

    /// Opens a file.
    pub fn load(&self, file: &Path) {
        self.address.replace(address(&fs::canonicalize(file).unwrap()));
        let answer = self.call("Page.navigate", json!({ "url": *self.address.borrow() }));
        assert!(answer["errorText"].is_null(), "{}: {answer}", self.address.borrow());
        self.wait_for("document.readyState === 'complete'");
    }

    /// Waits until the page says that all is there.
    pub fn ready(&self) {
        self.wait_for("document.body.dataset.ready");
    }

    /// Waits until an expression is true.
    pub fn wait_for(&self, expression: &str) {
        let is_true = format!("!!({expression})");
        let end = Instant::now() + PATIENCE;
        while self.js(&is_true) != true {
            assert!(
                Instant::now() < end,
                "never came true: {expression}\ncomplaints: {:?}",
                self.complaints()
            );
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// What an expression gives, as JSON; promises are awaited.
    pub fn js(&self, expression: &str) -> Value {
        let mut answer = self.call(
            "Runtime.evaluate",
            json!({ "expression": expression, "awaitPromise": true, "returnByValue": true, "userGesture": true, "replMode": true }),
        );
        let thrown = &answer["exceptionDetails"];
        assert!(thrown.is_null(), "{}\nthrew {}", shortened(expression), exception(thrown));
        answer["result"]["value"].take()
    }

    /// The text that an expression gives.
    pub fn text(&self, expression: &str) -> String {
        let value = self.js(expression);
        value.as_str().unwrap_or_else(|| panic!("{expression}: no text but {value}")).to_owned()
    }

    /// Whether the scripts of pages that are loaded from now on run.
    pub fn run_scripts(&self, run: bool) {
        self.call("Emulation.setScriptExecutionDisabled", json!({ "value": !run }));
    }

    /// Sets the size of what is seen, in CSS pixels, and device pixels per CSS pixel.
    pub fn resize(&self, width: u32, height: u32, scale: f64) {
        let metrics =
            json!({ "width": width, "height": height, "deviceScaleFactor": scale, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", metrics);
    }

    /// Shows the page as on `screen` or in `print`, to a reader who prefers `light` or `dark`.
    pub fn show_as(&self, media: &str, scheme: &str) {
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "media": media, "features": features }));
    }

    /// The whole page as a PNG, in the folder for what tests leave behind, where one may look at it; gives its bytes.
    pub fn screenshot(&self, name: &str) -> Vec<u8> {
        let size = &self.call("Page.getLayoutMetrics", json!({}))["cssContentSize"];
        let clip = json!({ "x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1 });
        let shot = json!({ "format": "png", "captureBeyondViewport": true, "clip": clip });
        let shot = self.call("Page.captureScreenshot", shot);
        let bytes = STANDARD.decode(shot["data"].as_str().unwrap()).unwrap();
        fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name).with_extension("png"), &bytes).unwrap();
        bytes
    }

    /// A file that the page offers for saving, once it is there.
    pub fn saved(&self, name: &str) -> Vec<u8> {
        let (file, end) = (self.downloads().join(name), Instant::now() + PATIENCE);
        // it has its name before it has its bytes
        while fs::metadata(&file).map_or(0, |file| file.len()) == 0 {
            assert!(Instant::now() < end, "{name} was never saved\ncomplaints: {:?}", self.complaints());
            thread::sleep(Duration::from_millis(5));
        }
        fs::read(file).unwrap()
    }

    /// What went wrong so far: exceptions nobody caught, errors and warnings that were logged.
    pub fn complaints(&self) -> Vec<String> {
        self.settle();
        let thrown = self.session.events("Runtime.exceptionThrown");
        let thrown = thrown.iter().map(|event| exception(&event["exceptionDetails"]));
        let logged = self.session.events("Runtime.consoleAPICalled").into_iter();
        let logged =
            logged.filter(|event| ["error", "warning", "assert"].iter().any(|kind| event["type"] == *kind));
        let entries =
            self.session.events("Log.entryAdded").into_iter().map(|mut event| event["entry"].take());
        let entries = entries.filter(|entry| entry["level"] == "error" || entry["level"] == "warning");
        let told = |told: &Value| format!("{told}");
        thrown
            .chain(logged.map(|event| told(&event["args"])))
            .chain(entries.map(|entry| told(&entry)))
            .collect()
    }

    /// Everything that the page has asked for but itself and what it carries along.
    pub fn requests(&self) -> Vec<String> {
        self.settle();
        let all = self.session.events("Network.requestWillBeSent").into_iter();
        let all = all.map(|event| event["request"]["url"].as_str().unwrap_or("?").to_owned());
        let own =
            |url: &str| url == *self.address.borrow() || url.starts_with("data:") || url.starts_with("blob:");
        all.filter(|url| !own(url)).collect()
    }

    /// Lets the page draw, after which what it has started is known; without its scripts, which may be switched off.
    fn settle(&self) {
        let clip = json!({ "x": 0, "y": 0, "width": 1, "height": 1, "scale": 1 });
        self.call("Page.captureScreenshot", json!({ "clip": clip }));
    }

    pub(super) fn call(&self, method: &str, params: Value) -> Value {
        self.session.call(method, params, self.deadline).unwrap_or_else(|why| panic!("{why}"))
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        let context = json!({ "browserContextId": self.context });
        let _ = self.browser.try_call("Target.disposeBrowserContext", context);
    }
}

/// The address of a file, as the browser writes it.
fn address(file: &Path) -> String {
    let mut address = "file://".to_owned();
    for &byte in file.to_str().unwrap().as_bytes() {
        if byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte) {
            address.push(char::from(byte));
        } else {
            write!(address, "%{byte:02X}").unwrap();
        }
    }
    address
}

/// What was thrown, with the place.
fn exception(details: &Value) -> String {
    let what = details["exception"]["description"].as_str().or(details["text"].as_str()).unwrap_or("?");
    format!("{what} (line {}, column {})", details["lineNumber"], details["columnNumber"])
}

fn shortened(text: &str) -> String {
    text.chars().take(200).collect()
}
