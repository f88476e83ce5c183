//! What of a thread other threads may touch: its mailbox, a few flags, and counters.

use crate::clock::Clock;
use crate::mailbox::{Content, Envelope, Mailbox};
use crate::sync::atomic::{AtomicBool, Ordering};
use crate::sync::{Queue, park, planted, thread};
use crate::trace;
use std::sync::Arc;
use std::sync::atomic::{self as std_atomic, AtomicU32, AtomicU64, AtomicUsize};
use std::time::Instant;

/// Shared by a thread's loop, its handles and the addresses of its receivers.
pub(crate) struct Shared {
    pub(crate) name: Arc<str>,
    pub(crate) clock: Clock,
    pub(crate) mailbox: Mailbox,
    /// Nothing is delivered or called while this is set.
    pub(crate) paused: AtomicBool,
    /// A stop is in the queue: no sleep and no pause may keep the thread from reaching it.
    pub(crate) stopping: AtomicBool,
    /// The loop has ended and every object of the thread is dropped.
    finished: AtomicBool,
    waiters: Queue<thread::Thread>,
    next_id: AtomicU32,
    /// What is running: number of the call above, number of the object below; 0 = nothing.
    pub(crate) running: AtomicU64,
    /// Do senders stamp what they send here?
    pub(crate) traced: std_atomic::AtomicBool,
    pub(crate) tallies: Tallies,
}

impl Shared {
    pub(crate) fn new(name: &str, clock: Clock, wake: Box<dyn Fn() + Send + Sync>) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            clock,
            mailbox: Mailbox::new(wake),
            paused: AtomicBool::new(false),
            stopping: AtomicBool::new(false),
            finished: AtomicBool::new(false),
            waiters: Queue::new(),
            next_id: AtomicU32::new(1),
            running: AtomicU64::new(0),
            traced: std_atomic::AtomicBool::new(false),
            tallies: Tallies::default(),
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
    pub(crate) fn send(&self, content: Content) -> Result<(), Content> {
        let traced = self.traced.load(std_atomic::Ordering::Relaxed);
        let stamp = traced.then(|| Box::new(trace::Stamp::now(&self.clock)));
        match self.mailbox.send(Envelope { content, stamp }) {
            Ok(discarded) => {
                self.tallies.undelivered.add(discarded);
                Ok(())
            }
            Err(envelope) => Err(envelope.content),
        }
    }

    /// Says that the loop has ended and all objects are dropped, and wakes who waits for it.
    pub(crate) fn finish(&self) {
        self.finished
            .store(true, if planted("relaxed_finish") { Ordering::Relaxed } else { Ordering::SeqCst });
        let mut waiters = std::collections::VecDeque::new();
        self.waiters.drain(&mut waiters);
        for waiter in waiters {
            waiter.unpark();
        }
    }

    pub(crate) fn is_finished(&self) -> bool {
        self.finished.load(Ordering::SeqCst)
    }

    /// Waits until all of `threads` have finished: the names of those that have not by `deadline`.
    ///
    /// First said, then looked: a thread that finishes in between either sees the waiter or is
    /// seen as finished.
    pub(crate) fn wait_for(threads: &[Arc<Self>], deadline: Instant) -> Result<(), Vec<String>> {
        let early: Vec<bool> = threads.iter().map(|shared| shared.is_finished()).collect();
        for shared in threads {
            shared.waiters.push(thread::current());
        }
        if planted("unchecked_wait") && early.contains(&false) {
            park(Some(deadline));
        }
        loop {
            let running: Vec<String> = threads
                .iter()
                .filter(|shared| !shared.is_finished())
                .map(|shared| shared.name.to_string())
                .collect();
            if running.is_empty() {
                return Ok(());
            }
            if Instant::now() >= deadline {
                return Err(running);
            }
            park(Some(deadline));
        }
    }
}

/// A number that goes up; read by anybody, exact once the counting threads are at rest.
#[derive(Default)]
pub(crate) struct Tally(AtomicUsize);

impl Tally {
    pub(crate) fn add(&self, count: usize) {
        if count > 0 {
            self.0.fetch_add(count, std_atomic::Ordering::Relaxed);
        }
    }

    fn get(&self) -> u64 {
        self.0.load(std_atomic::Ordering::Relaxed) as u64
    }
}

#[derive(Default)]
pub(crate) struct Tallies {
    pub(crate) iterations: Tally,
    pub(crate) delivered: Tally,
    pub(crate) undeliverable: Tally,
    pub(crate) undelivered: Tally,
    pub(crate) replaced: Tally,
    pub(crate) refused: Tally,
    pub(crate) panics: Tally,
    pub(crate) restarts: Tally,
}

/// What happened in a thread since its start. Every message that was accepted is counted in
/// exactly one of the first four, once the thread has stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Messages handed to their receiver, also when it panicked with them.
    pub delivered: u64,
    /// Messages to a receiver that was not, or no longer, registered.
    pub undeliverable: u64,
    /// Messages still queued when the thread stopped.
    pub undelivered: u64,
    /// Messages whose place a newer one took ([`Address::latest`](crate::Address::latest)).
    pub replaced: u64,
    /// Messages given back because the address was full: not accepted.
    pub refused: u64,
    /// Turns of the loop.
    pub iterations: u64,
    /// Calls that ended in a panic.
    pub panics: u64,
    /// Objects made anew after a panic.
    pub restarts: u64,
}

impl Tallies {
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
