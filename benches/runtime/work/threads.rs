//! Threads that are no part of what is measured: producers, and who makes noise.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Starts a bare OS thread; what it panics with is passed on by [`join`].
pub fn start<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> thread::JoinHandle<T> {
    thread::Builder::new().name(name.into()).spawn(work).expect("the system has a thread left")
}

/// Waits for a thread of [`start`].
pub fn join<T>(thread: thread::JoinHandle<T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Waits without using a processor for `flag`; may notice it up to some milliseconds late.
pub fn wait_for(flag: &AtomicBool) {
    while !flag.load(Ordering::Acquire) {
        thread::park_timeout(Duration::from_micros(50));
    }
}

/// Waits on the processor for `when`, so that the wait itself ends on time.
pub fn spin_until(when: Instant) {
    while Instant::now() < when {
        std::hint::spin_loop();
    }
}
