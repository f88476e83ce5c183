//! Detects stalls: reports the object of a thread whose call does not return, with its message type.

use crate::register::Label;
use crate::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Usual limit of a watchdog: it reports calls that take longer.
pub const STALL_LIMIT: Duration = Duration::from_secs(5);

/// A running call that has taken longer than the limit.
#[derive(Clone, Debug)]
pub struct Stall {
    /// The thread's name.
    pub thread: String,
    /// The name of the worker or receiver; `run` for a closure that was sent to the thread.
    pub object: Arc<str>,
    /// The type of the message being received, `update` for a worker, `run` for a closure.
    pub call: &'static str,
    /// Minimum duration of the call so far.
    pub running: Duration,
}

/// Watches any number of threads. It is a worker and receiver like any other.
///
/// Four times within the limit it reads one atomic number of each thread; the only cost for the
/// watched threads is storing that number. A stall is reported once, between 1 and 1.25 times the
/// limit after the call began.
pub struct Watchdog {
    address: Address<ThreadHandle>,
    /// The watchdog's own thread, if it has one. Stopped with the watchdog.
    _thread: Option<Thread>,
}

impl Watchdog {
    /// Starts a watchdog in a thread of its own. `report` is called there; each stall is also logged
    /// with `tracing` at level WARN.
    ///
    /// # Errors
    /// When the system cannot create a thread.
    pub fn start(limit: Duration, report: impl FnMut(&Stall) + Send + 'static) -> io::Result<Self> {
        let thread = Thread::start("watchdog")?;
        let mut watchdog = Self::start_in(thread.handle(), limit, report);
        watchdog._thread = Some(thread);
        Ok(watchdog)
    }

    /// Starts a watchdog in an existing thread. It ends with that thread.
    pub fn start_in(
        thread: &ThreadHandle,
        limit: Duration,
        report: impl FnMut(&Stall) + Send + 'static,
    ) -> Self {
        let address = thread.reserve_address();
        let own = address.clone();
        // Fails only when the thread has stopped, and then it needs no watchdog.
        let _ = thread.run(move |thread| {
            let watch = Rc::new(RefCell::new(WatchdogState {
                limit,
                report: Box::new(report),
                watched_threads: Vec::new(),
            }));
            thread.register_receiver_at(&own, Rc::clone(&watch));
            thread.register_worker(watch);
        });
        Self { address, _thread: None }
    }

    /// Watches `thread` until it stops.
    pub fn watch(&self, thread: &ThreadHandle) {
        let address = self.address.clone();
        // Fails only when the thread or the watchdog has stopped.
        let _ = thread.run(move |thread| {
            thread.publish_labels();
            let _ = address.send(thread.handle().clone());
        });
    }
}

/// The worker and receiver of a watchdog.
struct WatchdogState {
    limit: Duration,
    report: Box<dyn FnMut(&Stall)>,
    watched_threads: Vec<WatchedThread>,
}

/// The state of a watched thread at the last check.
struct WatchedThread {
    thread: ThreadHandle,
    /// Number of the call that was running.
    running: u64,
    /// Time of the first check that found this call; `None` once it was reported.
    since: Option<Instant>,
}

impl Receiver for WatchdogState {
    type Message = ThreadHandle;

    fn receive(&mut self, thread: ThreadHandle, _: &mut Context) {
        if self.watched_threads.iter().all(|watched| watched.thread != thread) {
            self.watched_threads.push(WatchedThread { thread, running: 0, since: None });
        }
    }
}

impl Worker for WatchdogState {
    fn update(&mut self, thread: &mut Context) -> bool {
        let now = thread.now();
        self.watched_threads.retain(|watched| !watched.thread.is_stopped());
        for watched in &mut self.watched_threads {
            if let Some(stall) = watched.check(now, self.limit) {
                tracing::warn!(?stall, "stalled");
                (self.report)(&stall);
            }
        }
        if !self.watched_threads.is_empty() {
            thread.wake_at(now + self.limit / 4);
        }
        true
    }
}

impl WatchedThread {
    /// Checks the thread again. Returns a stall that was not reported yet.
    fn check(&mut self, now: Instant, limit: Duration) -> Option<Stall> {
        let running = self.thread.shared.running();
        if running != self.running {
            self.running = running;
            self.since = Some(now);
        }
        let id = running as u32; // The upper half numbers the calls.
        let time = now.saturating_duration_since(self.since?);
        if id == 0 || time < limit {
            return None;
        }
        self.since = None;
        let label = self.thread.shared.labels.with(|labels| labels.get(&id).cloned());
        let Label { name: object, call } = label.unwrap_or_default();
        Some(Stall { thread: self.thread.name().to_owned(), object, call, running: time })
    }
}
