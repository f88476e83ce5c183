//! The lock, threads and atomics of the crate, replaceable by those of a model checker, so that the
//! checkers run the real code.
//!
//! | build | lock, threads, atomics |
//! |---|---|
//! | normal | `std` |
//! | `--cfg loom`, `--cfg shuttle` | the checker's |
//! | `--cfg tsan` | `std`, with a lock that ThreadSanitizer can look into |
//!
//! Statistics (counters, the running object) and the flags of jobs always use `std`: no thread waits
//! for them, and each further atomic multiplies the schedules that a checker has to try.

/// The checker's lock and atomics, and threads that park like those of the standard library.
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

/// The only kind of lock in the crate: a short one, as in the queue of the thesis (§3.2.6.1).
///
/// It cannot be held: there is no guard, only a closure. The closure moves a few bytes and returns;
/// it calls no user code and takes no second lock, so no two locks can be taken in the wrong order.
/// Debug builds check that.
pub(crate) struct BriefLock<T>(parts::Mutex<T>);

impl<T> BriefLock<T> {
    pub(crate) fn new(content: T) -> Self {
        Self(parts::Mutex::new(content))
    }

    pub(crate) fn with<R>(&self, briefly: impl FnOnce(&mut T) -> R) -> R {
        alone::inside(true);
        #[cfg(not(tsan))]
        // A poisoned lock is used as it is: no closure can panic in the middle of a change.
        let mut content = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        #[cfg(tsan)]
        let mut content = self.0.lock();
        let answer = briefly(&mut content);
        drop(content);
        alone::inside(false);
        answer
    }
}

/// Checks that no thread takes a lock inside another. Left out under the checkers, which run all
/// threads in one OS thread.
mod alone {
    #[cfg(all(debug_assertions, not(any(loom, shuttle))))]
    thread_local!(static INSIDE: std::cell::Cell<bool> = const { std::cell::Cell::new(false) });

    pub(super) fn inside(_now: bool) {
        #[cfg(all(debug_assertions, not(any(loom, shuttle))))]
        assert!(!(INSIDE.replace(_now) && _now), "a lock was taken inside another");
    }
}

/// Blocks until this thread is unparked, or until `deadline`. May return early.
/// The checkers have no time: there a deadline never passes, and a lost wake-up is a deadlock.
pub(crate) fn park(deadline: Option<Instant>) {
    match deadline {
        #[cfg(not(any(loom, shuttle)))]
        Some(deadline) => {
            thread::park_timeout(deadline.saturating_duration_since(Instant::now()));
        }
        _ => thread::park(),
    }
}
