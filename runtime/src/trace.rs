//! Who sent what to whom, when, how long it waited and how long it took.
//!
//! Off, it costs one relaxed load for each message sent, and next to nothing for each call. On, each
//! message and each worker call becomes a [`Record`] in a ring that belongs to the traced thread,
//! and an event of the `tracing` crate at level TRACE, target `dragonfly_runtime::trace`.

use crate::clock::Clock;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// One message delivered, or one worker called.
#[derive(Clone, Debug)]
pub struct Record {
    /// The iteration it happened in, counted from 1 since the thread's start.
    pub iteration: u64,
    /// When the call began.
    pub at: Instant,
    /// How long the call took.
    pub took: Duration,
    /// What it was.
    pub event: Event,
}

/// What a [`Record`] tells of.
#[derive(Clone, Debug)]
pub enum Event {
    /// A message was taken from the queue.
    Message {
        /// `thread/object` that sent it; empty when it was sent outside of any runtime thread, or
        /// before the trace was on.
        from: Arc<str>,
        /// The receiver's name; empty when there is none any more.
        to: Arc<str>,
        /// The type of the message.
        message: &'static str,
        /// How long it lay in the queue; `None` when it was sent before the trace was on.
        waited: Option<Duration>,
        /// What became of it.
        end: End,
    },
    /// A worker was called.
    Worker {
        /// The worker's name.
        name: Arc<str>,
        /// What became of the call; `Done(false)` ended the iteration.
        end: End,
    },
}

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// It returned; the answer is a worker's, and `true` for messages.
    Done(bool),
    /// It panicked.
    Panicked,
    /// There is no such receiver.
    Undeliverable,
}

/// The newest records of one thread, oldest first.
#[derive(Clone, Debug)]
pub struct TraceSnapshot {
    /// The thread's name.
    pub thread: Arc<str>,
    /// When it was taken.
    pub taken: Instant,
    /// At most as many as the trace was told to keep.
    pub records: Vec<Record>,
}

/// The ring.
pub(crate) struct Trace {
    capacity: usize,
    pub(crate) records: VecDeque<Record>,
}

/// How many threads are traced. While it is 0 nobody keeps track of who is sending.
static TRACED_THREADS: AtomicUsize = AtomicUsize::new(0);

impl Trace {
    pub(crate) fn new(capacity: usize) -> Self {
        TRACED_THREADS.fetch_add(1, Ordering::Relaxed);
        Self { capacity, records: VecDeque::with_capacity(capacity) }
    }

    pub(crate) fn add(&mut self, record: Record) {
        let took = record.took;
        match &record.event {
            Event::Message { from, to, message, waited, end } => {
                tracing::trace!(%from, %to, message, ?waited, ?took, ?end, "message")
            }
            Event::Worker { name, end } => tracing::trace!(worker = %name, ?took, ?end, "worker"),
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

/// Put on a message by its sender.
pub(crate) struct Stamp {
    pub(crate) from: Arc<str>,
    pub(crate) sent: Instant,
}

/// On messages to a traced thread only.
pub(crate) type Stamped = Option<Box<Stamp>>;

/// Thread and object that are sending.
pub(crate) type Sender = Option<(Arc<str>, Arc<str>)>;

thread_local! {
    /// Which object of which runtime thread is being called on this OS thread.
    static SENDER: RefCell<Sender> = const { RefCell::new(None) };
}

impl Stamp {
    pub(crate) fn now(clock: &Clock) -> Self {
        let name = |(thread, object): &(Arc<str>, Arc<str>)| format!("{thread}/{object}").into();
        let from = SENDER.with_borrow(|sender| sender.as_ref().map(name)).unwrap_or_default();
        Self { from, sent: clock.now() }
    }
}

/// The names of an object as a sender. `None`, and next to free, while no thread is traced.
pub(crate) fn sender(thread: &Arc<str>, object: &Arc<str>) -> Sender {
    (TRACED_THREADS.load(Ordering::Relaxed) > 0).then(|| (Arc::clone(thread), Arc::clone(object)))
}

/// From now on what this OS thread sends is stamped with `sender`; returns who it was before.
pub(crate) fn send_as(sender: Sender) -> Sender {
    SENDER.replace(sender)
}
