//! Blocks are made by several threads, ahead of the one that takes them in their order.
//!
//! Threads are watched: one that begins no walk for too long is given up, with the cell that it works for. A thread cannot be
//! stopped from outside, so it is left to itself, and others work for the next cell.

use super::guard::{Failure, guarded};
use crate::estimator::pulse;
use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Threads that make blocks of type `T`.
pub struct Ahead<T> {
    queue: Arc<Queue<T>>,
    watched: Vec<Watched>,
    /// A walk that takes longer does not end.
    patience: Duration,
}

/// How many threads make blocks, and how far ahead.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Threads, at least one.
    pub threads: usize,
    /// Blocks that are begun and not taken, at most.
    pub window: usize,
    /// Seconds of one walk.
    pub patience: Duration,
    /// The first block that is not to be begun yet.
    pub until: u64,
}

/// What the threads share.
pub struct Queue<T> {
    state: Mutex<State<T>>,
    /// Told when there may be something to make.
    work: Condvar,
    /// Told when something was made.
    made: Condvar,
}

struct State<T> {
    /// What is still to be made, in order.
    numbers: Box<dyn Iterator<Item = u64> + Send>,
    /// The next of them.
    next: Option<u64>,
    /// Nothing from here on is begun yet.
    until: u64,
    /// Begun and not taken, in order.
    begun: VecDeque<u64>,
    /// Made and not taken.
    made: BTreeMap<u64, Result<T, Failure>>,
    /// As many may be begun and not taken.
    window: usize,
    closed: bool,
}

/// A thread and its sign of life.
struct Watched {
    walks: Arc<AtomicU64>,
    /// The block that it makes, and one more; 0 while it waits.
    at: Arc<AtomicU64>,
    seen: (u64, u64),
    since: Instant,
}

impl<T: Send + 'static> Ahead<T> {
    /// Starts threads, each of which calls `work` with the queue to work off. At most `window` of the `numbers`, which
    /// ascend, are begun and not taken at any time, and none from `until` on.
    pub fn start(
        Limits { threads, window, patience, until }: Limits,
        numbers: impl Iterator<Item = u64> + Send + 'static,
        work: impl Fn(&Queue<T>) + Send + Sync + 'static,
    ) -> Self {
        let mut numbers = Box::new(numbers);
        let next = numbers.next();
        let state = State {
            numbers,
            next,
            until,
            begun: VecDeque::new(),
            made: BTreeMap::new(),
            window: window.max(1),
            closed: false,
        };
        let queue = Arc::new(Queue { state: Mutex::new(state), work: Condvar::new(), made: Condvar::new() });
        let work = Arc::new(work);
        let watched = (0..threads.max(1)).map(|_| watch(Arc::clone(&queue), Arc::clone(&work))).collect();
        Ahead { queue, watched, patience }
    }

    /// Nothing from the number `until` on is begun before this is called again.
    pub fn until(&self, until: u64) {
        self.queue.lock().until = until;
        self.queue.work.notify_all();
    }

    /// The next block with its number, if it is made within `wait`; `None` if it is not. To be called again while
    /// something is expected.
    pub fn take(&mut self, wait: Duration) -> Option<(u64, Result<T, Failure>)> {
        let taken = self.queue.take(wait);
        if taken.is_some() {
            return taken;
        }
        let block = self.watched.iter_mut().find_map(|watched| watched.stuck(self.patience))?;
        let seconds = self.patience.as_secs_f64();
        Some((block, Err(Failure { block, why: format!("a walk did not end within {seconds} s") })))
    }
}

impl<T> Drop for Ahead<T> {
    fn drop(&mut self) {
        self.queue.lock().closed = true;
        self.queue.work.notify_all();
    }
}

impl<T> Queue<T> {
    /// Makes blocks until there are none left, or nobody wants them any more.
    pub fn work(&self, make: impl Fn(u64) -> T) {
        while let Some(number) = self.begin() {
            AT.with(|at| at.store(number + 1, Ordering::Relaxed));
            let made = guarded(number, &make);
            AT.with(|at| at.store(0, Ordering::Relaxed));
            self.lock().made.insert(number, made);
            self.made.notify_one();
        }
    }

