//! Says which object of which thread does not come back, and with which type of message.

use crate::register::Label;
use crate::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a call may take before the watchdog speaks, unless another time is given.
pub const STALL_LIMIT: Duration = Duration::from_secs(5);

/// A call that has taken longer than the limit, and goes on.
#[derive(Clone, Debug)]
pub struct Stall {
    /// The thread's name.
    pub thread: String,
    /// The name of the worker or receiver; `run` for a closure that was sent to the thread.
    pub object: Arc<str>,
    /// The type of the message being received, `update` for a worker, `run` for a closure.
    pub call: &'static str,
    /// How long it has been seen running, at least.
    pub running: Duration,
}

/// Watches any number of threads; itself a worker and receiver like any other.
///
/// It looks four times within the limit, at one atomic number for each thread; the watched
/// threads do nothing for it but store that number. A stall is reported once, between one limit
/// and one and a quarter after it began.
pub struct Watchdog {
    address: Address<ThreadHandle>,
    /// Ends with the watchdog, when it has a thread of its own.
    _thread: Option<Thread>,
}

impl Watchdog {
    /// Starts a watchdog in a thread of its own. `report` is called there, and the stall is
    /// reported to `tracing` at level WARN in any case.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(limit: Duration, report: impl FnMut(&Stall) + Send + 'static) -> io::Result<Self> {
        let thread = Thread::start("watchdog")?;
        let mut watchdog = Self::start_in(thread.handle(), limit, report);
        watchdog._thread = Some(thread);
        Ok(watchdog)
    }

    /// Starts a watchdog in a thread that is there already, and lives as long as it.
    pub fn start_in(
        thread: &ThreadHandle,
        limit: Duration,
        report: impl FnMut(&Stall) + Send + 'static,
    ) -> Self {
        let address = thread.reserve_address();
        let own = address.clone();
        // A stopped thread watches nobody.
        let _ = thread.run(move |thread| {
            let watch = Rc::new(RefCell::new(Watch { limit, report: Box::new(report), looks: Vec::new() }));
            thread.register_receiver_at(&own, Rc::clone(&watch));
            thread.register_worker(watch);
        });
        Self { address, _thread: None }
    }

    /// Watches `thread` until it stops.
    pub fn watch(&self, thread: &ThreadHandle) {
        let address = self.address.clone();
        // A stopped thread need not be watched, and a watchdog that has stopped watches nobody.
        let _ = thread.run(move |thread| {
            thread.show_labels();
            let _ = address.send(thread.handle().clone());
        });
    }
}

struct Watch {
    limit: Duration,
    report: Box<dyn FnMut(&Stall)>,
    looks: Vec<Look>,
}

/// What was seen of a thread.
struct Look {
    thread: ThreadHandle,
    /// The call that was running.
    running: u64,
    /// When it was seen first; `None` when it was reported.
    since: Option<Instant>,
}

impl Receiver for Watch {
    type Message = ThreadHandle;

    fn receive(&mut self, thread: ThreadHandle, _: &mut Context) {
        if self.looks.iter().all(|look| look.thread != thread) {
            self.looks.push(Look { thread, running: 0, since: None });
        }
    }
}

impl Worker for Watch {
    fn update(&mut self, thread: &mut Context) -> bool {
        let now = thread.now();
        self.looks.retain(|look| !look.thread.is_stopped());
        for look in &mut self.looks {
            if let Some(stall) = look.again(now, self.limit) {
                tracing::warn!(?stall, "stalled");
                (self.report)(&stall);
            }
        }
        if !self.looks.is_empty() {
            thread.wake_at(now + self.limit / 4);
        }
        true
    }
}

impl Look {
    fn again(&mut self, now: Instant, limit: Duration) -> Option<Stall> {
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
