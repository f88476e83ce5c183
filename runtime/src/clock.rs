//! Where a thread gets the time from: the system, or a test's hand.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The source of time of a thread. Clones of a manual clock show the same time.
#[derive(Clone)]
pub(crate) enum Clock {
    /// The system's monotonic clock.
    Real,
    /// Stands still until a [`Stage`](crate::Stage) turns it.
    Manual { start: Instant, nanos: Arc<AtomicU64> },
}

impl Clock {
    pub(crate) fn manual() -> Self {
        Self::Manual { start: Instant::now(), nanos: Arc::default() }
    }

    pub(crate) fn now(&self) -> Instant {
        match self {
            Self::Real => Instant::now(),
            Self::Manual { start, nanos } => *start + Duration::from_nanos(nanos.load(Ordering::Acquire)),
        }
    }

    /// Turns a manual clock forward; a real one goes on by itself. 584 years at most.
    pub(crate) fn advance(&self, by: Duration) {
        if let Self::Manual { nanos, .. } = self {
            let by = u64::try_from(by.as_nanos()).unwrap_or(u64::MAX);
            nanos.fetch_add(by, Ordering::Release);
        }
    }
}

/// Time since a start, for fluid animation (thesis §3.2.5.1).
///
/// Not one for the whole program as in the thesis: a timer is a small value that is cloned to
/// whom it concerns, so that a test can hand out one whose clock it turns itself.
/// The caller keeps the previous stamp, so any number of objects can measure with one timer.
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
    clock: Clock,
    start: Instant,
}

impl Timer {
    /// A timer that starts now, on the system's monotonic clock.
    pub fn start() -> Self {
        Self::with_clock(Clock::Real)
    }

    pub(crate) fn with_clock(clock: Clock) -> Self {
        let start = clock.now();
        Self { clock, start }
    }

    /// The moment at which [`time`](Self::time) was zero.
    pub fn start_time(&self) -> Instant {
        self.start
    }

    /// Time since the start. Never goes back.
    pub fn time(&self) -> Duration {
        self.clock.now().saturating_duration_since(self.start)
    }

    /// Time since `previous`, an earlier [`time`](Self::time); zero when `previous` lies ahead.
    pub fn elapsed(&self, previous: Duration) -> Duration {
        self.time().saturating_sub(previous)
    }
}