    fn begin(&self) -> Option<u64> {
        let mut state = self.lock();
        loop {
            let next = state.next.filter(|_| !state.closed)?;
            if next < state.until && state.begun.len() < state.window {
                state.next = state.numbers.next();
                state.begun.push_back(next);
                return Some(next);
            }
            state = self.work.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn take(&self, wait: Duration) -> Option<(u64, Result<T, Failure>)> {
        let missing =
            |state: &mut State<T>| state.begun.front().is_none_or(|first| !state.made.contains_key(first));
        let waited = self.made.wait_timeout_while(self.lock(), wait, missing);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let first = *state.begun.front()?;
        let made = state.made.remove(&first)?;
        state.begun.pop_front();
        drop(state);
        self.work.notify_one();
        Some((first, made))
    }

    /// Nothing that panics holds the lock.
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

thread_local! {
    static AT: Arc<AtomicU64> = Arc::default();
}

/// A thread that works, and what tells that it does.
fn watch<T: Send + 'static>(
    queue: Arc<Queue<T>>,
    work: Arc<impl Fn(&Queue<T>) + Send + Sync + 'static>,
) -> Watched {
    let (tell, told) = std::sync::mpsc::channel();
    thread::spawn(move || {
        let _ = tell.send((pulse::of_this_thread(), AT.with(Arc::clone)));
        work(&queue);
    });
    let (walks, at) = told.recv().expect("the thread tells this first");
    Watched { walks, at, seen: (0, 0), since: Instant::now() }
}

impl Watched {
    /// The block in which the thread has begun no walk for so long.
    fn stuck(&mut self, patience: Duration) -> Option<u64> {
        let now = (self.walks.load(Ordering::Relaxed), self.at.load(Ordering::Relaxed));
        if now != self.seen || now.1 == 0 {
            (self.seen, self.since) = (now, Instant::now());
            return None;
        }
        (self.since.elapsed() > patience).then(|| now.1 - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ahead(make: impl Fn(u64) -> u64 + Send + Sync + 'static) -> Ahead<u64> {
        Ahead::start(LIMITS, (0..100).filter(|n| n % 3 != 1), move |queue| queue.work(&make))
    }

    const LIMITS: Limits =
        Limits { threads: 3, window: 5, patience: Duration::from_millis(200), until: u64::MAX };

    /// Waits for the next one.
    fn next(ahead: &mut Ahead<u64>) -> (u64, Result<u64, Failure>) {
        (0..100).find_map(|_| ahead.take(Duration::from_millis(50))).expect("something comes")
    }

    #[test]
    fn blocks_come_in_their_order() {
        let mut all = ahead(|n| {
            thread::sleep(Duration::from_millis((n * 7) % 4));
            n * n
        });
        for n in (0..100).filter(|n| n % 3 != 1) {
            assert_eq!(next(&mut all), (n, Ok(n * n)));
        }
        assert_eq!(all.take(Duration::from_millis(1)), None);
    }

    #[test]
    fn no_more_than_the_window_is_begun() {
        let all = ahead(|n| n);
        thread::sleep(Duration::from_millis(100));
        assert_eq!(all.queue.lock().made.len(), 5);
    }

    #[test]
    fn nothing_is_begun_beyond_a_look() {
        let limits = Limits { window: 50, until: 7, ..LIMITS };
        let mut all = Ahead::start(limits, 0..100, |queue: &Queue<u64>| queue.work(|n| n));
        (0..7).for_each(|n| assert_eq!(next(&mut all), (n, Ok(n))));
        assert_eq!(all.take(Duration::from_millis(50)), None);
        all.until(9);
        (7..9).for_each(|n| assert_eq!(next(&mut all), (n, Ok(n))));
    }

    #[test]
    fn a_panic_is_told_and_others_go_on() {
        let mut all = ahead(|n| if n == 6 { panic!("the {n}th") } else { n });
        for n in [0, 2, 3, 5] {
            assert_eq!(next(&mut all), (n, Ok(n)));
        }
        let (block, failure) = next(&mut all);
        let why = failure.unwrap_err().why;
        assert_eq!(block, 6);
        assert!(why.starts_with("it panicked: the 6th, at src/experiment/ahead.rs:"), "{why}");
        assert_eq!(next(&mut all), (8, Ok(8)));
    }

    #[test]
    fn a_walk_without_end_is_given_up_and_a_long_block_is_not() {
        let mut all = ahead(|n| {
            // thrice the patience, but a walk after the other
            for _ in 0..60 {
                thread::sleep(Duration::from_millis(10));
                pulse::beat();
            }
            if n == 5 {
                thread::sleep(Duration::from_secs(3600));
            }
            n
        });
        for n in [0, 2, 3] {
            assert_eq!(next(&mut all), (n, Ok(n)));
        }
        let why = "a walk did not end within 0.2 s".to_owned();
        assert_eq!(next(&mut all), (5, Err(Failure { block: 5, why })));
    }
}
