//! A panic in an estimator is the end of its cell, not of the run.

use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe, Location};
use std::path::Path;
use std::sync::Once;

/// Why a block could not be made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Its number within the cell, from 0.
    pub block: u64,
    /// What happened.
    pub why: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "block {} failed: {}", self.block, self.why)
    }
}

thread_local! {
    /// Where this thread panicked last.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// What `make` makes of a block, or what it panicked with.
///
/// # Errors
///
/// The message of the panic, with its place where that is in this program's sources.
pub fn guarded<T>(block: u64, make: impl FnOnce(u64) -> T) -> Result<T, Failure> {
    static PLACES: Once = Once::new();
    PLACES.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            PLACE.replace(info.location().and_then(place));
            usual(info);
        }));
    });
    panic::catch_unwind(AssertUnwindSafe(|| make(block))).map_err(|payload| {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
        let text = text.unwrap_or_else(|| "without a message".to_owned());
        let place = PLACE.take().map_or_else(String::new, |place| format!(", at {place}"));
        Failure { block, why: format!("it panicked: {text}{place}") }
    })
}

/// A place in our sources. Those of the standard library and of other crates lie elsewhere on each machine, and results do
/// not depend on it.
fn place(location: &Location<'_>) -> Option<String> {
    Path::new(location.file()).is_relative().then(|| format!("{}:{}", location.file(), location.line()))
}
