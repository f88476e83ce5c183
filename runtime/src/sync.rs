//! All that threads share passes through here, so that the model checkers see the real code.
//!
//! | build | lock, threads, atomics |
//! |---|---|
//! | normal | `std` |
//! | `--cfg loom`, `--cfg shuttle` | the checker's |
//! | `--cfg tsan` | `std`, with a lock that ThreadSanitizer can look into |
//!
//! Statistics (counters, what is running) stay with `std`: nothing waits for them, and each
//! further atomic multiplies what a checker has to try.

/// The checkers' lock and atomics, and threads that park as the standard library's do.
#[cfg(any(loom, shuttle))]
use crate::modelled as parts;
pub(crate) use parts::{atomic, thread};
use std::time::Instant;

#[cfg(not(any(loom, shuttle)))]
mod parts {
    #[cfg(tsan)]
    pub(crate) use spin::Mutex;
    #[cfg(not(tsan))]
    pub(crate) use std::sync::Mutex;
    pub(crate) use std::{sync::atomic, thread};
}

/// `mutant!(self.faulty(arguments))` returns what `faulty` returns, if a model checker has planted
/// the bug of that name: see `tests/runtime/mutants.rs`. Expands to nothing in a normal build.
macro_rules! mutant {
    ($object:ident $(. $method:ident)? $(:: $function:ident)? ($($argument:expr),*)) => {
        #[cfg(any(loom, shuttle))]
        if crate::modelled::planted(concat!($(stringify!($method))? $(stringify!($function))?)) {
            return $object $(. $method)? $(:: $function)? ($($argument),*);
        }
    };
}
pub(crate) use mutant;

/// The one lock of the crate, and so the one thing that two threads ever wait for in it: as in the
/// thesis, whose queue has one for the same reason (§3.2.6.1).
///
/// It cannot be held: there is no guard, only a closure. What runs in there moves a few bytes
/// and returns; nothing of the program's is called, and no second one is taken, so no two can be
/// taken in the wrong order. Debug builds check that.
pub(crate) struct Held<T>(parts::Mutex<T>);

impl<T> Held<T> {
    pub(crate) fn new(content: T) -> Self {
        Self(parts::Mutex::new(content))
    }

    pub(crate) fn with<R>(&self, briefly: impl FnOnce(&mut T) -> R) -> R {
        alone::inside(true);
        #[cfg(not(tsan))]
        // What runs inside cannot panic half way; and a message more or less is no broken promise.
        let mut content = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        #[cfg(tsan)]
        let mut content = self.0.lock();
        let answer = briefly(&mut content);
        drop(content);
        alone::inside(false);
        answer
    }
}

/// No thread is in two locks at once. Not under the checkers, all of whose threads are one.
mod alone {
    #[cfg(all(debug_assertions, not(any(loom, shuttle))))]
    thread_local!(static INSIDE: std::cell::Cell<bool> = const { std::cell::Cell::new(false) });

    pub(super) fn inside(_now: bool) {
        #[cfg(all(debug_assertions, not(any(loom, shuttle))))]
        assert!(!(INSIDE.replace(_now) && _now), "a lock was taken inside another");
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
