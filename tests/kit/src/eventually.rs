//! Waiting for a condition that another thread makes true, without a fixed delay.

use std::time::{Duration, Instant};

/// Polls `condition` until it holds: at once, then at growing intervals up to 5 ms.
///
/// # Panics
/// When it does not hold within `limit`, at the caller's line.
#[track_caller]
pub fn eventually(limit: Duration, mut condition: impl FnMut() -> bool) {
    let deadline = Instant::now() + limit;
    let mut pause = Duration::from_micros(20);
    while !condition() {
        assert!(Instant::now() < deadline, "did not become true within {limit:?}");
        std::thread::park_timeout(pause);
        pause = (pause * 2).min(Duration::from_millis(5));
    }
}
