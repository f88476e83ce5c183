//! The part of a thread that other threads access: its mailbox, a few flags, and counters.

use crate::batch::{Letter, LetterContent};
use crate::clock::ThreadClock;
use crate::job::Jobs;
use crate::mailbox::Mailbox;
use crate::register::Label;
use crate::sync::atomic::{AtomicBool, Ordering};
use crate::sync::{BriefLock, mutant, thread};
use crate::trace;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{self as std_atomic, AtomicU32, AtomicU64, AtomicUsize};

/// Aligns its content to cache lines of its own, so that frequent writes to it do not slow down reads
/// of the neighboring fields (false sharing).
#[repr(align(128))]
pub(crate) struct CacheAligned<T>(pub(crate) T);

/// The state shared by a thread's loop, its handles and the addresses of its receivers.
pub(crate) struct ThreadShared {
    pub(crate) name: Arc<str>,
    pub(crate) clock: ThreadClock,
    pub(crate) mailbox: CacheAligned<Mailbox>,
    /// While this is set, no message is delivered and no worker is called.
    pub(crate) paused: AtomicBool,
    /// A stop is queued: it interrupts a sleep or pause.
    pub(crate) stopping: AtomicBool,
    /// The loop has ended, and every object of the thread has been dropped.
    pub(crate) finished: AtomicBool,
    /// Threads to wake when the loop has ended.
    pub(crate) waiters: BriefLock<Vec<thread::Thread>>,
    /// The background work that belongs to the thread.
    pub(crate) jobs: Jobs,
    /// Names of the objects, for a watchdog; empty without one.
    pub(crate) labels: BriefLock<BTreeMap<u32, Label>>,
    next_id: AtomicU32,
    running: CacheAligned<AtomicU64>,
    /// Whether senders add a stamp to their messages.
    pub(crate) traced: std_atomic::AtomicBool,
    pub(crate) tallies: CacheAligned<Counters<Counter>>,
}

impl ThreadShared {
    pub(crate) fn new(name: &str, clock: ThreadClock, wake: Box<dyn Fn() + Send + Sync>) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            clock,
            mailbox: CacheAligned(Mailbox::new(wake)),
            paused: AtomicBool::new(false),
            stopping: AtomicBool::new(false),
            finished: AtomicBool::new(false),
            waiters: BriefLock::new(Vec::new()),
            jobs: Jobs::new(),
            labels: BriefLock::new(BTreeMap::new()),
            next_id: AtomicU32::new(1),
            running: CacheAligned(AtomicU64::new(0)),
            traced: std_atomic::AtomicBool::new(false),
            tallies: CacheAligned(Counters::default()),
        })
    }

    /// Returns a number for a worker or receiver: unique in this thread, ascending, never 0.
    pub(crate) fn new_id(&self) -> u32 {
        self.next_id.fetch_add(1, std_atomic::Ordering::Relaxed)
    }

    /// Returns the next number: objects registered from now on have this or a higher one.
    pub(crate) fn next_id(&self) -> u32 {
        self.next_id.load(std_atomic::Ordering::Relaxed)
    }

    /// Queues `content` for the next iteration, or returns it when the thread has stopped.
    pub(crate) fn send<C: LetterContent>(&self, to: u32, row: u32, content: C) -> Result<(), C> {
        let traced = self.traced.load(std_atomic::Ordering::Relaxed);
        let stamp = traced.then(|| Box::new(trace::Stamp::now(&self.clock)));
        self.mailbox.0.send(row, Letter { to, stamp, content })
    }

    /// Marks the thread as finished and wakes the threads that wait for it.
    pub(crate) fn finish(&self) {
        mutant!(self.relaxed_finish());
        self.finished.store(true, Ordering::SeqCst);
        self.waiters.with(std::mem::take).into_iter().for_each(|waiter| waiter.unpark());
    }

    /// Publishes to the watchdog which object is being called, with a new number of the call.
    pub(crate) fn set_running(&self, id: u32) {
        let calls = (self.running() >> 32) + 1;
        self.running.0.store(calls << 32 | u64::from(id), std_atomic::Ordering::Relaxed);
    }

    /// Returns the number of the object being called in the lower 32 bits, 0 for none, and the number
    /// of the call in the upper ones.
    pub(crate) fn running(&self) -> u64 {
        self.running.0.load(std_atomic::Ordering::Relaxed)
    }
}

/// A statistics counter. Exact once the threads that increment it have stopped doing so.
#[derive(Default)]
pub(crate) struct Counter(AtomicUsize);

impl Counter {
    /// Adds `count`; any thread may call this.
    pub(crate) fn add(&self, count: usize) {
        self.0.fetch_add(count, std_atomic::Ordering::Relaxed);
    }

    /// Adds `count` without an atomic read-modify-write; only the owning thread may call this.
    pub(crate) fn add_own(&self, count: usize) {
        self.0.store(self.0.load(std_atomic::Ordering::Relaxed) + count, std_atomic::Ordering::Relaxed);
    }

    pub(crate) fn get(&self) -> u64 {
        self.0.load(std_atomic::Ordering::Relaxed) as u64
    }
}

/// Statistics of a thread since its start. Once the thread has stopped, every accepted message is
/// counted in exactly one of the first four fields.
///
/// The public form has plain numbers; the thread itself uses atomic ones in the same fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters<N = u64> {
    /// Number of messages that their receiver was called with, also if it panicked.
    pub delivered: N,
    /// Number of messages to a receiver that was not, or no longer, registered.
    pub undeliverable: N,
    /// Number of messages still queued when the thread stopped.
    pub undelivered: N,
    /// Number of messages replaced by a newer one ([`Address::latest`](crate::Address::latest)).
    pub replaced: N,
    /// Number of messages not accepted because the address was full.
    pub refused: N,
    /// Number of iterations of the loop.
    pub iterations: N,
    /// Number of calls that panicked.
    pub panics: N,
    /// Number of objects restarted after a panic.
    pub restarts: N,
}

impl Counters<Counter> {
    pub(crate) fn read(&self) -> Counters {
        Counters {
            delivered: self.delivered.get(),
            undeliverable: self.undeliverable.get(),
            undelivered: self.undelivered.get(),
            replaced: self.replaced.get(),
            refused: self.refused.get(),
            iterations: self.iterations.get(),
            panics: self.panics.get(),
            restarts: self.restarts.get(),
        }
    }
}
