//! Signals that end a run: the first one politely, with all that is finished kept; the second one at once.

use crate::INTERRUPTED;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Whether one came, and which.
#[derive(Default)]
pub struct Signals {
    /// Raised by the first one.
    pub stop: Arc<AtomicBool>,
    which: Arc<AtomicUsize>,
}

impl Signals {
    /// Waits for them from now on.
    pub fn watch(&self) -> io::Result<()> {
        for signal in [SIGINT, SIGTERM] {
            // in the order in which they are asked: only the second signal finds the flag raised
            flag::register_conditional_default(signal, Arc::clone(&self.stop))?;
            flag::register_usize(signal, Arc::clone(&self.which), signal as usize)?;
            flag::register(signal, Arc::clone(&self.stop))?;
        }
        Ok(())
    }

    /// The exit status of who was stopped by one, as shells have it: 130 after Ctrl-C, 143 after a polite kill.
    pub fn status(&self) -> u8 {
        match self.which.load(Ordering::Relaxed) {
            0 => INTERRUPTED,
            signal => 128 + signal as u8,
        }
    }
}
