//! What of a thread other threads may touch: its mailbox, a few flags, and counters.

use crate::batch::{Content, Letter};
use crate::clock::Clock;
use crate::job::Jobs;
use crate::mailbox::Mailbox;
use crate::register::Label;
use crate::sync::atomic::{AtomicBool, Ordering};
use crate::sync::{Held, mutant, thread};
use crate::trace;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{self as std_atomic, AtomicU32, AtomicU64, AtomicUsize};

/// Has cache lines to itself: who changes it all the time does not take what lies beside it from
/// those who only read.
#[repr(align(128))]
pub(crate) struct Apart<T>(pub(crate) T);

/// Shared by a thread's loop, its handles and the addresses of its receivers.
pub(crate) struct Shared {
    pub(crate) name: Arc<str>,
    pub(crate) clock: Clock,
    pub(crate) mailbox: Apart<Mailbox>,
    /// Nothing is delivered or called while this is set.
    pub(crate) paused: AtomicBool,
    /// A stop is in the queue: no sleep and no pause may keep the thread from reaching it.
    pub(crate) stopping: AtomicBool,
    /// The loop has ended and every object of the thread is dropped.
    pub(crate) finished: AtomicBool,
    /// Woken when the loop has ended.
    pub(crate) waiters: Held<Vec<thread::Thread>>,
    /// The background work that belongs to the thread.
    pub(crate) jobs: Jobs,
    /// What the objects are called, for a watchdog; empty without one.
    pub(crate) labels: Held<BTreeMap<u32, Label>>,
    next_id: AtomicU32,
    running: Apart<AtomicU64>,
    /// Do senders stamp what they send here?
    pub(crate) traced: std_atomic::AtomicBool,
    pub(crate) tallies: Apart<Counters<Tally>>,
}

impl Shared {
    pub(crate) fn new(name: &str, clock: Clock, wake: Box<dyn Fn() + Send + Sync>) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            clock,
            mailbox: Apart(Mailbox::new(wake)),
            paused: AtomicBool::new(false),
            stopping: AtomicBool::new(false),
            finished: AtomicBool::new(false),
            waiters: Held::new(Vec::new()),
            jobs: Jobs::new(),
            labels: Held::new(BTreeMap::new()),
            next_id: AtomicU32::new(1),
            running: Apart(AtomicU64::new(0)),
            traced: std_atomic::AtomicBool::new(false),
            tallies: Apart(Counters::default()),
        })
    }

    /// A number for a worker or receiver, unique in this thread, ascending; never 0.
    pub(crate) fn new_id(&self) -> u32 {
        self.next_id.fetch_add(1, std_atomic::Ordering::Relaxed)
    }

    /// The number that comes next: those registered from now on have it or a higher one.
    pub(crate) fn next_id(&self) -> u32 {
        self.next_id.load(std_atomic::Ordering::Relaxed)
    }

    /// Stores `content` for the next iteration; gives it back when the thread has stopped.
    pub(crate) fn send<C: Content>(&self, to: u32, row: u32, content: C) -> Result<(), C> {
        let traced = self.traced.load(std_atomic::Ordering::Relaxed);
        let stamp = traced.then(|| Box::new(trace::Stamp::now(&self.clock)));
        self.mailbox.0.send(row, Letter { to, stamp, content })
    }

    /// Says that the loop has ended and all objects are dropped, and wakes who waits for it.
    pub(crate) fn finish(&self) {
        mutant!(self.relaxed_finish());
        self.finished.store(true, Ordering::SeqCst);
        self.waiters.with(std::mem::take).into_iter().for_each(|waiter| waiter.unpark());
    }

    /// Lets the watchdog see which object is running, and that it is another call than before.
    pub(crate) fn show_running(&self, id: u32) {
        let calls = (self.running() >> 32) + 1;
        self.running.0.store(calls << 32 | u64::from(id), std_atomic::Ordering::Relaxed);
    }

    /// The number of the object being called, 0 for none; above it the number of the call.
    pub(crate) fn running(&self) -> u64 {
        self.running.0.load(std_atomic::Ordering::Relaxed)
    }
}

/// A number that goes up; read by anybody, exact once the counting threads are at rest.
#[derive(Default)]
pub(crate) struct Tally(AtomicUsize);

impl Tally {
    /// Counts what any thread may do.
    pub(crate) fn add(&self, count: usize) {
        self.0.fetch_add(count, std_atomic::Ordering::Relaxed);
    }

    /// Counts what the thread itself does and nobody else: no thread has to be kept out.
    pub(crate) fn add_own(&self, count: usize) {
        self.0.store(self.0.load(std_atomic::Ordering::Relaxed) + count, std_atomic::Ordering::Relaxed);
    }

    pub(crate) fn get(&self) -> u64 {
        self.0.load(std_atomic::Ordering::Relaxed) as u64
    }
}

/// What happened in a thread since its start. Every message that was accepted is counted in
/// exactly one of the first four, once the thread has stopped.
///
/// What others get are plain numbers; the thread itself counts in the same fields with atomic ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters<N = u64> {
    /// Messages handed to their receiver, also when it panicked with them.
    pub delivered: N,
    /// Messages to a receiver that was not, or no longer, registered.
    pub undeliverable: N,
    /// Messages still queued when the thread stopped.
    pub undelivered: N,
    /// Messages whose place a newer one took ([`Address::latest`](crate::Address::latest)).
    pub replaced: N,
    /// Messages given back because the address was full: not accepted.
    pub refused: N,
    /// Turns of the loop.
    pub iterations: N,
    /// Calls that ended in a panic.
    pub panics: N,
    /// Objects made anew after a panic.
    pub restarts: N,
}

impl Counters<Tally> {
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
