//! A sign of life of each thread that samples: how many walks it has begun. Who waits for a block can so tell one that
//! takes long from a walk that does not end.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

thread_local! {
    static WALKS: Arc<AtomicU64> = Arc::default();
}

/// A walk begins on this thread.
#[inline]
pub fn beat() {
    // nobody else writes: no need to add atomically
    WALKS.with(|walks| walks.store(walks.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed));
}

/// How many walks this thread has begun, for others to watch.
pub fn of_this_thread() -> Arc<AtomicU64> {
    WALKS.with(Arc::clone)
}
