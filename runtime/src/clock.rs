//! Source of time of a thread: the system's clock, or one that a test advances.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The source of time of a thread. Clones of a manual clock show the same time.
#[derive(Clone)]
pub(crate) enum ThreadClock {
    /// The system's monotonic clock.
    Real,
    /// Advanced by a [`Stage`](crate::Stage) only.
    Manual { start: Instant, nanos: Arc<AtomicU64> },
}

impl ThreadClock {
    pub(crate) fn manual() -> Self {
        Self::Manual { start: Instant::now(), nanos: Arc::default() }
    }

    pub(crate) fn now(&self) -> Instant {
        match self {
            Self::Real => Instant::now(),
            Self::Manual { start, nanos } => *start + Duration::from_nanos(nanos.load(Ordering::Acquire)),
        }
    }

    /// Advances a manual clock, by 584 years at most in total. Does nothing to a real one.
    pub(crate) fn advance(&self, by: Duration) {
        if let Self::Manual { nanos, .. } = self {
            let by = u64::try_from(by.as_nanos()).unwrap_or(u64::MAX);
            nanos.fetch_add(by, Ordering::Release);
        }
    }
}

/// Time since a start, for fluid animation (thesis §3.2.5.1).
///
/// Unlike in the thesis there is not one timer for the whole program: a timer is a small value that
/// is cloned for every object that needs it, so a test can pass one whose clock it advances itself.
/// The caller stores the previous time, so any number of objects can measure with one timer.
///
/// ```
/// # use dragonfly_runtime::Timer;
/// let timer = Timer::start();
/// let mut previous = timer.time();
/// // Each frame:
/// let step = timer.elapsed(previous);
/// previous += step;
/// assert!(timer.time() >= previous);
/// ```
#[derive(Clone)]
pub struct Timer {
    clock: ThreadClock,
    start: Instant,
}

impl Timer {
    /// Returns a timer that starts now, on the system's monotonic clock.
    pub fn start() -> Self {
        Self::with_clock(ThreadClock::Real)
    }

    pub(crate) fn with_clock(clock: ThreadClock) -> Self {
        let start = clock.now();
        Self { clock, start }
    }

    /// Returns the moment at which [`time`](Self::time) was zero.
    pub fn start_time(&self) -> Instant {
        self.start
    }

    /// Returns the time since the start. Never decreases.
    pub fn time(&self) -> Duration {
        self.clock.now().saturating_duration_since(self.start)
    }

    /// Returns the time since `previous`, an earlier [`time`](Self::time); zero when `previous` is in
    /// the future.
    pub fn elapsed(&self, previous: Duration) -> Duration {
        self.time().saturating_sub(previous)
    }
}
