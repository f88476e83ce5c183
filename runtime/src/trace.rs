//! Trace of a thread: each message with its sender, its receiver, its time in the queue and the
//! duration of the call.
//!
//! While it is off, it costs one relaxed load for each message sent, and nearly nothing for each call.
//! While it is on, each message and each worker call becomes a [`TraceRecord`] in a ring that belongs
//! to the traced thread, and an event of the `tracing` crate at level TRACE, target
//! `dragonfly_runtime::trace`.

use crate::clock::ThreadClock;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// One message delivered, or one worker called.
#[derive(Clone, Debug)]
pub struct TraceRecord {
    /// The iteration it happened in, counted from 1 since the thread's start.
    pub iteration: u64,
    /// Start of the call.
    pub at: Instant,
    /// Duration of the call.
    pub took: Duration,
    /// The object and the message of the call.
    pub event: TraceEvent,
}

/// The call of a [`TraceRecord`].
#[derive(Clone, Debug)]
pub enum TraceEvent {
    /// A message was taken from the queue.
    Message {
        /// The sender as `thread/object` or `thread/job`; empty when it was sent outside of the
        /// runtime, or before the trace was on.
        from: Arc<str>,
        /// The receiver's name; empty when it no longer exists.
        to: Arc<str>,
        /// The type of the message.
        message: &'static str,
        /// Time in the queue; `None` when it was sent before the trace was on.
        waited: Option<Duration>,
        /// How the call ended.
        end: CallEnd,
    },
    /// A worker was called.
    Worker {
        /// The worker's name.
        name: Arc<str>,
        /// How the call ended; `Done(false)` ended the iteration.
        end: CallEnd,
    },
}

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CallEnd {
    /// It returned this value; always `true` for messages.
    Done(bool),
    /// It panicked.
    Panicked,
    /// The receiver does not exist.
    Undeliverable,
}

/// The newest records of one thread, oldest first.
#[derive(Clone, Debug)]
pub struct TraceSnapshot {
    /// The thread's name.
    pub thread: Arc<str>,
    /// When the snapshot was made.
    pub taken: Instant,
    /// The records, at most the capacity of the trace.
    pub records: Vec<TraceRecord>,
}

/// The ring of records.
pub(crate) struct Trace {
    capacity: usize,
    pub(crate) records: VecDeque<TraceRecord>,
}

/// Number of traced threads. While it is 0, senders are not recorded.
static TRACED_THREADS: AtomicUsize = AtomicUsize::new(0);

impl Trace {
    pub(crate) fn new(capacity: usize) -> Self {
        TRACED_THREADS.fetch_add(1, Ordering::Relaxed);
        Self { capacity, records: VecDeque::with_capacity(capacity) }
    }

    pub(crate) fn add(&mut self, record: TraceRecord) {
        let took = record.took;
        match &record.event {
            TraceEvent::Message { from, to, message, waited, end } => {
                tracing::trace!(%from, %to, message, ?waited, ?took, ?end, "message")
            }
            TraceEvent::Worker { name, end } => tracing::trace!(worker = %name, ?took, ?end, "worker"),
        }
        if self.records.len() == self.capacity {
            self.records.pop_front();
        }
        self.records.push_back(record);
    }
}

impl Drop for Trace {
    fn drop(&mut self) {
        TRACED_THREADS.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Sender and time of a message.
pub(crate) struct Stamp {
    pub(crate) from: Arc<str>,
    pub(crate) sent: Instant,
}

/// The stamp of a letter; only letters to a traced thread have one.
pub(crate) type Stamped = Option<Box<Stamp>>;

/// Names of the thread and of the object or job that is sending.
pub(crate) type Sender = Option<(Arc<str>, Arc<str>)>;

thread_local! {
    /// The object or job that is running in this OS thread.
    static SENDER: RefCell<Sender> = const { RefCell::new(None) };
}

impl Stamp {
    pub(crate) fn now(clock: &ThreadClock) -> Self {
        let name = |(thread, object): &(Arc<str>, Arc<str>)| format!("{thread}/{object}").into();
        let from = SENDER.with_borrow(|sender| sender.as_ref().map(name)).unwrap_or_default();
        Self { from, sent: clock.now() }
    }
}

/// Returns the names of an object as a sender. `None`, at nearly no cost, while no thread is traced.
pub(crate) fn sender(thread: &Arc<str>, object: &Arc<str>) -> Sender {
    (TRACED_THREADS.load(Ordering::Relaxed) > 0).then(|| (Arc::clone(thread), Arc::clone(object)))
}

/// Stamps messages of this OS thread with `sender` from now on. Returns the previous sender.
pub(crate) fn send_as(sender: Sender) -> Sender {
    SENDER.replace(sender)
}
