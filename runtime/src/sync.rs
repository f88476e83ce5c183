//! All that threads share passes through here, so that the model checkers see the real code.
//!
//! | build | queue | threads, atomics |
//! |---|---|---|
//! | normal | a flume channel, whose two ends stay together | `std` |
//! | `--cfg loom`, `--cfg shuttle` | a `Mutex<VecDeque>` of the checker, with the same methods | the checker's |
//!
//! flume cannot run under a checker, so what is proved there is our protocol over a queue that is
//! right (push, drain, empty), not flume itself; flume has the stress tests.
//! Statistics (counters, what is running) stay with `std`: nothing waits for them, and each
//! further atomic multiplies what a checker has to try.

/// The checkers' queue and atomics, and threads that park as the standard library's do.
#[cfg(any(loom, shuttle))]
use crate::modelled as parts;
pub(crate) use parts::{Queue, atomic, planted, thread};
use std::time::Instant;

#[cfg(not(any(loom, shuttle)))]
mod parts {
    pub(crate) use std::{sync::atomic, thread};

    /// An unbounded queue that many threads fill and one empties. Held for a push or a drain, no
    /// longer.
    pub(crate) struct Queue<T> {
        enter: flume::Sender<T>,
        leave: flume::Receiver<T>,
    }

    impl<T> Queue<T> {
        pub(crate) fn new() -> Self {
            let (enter, leave) = flume::unbounded();
            Self { enter, leave }
        }

        pub(crate) fn push(&self, item: T) {
            self.enter.send(item).expect("both ends of the channel live in this struct");
        }

        /// Takes everything that is there at the moment of the call, oldest first, under one lock.
        pub(crate) fn drain(&self) -> impl Iterator<Item = T> {
            self.leave.drain()
        }

        pub(crate) fn len(&self) -> usize {
            self.leave.len()
        }
    }

    /// Is the planted bug of this name on? Never, in a normal build: the question compiles to
    /// nothing.
    ///
    /// A model that cannot fail proves nothing. `.ci/models` turns each bug on in turn and demands
    /// that a checker finds it.
    pub(crate) const fn planted(_bug: &str) -> bool {
        false
    }
}

/// Sleeps until somebody unparks this thread, or until `deadline`. May return early.
/// The checkers know no time: there a deadline never comes, and a lost wake-up shows as a deadlock.
pub(crate) fn park(deadline: Option<Instant>) {
    match deadline {
        #[cfg(not(any(loom, shuttle)))]
        Some(deadline) => {
            thread::park_timeout(deadline.saturating_duration_since(Instant::now()));
        }
        _ => thread::park(),
    }
}
