//! Chromium without a window, for the tests beside this folder: opens a page from disk, asks it, presses its keys, and keeps
//! what it complained of and what it asked the network for.
//!
//! ```ignore
//! let Some(browser) = browser::shared() else { return };
//! let page = browser.open(&path.join("index.html"));
//! page.click("#filter");
//! assert_eq!(page.js("document.querySelectorAll('tbody tr').length"), 3);
//! assert_eq!(page.complaints(), [""; 0]);
//! ```
//!
//! Where there is no browser, tests say so and end; with one of [`NEEDED`] set they fail.

// each test file uses a part of it
#![allow(dead_code)]

mod axe;
mod input;
mod page;
mod pipe;
mod report;

pub use page::Page;
pub use report::Report;

use pipe::{Pipe, Session};
use serde_json::{Value, json};
use std::io::{Write, stderr};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::{Duration, Instant};
use std::{env, fs, thread};
use tempfile::TempDir;

/// Variables that forbid to go without a browser: a continuous integration sets the first, `.ci/run` the second once it
/// has found or installed one.
const NEEDED: [&str; 2] = ["CI", "FURNACE_NEEDS_BROWSER"];

/// Names the browser, where it is called otherwise than [`NAMES`].
const CHOSEN: &str = "FURNACE_CHROMIUM";

const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// To start, and to answer what is asked of the browser itself.
const PATIENCE: Duration = Duration::from_secs(20);

/// No profile but the given one, no window, no traffic of its own, and pages in the background as quick as in front.
const FLAGS: [&str; 18] = [
    "--headless",
    "--remote-debugging-pipe",
    // it opens nothing but pages of ours, and root has no sandbox
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--disable-breakpad",
    "--disable-sync",
    "--disable-extensions",
    "--disable-component-update",
    "--disable-background-networking",
    "--disable-background-timer-throttling",
    "--disable-backgrounding-occluded-windows",
    "--disable-renderer-backgrounding",
    "--no-first-run",
    "--no-default-browser-check",
    "--hide-scrollbars",
    "--host-resolver-rules=MAP * ~NOTFOUND",
];

/// A running browser, ended when dropped; a test that is killed ends it too, as its pipe closes.
pub struct Browser {
    process: Child,
    pipe: Arc<Pipe>,
    session: Mutex<Session>,
    // dropped last: the browser writes into it to its end
    folder: TempDir,
}

/// The browser that all tests of this process share, started by the first of them; `None`, after saying why, where
/// there is none.
pub fn shared() -> Option<Arc<Browser>> {
    static SHARED: Mutex<Weak<Browser>> = Mutex::new(Weak::new());
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(browser) = shared.upgrade() {
        return Some(browser);
    }
    let Some(program) = find() else {
        let why = format!("none of {} is here, and {CHOSEN} names no other", NAMES.join(", "));
        let needed = NEEDED.iter().find(|name| env::var_os(name).is_some_and(|value| !value.is_empty()));
        assert!(needed.is_none(), "no browser, and {} is set: {why}", needed.unwrap());
        // cargo keeps what a passing test prints, but not what it writes
        let name = thread::current().name().unwrap_or("a test").to_owned();
        let mut past_cargo = stderr();
        writeln!(past_cargo, "skipped: {name} needs Chromium: {why}").unwrap();
        return None;
    };
    let browser = Arc::new(Browser::start(&program));
    *shared = Arc::downgrade(&browser);
    Some(browser)
}

/// The browser that is named, or else the first to be found.
fn find() -> Option<PathBuf> {
    if let Some(chosen) = env::var_os(CHOSEN).filter(|name| !name.is_empty()) {
        return Some(chosen.into());
    }
    let path = env::var_os("PATH")?;
    let places = || env::split_paths(&path);
    NAMES.iter().find_map(|name| places().map(|place| place.join(name)).find(|file| file.is_file()))
}

impl Browser {
    fn start(program: &Path) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let said = fs::File::create(folder.path().join("stderr")).unwrap();
        // it listens at descriptor 3 and speaks at 4
        let mut process = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<&0 4>&1 0</dev/null 1>&2", "sh"])
            .arg(program)
            .args(FLAGS)
            .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(said)
            .process_group(0)
            .spawn()
            .unwrap();
        let pipe = Pipe::new(process.stdin.take().unwrap(), process.stdout.take().unwrap());
        let session = Mutex::new(Session::new(&pipe, ""));
        let browser = Browser { process, pipe, session, folder };
        if let Err(why) = browser.try_call("Browser.getVersion", json!({})) {
            let said = fs::read_to_string(browser.folder.path().join("stderr")).unwrap_or_default();
            panic!("{} does not start: {why}\n{said}", program.display());
        }
        browser
    }

    /// An empty page that shares nothing with others, 1280 by 800 pixels.
    pub fn page(self: &Arc<Self>) -> Page {
        Page::new(self)
    }

    /// A page from disk, once it has set `data-ready`.
    pub fn open(self: &Arc<Self>, file: &Path) -> Page {
        let page = self.page();
        page.load(file);
        page.ready();
        page
    }

    /// Asks the browser itself.
    fn call(&self, method: &str, params: Value) -> Value {
        self.try_call(method, params).unwrap_or_else(|why| panic!("{why}"))
    }

    fn try_call(&self, method: &str, params: Value) -> Result<Value, String> {
        let session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        session.call(method, params, Instant::now() + PATIENCE)
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // asked first, as then it ends its children itself
        let _ = self.try_call("Browser.close", json!({}));
        let end = Instant::now() + Duration::from_secs(5);
        while Instant::now() < end && matches!(self.process.try_wait(), Ok(None)) {
            thread::sleep(Duration::from_millis(10));
        }
        let group = format!("-{}", self.process.id());
        let _ = Command::new("sh").args(["-c", "kill -KILL -- \"$0\" 2>/dev/null", &group]).status();
        let _ = self.process.wait();
    }
}
